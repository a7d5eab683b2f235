"""Paper templates at full size: strips in tiles to glue together, for a workshop with hand tools.

A tile overlaps the next one by a glued flap; crosses on both sides of the flap lie on each other
when the tiles fit. Every page carries a length of 100 mm to check that the printer has not scaled.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from reportlab.lib.units import mm
from reportlab.pdfgen.canvas import Canvas

from fabrication.errors import OutputError
from fabrication.export.papers.sheet_frame import MEDIUM, SIZES, THIN, Pen, printable
from fabrication.flattening import corners
from fabrication.parts import FlatPart
from gridshell import SettingError

FLAP = 15.0
"""Overlap of two tiles, mm."""

_EDGE, _FOOT, _GAP = 8.0, 12.0, 9.0
"""Of the paper that printers leave free, for the check scale, and between rows, mm."""


@dataclass(frozen=True)
class _Tile:
    """A length of a part on paper: from *low* on, tile *number* of *count*."""

    part: FlatPart
    low: float
    number: int
    count: int


def write_templates(
    path: Path | str, parts: Sequence[FlatPart], *, name: str, paper: str = "A4"
) -> Path:
    """Write all *parts* at 1:1 on landscape pages; the same input gives the same bytes.

    Raises
    ------
    SettingError
        For a size of paper that is not known or lower than a strip.
    OutputError
        When the file cannot be written.
    """
    path = Path(path)
    if paper not in SIZES:
        raise SettingError(
            "No such size of paper", where="paper", value=paper, limit=", ".join(SIZES)
        )
    width, height = SIZES[paper]
    room = height - 2.0 * _EDGE - _FOOT
    for part in parts:
        if part.width > room:
            raise SettingError(
                "A strip is wider than the paper",
                where=part.mark,
                value=f"{part.width:g} mm",
                limit=f"{room:g} mm on {paper}",
                advice="a larger size of paper",
            )
    canvas = Canvas(str(path), pagesize=(width * mm, height * mm), invariant=1, pageCompression=1)
    canvas.setTitle(f"{printable(name)}: templates at full size")
    pen = Pen(canvas)
    length = width - 2.0 * _EDGE
    tiles = [tile for part in parts for tile in _tiles(part, length)]
    for page in _pages(tiles, room):
        y = height - _EDGE
        for tile in page:
            y -= tile.part.width
            _draw(pen, tile, _EDGE, y, length)
            y -= _GAP
        _check(pen, name, width)
        canvas.showPage()
    try:
        canvas.save()
    except OSError as error:
        raise OutputError(
            "The templates cannot be written", where=str(path), value=error.strerror or ""
        ) from None
    return path


def _tiles(part: FlatPart, length: float) -> Iterator[_Tile]:
    step = length - FLAP
    count = max(1, int(np.ceil((part.length - FLAP) / step - 1e-9)))
    for k in range(count):
        yield _Tile(part, k * step, k + 1, count)


def _pages(tiles: Sequence[_Tile], room: float) -> Iterator[list[_Tile]]:
    page: list[_Tile] = []
    used = 0.0
    for tile in tiles:
        if page and used + tile.part.width > room:
            yield page
            page, used = [], 0.0
        page.append(tile)
        used += tile.part.width + _GAP
    if page:
        yield page


def _draw(pen: Pen, tile: _Tile, x: float, y: float, length: float) -> None:
    part, low, high = tile.part, tile.low, min(tile.low + length, tile.part.length)
    canvas = pen.canvas
    canvas.saveState()
    clip = canvas.beginPath()
    clip.rect((x - 0.2) * mm, (y - 0.2) * mm, (high - low + 0.4) * mm, (part.width + 0.4) * mm)
    canvas.clipPath(clip, stroke=0)
    shift = np.array([x - low, y])
    pen.line((corners(part.outline) + shift).tolist(), closed=True, width=MEDIUM)
    for cx, cy, diameter in part.circles.tolist():
        pen.circle(cx - low + x, cy + y, diameter / 2.0)
        _cross(pen, cx - low + x, cy + y)
    for label in part.labels[1:]:
        pen.text(label.x - low + x, label.y + y - 1.2, label.text, height=2.6, align="middle")
    canvas.restoreState()
    for at, inside in ((low, tile.number > 1), (low + FLAP, tile.number > 1)):
        _seam(pen, at - low + x, y, part.width, shown=inside)
    last = tile.number < tile.count
    for at in (high - FLAP, high):
        _seam(pen, at - low + x, y, part.width, shown=last)
    pen.text(
        x + 20.0,
        y + 4.0,
        f"{part.mark}   {tile.number} / {tile.count}   from {low:.0f} mm",
        height=3.0,
        bold=True,
        grey=0.35,
    )


def _seam(pen: Pen, x: float, y: float, width: float, *, shown: bool) -> None:
    """A dashed line across the strip with a cross on it, where two tiles lie on each other."""
    if shown:
        pen.line([(x, y), (x, y + width)], width=THIN, dash=(2.0, 1.5), grey=0.4)
        _cross(pen, x, y + width / 2.0)


def _cross(pen: Pen, x: float, y: float) -> None:
    pen.line([(x - 2.0, y), (x + 2.0, y)], width=THIN)
    pen.line([(x, y - 2.0), (x, y + 2.0)], width=THIN)


def _check(pen: Pen, name: str, width: float) -> None:
    x, y = _EDGE + 2.0, _EDGE
    pen.line([(x, y), (x + 100.0, y)], width=MEDIUM)
    for at in (x, x + 50.0, x + 100.0):
        pen.line([(at, y - 1.5), (at, y + 1.5)], width=MEDIUM)
    pen.text(x, y + 2.5, "100 mm: measure it before you cut", height=2.2)
    pen.text(width - _EDGE - 2.0, y + 2.5, name, height=2.2, align="right", within=120.0)
