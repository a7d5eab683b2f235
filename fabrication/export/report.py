"""The report: one HTML page that opens from disk and asks no network for anything.

The page shows what ``report.json`` and the parts hold: the shell to turn, to hover over and to
colour, the key figures, the findings, the stress by strip, the bill, the cut list and the longest
strip. Words and definitions live in
``report.html``, what the 3D view shows in ``scene``, the writing of numbers here. Scripts are
inlined, and the page's own policy forbids every request.
"""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np
from jinja2 import ChainableUndefined, Environment, FileSystemLoader
from markupsafe import Markup

import gridshell as gs
from fabrication.colours import FAMILY_COLOURS, css
from fabrication.errors import OutputError
from fabrication.export.scene.bodies import connector_layers
from fabrication.export.scene.layers import Layer, Scene, on_screen
from fabrication.export.scene.motion import motion_layers
from fabrication.export.scene.net import net_layers
from fabrication.export.scene.page import as_json, deflated, scripts, style
from fabrication.export.scene.panels import panel_layers
from fabrication.export.scene.strips import axis_layers, strip_layers
from fabrication.export.schedule import mass
from fabrication.export.stress_view import net_words, stress_colourings, stress_rows
from fabrication.export.strip_drawing import strip_drawing
from fabrication.export.words import finite, fixed, number, plural, raised
from fabrication.finding import Severity
from fabrication.jointed import Jointed
from fabrication.motion import Motion
from fabrication.nesting import NestedSheet, sheets_of
from fabrication.outlines import Frame
from fabrication.panel_structure import PanelStructure
from fabrication.parts import FlatPart
from fabrication.strength import BayStress, bay_stress
from fabrication.stress_checks import stress_section
from gridshell.arrays import Floats, Points


def write_report(
    path: Path | str,
    *,
    name: str,
    report: Mapping[str, Any],
    jointed: Jointed,
    parts: Sequence[FlatPart],
    stress: BayStress | None = None,
    sheets: Sequence[NestedSheet] = (),
    clearance: float | None = None,
    facade: PanelStructure | None = None,
    pictures: Sequence[Mapping[str, Any]] = (),
    copies: Sequence[Frame] = (),
    moving: tuple[Motion, float] | None = None,
) -> None:
    """Write the page.

    Parameters
    ----------
    path : the HTML file, in a folder that exists.
    name : the project's name, as the title.
    report : what ``report.json`` holds; a figure that is missing or None reads "not measured".
    jointed, parts : what is built; one part per strip, in the strips' order.
    stress : of all bays, where it is known already.
    sheets : where the parts lie; without them the cut list names no sheet.
    clearance : of the slots, mm; None leaves it out.
    facade : panels above the strips, where there are any.
    pictures : of the way from the surface to the net, see ``stages``.
    copies : where else the shell stands, drawn as lines.
    moving : how the net opens, and how far it is opened as built.

    Raises
    ------
    OutputError
        When the file cannot be written.
    """
    stress = bay_stress(jointed.strips, parts) if stress is None else stress
    design, strips = jointed.design, jointed.strips
    page = shared(
        "report.html",
        name=name,
        report=report,
        pictures=pictures,
        scene=lamella_scene(jointed, parts, stress, facade=facade, copies=copies, moving=moving),
        patterns=flat_patterns(jointed, parts),
        stress=stress_section(stress),
        net_section=net_words(stress),
        stress_rows=stress_rows(strips, stress),
        bill=jointed.bill,
        connectors=[prisms for prisms in jointed.connectors if prisms.bodies],
        masses=[mass(part, strips.profile.material) for part in parts],
        sheets_of=sheets_of(sheets),
        sheet_count=len(sheets),
        raw=sorted({(sheet.sheet.length, sheet.sheet.width) for sheet in sheets}),
        clearance=clearance,
        design=design,
        strips=strips,
        parts=parts,
        families=[sum(lamella.family == f for lamella in design.lamellas) for f in (1, 2)],
        size=np.ptp([node.position for node in design.nodes], axis=0) / 1e3,
        colours={family: css(colour) for family, colour in FAMILY_COLOURS.items()},
        drawing=strip_drawing(max(parts, key=lambda part: round(part.length, 1))),
    )
    try:
        Path(path).write_text(page, encoding="utf-8")
    except OSError as error:
        raise OutputError(
            "The report cannot be written", where=str(path), value=error.strerror or ""
        ) from None


