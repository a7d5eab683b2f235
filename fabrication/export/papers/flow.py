"""Text, tables and pictures one below the other on portrait pages, with page numbers.

A document is a list of blocks of known height. All are placed before the first one is drawn, so
that every page says which of how many it is. Text that is too long for its line or its cell goes on
below, and words that are too long are cut.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace
from pathlib import Path

from reportlab.lib.units import mm
from reportlab.pdfgen.canvas import Canvas

from fabrication.errors import OutputError
from fabrication.export.papers.sheet_frame import MEDIUM, THIN, Area, Pen, printable, text_width
from fabrication.export.papers.tables import Column

WIDTH, HEIGHT = 210.0, 297.0
SIDE, TOP, BOTTOM = 16.0, 16.0, 20.0
"""Margins, mm."""

LINE = WIDTH - 2.0 * SIDE
"""Width of what stands on a page, mm."""

BODY, CELL = 2.0, 1.75
"""Heights of capitals in text and in tables, mm."""

_PITCH = 1.85
"""Of lines over the height of capitals."""

_FIRST = 3
"""Rows of a table that stay with its headings."""

_BESIDE = 2.6
"""Between the columns of a table, mm."""


@dataclass(frozen=True)
class Block:
    """Something of a certain height.

    Parameters
    ----------
    height : mm.
    draw : draws into the area it is given, which is as wide as the page allows.
    joined : whether it must not be parted from the next one.
    head : drawn once more above it where it begins a page.
    """

    height: float
    draw: Callable[[Pen, Area], None]
    joined: bool = False
    head: Block | None = None


def write_flow(path: Path | str, blocks: Sequence[Block], *, title: str, foot: str) -> Path:
    """Write *blocks* as one PDF; the same input gives the same bytes.

    Parameters
    ----------
    title : of the file.
    foot : stands at the foot of every page.

    Raises
    ------
    OutputError
        When the file cannot be written.
    """
    path = Path(path)
    canvas = Canvas(str(path), pagesize=(WIDTH * mm, HEIGHT * mm), invariant=1, pageCompression=1)
    canvas.setTitle(printable(title))
    pen = Pen(canvas)
    pages = placed(blocks)
    for number, page in enumerate(pages, start=1):
        for block, top in page:
            block.draw(pen, Area(SIDE, top - block.height, LINE, block.height))
        _foot(pen, foot, f"{number} / {len(pages)}")
        canvas.showPage()
    try:
        canvas.save()
    except OSError as error:
        raise OutputError(
            "The report cannot be written", where=str(path), value=error.strerror or ""
        ) from None
    return path


def placed(blocks: Sequence[Block]) -> list[list[tuple[Block, float]]]:
    """Of every page its blocks and their upper edges, mm from the lower edge of the paper."""
    pages: list[list[tuple[Block, float]]] = [[]]
    y = HEIGHT - TOP
    for k, block in enumerate(blocks):
        needed, last = block.height, k
        while blocks[last].joined and last + 1 < len(blocks):
            last += 1
            needed += blocks[last].height
        if pages[-1] and y - needed < BOTTOM and (needed < HEIGHT - TOP - BOTTOM or k == last):
            pages.append([])
            y = HEIGHT - TOP
            if block.head is not None:
                pages[-1].append((block.head, y))
                y -= block.head.height
        elif pages[-1] and y - block.height < BOTTOM:
            pages.append([])
            y = HEIGHT - TOP
        pages[-1].append((block, y))
        y -= block.height
    return pages


# ---- blocks --------------------------------------------------------------------------------------


def space(height: float) -> Block:
    """Nothing."""
    return Block(height, lambda pen, area: None)


def heading(text: str, *, size: float = 3.2) -> Block:
    """A heading; *size* is the height of its capitals, mm."""

    def draw(pen: Pen, area: Area) -> None:
        pen.text(area.x, area.y + 2.0, text, height=size, bold=True, within=area.width)

    return Block(size + 8.0, draw, joined=True)


def subheading(text: str) -> Block:
    """A small grey heading."""

    def draw(pen: Pen, area: Area) -> None:
        pen.text(area.x, area.y + 1.6, text, bold=True, grey=0.35, height=2.2, within=area.width)

    return Block(7.0, draw, joined=True)


def paragraph(
    text: str, *, size: float = BODY, bold: bool = False, grey: float = 0.0
) -> Iterator[Block]:
    """Lines of text, a block each."""
    lines = wrapped(text, LINE, size, bold=bold)
    for k, line in enumerate(lines):

        def draw(pen: Pen, area: Area, line: str = line) -> None:
            pen.text(area.x, area.y + 0.5 * size, line, height=size, bold=bold, grey=grey)

        yield Block(_PITCH * size, draw, joined=k == 0 and len(lines) > 1)
    yield space(0.8 * size)


def table(columns: Sequence[Column], rows: Sequence[Sequence[str]]) -> Iterator[Block]:
    """A table whose headings are repeated on every page; a row's cells are as high as they need."""
    whole = sum(column.share for column in columns)
    widths = [column.share / whole * LINE for column in columns]
    head = _row(columns, widths, [column.heading for column in columns], head=True)
    yield head
    body = [list(row) for row in rows] or [["none", *([""] * (len(columns) - 1))]]
    for k, row in enumerate(body):
        joined = k < min(_FIRST, len(body)) - 1
        yield replace(_row(columns, widths, row, head=False), head=head, joined=joined)
    yield space(2.0)


def _row(
    columns: Sequence[Column], widths: Sequence[float], cells: Sequence[str], *, head: bool
) -> Block:
    lines = [
        wrapped(cell, width - _BESIDE, CELL, bold=head)
        for cell, width in zip(cells, widths, strict=True)
    ]
    most = max(len(cell) for cell in lines)
    pitch = 1.6 * CELL
    height = pitch * most + 1.6

    def draw(pen: Pen, area: Area) -> None:
        x, top = area.x, area.y + area.height
        for column, width, cell in zip(columns, widths, lines, strict=True):
            right = column.align == "right"
            at = x + width - _BESIDE if right else x
            skipped = most - len(cell) if head else 0
            for k, line in enumerate(cell, start=skipped):
                y = top - 0.8 - CELL - pitch * k
                align = "right" if right else "left"
                pen.text(at, y, line, height=CELL, bold=head, align=align)
            x += width
        ends = [(area.x, area.y), (area.x + area.width, area.y)]
        pen.line(ends, width=MEDIUM if head else THIN, grey=0.0 if head else 0.75)

    return Block(height, draw, joined=head)


def wrapped(text: str, width: float, height: float, *, bold: bool = False) -> list[str]:
    """*text* in lines of at most *width* mm; a word that is longer is cut."""
    lines = [""]
    for word in re.split("[ \x00-\x1f]", text):
        longer = f"{lines[-1]} {word}" if lines[-1] else word
        if text_width(longer, height, bold=bold) <= width:
            lines[-1] = longer
            continue
        if lines[-1]:
            lines.append("")
        for letter in word:
            if lines[-1] and text_width(lines[-1] + letter, height, bold=bold) > width:
                lines.append("")
            lines[-1] += letter
    return lines


def _foot(pen: Pen, foot: str, number: str) -> None:
    y = BOTTOM - 10.0
    pen.line([(SIDE, y + 4.5), (SIDE + LINE, y + 4.5)], width=THIN, grey=0.6)
    pen.text(SIDE, y, foot, height=1.8, grey=0.35, within=LINE - 24.0)
    pen.text(SIDE + LINE, y, number, height=1.8, grey=0.35, align="right")
