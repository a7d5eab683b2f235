"""Histograms as SVG that stands in a page: no script, no style of its own outside its elements."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
import numpy.typing as npt
from markupsafe import escape

from fabrication.export.bars import Bars, bars_of
from fabrication.words import number, plural

_WIDTH, _HEIGHT = 360.0, 200.0
_LEFT, _RIGHT, _TOP, _BOTTOM = 38.0, 14.0, 50.0, 34.0
"""Px around the bars."""

_INK, _QUIET, _LINE, _FILL, _LIMIT = "#1c232d", "#5a6472", "#d5dae1", "#5c7894", "#b3261e"
_LETTER = 6.4


def histogram(
    values: npt.ArrayLike, *, title: str, unit: str = "", limit: float | None = None
) -> str:
    """Values counted in bars of a round width, as one SVG element.

    Parameters
    ----------
    values : of any shape; what is no finite number is left out, and told.
    title, unit : text, escaped here.
    limit : what is allowed, in the same unit: a dashed line where it is near the values, else
        words.
    """
    bars = bars_of(values, limit=limit)
    body = "".join(_elements(bars, title, unit))
    return (
        f'<svg xmlns="http://www.w3.org/2000/svg" class="histogram" '
        f'viewBox="0 0 {_WIDTH:g} {_HEIGHT:g}" role="img" aria-label="{escape(title)}" '
        f'font-family="system-ui, sans-serif">{body}</svg>'
    )


def summary(bars: Bars, unit: str) -> str:
    """Number, mean and largest of the values, what is missing, and a limit that is not drawn."""
    if bars.mean is None or bars.largest is None:
        words = ["no values"]
    else:
        words = [
            plural(bars.known, "value"),
            f"mean {_with(bars.mean, unit)}",
            f"largest {_with(bars.largest, unit)}",
        ]
    if bars.missing:
        words.append(f"{bars.missing} not measured")
    if bars.limit is not None and not bars.shown:
        words.append(limit_words(bars, unit))
    return ", ".join(words)


def axis_words(bars: Bars, unit: str) -> str:
    """The unit along the axis, with the power of ten its figures are multiples of."""
    if not bars.power:
        return unit
    power = str(bars.power).translate(str.maketrans("-0123456789", "⁻⁰¹²³⁴⁵⁶⁷⁸⁹"))
    return f"× 10{power} {unit}".strip()


def limit_words(bars: Bars, unit: str) -> str:
    """What stands at the line of the limit."""
    return f"limit {bars.limit or 0.0:.4g}{_spaced(unit)}"


def _with(value: float, unit: str) -> str:
    text = number(value, 3)
    return f"{text} {unit}".rstrip() if "×" in text else f"{text}{_spaced(unit)}"


def _spaced(unit: str) -> str:
    """*unit* as it stands behind a number."""
    return unit if unit in ("", "°") else f" {unit}"


def _elements(bars: Bars, title: str, unit: str) -> Iterator[str]:
    right, foot = _WIDTH - _RIGHT, _HEIGHT - _BOTTOM
    x = _LEFT + (bars.stops - bars.low) / (bars.high - bars.low) * (right - _LEFT)
    per_count = (foot - _TOP) / float(bars.heights[-1])
    yield _text(0.0, 12.0, title, "start", f"font-size:12.5px;font-weight:600;fill:{_INK}")
    yield _text(0.0, 27.0, summary(bars, unit), "start")
    for height in bars.heights.tolist():
        y = foot - height * per_count
        yield f'<path d="M{_LEFT:g} {y:.1f}H{right:g}" stroke="{_LINE}" stroke-width="1"/>'
        yield _text(_LEFT - 6.0, y + 3.5, f"{height}", "end")
    for k, count in enumerate(bars.counts.tolist()):
        if count:
            top, wide = foot - max(count * per_count, 1.0), max(float(x[k + 1] - x[k]) - 1.0, 1.0)
            ends = " to ".join(number(float(stop)) for stop in bars.stops[k : k + 2])
            yield (
                f'<rect x="{x[k] + 0.5:.1f}" y="{top:.1f}" width="{wide:.1f}" '
                f'height="{foot - top:.1f}" fill="{_FILL}"><title>{escape(ends + _spaced(unit))}: '
                f"{count}</title></rect>"
            )
    for tick, figure in zip(bars.ticks.tolist(), bars.figures(), strict=True):
        at = float(np.interp(tick, bars.stops, x))
        yield f'<path d="M{at:.1f} {foot:g}v4" stroke="{_QUIET}" stroke-width="1"/>'
        yield _text(at, foot + 15.0, figure, "middle")
    yield _text(right, foot + 28.0, axis_words(bars, unit), "end")
    if bars.limit is not None and bars.shown:
        yield from _limit(
            float(np.interp(bars.limit, bars.stops, x)), foot, limit_words(bars, unit)
        )


def _limit(at: float, foot: float, words: str) -> Iterator[str]:
    yield (
        f'<path class="limit" d="M{at:.1f} {_TOP - 4.0:g}V{foot:g}" stroke="{_LIMIT}" '
        f'stroke-width="1.4" stroke-dasharray="4 3"/>'
    )
    place = min(max(at, _LEFT), _WIDTH - _LETTER * len(words) / 2.0)
    yield _text(place, _TOP - 8.0, words, "middle", f"font-size:10.5px;fill:{_LIMIT}")


def _text(
    x: float, y: float, text: str, anchor: str, style: str = f"font-size:10.5px;fill:{_QUIET}"
) -> str:
    """A line of text; its style is its own, whatever the page says of text in pictures."""
    return (
        f'<text x="{x:.1f}" y="{y:.1f}" text-anchor="{anchor}" style="{style}">'
        f"{escape(text)}</text>"
    )
