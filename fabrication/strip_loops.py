"""The loops that trim the sides of a strip, piece by piece: straight along or across it, or arcs.

A piece runs from one corner of a loop to the next, on both sides of the strip at once. Pieces have
a natural direction, of growing x, growing y or counter-clockwise; a loop may run through them
against it. Corners differ between the sides only at bevelled ends.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from enum import Enum

import numpy as np
from scipy.interpolate import make_interp_spline

from fabrication.parts import FlatPart
from fabrication.shapes import with_bulges
from fabrication.sides import Side
from gridshell.arrays import Floats, Points

_SAMPLES = 13
"""Points through which the image of an arc is interpolated; half circles need them."""

DEGREE = 5
"""Of the images of arcs: the third degree would be 5e-4 mm off a half circle of 4 mm."""


class Run(Enum):
    """What a piece follows."""

    ALONG = "along"
    ACROSS = "across"
    ARC = "arc"


@dataclass(frozen=True, eq=False)
class Piece:
    """One piece of a loop.

    Parameters
    ----------
    run : what it follows.
    first, last : numbers of its corners in its natural direction.
    forward : whether the loop runs in that direction.
    low, high : (2,) parameter of its edge at *first* and *last* on either side: x, y, or the angle
        around *centre*.
    at : (2,) what stays the same along it on either side: y, x, or the radius.
    centre : (2,) of an arc, mm.
    """

    run: Run
    first: int
    last: int
    forward: bool
    low: tuple[float, float]
    high: tuple[float, float]
    at: tuple[float, float]
    centre: tuple[float, float] = (0.0, 0.0)


@dataclass(frozen=True, eq=False)
class Loop:
    """A loop on both sides.

    Parameters
    ----------
    rows : (2, k, 3) x, y and bulge of the corners on the near and on the far side.
    pieces : one from each corner to the next.
    """

    rows: Floats
    pieces: tuple[Piece, ...]


@dataclass(frozen=True, eq=False)
class ArcImages:
    """The images of all arcs on both sides as splines of the angle.

    Parameters
    ----------
    knots : of the share of the sweep, 0 to 1.
    poles : (arcs, 2, n, 3) mm.
    off : largest distance of a spline from its side, mm.
    """

    knots: Floats
    poles: Floats
    off: float


def strip_loops(part: FlatPart) -> tuple[Loop, ...]:
    """The outline and the holes of *part*; holes run clockwise, as two half circles each."""
    near, far = (with_bulges(face) for face in part.faces)
    loops = [_loop(np.stack([near, far]))]
    for x, y, diameter in part.circles.tolist():
        half = diameter / 2.0
        rows = np.array([[x - half, y, -1.0], [x + half, y, -1.0]])
        loops.append(_loop(np.stack([rows, rows])))
    return tuple(loops)


def _loop(rows: Floats) -> Loop:
    count = rows.shape[1]
    return Loop(rows, tuple(_piece(rows, i, (i + 1) % count) for i in range(count)))


def _piece(rows: Floats, i: int, j: int) -> Piece:
    (a, far_a), (b, far_b) = rows[:, i], rows[:, j]
    if a[2] != 0.0:
        return _arc(a, b, i, j)
    along = abs(b[0] - a[0]) > abs(b[1] - a[1])
    runs, fixed = (0, 1) if along else (1, 0)
    forward = bool(b[runs] > a[runs])
    first, last = (i, j) if forward else (j, i)
    start, end = (a, b) if forward else (b, a)
    far_start, far_end = (far_a, far_b) if forward else (far_b, far_a)
    return Piece(
        run=Run.ALONG if along else Run.ACROSS,
        first=first,
        last=last,
        forward=forward,
        low=(float(start[runs]), float(far_start[runs])),
        high=(float(end[runs]), float(far_end[runs])),
        at=(float(start[fixed]), float(far_start[fixed])),
    )


def _arc(a: Floats, b: Floats, i: int, j: int) -> Piece:
    bulge = float(a[2])
    chord = b[:2] - a[:2]
    left = np.array([-chord[1], chord[0]])
    centre = (a[:2] + b[:2]) / 2.0 + left * (1.0 - bulge**2) / (4.0 * bulge)
    forward = bulge > 0.0
    out = (a if forward else b)[:2] - centre
    low = float(np.arctan2(out[1], out[0]) % (2.0 * np.pi))
    high = low + 4.0 * abs(float(np.arctan(bulge)))
    radius = float(np.linalg.norm(out))
    return Piece(
        run=Run.ARC,
        first=i if forward else j,
        last=j if forward else i,
        forward=forward,
        low=(low, low),
        high=(high, high),
        at=(radius, radius),
        centre=(float(centre[0]), float(centre[1])),
    )


def arc_images(sides: Sequence[Side], arcs: Sequence[Piece]) -> ArcImages:
    """Interpolate the images of *arcs* on both *sides*, all at once."""
    share = np.linspace(0.0, 1.0, _SAMPLES)
    points = np.stack([_on_side(side, arcs, share) for side in sides], axis=1)
    columns = np.moveaxis(points, 2, 0).reshape(_SAMPLES, -1)
    spline = make_interp_spline(share, columns, k=DEGREE)
    between = (share[1:] + share[:-1]) / 2.0
    wanted = np.stack([_on_side(side, arcs, between) for side in sides], axis=1)
    found = np.moveaxis(spline(between).reshape(len(between), len(arcs), len(sides), 3), 0, 2)
    off = float(np.linalg.norm(found - wanted, axis=3).max(initial=0.0))
    poles = np.moveaxis(np.asarray(spline.c).reshape(-1, len(arcs), len(sides), 3), 0, 2)
    return ArcImages(np.asarray(spline.t), poles, off)


def _on_side(side: Side, arcs: Sequence[Piece], share: Floats) -> Points:
    """(arcs, n, 3) places on *side* at *share* (n,) of every arc's sweep."""
    low = np.array([arc.low[0] for arc in arcs])[:, None]
    high = np.array([arc.high[0] for arc in arcs])[:, None]
    radius = np.array([arc.at[0] for arc in arcs])[:, None]
    x, y = np.array([arc.centre for arc in arcs]).T[..., None]
    turn = low + (high - low) * share
    u, v = x + radius * np.cos(turn), y + radius * np.sin(turn)
    return side.points(u.ravel(), v.ravel()).reshape(len(arcs), len(share), 3)
