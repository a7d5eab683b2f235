"""A lamella: a straight flat strip, bent and twisted so that it stands on the surface.

Its axis is a smooth curve through the net's nodes (not-a-knot cubic spline; a closed one where the
lamella is closed), parametrised by its own arc length, so that a station on the axis is a station
on the flat strip. Along the axis runs a frame: tangent t, surface normal n, and b = n x t across
the strip's thickness. A point of the strip has coordinates (s, y, z): arc length along the axis,
distance along b, height along n.

Do not confuse: *station* s is measured from the first node, *x* from the strip's cut end.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.polynomial.legendre import leggauss
from scipy.interpolate import CubicSpline

from gridshell.arrays import Floats, Indices, Points, Vectors, frozen, unit
from gridshell.picture import FAMILY_COLOURS, card, sketch, straight

_GAUSS_X, _GAUSS_W = leggauss(8)
_REPARAMETRISATIONS = 12
_SAMPLES_PER_BAY = 8
_PER_BAY_SHOWN = 6


@dataclass(frozen=True, eq=False)
class AxisCurve:
    """A smooth curve through points, parametrised by arc length at the points.

    Parameters
    ----------
    spline : position by station, mm.
    stations : (k,) arc length at the points; a closed curve has one more for its return.
    closed : whether the curve returns to its first point.
    """

    spline: CubicSpline
    stations: Floats
    closed: bool

    @property
    def length(self) -> float:
        """Arc length from the first to the last point, or all around, mm."""
        return float(self.stations[-1])

    def tangents(self, s: Floats) -> Vectors:
        """Unit tangents at stations *s* (n,)."""
        return unit(self.spline(s, 1))


def axis_curve(points: Points, *, closed: bool, reach: float = 0.0) -> AxisCurve:
    """The axis through *points* (k, 3), k >= 2 (3 when closed).

    Chord sums fall short of the arc by s^3 / (24 R^2) per bay; here the knots are moved until
    they equal the arc lengths of the curve itself. The curve is then resampled by arc length, so
    that stations are true between the nodes as well, and over *reach* mm beyond both ends.
    """
    through = np.vstack([points, points[:1]]) if closed else np.asarray(points)
    knots = np.r_[0.0, np.cumsum(np.linalg.norm(np.diff(through, axis=0), axis=1))]
    boundary = "periodic" if closed else "not-a-knot"
    spline = CubicSpline(knots, through, bc_type=boundary)
    for _ in range(_REPARAMETRISATIONS):
        arcs = np.r_[0.0, np.cumsum(_arc_lengths(spline, knots))]
        moved = np.abs(arcs - knots).max()
        knots = arcs
        spline = CubicSpline(knots, through, bc_type=boundary)
        if moved <= 1e-10 * arcs[-1]:
            break
    return _resampled(spline, knots, closed=closed, reach=0.0 if closed else reach)


def _resampled(spline: CubicSpline, knots: Floats, *, closed: bool, reach: float) -> AxisCurve:
    share = np.arange(_SAMPLES_PER_BAY) / _SAMPLES_PER_BAY
    dense = np.r_[(knots[:-1, None] + np.diff(knots)[:, None] * share).ravel(), knots[-1]]
    if reach > 0.0:
        dense = np.r_[-reach, -reach / 2.0, dense, knots[-1] + reach / 2.0, knots[-1] + reach]
    arcs = np.r_[0.0, np.cumsum(_arc_lengths(spline, dense))]
    arcs -= arcs[2] if reach > 0.0 else 0.0
    through = spline(dense)
    if closed:
        through[-1] = through[0]
    by_arc = CubicSpline(arcs, through, bc_type="periodic" if closed else "not-a-knot")
    first = 2 if reach > 0.0 else 0
    stations = arcs[first::_SAMPLES_PER_BAY][: len(knots)]
    return AxisCurve(by_arc, frozen(stations), closed)


def _arc_lengths(spline: CubicSpline, knots: Floats) -> Floats:
    """(k - 1,) arc length between neighbouring knots, by Gauss quadrature."""
    half = np.diff(knots)[:, None] / 2.0
    s = (knots[:-1, None] + half) + half * _GAUSS_X
    return np.asarray((np.linalg.norm(spline(s, 1), axis=2) * half) @ _GAUSS_W)


def curve_beside(lamella: Lamella, *, across: float, along: float) -> tuple[AxisCurve, CubicSpline]:
    """The curve at a distance from a lamella's axis, parametrised by its own arc length.

    Parameters
    ----------
    across, along : distances along b and along n, mm.

    Returns
    -------
    The curve, with the feet of the lamella's nodes as its stations; and the spline that takes
    stations of the lamella to stations of the curve.
    """
    knots = lamella.axis.spline.x
    flat = np.ones_like(knots)
    points = lamella.place(knots, across * flat, along * flat)
    closed = lamella.closed
    if closed:
        points[-1] = points[0]
    boundary = "periodic" if closed else "not-a-knot"
    arcs = np.r_[0.0, np.cumsum(_arc_lengths(CubicSpline(knots, points, bc_type=boundary), knots))]
    arcs -= arcs[np.searchsorted(knots, 0.0)]
    stations = CubicSpline(knots, arcs)
    curve = CubicSpline(arcs, points, bc_type=boundary)
    return AxisCurve(curve, frozen(stations(lamella.axis.stations)), closed), stations


@dataclass(frozen=True, eq=False)
class Frames:
    """Frames along an axis: rows of points and right-handed unit vectors t, b, n."""

    points: Points
    t: Vectors
    b: Vectors
    n: Vectors


@dataclass(frozen=True, eq=False)
class Lamella:
    """One strip.

    Parameters
    ----------
    mark : "A1", "A2", ... in family 1, "B1", ... in family 2.
    family : 1 or 2.
    nodes : (k,) node numbers in order along the axis.
    axis : its curve through the nodes.
    normals : direction of the strip's width by station; perpendicular to the axis at the nodes.
    start, end : stations of the two cut ends; the strip overhangs its end nodes, or stops short.
    """

    mark: str
    family: int
    nodes: Indices
    axis: AxisCurve
    normals: CubicSpline
    start: float
    end: float

    @property
    def length(self) -> float:
        """Developed length of the flat strip, mm."""
        return self.end - self.start

    @property
    def closed(self) -> bool:
        """Whether the two cut ends meet in a seam."""
        return self.axis.closed

    @cached_property
    def stations(self) -> Floats:
        """(k,) station of each node."""
        return self.axis.stations[: len(self.nodes)]

    def frames(self, s: Floats) -> Frames:
        """Frames at stations *s* (n,)."""
        s = np.asarray(s, dtype=np.float64)
        t = self.axis.tangents(s)
        n = self.normals(s)
        n = unit(n - np.einsum("nc,nc->n", n, t)[:, None] * t)
        return Frames(np.asarray(self.axis.spline(s)), t, np.cross(n, t), n)

    def place(self, s: Floats, y: Floats, z: Floats) -> Points:
        """Strip coordinates (n,) each to positions (n, 3), mm."""
        f = self.frames(s)
        return np.asarray(f.points + np.asarray(y)[:, None] * f.b + np.asarray(z)[:, None] * f.n)

    def twist(self, s: Floats) -> Floats:
        """Rate of turn of the frame about the axis, dn/ds . b, at stations *s*, rad/mm.

        Along an asymptotic curve its square is the negative Gaussian curvature (Beltrami and
        Enneper), with opposite signs in the two families.
        """
        step = 1e-4 * max(self.axis.length, 1.0)
        before, after = self.frames(np.asarray(s) - step), self.frames(np.asarray(s) + step)
        b = self.frames(s).b
        return np.asarray(np.einsum("nc,nc->n", after.n - before.n, b) / (2.0 * step))

    def bending(self, s: Floats) -> tuple[Floats, Floats]:
        """Curvature about the weak axis (within the surface) and about the strong one, 1/mm.

        The first bends the thin strip, as built. The second is the normal curvature of the axis:
        zero on an asymptotic curve, and what a straight strip cannot follow elsewhere.
        """
        first, second = self.axis.spline(s, 1), self.axis.spline(s, 2)
        speed = np.einsum("nc,nc->n", first, first)
        f = self.frames(s)
        return (
            np.einsum("nc,nc->n", second, f.b) / speed,
            np.einsum("nc,nc->n", second, f.n) / speed,
        )

    def _repr_html_(self) -> str:
        """For notebooks: its axis, and the direction of its width at the nodes."""
        s = np.linspace(self.start, self.end, _PER_BAY_SHOWN * max(len(self.stations), 2))
        axis, nodes = self.frames(s), self.frames(self.stations)
        up = self.length / 40.0 * nodes.n
        points = np.concatenate([axis.points, nodes.points - up, nodes.points + up])
        first = np.arange(len(s) - 1)
        ticks = len(s) + np.arange(len(nodes.points))
        lines = [
            straight(
                points, np.stack([first, first + 1], axis=1), FAMILY_COLOURS[self.family], 2.0
            ),
            straight(points, np.stack([ticks, ticks + len(ticks)], axis=1)),
        ]
        bend = float(np.abs(self.bending(s)[0]).max())
        return card(
            f"Lamella {self.mark}",
            [
                ("Family", "AB"[self.family - 1]),
                ("Length", f"{self.length:.1f} mm{', closed' if self.closed else ''}"),
                ("Nodes", f"{len(self.nodes)}"),
                ("Smallest bending radius", f"{1e-3 / bend:.2f} m" if bend > 1e-9 else "straight"),
                ("Largest twist", f"{np.degrees(np.abs(self.twist(s)).max()) * 1e3:.1f} degrees/m"),
            ],
            picture=sketch(lines, label=f"The axis of lamella {self.mark}"),
        )


def piece_of(
    lamella: Lamella, mark: str, nodes: tuple[int, int], start: float, end: float
) -> Lamella:
    """A length of *lamella* as a strip of its own; its stations begin at its own first node.

    Parameters
    ----------
    nodes : number of the first and of the last node it keeps along the lamella; it may end short
        of either. On a closed lamella of k nodes the last may be k or more: the piece then goes
        on over the first node, whose number is k the second time round.
    start, end : its cut ends, stations of *lamella*, mm; beyond its length likewise.
    """
    first, last = nodes
    numbers = np.arange(first, last + 1)
    stations = station_of(lamella, numbers)
    origin = float(stations[0])
    return Lamella(
        mark=mark,
        family=lamella.family,
        nodes=lamella.nodes[numbers % len(lamella.nodes)],
        axis=AxisCurve(_moved(lamella.axis.spline, -origin), frozen(stations - origin), False),
        normals=_moved(lamella.normals, -origin),
        start=start - origin,
        end=end - origin,
    )


def station_of(lamella: Lamella, numbers: Indices) -> Floats:
    """(n,) stations of the nodes with *numbers* along a lamella, mm.

    On a closed one the numbers go on past its last node, and so do the stations.
    """
    around, number = np.divmod(np.asarray(numbers), len(lamella.nodes))
    return np.asarray(lamella.stations[number] + around * lamella.axis.length)


def _moved(spline: CubicSpline, by: float) -> CubicSpline:
    """*spline* with its parameter moved *by* mm."""
    return CubicSpline.construct_fast(spline.c, spline.x + by, spline.extrapolate, spline.axis)
