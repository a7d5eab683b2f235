"""Tables over as many pages as they need, with their headings repeated."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

from fabrication.export.papers.sheet_frame import (
    MEDIUM,
    THIN,
    Area,
    Page,
    Pen,
    page_area,
)

_ROW, _HEAD = 4.6, 6.0
_MARGIN = 6.0


@dataclass(frozen=True)
class Column:
    """A column: its heading, its share of the width, how its cells are aligned."""

    heading: str
    share: float
    align: str = "left"


def table_pages(
    title: str, columns: Sequence[Column], rows: Sequence[Sequence[str]], *, paper: str
) -> Iterator[Page]:
    """Pages of a table; one page says that it is empty where there are no rows."""
    area = page_area(paper).inset(_MARGIN)
    per_page = int((area.height - _HEAD) // _ROW)
    chunks = [rows[k : k + per_page] for k in range(0, len(rows), per_page)] or [[]]
    for number, chunk in enumerate(chunks, start=1):
        more = f" {number} of {len(chunks)}" if len(chunks) > 1 else ""

        def draw(pen: Pen, area: Area, chunk: Sequence[Sequence[str]] = chunk) -> None:
            draw_table(pen, area.inset(_MARGIN), columns, chunk)

        yield Page(f"{title}{more}", "-", draw)


def draw_table(
    pen: Pen, area: Area, columns: Sequence[Column], rows: Sequence[Sequence[str]]
) -> float:
    """Draw a table from the upper edge of *area*; where it ends, mm."""
    whole = sum(column.share for column in columns)
    top = area.y + area.height
    _row(pen, area, top - 4.2, [(c, c.heading) for c in columns], whole, bold=True)
    y = top - _HEAD
    pen.line([(area.x, y), (area.x + area.width, y)], width=MEDIUM)
    for row in rows:
        _row(pen, area, y - 3.4, list(zip(columns, row, strict=True)), whole, bold=False)
        y -= _ROW
        pen.line([(area.x, y), (area.x + area.width, y)], width=THIN, grey=0.7)
    if not rows:
        pen.text(area.x, y - 4.0, "none")
        y -= _ROW
    return y


def _row(
    pen: Pen,
    area: Area,
    y: float,
    cells: Sequence[tuple[Column, str]],
    whole: float,
    *,
    bold: bool,
) -> None:
    x = area.x
    for column, text in cells:
        width = column.share / whole * area.width
        at = {"left": x, "right": x + width - 2.0, "middle": x + width / 2.0}[column.align]
        pen.text(at, y, text, height=2.2, bold=bold, align=column.align, within=width - 2.5)
        x += width
