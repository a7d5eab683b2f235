"""The cut list as CSV: one line per part."""

from __future__ import annotations

import csv
from collections.abc import Sequence
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


def write_schedule(
    path: Path | str,
    parts: Sequence[FlatPart],
    sheets: Sequence[NestedSheet],
    material: Material,
) -> None:
    """Write the cut list of *parts*, in their order; it opens in any spreadsheet.

    Raises
    ------
    OutputError
        When the file cannot be written.
    """
    sheet_of = {p.part.mark: sheet.number for sheet in sheets for p in sheet.placements}
    rows = [_row(part, material, sheet_of[part.mark]) for part in parts]
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
