"""The report to print on a planar net: panels, plates and connectors, on A4 portrait pages."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from fabrication.export.panel_schedule import Row, schedule_rows
from fabrication.export.papers.flow import heading, table, write_flow
from fabrication.export.papers.report_figures import (
    file_figures,
    net_figures,
    panel_figures,
    support_figures,
)
from fabrication.export.papers.report_front import (
    charts,
    foot_words,
    found,
    front,
    key_figures,
    surface_group,
)
from fabrication.export.papers.tables import Column
from fabrication.export.quality_series import Series
from fabrication.nesting import NestedSheet
from fabrication.panel_structure import COLOURS, PanelStructure
from fabrication.words import fixed, number
from gridshell.painter import Faces, padded, painted

_PANELS = (
    *(Column("mark", 0.8), Column("kind", 1.1), Column("group", 0.7)),
    *(Column("alike", 0.6, "right"), Column("length, mm", 1.0, "right")),
    *(Column("width, mm", 1.0, "right"), Column("angles, °", 3.0)),
    *(Column("out of plane, mm", 1.0, "right"), Column("mass, kg", 0.9, "right")),
    Column("sheet", 1.3),
)


def write_panel_paper(
    path: Path | str,
    *,
    name: str,
    report: Mapping[str, Any],
    series: Sequence[Series],
    built: PanelStructure,
    panel_sheets: Sequence[NestedSheet],
    plate_sheets: Sequence[NestedSheet],
    star_sheets: Sequence[NestedSheet] = (),
) -> Path:
    """Write the report; the same input gives the same bytes on the same day.

    Parameters
    ----------
    name : the project's.
    report : what ``report.json`` holds; a figure that is missing reads "not measured".
    series : of the net.
    built : what is built; the sheets are those of its panels, plates and star plates.

    Raises
    ------
    OutputError
        When the file cannot be written.
    """
    spec, held = built.system.panels, report.get("supports")
    kinds = ["panels", *(["plates"] if built.plates else [])]
    faces = tuple(
        Faces(found, painted(COLOURS[kind], len(found)))
        for kind in kinds
        for found in (padded([part.in_space() for part in getattr(built, kind)]),)
    )
    blocks = [
        *front(
            name,
            report,
            f"{len(built.panels)} panels of {spec.thickness:g} mm, {spec.material.name}, "
            f"{spec.gap:g} mm apart.",
            faces,
            tuple((kind.capitalize(), COLOURS[kind]) for kind in kinds),
        ),
        *key_figures(
            *surface_group(report),
            ("Net", net_figures(report.get("net") or {})),
            ("Structure", panel_figures(report.get("structure") or {})),
            *((("Supports", support_figures(held)),) if held else ()),
            ("Files", file_figures(report)),
        ),
        *found(
            report,
            "Not checked: loads, deflections, buckling, glass strength, and how panels are held.",
        ),
        *charts(series),
        heading("Cut list"),
        *table(
            _PANELS,
            [
                _panel_row(row)
                for row in schedule_rows(built, panel_sheets, plate_sheets, star_sheets)
            ],
        ),
    ]
    return write_flow(path, blocks, title=f"{name}: report", foot=foot_words(name))


def _panel_row(row: Row) -> tuple[str, ...]:
    return (
        *(row.mark, row.kind, row.group, f"{row.alike}"),
        *(fixed(row.length, 1), fixed(row.width, 1)),
        " / ".join(fixed(angle, 1) for angle in row.angles),
        "" if row.out_of_plane is None else fixed(row.out_of_plane, 4),
        *(number(row.mass), row.sheet),
    )
