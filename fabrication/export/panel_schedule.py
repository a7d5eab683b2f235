"""The cut list of a planar net as CSV: one line per panel, plate, and cylinder or star plate."""

from __future__ import annotations

import csv
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from fabrication.errors import OutputError
from fabrication.export.sheet_files import sheet_files
from fabrication.grouping import Group
from fabrication.nesting import NestedSheet, SheetPart
from fabrication.outlines import corner_angles
from fabrication.panel_structure import PanelStructure
from gridshell.arrays import Floats

COLUMNS = (
    *("mark", "kind", "quantity", "group", "alike", "length_mm", "width_mm", "thickness_mm"),
    *("material", "corner_angles_deg", "out_of_plane_mm", "mass_kg", "sheet"),
)


@dataclass(frozen=True)
class Row:
    """One part of the list, as numbers.

    Parameters
    ----------
    alike : parts in its group.
    length, width, thickness : mm; of a connector its diameter twice and its height.
    angles : of the corners, or between a connector's slots, degrees.
    out_of_plane : of the net's corners, mm; None for a connector.
    mass : kg.
    sheet : name of the file without its ending; empty for parts that are not cut from sheets.
    """

    mark: str
    kind: str
    group: str
    alike: int
    length: float
    width: float
    thickness: float
    material: str
    angles: tuple[float, ...]
    out_of_plane: float | None
    mass: float
    sheet: str


def write_panel_schedule(
    path: Path | str,
    built: PanelStructure,
    panel_sheets: Sequence[NestedSheet],
    plate_sheets: Sequence[NestedSheet],
    star_sheets: Sequence[NestedSheet] = (),
) -> None:
    """Write the cut list; it opens in any spreadsheet.

    Raises
    ------
    OutputError
        When the file cannot be written.
    """
    rows = [_cells(row) for row in schedule_rows(built, panel_sheets, plate_sheets, star_sheets)]
    try:
        with Path(path).open("w", newline="", encoding="utf-8") as file:
            csv.writer(file).writerows([COLUMNS, *rows])
    except OSError as error:
        raise OutputError(
            "The cut list cannot be written", where=str(path), value=error.strerror or ""
        ) from None


def schedule_rows(
    built: PanelStructure,
    panel_sheets: Sequence[NestedSheet],
    plate_sheets: Sequence[NestedSheet],
    star_sheets: Sequence[NestedSheet] = (),
) -> list[Row]:
    """Panels, then plates, then connectors, each in the order of their numbers."""
    return [
        *_panels(built, panel_sheets),
        *_plates(built, plate_sheets),
        *_connectors(built, star_sheets),
    ]


def _panels(built: PanelStructure, sheets: Sequence[NestedSheet]) -> Iterator[Row]:
    lies, groups = _lying(sheets, "panels"), _groups(built.panel_groups)
    for panel in built.panels:
        part, sheet = lies[panel.mark]
        group, alike = groups[panel.index]
        yield Row(
            mark=panel.mark,
            kind="panel",
            group=group,
            alike=alike,
            length=part.length,
            width=part.width,
            thickness=panel.thickness,
            material=built.system.panels.material.name,
            angles=_degrees(panel.corner_angles),
            out_of_plane=panel.planarity,
            mass=panel.mass,
            sheet=sheet,
        )


def _plates(built: PanelStructure, sheets: Sequence[NestedSheet]) -> Iterator[Row]:
    if built.system.plates is None:
        return
    lies, groups = _lying(sheets, "plates"), _groups(built.plate_groups)
    for plate in built.plates:
        part, sheet = lies[plate.mark]
        group, alike = groups[plate.edge]
        yield Row(
            mark=plate.mark,
            kind="plate",
            group=group,
            alike=alike,
            length=part.length,
            width=part.width,
            thickness=plate.thickness,
            material=built.system.plates.material.name,
            angles=_degrees(corner_angles(plate.outline)),
            out_of_plane=plate.out_of_plane,
            mass=plate.mass,
            sheet=sheet,
        )


def _connectors(built: PanelStructure, sheets: Sequence[NestedSheet]) -> Iterator[Row]:
    material = built.system.connector_material
    if material is None:
        return
    lies, groups = _lying(sheets, "stars"), _groups(built.connector_groups)
    kind = "connector" if built.system.star is None else "star plate"
    for index, piece in enumerate(built.pieces):
        across = 2.0 * piece.connector.spec.radius
        group, alike = groups[index]
        yield Row(
            mark=piece.mark,
            kind=kind,
            group=group,
            alike=alike,
            length=across,
            width=across,
            thickness=piece.height,
            material=material.name,
            angles=_degrees(piece.connector.between),
            out_of_plane=None,
            mass=built.piece_mass(piece),
            sheet=lies[piece.mark][1] if piece.mark in lies else "",
        )


def _lying(sheets: Sequence[NestedSheet], prefix: str) -> dict[str, tuple[SheetPart, str]]:
    files = sheet_files(sheets, prefix=prefix)
    return {
        p.part.mark: (p.part, file)
        for sheet, file in zip(sheets, files, strict=True)
        for p in sheet.placements
    }


def _groups(groups: Sequence[Group]) -> dict[int, tuple[str, int]]:
    return {m.index: (group.name, len(group.members)) for group in groups for m in group.members}


def _degrees(angles: Floats) -> tuple[float, ...]:
    return tuple(np.degrees(angles).tolist())


def _cells(row: Row) -> list[str | int]:
    return [
        *(row.mark, row.kind, 1, row.group, row.alike),
        *(f"{row.length:.2f}", f"{row.width:.2f}", f"{row.thickness:g}", row.material),
        " ".join(f"{angle:.2f}" for angle in row.angles),
        "" if row.out_of_plane is None else f"{row.out_of_plane:.4f}",
        np.format_float_positional(row.mass, precision=6, fractional=False, trim="-"),
        row.sheet,
    ]
