"""The cut list and the bill of material as CSV: one line per part, one per thing bought or made."""

from __future__ import annotations

import csv
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from fabrication.errors import OutputError
from fabrication.jointed import BillLine
from fabrication.nesting import NestedSheet, sheets_of
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
    "holes",
    "wall_mm",
    "drillings",
    "bevel_start_mm",
    "bevel_end_mm",
    "mass_kg",
    "sheet",
)
"""Bevels: how much longer the near face is than the far one at either end; empty at a square end.
A strip that lies on no sheet has none."""

BILL_COLUMNS = ("item", "size", "quantity", "unit", "material", "mass_kg", "total_kg", "note")
"""Of ``bill.csv``; mass_kg is that of one piece, empty where it is not known."""


DRILL_COLUMNS = ("mark", "from_end_mm", "diameter_mm", "node", "purpose")
"""Of ``drillings.csv``."""


def mass(part: FlatPart, material: Material) -> float:
    """Mass of a part after cutting, kg."""
    return part.volume * material.density * 1e-9


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
    on = sheets_of(sheets)
    rows = [_row(part, material, " ".join(map(str, on.get(part.mark, ())))) for part in parts]
    rows += [_more(line) for line in more]
    write_csv(path, "The cut list", [COLUMNS, *rows])


def write_drillings(path: Path | str, parts: Sequence[FlatPart]) -> None:
    """Write where tubes are drilled through both narrow walls, from their left ends.

    Raises
    ------
    OutputError
        When the file cannot be written.
    """
    rows = [
        (part.mark, f"{drill.x:.2f}", f"{drill.diameter:g}", drill.node, drill.purpose)
        for part in parts
        for drill in part.drills
    ]
    write_csv(path, "The list of drillings", [DRILL_COLUMNS, *rows])


def write_bill(path: Path | str, bill: Sequence[BillLine]) -> None:
    """Write what a joint needs besides the strips, in the order of *bill*.

    Raises
    ------
    OutputError
        When the file cannot be written.
    """
    rows = [
        (
            *(line.item, line.size, f"{line.quantity:g}", line.unit, line.material),
            "" if line.mass is None else six_digits(line.mass),
            "" if line.mass is None else six_digits(line.mass * line.quantity),
            line.note,
        )
        for line in bill
    ]
    write_csv(path, "The bill of material", [BILL_COLUMNS, *rows])


def write_csv(path: Path | str, what: str, rows: Sequence[Sequence[str | int]]) -> None:
    """Write *rows*, their headings first; *what* they are, for the message when that fails.

    Raises
    ------
    OutputError
        When the file cannot be written.
    """
    try:
        with Path(path).open("w", newline="", encoding="utf-8") as file:
            csv.writer(file).writerows(rows)
    except OSError as error:
        raise OutputError(
            f"{what} cannot be written", where=str(path), value=error.strerror or ""
        ) from None


def six_digits(value: float) -> str:
    """*value* with six digits that count, without a power of ten."""
    return np.format_float_positional(value, precision=6, fractional=False, trim="-")


def _row(part: FlatPart, material: Material, sheet: str) -> list[str | int]:
    widths = [slot.width for slot in part.slots]
    return [
        part.mark,
        part.quantity,
        f"{part.length:.2f}",
        f"{part.width:g}",
        f"{part.thickness:g}",
        material.name,
        len(part.slots),
        f"{min(widths):.2f}" if widths else "",
        f"{max(widths):.2f}" if widths else "",
        len(part.holes),
        f"{part.wall:g}" if part.wall else "",
        len(part.drills),
        *(f"{run:.2f}" if run else "" for run in part.bevels),
        six_digits(mass(part, material)),
        sheet,
    ]


def _more(line: Line) -> list[str | int]:
    def cell(value: float | None) -> str:
        return "" if value is None else f"{value:g}"

    return [
        *(line.mark, 1, f"{line.length:.2f}"),
        *("" if line.width is None else f"{line.width:.2f}", cell(line.thickness), line.material),
        *("", "", "", "", "", "", "", "", cell(line.mass), line.sheet),
    ]
