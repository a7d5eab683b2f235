"""Ruled faces of a STEP file: straight rulings between two splines of one parameter."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from scipy.interpolate import BSpline

from gridshell.arrays import Floats

_NEWTON_STEPS = 8


@dataclass(frozen=True, eq=False)
class RuledSide:
    """A large face: straight rulings between two splines of one parameter u.

    Parameters
    ----------
    lower, upper : the edges of the untrimmed face, mm.
    width : of the second parameter v, which runs from lower to upper, mm.
    """

    lower: BSpline
    upper: BSpline
    width: float

    def points(self, u: Floats, v: Floats) -> Floats:
        """Positions (n, 3)."""
        share = (np.asarray(v) / self.width)[..., None]
        return np.asarray((1.0 - share) * self.lower(u) + share * self.upper(u))

    def slopes(self, u: Floats, v: Floats) -> tuple[Floats, Floats]:
        """Derivatives by u and by v, each (n, 3)."""
        share = (np.asarray(v) / self.width)[..., None]
        by_u = (1.0 - share) * self.lower(u, 1) + share * self.upper(u, 1)
        return by_u, (self.upper(u) - self.lower(u)) / self.width

    def parameters(self, points: Floats) -> Floats:
        """(n, 2) parameters of *points* on the face: nearest sample, then Newton."""
        samples = np.linspace(self.lower.t[0], self.lower.t[-1], 4 * len(self.lower.c))
        middle = self.points(samples, np.full_like(samples, self.width / 2.0))
        nearest = np.argmin(np.linalg.norm(points[:, None] - middle, axis=2), axis=1)
        uv = np.stack([samples[nearest], np.full(len(points), self.width / 2.0)], axis=1)
        for _ in range(_NEWTON_STEPS):
            offset = points - self.points(uv[:, 0], uv[:, 1])
            slopes = np.stack(self.slopes(uv[:, 0], uv[:, 1]), axis=2)
            gram = np.einsum("nci,ncj->nij", slopes, slopes)
            right = np.einsum("nci,nc->ni", slopes, offset)
            uv = uv + np.linalg.solve(gram, right[..., None])[..., 0]
        return uv


def extent(surface: Any) -> float:
    """Area of the parameters of a spline surface."""
    last_u, last_v = surface.NbUKnots(), surface.NbVKnots()
    u = surface.UKnotsValue(last_u) - surface.UKnotsValue(1)
    return float(u * (surface.VKnotsValue(last_v) - surface.VKnotsValue(1)))


def ruled(surface: Any) -> RuledSide:
    """The face over a spline surface of degree one across."""
    u = np.repeat(
        [surface.UKnotsValue(i) for i in range(1, surface.NbUKnots() + 1)],
        [surface.UMultiplicitiesValue(i) for i in range(1, surface.NbUKnots() + 1)],
    )
    v = [surface.VKnotsValue(i) for i in range(1, surface.NbVKnots() + 1)]
    rows = range(1, surface.NbControlPointsListI() + 1)
    edges = [
        BSpline(
            u,
            np.array([_xyz(surface.ControlPointsListValue(i, j)) for i in rows]),
            surface.UDegree(),
        )
        for j in (1, surface.NbControlPointsListJ())
    ]
    return RuledSide(edges[0], edges[1], v[-1] - v[0])


def _xyz(point: Any) -> list[float]:
    return [point.CoordinatesValue(i) for i in (1, 2, 3)]
