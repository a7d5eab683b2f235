"""The report: one HTML page that opens from disk and asks no network for anything.

The page shows what ``report.json`` and the parts hold: the shell to turn, to hover over and to
colour, the key figures, the findings, the stress by strip, the bill, the cut list and the longest
strip. Words and definitions live in
``report.html``, what the 3D view shows in ``scene``, the writing of numbers here. Scripts are
inlined, and the page's own policy forbids every request.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np
from markupsafe import Markup

from fabrication.colours import FAMILY_COLOURS, css
from fabrication.errors import OutputError
from fabrication.export.html import rendered
from fabrication.export.quality_series import Series, histograms, stress_series
from fabrication.export.scene.layers import Scene
from fabrication.export.scene.page import as_json, deflated, scripts, style
from fabrication.export.scene.whole import flat_patterns, lamella_scene
from fabrication.export.schedule import mass
from fabrication.export.sheet_drawing import SheetDrawing
from fabrication.export.stress_view import net_words, stress_rows
from fabrication.export.verdicts import finding_groups, verdict
from fabrication.jointed import Jointed
from fabrication.motion import Motion
from fabrication.nesting import NestedSheet, sheets_of
from fabrication.outlines import Frame
from fabrication.panel_structure import PanelStructure
from fabrication.parts import FlatPart
from fabrication.strength import BayStress, bay_stress
from fabrication.stress_checks import stress_section


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
    series: Sequence[Series] = (),
    copies: Sequence[Frame] = (),
    moving: tuple[Motion, float] | None = None,
    drawings: Sequence[SheetDrawing] = (),
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
    series : the figures of the net, element by element; those of the strips come from *stress*.
    copies : where else the shell stands, drawn as lines.
    moving : how the net opens, and how far it is opened as built.
    drawings : of all cutting sheets.

    Raises
    ------
    OutputError
        When the file cannot be written.
    """
    stress = bay_stress(jointed.strips, parts) if stress is None else stress
    design, strips = jointed.design, jointed.strips
    longest = max(parts, key=lambda part: round(part.length, 1))
    patterns = flat_patterns(jointed, parts)
    page = shared(
        "report.html",
        name=name,
        report=report,
        pictures=pictures,
        series=[*series, stress_series(stress)],
        scene=lamella_scene(jointed, parts, stress, facade=facade, copies=copies, moving=moving),
        patterns=patterns,
        drawings=drawings,
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
        longest=longest,
        drawing=Markup(patterns[longest.mark]),
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
    series: Sequence[Series],
    scene: Scene,
    patterns: Mapping[str, str],
    drawings: Sequence[SheetDrawing],
    **more: Any,
) -> str:
    """A report's page: *template* with what all reports share, and *more* of its own.

    Parameters
    ----------
    series : what the histograms are drawn of.
    scene : of the 3D view.
    patterns : SVG of flat parts, by their marks.
    drawings : of all cutting sheets.
    """
    level, words = verdict(report.get("findings"))
    return rendered(
        template,
        name=name,
        report=report,
        level=level,
        verdict=words,
        groups=finding_groups(report.get("findings") or ()),
        pictures=[{**picture, "svg": Markup(picture["svg"])} for picture in pictures],
        histograms=[Markup(svg) for svg in histograms(series)],
        scene=as_json(scene.packed()),
        patterns=deflated(patterns),
        drawings=drawings,
        scripts=scripts(),
        viewer_style=style(),
        **more,
    )
