"""The cut list as CSV: one line per part."""

from __future__ import annotations

import csv
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from fabrication.errors import OutputError
from fabrication.nesting import NestedSheet
from fabrication.parts import FlatPart
from fabrication.stock import Material

COLUMNS = (
    "mark",
    "quantity",
    "length_mm",
    "width_mm",
    "thickness_mm",
    "material",
    "slots",
    "slot_width_min_mm",
    "slot_width_max_mm",
    "mass_kg",
    "sheet",
)


def mass(part: FlatPart, material: Material) -> float:
    """Mass of a part after cutting, kg."""
    return part.area * part.thickness * material.density * 1e-9


@dataclass(frozen=True)
class Line:
    """One more part of the list, of a facade; what is None stays empty. Mm and kg."""

    mark: str
    length: float
    width: float | None = None
    thickness: float | None = None
    material: str = ""
    mass: float | None = None
    sheet: str = ""


def write_schedule(
    path: Path | str,
    parts: Sequence[FlatPart],
    sheets: Sequence[NestedSheet],
    material: Material,
    more: Sequence[Line] = (),
) -> None:
    """Write the cut list of *parts*, in their order, and *more*; it opens in any spreadsheet.

    Raises
    ------
    OutputError
        When the file cannot be written.
    """
    sheet_of = {p.part.mark: sheet.number for sheet in sheets for p in sheet.placements}
    rows = [_row(part, material, sheet_of[part.mark]) for part in parts]
    rows += [_more(line) for line in more]
    try:
        with Path(path).open("w", newline="", encoding="utf-8") as file:
            csv.writer(file).writerows([COLUMNS, *rows])
    except OSError as error:
        raise OutputError(
            "The cut list cannot be written", where=str(path), value=error.strerror or ""
        ) from None


def _row(part: FlatPart, material: Material, sheet: int) -> list[str | int]:
    widths = [slot.width for slot in part.slots]
    return [
        part.mark,
        1,
        f"{part.length:.2f}",
        f"{part.width:g}",
        f"{part.thickness:g}",
        material.name,
        len(part.slots),
        f"{min(widths):.2f}" if widths else "",
        f"{max(widths):.2f}" if widths else "",
        np.format_float_positional(mass(part, material), precision=6, fractional=False, trim="-"),
        sheet,
    ]


def _more(line: Line) -> list[str | int]:
    def cell(value: float | None) -> str:
        return "" if value is None else f"{value:g}"

    return [
        *(line.mark, 1, f"{line.length:.2f}"),
        *("" if line.width is None else f"{line.width:.2f}", cell(line.thickness), line.material),
        *("", "", "", cell(line.mass), line.sheet),
    ]
