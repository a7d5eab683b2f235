"""Damped Newton iteration for the closest points of a parametrised surface."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from gridshell.arrays import Floats, Points
from gridshell.surface.forms import Derivatives, dot, frame

Evaluate = Callable[[Floats, Floats], Derivatives]
Confine = Callable[[Floats, Floats], tuple[Floats, Floats]]

ITERATIONS = 60
"""Upper bound; a good seed needs five or six, a point far outside the seeds one per half unit."""

TOLERANCE = 1e-12
"""A foot has converged when it moves less than this times surface size plus coordinates."""

_LARGEST_STEP = 0.5  # in u and v, which are pure numbers
_SMALLEST_EIGENVALUE = 1e-3  # of the Hessian over the metric; 1 on the surface, 0 at a focal point
_HALVINGS = 12
_ROUNDING = 1e-14  # of a distance, over the coordinates it is the difference of


def refine(
    evaluate: Evaluate,
    confine: Confine,
    start: tuple[Floats, Floats],
    points: Points,
    *,
    length: float,
) -> tuple[Floats, Floats]:
    """Find the parameters (u, v), each (n,), of the feet of *points* (n, 3) next to *start*.

    Parameters
    ----------
    evaluate : the surface and its derivatives at parameters (n,).
    confine : brings parameters (n,) back to where the formula is regular.
    start : parameters (u, v), each (n,).
    length : size of the surface, mm; the tolerance is relative to it plus the coordinates.

    Notes
    -----
    A point at a centre of curvature has a degenerate Hessian; convergence is linear there and the
    best parameters found are returned, whose distance is exact to far more digits than the foot.
    """
    u, v = start[0].copy(), start[1].copy()
    active = np.arange(len(points))
    size = length + np.linalg.norm(points, axis=1)
    for _ in range(ITERATIONS):
        if not len(active):
            break
        d = evaluate(u[active], v[active])
        step = _step(d, points[active])
        new_u, new_v = _descend(
            evaluate, confine, (u[active], v[active]), step, points[active], size[active]
        )
        moved = (new_u - u[active])[:, None] * d.xu + (new_v - v[active])[:, None] * d.xv
        u[active], v[active] = new_u, new_v
        active = active[dot(moved, moved) > (TOLERANCE * size[active]) ** 2]
    return u, v


def _step(d: Derivatives, points: Points) -> tuple[Floats, Floats]:
    """Return the Newton step (du, dv) of half the squared distance, always downhill."""
    r = d.x - points
    tangent = frame(d)
    g1, g2 = tangent.covector(dot(r, d.xu), dot(r, d.xv))
    a, b, c = tangent.form(dot(r, d.xuu), dot(r, d.xuv), dot(r, d.xvv))
    least = 1.0 + (a + c) / 2.0 - np.hypot((a - c) / 2.0, b)
    shift = 1.0 + np.maximum(np.abs(least), _SMALLEST_EIGENVALUE) - least
    a, c = a + shift, c + shift
    determinant = a * c - b * b
    du, dv = tangent.parameters((b * g2 - c * g1) / determinant, (b * g1 - a * g2) / determinant)
    damping = _LARGEST_STEP / np.maximum(np.maximum(np.abs(du), np.abs(dv)), _LARGEST_STEP)
    return du * damping, dv * damping


def _descend(
    evaluate: Evaluate,
    confine: Confine,
    start: tuple[Floats, Floats],
    step: tuple[Floats, Floats],
    points: Points,
    size: Floats,
) -> tuple[Floats, Floats]:
    """Take the step, halved until the distance no longer grows, up to rounding."""

    def squared_distance(u: Floats, v: Floats) -> Floats:
        r = evaluate(u, v).x - points
        return dot(r, r)

    limit = (np.sqrt(squared_distance(*start)) + _ROUNDING * size) ** 2
    factor = np.ones(len(points))
    for _ in range(_HALVINGS):
        u, v = confine(start[0] + factor * step[0], start[1] + factor * step[1])
        grows = squared_distance(u, v) > limit
        if not grows.any():
            return u, v
        factor[grows] /= 2.0
    return np.where(grows, start[0], u), np.where(grows, start[1], v)
