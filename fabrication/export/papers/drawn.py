"""Pictures of the shell and histograms in vectors, and figures in a grid."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from typing import TypeVar

import numpy as np
from reportlab.lib.units import mm

from fabrication.export.bars import Bars, bars_of
from fabrication.export.histogram import axis_words, limit_words, summary
from fabrication.export.papers.flow import LINE, Block, space
from fabrication.export.papers.sheet_frame import THIN, Area, Pen
from fabrication.export.quality_series import Series
from gridshell.arrays import Floats
from gridshell.painter import Layer, Lines, bounds, in_order
from gridshell.picture import VIEW

Colour = tuple[float, float, float]

BAR, LIMIT = (0.36, 0.47, 0.58), (0.70, 0.15, 0.12)
"""Of the bars of histograms and of limits, sRGB."""

_CARDS, _CARD, _CHARTS, _CHART = 3, 15.5, 2, 51.0
"""Figures in a row and their height, histograms in a row and their height, mm."""

_PICTURE = 90.0
_PX = 0.2
"""Of the painter's line widths, mm."""

Item = TypeVar("Item")


@dataclass(frozen=True)
class Figure:
    """A figure with its label; a value with a dash, or without text, was not measured."""

    label: str
    value: str
    unit: str = ""
    detail: str = ""


def figure_blocks(figures: Sequence[Figure]) -> Iterator[Block]:
    """Figures in rows of three."""
    yield from _grid(figures, _CARDS, _CARD, _draw_figure, joined=True)


def chart_blocks(series: Sequence[Series]) -> Iterator[Block]:
    """Histograms in rows of two."""
    yield from _grid(series, _CHARTS, _CHART, _draw_series)


def picture_block(layers: Sequence[Layer]) -> Block:
    """*layers* from the reports' viewpoint, as large as fits."""
    shown = [layer for layer in layers if len(layer.colours)]
    low, high = bounds(shown, VIEW) if shown else np.zeros((2, 2))
    span = np.maximum(high - low, 1e-9)
    scale = float(min(LINE / span[0], _PICTURE / span[1]))

    def draw(pen: Pen, area: Area) -> None:
        left = area.x + (area.width - scale * span[0]) / 2.0
        _paint(pen, shown, low, scale, np.array([left, area.y + 2.0]))

    return Block((scale * float(span[1]) if shown else 0.0) + 4.0, draw)


def _paint(pen: Pen, layers: Sequence[Layer], low: Floats, scale: float, corner: Floats) -> None:
    """Everything from far to near."""
    canvas = pen.canvas
    canvas.saveState()
    canvas.setLineJoin(1)
    for mark in in_order(layers, VIEW):
        places = ((mark.places - low) * scale + corner) * mm
        line = mark.kind is Lines
        paint(pen, tuple(mark.colour.tolist()), width=_PX * mark.size if line else 0.06)
        path = canvas.beginPath()
        (x, y), *rest = places.tolist()
        path.moveTo(x, y)
        for x, y in rest:
            path.lineTo(x, y)
        if not line:
            path.close()
        canvas.drawPath(path, stroke=1, fill=0 if line else 1)
    canvas.restoreState()


def paint(pen: Pen, colour: Colour, *, width: float = THIN) -> None:
    """Lines and faces that follow are of *colour*, lines *width* mm wide."""
    pen.canvas.setLineWidth(width * mm)
    pen.canvas.setDash([])
    pen.canvas.setStrokeColorRGB(*colour)
    pen.canvas.setFillColorRGB(*colour)


def box(pen: Pen, area: Area, colour: Colour) -> None:
    """A rectangle filled with *colour*."""
    paint(pen, colour)
    pen.canvas.rect(area.x * mm, area.y * mm, area.width * mm, area.height * mm, stroke=0, fill=1)


