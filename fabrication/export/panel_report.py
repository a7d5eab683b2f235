"""The report on a planar net: one HTML page, as that on lamellas."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np

import gridshell as gs
from fabrication.colours import css
from fabrication.errors import OutputError
from fabrication.export.panel_schedule import schedule_rows
from fabrication.export.report import middle, shared
from fabrication.export.scene.layers import Scene, on_screen
from fabrication.export.scene.net import net_layers
from fabrication.export.scene.panels import (
    group_colours,
    panel_layers,
    plate_colouring,
    support_layers,
)
from fabrication.export.scene.strips import axis_layers
from fabrication.nesting import NestedSheet
from fabrication.panel_structure import COLOURS, PanelStructure
from gridshell.arrays import Floats


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
) -> None:
    """Write the page.

    Parameters
    ----------
    report : what ``report.json`` holds.
    built : what is built; the sheets are those of its panels and plates.
    pictures : of the way from the surface to the net.

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
        scene=panel_scene(built),
        patterns={},
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
        sheets=[
            *_sheets(panel_sheets, "panels"),
            *_sheets(plate_sheets, "plates"),
            *_sheets(star_sheets, "stars"),
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


def panel_scene(
    built: PanelStructure, *, net: gs.ControlMesh | None = None, centre: Floats | None = None
) -> Scene:
    """Panels, plates, connectors and marks.

    Parameters
    ----------
    net : the control mesh; its layers are left out without.
    centre : (3,) mm, the origin of the scene; the middle of the vertices without.
    """
    vertices = built.mesh.vertices
    centre = middle(vertices) if centre is None else centre
    layers = [*panel_layers(built, centre), *support_layers(built, centre)]
    layers += [] if net is None else net_layers(net, centre)
    return Scene([*layers, *axis_layers(on_screen(vertices, centre))], plate_colouring(built))


def _sheets(sheets: Sequence[NestedSheet], prefix: str) -> list[dict[str, Any]]:
    digits = max(2, len(str(len(sheets))))
    return [
        {
            "file": f"{prefix}-{sheet.number:0{digits}d}.dxf",
            "parts": len(sheet.placements),
            "length": sheet.sheet.length,
            "width": sheet.sheet.width,
            "used": sheet.used,
        }
        for sheet in sheets
    ]
