"""Closed curves in space laid into the plane: the domain a surface between them is meshed over."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from gridshell.arrays import Floats, Points, unit
from gridshell.errors import SurfaceError
from gridshell.surface.constrained_delaunay import inside
from gridshell.surface.forms import dot
from gridshell.surface.planar_mesher import signed_area

_CORNER = np.radians(25.0)
_FEWEST = 12  # points along a loop
_MATCHED = 180  # points along each of two loops that are matched to each other
_RING = (0.1, 0.9)  # limits of the inner radius of a ring


@dataclass(frozen=True, eq=False)
class Flattening:
    """Flat places for points of closed curves, in mm or, on circles, pure numbers.

    Parameters
    ----------
    plane : (2, 3) axes of a projection, or None: then every loop lies on a circle.
    circles : (loops, 3) radius, angle of the start and the sense of each loop (+1 or -1).
    outline : the loop outside of all others.
    """

    plane: Floats | None
    circles: Floats
    outline: int

    @classmethod
    def of(cls, curves: Sequence[Points]) -> Flattening:
        """Project where no curve crosses itself or another then, otherwise lay them on circles.

        Raises
        ------
        SurfaceError
            For three and more curves that cross in the projection.
        """
        sizes = [np.linalg.norm(_area_vector(c)) for c in curves]
        largest = int(np.argmax(sizes))
        plane = _plane(_area_vector(curves[largest]))
        circles = np.tile([1.0, 0.0, 1.0], (len(curves), 1))
        if plane is not None and _nested([c @ plane.T for c in curves], largest):
            return cls(plane, circles, largest)
        if len(curves) > 2:
            raise SurfaceError(
                "Three or more boundary curves must project onto a plane without crossing",
                value=f"{len(curves)} curves that cross or are not inside the largest one",
                advice="cut the surface into pieces with one or two boundary curves",
            )
        if len(curves) == 1:
            return cls(None, circles, 0)
        outline = int(np.argmax([length(c) for c in curves]))
        circles[1 - outline] = _matched(curves[outline], curves[1 - outline])
        return cls(None, circles, outline)

    def flat(self, loop: int, points: Points, share: Floats) -> Floats:
        """Flat places (k, 2) of *points* (k, 3) at *share* (k,) of the length of a loop."""
        if self.plane is not None:
            return np.asarray(points @ self.plane.T)
        radius, start, sense = self.circles[loop]
        angle = start + sense * 2.0 * np.pi * share
        return np.asarray(radius * np.stack([np.cos(angle), np.sin(angle)], axis=1))


def laid_out(
    curves: Sequence[Points], flattening: Flattening, edge: float
) -> tuple[list[Floats], list[Points]]:
    """Points about *edge* apart on every curve: flat and in space, walked as a mesher needs them.

    The outline comes first and runs counter-clockwise, holes clockwise.
    """
    order = [flattening.outline] + [k for k in range(len(curves)) if k != flattening.outline]
    flat, border = [], []
    for k in order:
        points, share = resampled(curves[k], edge)
        places = flattening.flat(k, points, share)
        forward = (signed_area(places) > 0.0) == (k == flattening.outline)
        flat.append(places if forward else places[::-1])
        border.append(points if forward else points[::-1])
    return flat, border


def resampled(curve: Points, edge: float) -> tuple[Points, Floats]:
    """Points (k, 3) of a closed polyline about *edge* apart, and their share (k,) of its length.

    Corners of more than 25 degrees stay points.
    """
    ahead = unit(np.roll(curve, -1, axis=0) - curve)
    turn = np.arccos(np.clip(dot(ahead, np.roll(ahead, 1, axis=0)), -1.0, 1.0))
    sides = np.linalg.norm(np.roll(curve, -1, axis=0) - curve, axis=1)
    station = np.concatenate([[0.0], np.cumsum(sides)])
    corners = np.flatnonzero(turn > _CORNER)
    stops = station[corners] if len(corners) else station[:1]
    total = station[-1]
    steps = []
    for start, end in zip(stops, np.append(stops[1:], stops[0] + total), strict=True):
        fewest = max(1, int(np.ceil(_FEWEST * (end - start) / total)))
        count = max(fewest, round(min((end - start) / edge if edge > 0.0 else 1.0, 1e6)))
        steps.append(start + (end - start) * np.arange(count) / count)
    at = np.sort(np.concatenate(steps) % total)
    closed = np.concatenate([curve, curve[:1]])
    points = np.stack([np.interp(at, station, closed[:, k]) for k in range(3)], axis=1)
    return points, at / total


def length(curve: Points) -> float:
    """Length of a closed polyline, mm."""
    return float(np.linalg.norm(curve - np.roll(curve, -1, axis=0), axis=1).sum())


def _area_vector(curve: Points) -> Floats:
    """The vector area inside a closed polyline (Newell), mm2."""
    centred = curve - curve.mean(axis=0)
    return np.asarray(np.cross(centred, np.roll(centred, -1, axis=0)).sum(axis=0) / 2.0)


def _plane(normal: Floats) -> Floats | None:
    """Two axes (2, 3) across *normal*, right-handed with it; None for no normal."""
    if not np.linalg.norm(normal) > 0.0:
        return None
    n = unit(normal)
    first = unit(np.cross(np.eye(3)[np.argmin(np.abs(n))], n))
    return np.stack([first, np.cross(n, first)])


def _nested(flat: list[Floats], outline: int) -> bool:
    """Whether no polygon crosses itself or another and all lie inside the outline, side by side."""
    start = np.concatenate(flat)
    end = np.concatenate([np.roll(f, -1, axis=0) for f in flat])
    if _any_crossing(start, end):
        return False
    holes = [f for k, f in enumerate(flat) if k != outline]
    apart = all(
        not inside(f[:1], [g])[0]
        for i, f in enumerate(holes)
        for j, g in enumerate(holes)
        if i != j
    )
    full = abs(signed_area(flat[outline])) > 0.05 * np.ptp(flat[outline], axis=0).max() ** 2
    return apart and bool(full) and all(inside(f, [flat[outline]]).all() for f in holes)


def _any_crossing(start: Floats, end: Floats) -> bool:
    """Whether any two of the segments (k, 2) cross properly."""

    def turn(a: Floats, b: Floats, c: Floats) -> Floats:
        ab, ac = b - a, c - a
        return np.asarray(ab[..., 0] * ac[..., 1] - ab[..., 1] * ac[..., 0])

    for a, b in zip(start, end, strict=True):
        across = turn(a, b, start) * turn(a, b, end) < 0.0
        if (across & (turn(start, end, a) * turn(start, end, b) < 0.0)).any():
            return True
    return False


def _matched(outer: Points, inner: Points) -> tuple[float, float, float]:
    """Radius, angle of the start and sense of *inner* on a circle inside the unit one."""
    first, second = _even(outer), _even(inner)
    best = (np.inf, 0.0, 1.0)
    for sense, walked in ((1.0, second), (-1.0, np.roll(second[::-1], 1, axis=0))):
        for shift in range(_MATCHED):
            away = float(np.linalg.norm(first - np.roll(walked, shift, axis=0), axis=1).mean())
            if away < best[0] * (1.0 - 1e-9):
                best = (away, 2.0 * np.pi * shift / _MATCHED, sense)
    away, angle, sense = best
    around = (length(outer) + length(inner)) / 2.0
    radius = float(np.clip(np.exp(-2.0 * np.pi * away / around), *_RING))
    return radius, angle, sense


def _even(curve: Points) -> Points:
    """As many points as are matched, evenly along a closed polyline from its first point."""
    closed = np.concatenate([curve, curve[:1]])
    station = np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(closed, axis=0), axis=1))])
    at = station[-1] * np.arange(_MATCHED) / _MATCHED
    return np.stack([np.interp(at, station, closed[:, k]) for k in range(3)], axis=1)
