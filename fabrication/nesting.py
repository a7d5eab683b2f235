"""Parts on sheets: strips in rows, longest first into the first row that still has room."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from fabrication.errors import StockError
from fabrication.parts import FlatPart
from fabrication.stock import Sheet


@dataclass(frozen=True, eq=False)
class Placement:
    """A part on a sheet; (x, y) is where its strip coordinates (0, 0) lie, mm."""

    part: FlatPart
    x: float
    y: float


@dataclass(frozen=True, eq=False)
class NestedSheet:
    """One sheet and its parts."""

    number: int
    sheet: Sheet
    placements: tuple[Placement, ...]

    @property
    def used(self) -> float:
        """Part area over sheet area."""
        area = sum(p.part.area for p in self.placements)
        return area / (self.sheet.length * self.sheet.width)


def nest(parts: Sequence[FlatPart], sheet: Sheet) -> tuple[NestedSheet, ...]:
    """Place all *parts* on as few sheets as first-fit decreasing finds.

    Raises
    ------
    StockError
        For a part longer or wider than the sheet between its margins; the longest is named.
    """
    for part in sorted(parts, key=lambda p: -p.length):
        _check_fit(part, sheet)
    rows = _rows(parts, sheet)
    pitch = max((part.width for part in parts), default=0.0) + sheet.gap
    per_sheet = max(1, int((sheet.width - 2.0 * sheet.margin + sheet.gap) // pitch)) if parts else 1
    sheets = []
    for number, first in enumerate(range(0, len(rows), per_sheet), start=1):
        placements = []
        for i, row in enumerate(rows[first : first + per_sheet]):
            x = sheet.margin
            for part in row:
                placements.append(Placement(part, x, sheet.margin + i * pitch))
                x += part.length + sheet.gap
        sheets.append(NestedSheet(number, sheet, tuple(placements)))
    return tuple(sheets)


def _rows(parts: Sequence[FlatPart], sheet: Sheet) -> list[list[FlatPart]]:
    room = sheet.length - 2.0 * sheet.margin
    rows: list[list[FlatPart]] = []
    left: list[float] = []
    for part in sorted(parts, key=lambda p: (-p.length, p.mark)):
        row = next((i for i, free in enumerate(left) if free >= part.length), None)
        if row is None:
            rows.append([])
            left.append(room)
            row = len(rows) - 1
        rows[row].append(part)
        left[row] -= part.length + sheet.gap
    return rows


def _check_fit(part: FlatPart, sheet: Sheet) -> None:
    for what, size, room in (
        ("long", part.length, sheet.length - 2.0 * sheet.margin),
        ("wide", part.width, sheet.width - 2.0 * sheet.margin),
    ):
        if size > room:
            raise StockError(
                f"A lamella is too {what} for the stock",
                where=part.mark,
                value=f"{size:.1f} mm",
                limit=f"{room:.1f} mm between the sheet's margins",
                advice="a longer sheet or coil, a smaller margin, or shorter lamellas"
                if what == "long"
                else "a wider sheet, or a narrower profile",
            )
