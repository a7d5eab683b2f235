"""The surfaces of a strip's solid in the CAD kernel's types."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from fabrication.errors import no_kernel
from fabrication.sides import Side
from fabrication.strip_loops import Loop, Run
from gridshell.arrays import Floats, unit

try:
    from OCP.Geom import Geom_BSplineCurve, Geom_BSplineSurface, Geom_Plane
    from OCP.gp import gp_Dir, gp_Pnt
    from OCP.TColgp import TColgp_Array2OfPnt
    from OCP.TColStd import TColStd_Array1OfInteger, TColStd_Array1OfReal
except ImportError as error:  # pragma: no cover - depends on the machine
    raise no_kernel(error) from error

TOLERANCE = 1e-6
"""Of the kernel's vertices and edges at least, mm."""

SQUARE = 1e-9
"""Corners whose x agrees this well on both sides are not bevelled, mm."""


def wall_planes(
    loops: Sequence[Loop], corners: Sequence[Sequence[Floats]], thickness: float
) -> tuple[dict[tuple[int, int], Geom_Plane], float]:
    """Planes of the square walls across the strip by loop and piece, and the tolerance they need.

    A normal belongs to the natural direction of its piece. The tolerance covers what walls are out
    of plane and straight edges off their length; both come from interpolating the corner curves
    and stay around 1e-6 mm on smooth strips.
    """
    walls, quads, heights, bevels = [], [], [], []
    for number, loop in enumerate(loops):
        near, far = corners[number]
        for i, piece in enumerate(loop.pieces):
            if piece.run is not Run.ACROSS:
                continue
            a, b = piece.first, piece.last
            square = abs(piece.at[0] - piece.at[1]) < SQUARE
            heights.append(piece.high[0] - piece.low[0])
            quads.append([near[a], near[b], far[b], far[a]])
            bevels.append(not square)
            walls.append((number, i))
    points = np.array(quads)
    middle = points.mean(axis=1)
    normal = unit(np.cross(points[:, 2] - points[:, 0], points[:, 3] - points[:, 1]))
    offset = np.abs(np.einsum("mkc,mc->mk", points - middle[:, None], normal)).max(axis=1)
    offset = np.where(bevels, 0.0, offset)
    up = np.linalg.norm(points[:, [1, 2]] - points[:, [0, 3]], axis=2)
    through = np.linalg.norm(points[:, [0, 1]] - points[:, [3, 2]], axis=2)
    astray = np.where(np.array(bevels)[:, None], 0.0, np.abs(through - thickness))
    tolerance = 2.0 * max(
        float(offset.max()),
        float(np.abs(up - np.array(heights)[:, None]).max()),
        float(astray.max()),
    )
    planes = {
        place: Geom_Plane(gp_Pnt(*point), gp_Dir(*direction))
        for place, bevelled, point, direction in zip(
            walls, bevels, middle.tolist(), normal.tolist(), strict=True
        )
        if not bevelled
    }
    return planes, tolerance


def bevel_sag(sides: Sequence[Side], outline: Loop) -> float:
    """How far edges through the thickness at bevelled ends are from the walls beside them, mm."""
    near, far = outline.rows
    lean = np.abs(near[:, 0] - far[:, 0]) >= SQUARE
    if not lean.any():
        return 0.0
    x = (near[lean, 0] + far[lean, 0]) / 2.0
    y = near[lean, 1]
    wall = (sides[0].points(x, y) + sides[1].points(x, y)) / 2.0
    ends = [side.points(rows[lean, 0], y) for side, rows in zip(sides, (near, far), strict=True)]
    return float(np.linalg.norm(wall - (ends[0] + ends[1]) / 2.0, axis=1).max())


def multiplicities(
    repeated: Floats,
) -> tuple[TColStd_Array1OfReal, TColStd_Array1OfInteger]:
    """Knots of which each stands as often as it counts (k,), in the kernel's form."""
    values, counts = np.unique(repeated, return_counts=True)
    return knots(values.tolist(), counts.tolist())


def knots(
    values: Sequence[float], counts: Sequence[int]
) -> tuple[TColStd_Array1OfReal, TColStd_Array1OfInteger]:
    """Distinct knots and how often each counts, in the kernel's form."""
    reals = TColStd_Array1OfReal(1, len(values))
    integers = TColStd_Array1OfInteger(1, len(values))
    for i, (value, count) in enumerate(zip(values, counts, strict=True), start=1):
        reals.SetValue(i, value)
        integers.SetValue(i, count)
    return reals, integers


def side_surface(side: Side) -> Geom_BSplineSurface:
    """The surface of a side, of degree 3 x 1; its parameters are x and y of the flat strip, mm."""
    points = TColgp_Array2OfPnt(1, len(side.lower), 1, 2)
    for column, poles in enumerate((side.lower, side.upper), start=1):
        for row, pole in enumerate(poles.tolist(), start=1):
            points.SetValue(row, column, gp_Pnt(*pole))
    u, u_counts = multiplicities(side.knots)
    v, v_counts = knots((0.0, side.width), (2, 2))
    return Geom_BSplineSurface(points, u, v, u_counts, v_counts, 3, 1)


def ruled_surface(
    near: Geom_BSplineCurve, far: Geom_BSplineCurve, thickness: float
) -> Geom_BSplineSurface:
    """Between two curves with the same knots; the second parameter runs from 0 to *thickness*."""
    count = near.NbPoles()
    points = TColgp_Array2OfPnt(1, count, 1, 2)
    for column, curve in enumerate((near, far), start=1):
        for row in range(1, count + 1):
            points.SetValue(row, column, curve.Pole(row))
    w, w_counts = knots((0.0, thickness), (2, 2))
    u = TColStd_Array1OfReal(1, near.NbKnots())
    u_counts = TColStd_Array1OfInteger(1, near.NbKnots())
    near.Knots(u)
    near.Multiplicities(u_counts)
    return Geom_BSplineSurface(points, u, w, u_counts, w_counts, near.Degree(), 1)


def bilinear(ends: Sequence[Sequence[Floats]], height: float, depth: float) -> Geom_BSplineSurface:
    """Over low and high of the near side, then of the far one, at 0 .. height and 0 .. depth."""
    points = TColgp_Array2OfPnt(1, 2, 1, 2)
    for column, side in enumerate(ends, start=1):
        for row, end in enumerate(side, start=1):
            points.SetValue(row, column, gp_Pnt(*end.tolist()))
    u, u_counts = knots((0.0, height), (2, 2))
    w, w_counts = knots((0.0, depth), (2, 2))
    return Geom_BSplineSurface(points, u, w, u_counts, w_counts, 1, 1)
