"""The drawing of one flat strip in the report: an SVG path in pixels, and what is written on it."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import Any, Protocol

import numpy as np

from fabrication.cut import Drill, Edge, Floor, Hole, Relief, Slot, outline
from fabrication.shapes import with_bulges
from fabrication.words import fixed
from gridshell.arrays import Floats

_STRIP, _THINNEST_SLOT, _PITCH = (1040.0, 62.0), 3.0, 13.0
"""Px: the strip, its narrowest slot, and the room a station's figure needs."""

_LETTER, _LINE = 7.0, 10.5
_THINNEST_RELIEF, _SMALLEST_HOLE, _SHORTEST_BEVEL = 6.0, 1.6, 5.0


class Strip(Protocol):
    """What of a flat part is drawn; lengths mm, x from the left end."""

    @property
    def mark(self) -> str:
        """Its name."""

    @property
    def length(self) -> float:
        """Of the longer face."""

    @property
    def width(self) -> float:
        """Across."""

    @property
    def slots(self) -> Sequence[Slot]:
        """From either edge."""

    @property
    def holes(self) -> Sequence[Hole]:
        """Through the thickness."""

    @property
    def drills(self) -> Sequence[Drill]:
        """Through the narrow walls of a tube."""

    @property
    def bevels(self) -> tuple[float, float]:
        """How much longer the near face is at either end."""


def strip_drawing(part: Strip) -> dict[str, Any]:
    """A flat strip to look at, px: lengths to scale, its width, slots, holes and bevels not.

    A station is its place along the strip, the place of its figure, and the figure. Labels are the
    marks of the partners and where they stand. A strip without slots shows the stations of its
    holes, a tube those of its drills, which are dashed.
    """
    length, height = _STRIP
    along, across = length / part.length, height / part.width
    room = _room(part.slots, along)
    drawn = [_drawn(s, along, across, free) for s, free in zip(part.slots, room, strict=True)]
    x = np.array([0.0, *(cut.x for cut in part.slots or part.holes or part.drills), part.length])
    figures = [fixed(station, 1) for station in x.tolist()]
    places = (x * along).round(1).tolist(), _apart(x * along).round(1).tolist()
    return {
        "part": part,
        "length": length,
        "height": height,
        "path": svg_path(outline(length, height, drawn), height),
        "holes": [
            (h.x * along, height - h.y * across, max(_SMALLEST_HOLE, h.diameter * across / 2.0))
            for h in part.holes
        ],
        "bevels": _bevels(part, along),
        "drills": [drill.x * along for drill in part.drills],
        "stations": list(zip(*places, figures, strict=True)),
        "labels": _labels(part.slots, along),
    }


def _room(slots: Sequence[Slot], along: float) -> list[float]:
    """Px from each slot to its nearest neighbour."""
    x = np.r_[-np.inf, [slot.x * along for slot in slots], np.inf]
    return [float(free) for free in np.minimum(x[1:-1] - x[:-2], x[2:] - x[1:-1])]


def _labels(slots: Sequence[Slot], along: float) -> list[tuple[float, float, str]]:
    """Place, level and text of the partners' marks, behind the slots; close ones share a column."""
    length, height = _STRIP
    labels: list[tuple[float, int, Slot]] = []
    ends: list[float] = []
    for slot in slots:
        half = _LETTER * len(slot.partner) / 2.0 + 2.0
        x = min(max(slot.x * along, half), length - half)
        free = (row for row, end in enumerate(ends) if x - half > end)
        row = next(free, len(ends))
        ends[row : row + 1] = [x + half]
        labels.append((x, row, slot))
    first = (len(ends) - 1) / 2.0
    return [
        (
            x,
            height * (0.2 if slot.edge is Edge.LOWER else 0.8) + _LINE * (row - first),
            slot.partner,
        )
        for x, row, slot in labels
    ]


def _drawn(slot: Slot, along: float, across: float, free: float) -> Slot:
    """*slot* in px, at most half as wide as what is *free*, its relief in proportion."""
    thinnest = _THINNEST_SLOT if slot.floor is Floor.SQUARE else _THINNEST_RELIEF
    width = max(slot.width * along, min(thinnest, free / 2.0))
    relief = Relief(slot.floor, width / 3.2 if slot.floor is Floor.DOGBONE else 0.0)
    return replace(slot, x=slot.x * along, width=width, depth=slot.depth * across, relief=relief)


def _bevels(part: Strip, along: float) -> list[float]:
    """Where the shorter face ends, px."""
    start, end = (max(abs(run) * along, _SHORTEST_BEVEL) if run else 0.0 for run in part.bevels)
    return [*([start] if start else []), *([_STRIP[0] - end] if end else [])]


def svg_path(corners: Floats, height: float) -> str:
    """An outline (k, 2) or with bulges (k, 3) as an SVG path, px, y downwards from *height*."""
    rows = with_bulges(corners)
    words = [f"M{rows[0, 0]:.1f} {height - rows[0, 1]:.1f}"]
    for (x, y, bulge), (to_x, to_y, _) in zip(rows, np.roll(rows, -1, axis=0), strict=True):
        end = f"{to_x:.1f} {height - to_y:.1f}"
        if bulge == 0.0:
            words.append(f"L{end}")
            continue
        radius = np.hypot(to_x - x, to_y - y) * (1.0 + bulge**2) / (4.0 * abs(bulge))
        words.append(
            f"A{radius:.2f} {radius:.2f} 0 {int(abs(bulge) > 1.0)} {int(bulge < 0.0)} {end}"
        )
    return " ".join(words) + "Z"


def _apart(x: Floats) -> Floats:
    """*x* (n,) in order, moved so far that neighbours are a pitch apart within the strip."""
    steps = min(_PITCH, _STRIP[0] / (len(x) - 1)) * np.arange(len(x))
    moved = np.maximum.accumulate(x - steps) + steps
    return np.asarray(np.minimum(moved, _STRIP[0] - steps[::-1]))
