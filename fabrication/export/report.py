"""The report: one HTML page that opens from disk and asks no network for anything.

The page shows what ``report.json`` and the parts hold: the shell to turn and to hover over, the
key figures, the findings, the cut list and the longest strip. Words and definitions live in
``report.html``, geometry and the writing of numbers here. plotly.js is inlined, and the page's own
policy forbids every request.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
from jinja2 import ChainableUndefined, Environment, FileSystemLoader
from markupsafe import Markup
from plotly.offline import get_plotlyjs

from fabrication.colours import FAMILY_COLOURS, css
from fabrication.cut import Edge, outline
from fabrication.errors import OutputError
from fabrication.export.schedule import mass
from fabrication.export.shell import shell_figure
from fabrication.export.words import finite, fixed, number, plural, raised
from fabrication.finding import Severity
from fabrication.nesting import NestedSheet
from fabrication.parts import FlatPart
from fabrication.structures import Structure
from gridshell.arrays import Floats

_STRIP, _THINNEST_SLOT, _PITCH = (1040.0, 62.0), 3.0, 13.0
"""Of the drawing, px: the strip, its narrowest slot, and the room a station's figure needs."""


def write_report(
    path: Path | str,
    *,
    name: str,
    report: Mapping[str, Any],
    structure: Structure,
    parts: Sequence[FlatPart],
    sheets: Sequence[NestedSheet] = (),
    clearance: float | None = None,
    pictures: Sequence[Mapping[str, Any]] = (),
) -> None:
    """Write the page.

    Parameters
    ----------
    path : the HTML file, in a folder that exists.
    name : the project's name, as the title.
    report : what ``report.json`` holds; a figure that is missing or None reads "not measured".
    structure, parts : one part per lamella, in the structure's order.
    sheets : where the parts lie; without them the cut list names no sheet.
    clearance : of the slots, mm; None leaves it out.
    pictures : of the way from the surface to the net, see ``stages``.

    Raises
    ------
    OutputError
        When the file cannot be written.
    """
    page = shared(
        "report.html",
        name=name,
        report=report,
        pictures=pictures,
        figure=shell_figure(structure, parts),
        masses=[mass(part, structure.profile.material) for part in parts],
        sheet_of={p.part.mark: sheet.number for sheet in sheets for p in sheet.placements},
        raw=sorted({(sheet.sheet.length, sheet.sheet.width) for sheet in sheets}),
        clearance=clearance,
        structure=structure,
        parts=parts,
        families=[sum(lamella.family == f for lamella in structure.lamellas) for f in (1, 2)],
        size=np.ptp([node.position for node in structure.nodes], axis=0) / 1e3,
        colours={family: css(colour) for family, colour in FAMILY_COLOURS.items()},
        drawing=_drawing(max(parts, key=lambda part: round(part.length, 1))),
    )
    try:
        Path(path).write_text(page, encoding="utf-8")
    except OSError as error:
        raise OutputError(
            "The report cannot be written", where=str(path), value=error.strerror or ""
        ) from None


def shared(
    template: str,
    *,
    name: str,
    report: Mapping[str, Any],
    pictures: Sequence[Mapping[str, Any]],
    figure: Any,
    **more: Any,
) -> str:
    """A report's page: *template* with what all reports share, and *more* of its own.

    Parameters
    ----------
    figure : plotly's, of the 3D view.
    """
    level, verdict = _verdict(report.get("findings"))
    page: str = _template(template).render(
        name=name,
        report=report,
        level=level,
        verdict=verdict,
        groups=_groups(report.get("findings") or ()),
        pictures=[{**picture, "svg": Markup(picture["svg"])} for picture in pictures],
        figure=Markup(figure.to_json().replace("<", "\\u003c")),
        plotly=Markup(get_plotlyjs()),
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


# ---- the longest strip ----------------------------------------------------------------------


def _drawing(part: FlatPart) -> dict[str, Any]:
    """A flat strip to look at, px: lengths to scale, its width and its slots not.

    A station is its place along the strip, the place of its figure, the figure, and the mark of
    the partner with its height; the two ends have no partner.
    """
    length, height = _STRIP
    along, across = length / part.length, height / part.width
    drawn = [
        replace(
            s, x=s.x * along, width=max(s.width * along, _THINNEST_SLOT), depth=s.depth * across
        )
        for s in part.slots
    ]
    x = np.array([0.0, *(slot.x for slot in part.slots), part.length])
    figures = [fixed(station, 1) for station in x.tolist()]
    partners = ["", *(slot.partner for slot in part.slots), ""]
    behind = [0.8 if slot.edge is Edge.UPPER else 0.2 for slot in part.slots]
    heights = [height * share for share in (0.0, *behind, 0.0)]
    places = (x * along).round(1).tolist(), _apart(x * along).round(1).tolist()
    return {
        "part": part,
        "length": length,
        "height": height,
        "corners": " ".join(f"{x:.1f},{height - y:.1f}" for x, y in outline(length, height, drawn)),
        "stations": list(zip(*places, figures, partners, heights, strict=True)),
    }


def _apart(x: Floats) -> Floats:
    """*x* (n,) in order, moved so far that neighbours are a pitch apart within the strip."""
    steps = min(_PITCH, _STRIP[0] / (len(x) - 1)) * np.arange(len(x))
    moved = np.maximum.accumulate(x - steps) + steps
    return np.asarray(np.minimum(moved, _STRIP[0] - steps[::-1]))
