"""Lines over one axis as SVG that stands in a page, with a mark that a page may move along."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np
from markupsafe import escape

from fabrication.export.bars import round_step
from fabrication.words import fixed
from gridshell.arrays import Floats

_WIDTH, _HEIGHT = 480.0, 200.0
_LEFT, _RIGHT, _TOP, _BOTTOM = 38.0, 14.0, 44.0, 34.0
"""Px around the lines."""

_INK, _QUIET, _LINE = "#1c232d", "#5a6472", "#d5dae1"
_LETTER = 6.6


@dataclass(frozen=True, eq=False)
class Course:
    """One line: its name, its colour (CSS), and its values (n,)."""

    name: str
    colour: str
    values: Floats


def line_chart(x: Floats, courses: Sequence[Course], *, title: str, unit: str, axis: str) -> str:
    """Courses over *x* as one SVG element; the y axis begins at nought.

    Its group ``now`` stands at the first place; a page moves it by shares of ``data-span`` px.

    Parameters
    ----------
    x : (n,) rising.
    courses : of values that are not negative.
    title, unit, axis : of the chart, of its values, and of *x*; text, escaped here.
    """
    largest = max(float(course.values.max()) for course in courses) or 1.0
    step = round_step(largest / 4.0)
    top = step * np.ceil(largest / step - 1e-9)
    wide, high = _WIDTH - _LEFT - _RIGHT, _HEIGHT - _TOP - _BOTTOM
    across = _LEFT + wide * (x - x[0]) / max(float(x[-1] - x[0]), 1e-12)
    body = [
        *_heads(courses, title, unit),
        *_grid(np.arange(0.0, top + step / 2.0, step), top, high),
        *_ticks(x, axis, wide),
        *(_course(course, across, top, high) for course in courses),
    ]
    return (
        f'<svg xmlns="http://www.w3.org/2000/svg" class="chart" viewBox="0 0 {_WIDTH:g} '
        f'{_HEIGHT:g}" role="img" aria-label="{escape(title)}" font-size="11" '
        f'font-family="system-ui, sans-serif">{"".join(body)}<path class="now" '
        f'data-span="{wide:g}" d="M{_LEFT:g} {_TOP:g}v{high:g}" stroke="{_INK}"/></svg>'
    )


def _heads(courses: Sequence[Course], title: str, unit: str) -> Iterator[str]:
    yield (
        f'<text x="0" y="13" font-size="13" font-weight="600" fill="{_INK}">'
        f"{escape(f'{title}, {unit}')}</text>"
    )
    at = _LEFT
    for course in courses:
        yield (
            f'<path d="M{at:.1f} 29h14" stroke="{course.colour}" stroke-width="2.5"/>'
            f'<text x="{at + 19:.1f}" y="33" fill="{_QUIET}">{escape(course.name)}</text>'
        )
        at += 36.0 + _LETTER * len(course.name)


def _grid(stops: Floats, top: float, high: float) -> Iterator[str]:
    decimals = max(0, -int(np.floor(np.log10(stops[1]) + 1e-9)))
    for stop in stops.tolist():
        y = _TOP + high * (1.0 - stop / top)
        yield f'<path d="M{_LEFT:g} {y:.1f}H{_WIDTH - _RIGHT:g}" stroke="{_LINE}"/>'
        yield (
            f'<text x="{_LEFT - 6:g}" y="{y + 4:.1f}" text-anchor="end" fill="{_QUIET}">'
            f"{fixed(stop, decimals)}</text>"
        )


def _ticks(x: Floats, axis: str, wide: float) -> Iterator[str]:
    for share in (0.0, 0.25, 0.5, 0.75, 1.0):
        value = float(x[0] + share * (x[-1] - x[0]))
        yield (
            f'<text x="{_LEFT + share * wide:.1f}" y="{_HEIGHT - _BOTTOM + 15:g}" '
            f'text-anchor="middle" fill="{_QUIET}">{fixed(value, 0)}</text>'
        )
    yield (
        f'<text x="{_WIDTH - _RIGHT:g}" y="{_HEIGHT - 4:g}" text-anchor="end" fill="{_QUIET}">'
        f"{escape(axis)}</text>"
    )


def _course(course: Course, across: Floats, top: float, high: float) -> str:
    y = _TOP + high * (1.0 - course.values / top)
    line = " ".join(f"{a:.1f},{b:.1f}" for a, b in zip(across, y, strict=True))
    return f'<polyline points="{line}" fill="none" stroke="{course.colour}" stroke-width="2"/>'
