"""The loops that trim a side of a strip in a STEP file, as rows x, y, bulge in its parameters."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
from numpy.polynomial.legendre import leggauss
from scipy.interpolate import BSpline

from fabrication.outlines import outline_area, polygon_area
from gridshell.arrays import Floats, Points

_FLAT = 1e-4
"""A piece whose middle is this close to its chord is straight, mm."""


def read_loops(face: Any, parameters: Callable[[Points], Floats]) -> tuple[Floats, ...]:
    """All loops of *face*, each (k, 3), the outer one first; that one runs counter-clockwise.

    Parameters
    ----------
    parameters : takes points (n, 3) to their parameters (n, 2) on the face.
    """
    bounds = [face.BoundsValue(i).Bound() for i in range(1, face.NbBounds() + 1)]
    points = [_corners_and_middles(bound) for bound in bounds]
    flat = parameters(np.concatenate([p.reshape(-1, 3) for p in points])).reshape(-1, 2, 2)
    ends = np.cumsum([len(p) for p in points])[:-1]
    loops = [_rows(uv[:, 0], uv[:, 1]) for uv in np.split(flat, ends)]
    loops.sort(key=lambda rows: abs(polygon_area(rows[:, :2])), reverse=True)
    outer, *inner = loops
    return (_turned(outer) if polygon_area(outer[:, :2]) < 0.0 else outer, *inner)


def landmarks(rows: Floats) -> Floats:
    """(n, 2) corners of an outline (k, 2) or (k, 3), and the middles of its arcs."""
    corners = rows[:, :2]
    if rows.shape[1] == 2:
        return corners
    curved = rows[:, 2] != 0.0
    a, b = corners[curved], np.roll(corners, -1, axis=0)[curved]
    right = np.stack([b[:, 1] - a[:, 1], a[:, 0] - b[:, 0]], axis=1)
    return np.concatenate([corners, (a + b) / 2.0 + rows[curved, 2:] / 2.0 * right])


def _corners_and_middles(loop: Any) -> Points:
    """(k, 2, 3) start of every edge in the loop's sense, and the middle of the edge."""
    found = []
    for i in range(1, loop.NbEdgeList() + 1):
        oriented = loop.EdgeListValue(i)
        edge = oriented.EdgeElement()
        start, end = (
            np.array(_xyz(v.VertexGeometry())) for v in (edge.EdgeStart(), edge.EdgeEnd())
        )
        found.append([start if oriented.Orientation() else end, _middle(edge, start, end)])
    return np.array(found)


def _middle(edge: Any, start: Floats, end: Floats) -> Floats:
    """Half-way along an edge in its curve's parameter; curves end where their edges do."""
    from OCP.StepGeom import StepGeom_BSplineCurveWithKnots

    curve = edge.EdgeGeometry()
    if not isinstance(curve, StepGeom_BSplineCurveWithKnots):
        return np.asarray((start + end) / 2.0)
    knots = np.repeat(
        [curve.KnotsValue(i) for i in range(1, curve.NbKnots() + 1)],
        [curve.KnotMultiplicitiesValue(i) for i in range(1, curve.NbKnots() + 1)],
    )
    count = curve.NbControlPointsList() + 1
    poles = np.array([_xyz(curve.ControlPointsListValue(i)) for i in range(1, count)])
    return np.asarray(BSpline(knots, poles, curve.Degree())((knots[0] + knots[-1]) / 2.0))


def _rows(corners: Floats, middles: Floats) -> Floats:
    chord = np.roll(corners, -1, axis=0) - corners
    length = np.linalg.norm(chord, axis=1)
    away = middles - corners - chord / 2.0
    sagitta = (away[:, 0] * chord[:, 1] - away[:, 1] * chord[:, 0]) / length
    return np.column_stack([corners, np.where(np.abs(sagitta) < _FLAT, 0.0, 2 * sagitta / length)])


def _turned(rows: Floats) -> Floats:
    """The same loop the other way round."""
    back = rows[::-1].copy()
    back[:, 2] = -np.roll(back[:, 2], -1)
    return back


def _xyz(point: Any) -> list[float]:
    return [point.CoordinatesValue(i) for i in (1, 2, 3)]


# ---- integration over a loop ---------------------------------------------------------------------


def quadrature(loop: Floats, knots: Floats) -> tuple[Floats, Floats, Floats]:
    """Points u, v and weights over the polygon of a loop's corners, column by column.

    Columns end where the loop turns and at the *knots* of the faces; inside a column the polygon
    is a set of intervals of v between straight pieces.
    """
    corners = loop[:, :2]
    a, b = corners, np.roll(corners, -1, axis=0)
    leans = np.abs(b[:, 0] - a[:, 0]) > 1e-9
    a, b = a[leans], b[leans]
    swap = a[:, 0] > b[:, 0]
    a, b = np.where(swap[:, None], b, a), np.where(swap[:, None], a, b)
    inside = knots[(knots > corners[:, 0].min()) & (knots < corners[:, 0].max())]
    stops = np.unique(np.r_[corners[:, 0], inside])
    stops = stops[np.r_[True, np.diff(stops) > 1e-9]]
    nodes, weights = leggauss(4)
    half_u = np.diff(stops) / 2.0
    u = ((stops[:-1] + stops[1:])[:, None] / 2.0 + half_u[:, None] * nodes).ravel()
    weight_u = (half_u[:, None] * weights).ravel()
    share = (u[:, None] - a[:, 0]) / (b[:, 0] - a[:, 0])
    level = np.where((share > 0.0) & (share < 1.0), a[:, 1] + share * (b - a)[:, 1], np.inf)
    level = np.sort(level, axis=1)
    row, interval = np.nonzero(np.isfinite(level[:, 1::2]))
    bottom, top = level[row, 2 * interval], level[row, 2 * interval + 1]
    half_v = (top - bottom) / 2.0
    v = (bottom + half_v)[:, None] + half_v[:, None] * nodes
    weight = weight_u[row, None] * half_v[:, None] * weights
    return np.repeat(u[row], 4), v.ravel(), weight.ravel()


def segments(loop: Floats) -> tuple[Floats, Floats]:
    """(n, 2) middles of a loop's arcs' chords, and the signed areas between arc and chord."""
    curved = np.flatnonzero(loop[:, 2])
    following = np.roll(loop, -1, axis=0)[curved]
    middle = (loop[curved, :2] + following[:, :2]) / 2.0
    areas = []
    for i, end in zip(curved, following, strict=True):
        pair = np.array([loop[i], [end[0], end[1], 0.0]])
        areas.append(outline_area(pair))
    return middle, np.array(areas)
