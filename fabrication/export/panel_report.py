"""The report on a planar net: one HTML page, as that on lamellas."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np

from fabrication.colours import css
from fabrication.errors import OutputError
from fabrication.export.panel_schedule import schedule_rows
from fabrication.export.quality_series import Series
from fabrication.export.report import shared
from fabrication.export.scene.panels import group_colours
from fabrication.export.scene.whole import panel_patterns, panel_scene
from fabrication.export.sheet_drawing import sheet_drawings
from fabrication.export.sheet_files import sheet_files
from fabrication.nesting import NestedSheet
from fabrication.panel_structure import COLOURS, PanelStructure


def write_panel_report(
    path: Path | str,
    *,
    name: str,
    report: Mapping[str, Any],
    built: PanelStructure,
    panel_sheets: Sequence[NestedSheet],
    plate_sheets: Sequence[NestedSheet],
    star_sheets: Sequence[NestedSheet] = (),
    pictures: Sequence[Mapping[str, Any]] = (),
    series: Sequence[Series] = (),
) -> None:
    """Write the page.

    Parameters
    ----------
    report : what ``report.json`` holds.
    built : what is built; the sheets are those of its panels and plates.
    pictures : of the way from the surface to the net.
    series : the figures of the net, element by element.

    Raises
    ------
    OutputError
        When the file cannot be written.
    """
    colours = group_colours(built.panel_groups)
    page = shared(
        "panel_report.html",
        name=name,
        report=report,
        pictures=pictures,
        series=series,
        scene=panel_scene(built),
        patterns=panel_patterns(built),
        system=built.system,
        rows=schedule_rows(built, panel_sheets, plate_sheets, star_sheets),
        panel_groups=[
            {
                "name": group.name,
                "colour": css(tuple(colours[number].tolist())),
                "marks": [built.panels[m.index].mark for m in group.members],
                "deviation": max(m.deviation for m in group.members),
            }
            for number, group in sorted(
                enumerate(built.panel_groups), key=lambda pair: -len(pair[1].members)
            )
        ],
        drawings=[
            drawing
            for prefix, sheets in (
                ("panels", panel_sheets),
                ("plates", plate_sheets),
                ("stars", star_sheets),
            )
            for drawing in sheet_drawings(sheets, sheet_files(sheets, prefix=prefix))
        ],
        size=np.ptp(built.mesh.vertices, axis=0) / 1e3,
        swatches={"panel": "a", "plate": "b", "connector": "c", "star plate": "c"},
        colours={number: css(COLOURS[kind]) for number, kind in enumerate(COLOURS, start=1)},
    )
    try:
        Path(path).write_text(page, encoding="utf-8")
    except OSError as error:
        raise OutputError(
            "The report cannot be written", where=str(path), value=error.strerror or ""
        ) from None
