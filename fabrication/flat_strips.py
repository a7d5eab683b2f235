"""Strips of a flat segment as elastic lines through its nodes, and the rectangle around them.

A thin strip held at its slots alone is a cubic between them, with no moment at its ends: the
natural spline through the nodes, by stations.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.polynomial.legendre import leggauss
from scipy.interpolate import CubicSpline
from scipy.spatial import ConvexHull, QhullError

from fabrication.flat_grid import FlatGrid
from gridshell.arrays import Floats, Indices

_GAUSS_X, _GAUSS_W = leggauss(6)
_SAMPLES_PER_BAY = 8
_STRAIGHT = 1e-10
"""Smaller curvatures are rounding, 1/mm."""


@dataclass(frozen=True, eq=False)
class FlatStrip:
    """One strip as it lies.

    Parameters
    ----------
    mark : its mark.
    nodes : (k,) numbers of its nodes in the flat state, in order.
    stations : (k,) their stations, mm.
    curve : position on the ground (2,) by station; straight beyond the end nodes.
    start, end : stations of the cut ends, mm.
    radius : smallest bending radius, mm.
    """

    mark: str
    nodes: Indices
    stations: Floats
    curve: CubicSpline
    start: float
    end: float
    radius: float

    def points(self, per_bay: int = _SAMPLES_PER_BAY) -> Floats:
        """(q, 2) points from cut end to cut end, for drawings."""
        share = np.arange(per_bay) / per_bay
        inner = (self.stations[:-1, None] + np.diff(self.stations)[:, None] * share).ravel()
        nodes = np.r_[inner, self.stations[-1]]
        s = np.r_[self.start, nodes[(nodes > self.start) & (nodes < self.end)], self.end]
        held = np.clip(s, self.stations[0], self.stations[-1])
        ahead = self.curve(held, 1)
        ahead /= np.linalg.norm(ahead, axis=1, keepdims=True)
        return np.asarray(self.curve(held) + (s - held)[:, None] * ahead)


def _curves(grid: FlatGrid, p: Floats) -> list[CubicSpline]:
    """Elastic lines through the nodes, free of moment at their ends."""
    return [
        CubicSpline(s, p[row], bc_type="natural")
        for row, s in zip(grid.rows, grid.stations, strict=True)
    ]


def arcs(grid: FlatGrid, p: Floats) -> Floats:
    """(m,) length of each bay along the elastic line, mm."""
    bays = []
    for curve in _curves(grid, p):
        half = np.diff(curve.x)[:, None] / 2.0
        s = curve.x[:-1, None] + half * (1.0 + _GAUSS_X)
        bays.append((np.linalg.norm(curve(s, 1), axis=2) * half) @ _GAUSS_W)
    return np.concatenate(bays)


def _radius(curve: CubicSpline) -> float:
    share = np.arange(_SAMPLES_PER_BAY) / _SAMPLES_PER_BAY
    s = np.r_[(curve.x[:-1, None] + np.diff(curve.x)[:, None] * share).ravel(), curve.x[-1]]
    first, second = curve(s, 1), curve(s, 2)
    across = np.abs(first[:, 0] * second[:, 1] - first[:, 1] * second[:, 0])
    most = float((across / np.linalg.norm(first, axis=1) ** 3).max())
    return np.inf if most < _STRAIGHT else 1.0 / most


def set_down(
    grid: FlatGrid, p: Floats, thickness: float
) -> tuple[Floats, tuple[FlatStrip, ...], tuple[float, float]]:
    """Turn the segment into the smallest rectangle around it, and move it into its corner."""
    lying = _strips(grid, p)
    points = np.concatenate([strip.points() for strip in lying])
    turn, low, size = _smallest_rectangle(points)
    placed = p @ turn - low + thickness / 2.0
    length, width = (float(side) + thickness for side in size)
    return placed, _strips(grid, placed), (length, width)


def _strips(grid: FlatGrid, p: Floats) -> tuple[FlatStrip, ...]:
    return tuple(
        FlatStrip(
            mark=lamella.mark,
            nodes=row,
            stations=stations,
            curve=curve,
            start=lamella.start,
            end=lamella.end,
            radius=_radius(curve),
        )
        for lamella, row, stations, curve in zip(
            grid.lamellas, grid.rows, grid.stations, _curves(grid, p), strict=True
        )
    )


def _smallest_rectangle(points: Floats) -> tuple[Floats, Floats, Floats]:
    """The turn (2, 2) that lays the smallest rectangle along x, its low corner, and its sides."""
    try:
        hull = points[ConvexHull(points).vertices]
    except QhullError:  # all on a line
        hull = points
    sides = np.roll(hull, -1, axis=0) - hull
    angles = np.unique(np.round(np.arctan2(sides[:, 1], sides[:, 0]) % (np.pi / 2.0), 9))
    cosine, sine = np.cos(angles), np.sin(angles)
    turns = np.stack([np.stack([cosine, -sine], 1), np.stack([sine, cosine], 1)], 1)
    turned = np.einsum("qc,tcd->tqd", hull, turns)
    extent = turned.max(axis=1) - turned.min(axis=1)
    best = int(np.argmin(extent.prod(axis=1)))
    turn = turns[best]
    if extent[best, 1] > extent[best, 0]:
        turn = turn @ np.array([[0.0, -1.0], [1.0, 0.0]])
    seen = hull @ turn
    return turn, seen.min(axis=0), np.ptp(seen, axis=0)
