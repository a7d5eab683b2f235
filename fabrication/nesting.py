"""Parts on sheets: in rows, widest and longest first, into the first row that still has room."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Protocol

import numpy as np

from fabrication.errors import StockError
from fabrication.parts import FlatPart, Label
from fabrication.stock import Sheet
from gridshell.arrays import Floats


class SheetPart(Protocol):
    """Anything cut from a sheet: a strip, a panel, a plate."""

    @property
    def mark(self) -> str:
        """Name, engraved and listed."""

    @property
    def outline(self) -> Floats:
        """(k, 2) closed, counter-clockwise, within (0, 0) .. (length, width), mm.

        Or (k, 3) with bulges, tan(sweep / 4), of the pieces from each corner to the next.
        """

    @property
    def circles(self) -> Floats:
        """(m, 3) rows x, y, diameter of round holes, mm."""

    @property
    def labels(self) -> tuple[Label, ...]:
        """Texts to engrave."""

    @property
    def length(self) -> float:
        """Extent along the sheet, mm."""

    @property
    def width(self) -> float:
        """Extent across the sheet, mm."""

    @property
    def thickness(self) -> float:
        """Of the sheet it is cut from, mm."""

    @property
    def area(self) -> float:
        """Net area, mm2."""


@dataclass(frozen=True, eq=False)
class Placement:
    """A part on a sheet; (x, y) is where its own coordinates (0, 0) lie, mm."""

    part: SheetPart
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


_ROUNDING = 1e-9


@dataclass(eq=False)
class _Row:
    """Parts beside each other, as high as the first of them."""

    height: float
    free: float
    parts: list[SheetPart]


def nest(parts: Sequence[SheetPart], sheet: Sheet) -> tuple[NestedSheet, ...]:
    """Place all *parts* on as few sheets as first-fit decreasing finds, first in rows.

    Raises
    ------
    StockError
        For a part longer or wider than the sheet between its margins; the longest is named.
    """
    for part in sorted(parts, key=lambda p: -p.length):
        _check_fit(part, sheet)
    room = sheet.width - 2.0 * sheet.margin
    heights: list[float] = []
    filled: list[list[Placement]] = []
    for row in _rows(parts, sheet):
        number = next((i for i, y in enumerate(heights) if y + row.height <= room + _ROUNDING), -1)
        if number < 0:
            number = len(heights)
            heights.append(0.0)
            filled.append([])
        x, y = sheet.margin, sheet.margin + heights[number]
        for part in row.parts:
            filled[number].append(Placement(part, x, y))
            x += part.length + sheet.gap
        heights[number] += row.height + sheet.gap
    return tuple(
        NestedSheet(number, sheet, tuple(placements))
        for number, placements in enumerate(filled, start=1)
    )


def sheets_of(sheets: Sequence[NestedSheet]) -> dict[str, list[int]]:
    """By mark the numbers of the sheets that hold such a part, in their order."""
    found: dict[str, list[int]] = {}
    for sheet in sheets:
        for mark in dict.fromkeys(placement.part.mark for placement in sheet.placements):
            found.setdefault(mark, []).append(sheet.number)
    return found


def sheet_bound(parts: Sequence[SheetPart], sheet: Sheet) -> int:
    """Sheets that the boxes of all *parts* need at least, by their area with the gaps."""
    gap = sheet.gap
    length, width = (size - 2.0 * sheet.margin + gap for size in (sheet.length, sheet.width))
    boxes = sum((part.length + gap) * (part.width + gap) for part in parts)
    return int(np.ceil(boxes / (length * width) - _ROUNDING))


def _rows(parts: Sequence[SheetPart], sheet: Sheet) -> list[_Row]:
    room = sheet.length - 2.0 * sheet.margin
    rows: list[_Row] = []
    for part in sorted(parts, key=lambda p: (-p.width, -p.length, p.mark)):
        row = next((row for row in rows if row.free >= part.length), None)
        if row is None:
            row = _Row(part.width, room, [])
            rows.append(row)
        row.parts.append(part)
        row.free -= part.length + sheet.gap
    return rows


def _check_fit(part: SheetPart, sheet: Sheet) -> None:
    for what, size, room in (
        ("long", part.length, sheet.length - 2.0 * sheet.margin),
        ("wide", part.width, sheet.width - 2.0 * sheet.margin),
    ):
        if size > room:
            raise StockError(
                f"A part is too {what} for the stock",
                where=part.mark,
                value=f"{size:.1f} mm",
                limit=f"{room:.1f} mm between the sheet's margins",
                advice=_longer(part) if what == "long" else "a wider sheet, or narrower parts",
            )


def _longer(part: SheetPart) -> str:
    """What helps where *part* is too long."""
    pieces = ", or [bars] with a splice" if isinstance(part, FlatPart) else ""
    return f"a longer sheet or coil, a smaller margin, shorter parts{pieces}"