def lamella_scene(
    jointed: Jointed,
    parts: Sequence[FlatPart],
    stress: BayStress,
    *,
    facade: PanelStructure | None = None,
    copies: Sequence[Frame] = (),
    net: gs.ControlMesh | None = None,
    moving: tuple[Motion, float] | None = None,
    centre: Floats | None = None,
) -> Scene:
    """Strips, nodes, connectors, and the panels above them, hidden until they are asked for.

    Parameters
    ----------
    net : the control mesh; its layers are left out without.
    moving : how the net opens, and how far it is opened as built.
    centre : (3,) mm, the origin of the scene; the middle of the nodes without.
    """
    nodes = np.array([node.position for node in jointed.design.nodes])
    centre = middle(nodes) if centre is None else centre
    layers: list[Layer] = strip_layers(jointed, parts, stress, centre, copies)
    layers += connector_layers(jointed.connectors, centre)
    if facade is not None:
        layers += panel_layers(facade, centre, visible=False)
    if net is not None:
        layers += net_layers(net, centre)
    if moving is not None:
        layers += motion_layers(moving[0], centre, moving[1])
    return Scene([*layers, *axis_layers(on_screen(nodes, centre))], stress_colourings(stress))


def middle(points: Points) -> Floats:
    """(3,) of the box around *points* (n, 3)."""
    return np.asarray((points.min(axis=0) + points.max(axis=0)) / 2.0)


def flat_patterns(jointed: Jointed, parts: Sequence[FlatPart]) -> dict[str, str]:
    """The drawing of every flat strip, an SVG, by its mark."""
    families = [lamella.family for lamella in jointed.strips.lamellas]
    return {
        part.mark: strip_svg(part, family) for part, family in zip(parts, families, strict=True)
    }


def strip_svg(part: FlatPart, family: int) -> str:
    """The drawing of one flat strip as an SVG that stands alone."""
    drawn: str = _template("strip.html").module.strip(
        strip_drawing(part), css(FAMILY_COLOURS[family])
    )
    return re.sub(r"[ \n]+", " ", drawn).strip()


def shared(
    template: str,
    *,
    name: str,
    report: Mapping[str, Any],
    pictures: Sequence[Mapping[str, Any]],
    scene: Scene,
    patterns: Mapping[str, str],
    **more: Any,
) -> str:
    """A report's page: *template* with what all reports share, and *more* of its own.

    Parameters
    ----------
    scene : of the 3D view.
    patterns : SVG of flat parts, by their marks.
    """
    level, verdict = _verdict(report.get("findings"))
    page: str = _template(template).render(
        name=name,
        report=report,
        level=level,
        verdict=verdict,
        groups=_groups(report.get("findings") or ()),
        pictures=[{**picture, "svg": Markup(picture["svg"])} for picture in pictures],
        scene=as_json(scene.packed()),
        patterns=deflated(patterns),
        scripts=scripts(),
        viewer_style=style(),
        **more,
    )
    return page


def _template(name: str) -> Any:
    environment = Environment(
        loader=FileSystemLoader(Path(__file__).parent),
        autoescape=True,
        undefined=ChainableUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
    )
    environment.filters.update(figure=number, fixed=fixed, plural=plural)
    return environment.get_template(name)


# ---- words and numbers ----------------------------------------------------------------------

_GRADES = [grade.value for grade in (Severity.ERROR, Severity.WARNING, Severity.INFO)]


def _verdict(findings: Sequence[Mapping[str, Any]] | None) -> tuple[str, str]:
    """The worst severity, or "good" or "unknown", and the line that says so."""
    if findings is None:
        return "unknown", "Not checked"
    if not findings:
        return "good", "Good: no findings"
    grades = [_GRADES[_gravity(finding)] for finding in findings]
    counts = ", ".join(plural(grades.count(g), g) for g in _GRADES if g in grades)
    text = f"{plural(len(findings), 'finding')} ({counts})"
    worst = _GRADES[min(map(_gravity, findings))]
    return ("good", f"Good, with {text}") if worst == Severity.INFO.value else (worst, text)


def _gravity(finding: Mapping[str, Any]) -> int:
    """0 for an error, and for what is no known severity."""
    grade = finding.get("severity")
    return _GRADES.index(grade) if grade in _GRADES else 0


def _groups(findings: Sequence[Mapping[str, Any]]) -> list[list[dict[str, Any]]]:
    """The findings as people read them, those of one severity and code together, gravest first."""
    groups: dict[tuple[int, Any], list[dict[str, Any]]] = {}
    for finding in sorted(findings, key=_gravity):
        key = _gravity(finding), finding.get("code")
        groups.setdefault(key, []).append(_readable(finding))
    return list(groups.values())


def _readable(finding: Mapping[str, Any]) -> dict[str, Any]:
    """*finding* with twist in degrees per metre, as its message says it, and raised exponents."""
    shown = {key: raised(text) if isinstance(text, str) else text for key, text in finding.items()}
    if finding.get("unit") == "rad/mm":
        values = {key: finding[key] for key in ("value", "limit") if finite(finding.get(key))}
        shown |= {key: float(np.degrees(v)) * 1000.0 for key, v in values.items()}
        shown["unit"] = "degrees/m"
    return shown