def _grid(
    items: Sequence[Item],
    columns: int,
    height: float,
    draw_one: Callable[[Pen, Area, Item], None],
    *,
    joined: bool = False,
) -> Iterator[Block]:
    """*items* in rows, which stay on one page where they are *joined*."""
    gap = 6.0
    width = (LINE - gap * (columns - 1)) / columns
    for k in range(0, len(items), columns):

        def draw(pen: Pen, area: Area, row: Sequence[Item] = items[k : k + columns]) -> None:
            for column, item in enumerate(row):
                x = area.x + column * (width + gap)
                draw_one(pen, Area(x, area.y, width, area.height), item)

        yield Block(height, draw, joined=joined)
    yield space(1.0)


def _draw_figure(pen: Pen, area: Area, figure: Figure) -> None:
    top = area.y + area.height
    pen.line([(area.x, top - 1.0), (area.x + area.width, top - 1.0)], width=THIN, grey=0.6)
    pen.text(area.x, top - 4.4, figure.label, height=1.75, grey=0.35, within=area.width)
    measured = bool(figure.value) and "–" not in figure.value
    value = f"{figure.value}{_unit(figure.unit)}" if measured else "–"
    pen.text(area.x, top - 9.0, value, height=2.8, bold=measured, within=area.width)
    detail = figure.detail if measured else "not measured"
    if "–" not in detail:
        pen.text(area.x, top - 12.4, detail, height=1.6, grey=0.35, within=area.width)


def _unit(unit: str) -> str:
    return unit if unit in ("", "°") else f" {unit}"


def _draw_series(pen: Pen, area: Area, series: Series) -> None:
    bars = bars_of(series.values, limit=series.limit)
    top = area.y + area.height
    pen.text(area.x, top - 4.0, series.title, height=2.0, bold=True, within=area.width)
    told = summary(bars, series.unit)
    pen.text(area.x, top - 7.4, told, height=1.6, grey=0.35, within=area.width)
    plot = Area(area.x + 9.0, area.y + 10.0, area.width - 11.0, area.height - 23.0)
    _draw_bars(pen, plot, bars, series.unit)


def _draw_bars(pen: Pen, plot: Area, bars: Bars, unit: str) -> None:
    """Grid, bars, axis and limit; *plot* is where bars stand."""
    right, per_count = plot.x + plot.width, plot.height / float(bars.heights[-1])
    along = plot.width / (bars.high - bars.low)
    for count in bars.heights.tolist():
        y = plot.y + count * per_count
        pen.line([(plot.x, y), (right, y)], width=THIN, grey=0.8)
        pen.text(plot.x - 1.5, y - 0.75, f"{count}", height=1.5, grey=0.35, align="right")
    x = plot.x + (bars.stops - bars.low) * along
    for left, end, count in zip(x[:-1].tolist(), x[1:].tolist(), bars.counts.tolist(), strict=True):
        if count:
            high = max(count * per_count, 0.25)
            box(pen, Area(left + 0.12, plot.y, max(end - left - 0.24, 0.2), high), BAR)
    for tick, figure in zip(bars.ticks.tolist(), bars.figures(), strict=True):
        at = plot.x + (tick - bars.low) * along
        pen.line([(at, plot.y), (at, plot.y - 1.0)], width=THIN, grey=0.35)
        pen.text(at, plot.y - 3.4, figure, height=1.5, grey=0.35, align="middle")
    pen.text(right, plot.y - 6.4, axis_words(bars, unit), height=1.5, grey=0.35, align="right")
    if bars.limit is not None and bars.shown:
        _draw_limit(pen, plot, plot.x + (bars.limit - bars.low) * along, limit_words(bars, unit))


def _draw_limit(pen: Pen, plot: Area, at: float, words: str) -> None:
    top = plot.y + plot.height + 1.5
    paint(pen, LIMIT, width=0.3)
    pen.canvas.setDash([1.2 * mm, 0.9 * mm])
    pen.canvas.line(at * mm, plot.y * mm, at * mm, top * mm)
    align = "right" if at > plot.x + plot.width / 2.0 else "left"
    pen.text(at, top + 0.8, words, height=1.5, align=align, grey=0.2)
