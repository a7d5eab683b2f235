"""The two sides of a built strip as splines: what its solid is bounded by.

A side is ruled between two corner curves. All four corner curves share their knots, and their
parameter u is x on the flat strip, so (u, v) on a side is (x, y) on the flat part.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from scipy.interpolate import BSpline, make_interp_spline

from fabrication.lamella import Lamella
from fabrication.parts import FlatPart
from gridshell.arrays import Floats

_SAMPLES_PER_BAY = (2, 4, 8, 16, 32, 64)
_ACCURACY = 1e-3
"""Of the corner curves, mm: more samples are taken until they reach it."""


@dataclass(frozen=True, eq=False)
class Side:
    """A side of the strip: lower and upper corner curve with the same knots, v = 0 .. width."""

    knots: Floats
    lower: Floats
    upper: Floats
    width: float

    def points(self, u: Floats, v: Floats) -> Floats:
        """Positions (n, 3) at parameters *u*, *v*."""
        share = (np.asarray(v) / self.width)[:, None]
        lower = BSpline(self.knots, self.lower, 3)(u)
        return np.asarray((1.0 - share) * lower + share * BSpline(self.knots, self.upper, 3)(u))


def strip_sides(lamella: Lamella, part: FlatPart) -> tuple[Side, Side]:
    """The sides at +t/2 and -t/2 across; u is x on the flat strip.

    Samples are doubled until the splines meet the strip's own map half-way between them.
    """
    half_t, half_h = part.thickness / 2.0, part.width / 2.0
    corners = [(y, z) for y in (half_t, -half_t) for z in (-half_h, half_h)]

    def corner_curves(x: Floats) -> Floats:
        f = lamella.frames(x + lamella.start)
        return np.concatenate([f.points + y * f.b + z * f.n for y, z in corners], axis=1)

    for per_bay in _SAMPLES_PER_BAY:
        u = _sample_stations(lamella, per_bay) - lamella.start
        spline = _clamped_spline(u, corner_curves)
        between = (u[1:] + u[:-1]) / 2.0
        if np.abs(spline(between) - corner_curves(between)).max() <= _ACCURACY:
            break
    poles = spline.c.reshape(-1, 4, 3)
    near, far = (Side(spline.t, poles[:, 2 * i], poles[:, 2 * i + 1], part.width) for i in (0, 1))
    return near, far


def _clamped_spline(u: Floats, curves: Callable[[Floats], Floats]) -> BSpline:
    """The cubic spline through *curves* at *u*, with their slopes at both ends."""
    step = 1e-3 * float(u[-1] - u[0]) / len(u)
    slopes = [
        (curves(np.array([x + step])) - curves(np.array([x - step])))[0] / (2.0 * step)
        for x in (u[0], u[-1])
    ]
    boundary = ([(1, slopes[0])], [(1, slopes[1])])
    return make_interp_spline(u, curves(u), k=3, bc_type=boundary)


def _sample_stations(lamella: Lamella, per_bay: int) -> Floats:
    """Cut ends, nodes, and points between them in every bay."""
    inside = lamella.stations[(lamella.stations > lamella.start) & (lamella.stations < lamella.end)]
    stops = np.unique(np.r_[lamella.start, inside, lamella.end])
    share = np.arange(per_bay) / per_bay
    between = (stops[:-1, None] + np.diff(stops)[:, None] * share).ravel()
    return np.asarray(np.r_[between, stops[-1]])
