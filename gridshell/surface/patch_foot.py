"""Closest points of a NURBS patch within its unit square: Newton's method with active bounds."""

from __future__ import annotations

import numpy as np

from gridshell.arrays import Floats, Mask, Points
from gridshell.surface.forms import Derivatives, dot
from gridshell.surface.nurbs import NurbsPatch

ITERATIONS = 40
TOLERANCE = 1e-13
"""A foot has converged when it moves less than this times the size."""

_LARGEST_STEP = 0.5
_HALVINGS = 10
_CONVEX = 1e-3  # of the Hessian over the metric: less counts as a focal point
_OFF_POLE = 1e-11
_AT_SIDE = 1e-10
_SINGULAR = 1e-7  # of the size: shorter derivatives make no tangent plane
_INSET = 1e-5


def settle(patch: NurbsPatch, start: Floats, points: Points, size: float) -> Floats:
    """Find the parameters (n, 2) of the feet of *points* (n, 3) next to *start* (n, 2).

    A parameter that would leave the unit square stays on its side, and the foot is the closest
    point of that side; closed directions have no sides. The distance never grows.
    """
    low = np.where(patch.closed, -np.inf, _margin(patch))
    high = np.where(patch.closed, np.inf, 1.0 - _margin(patch))
    uv = np.clip(start, low, high)
    active, here = np.arange(len(points)), uv.copy()
    d = patch.derivatives(*here.T)
    for _ in range(ITERATIONS):
        if not len(active):
            break
        step = _step(d, points[active], here <= low + _AT_SIDE, here >= high - _AT_SIDE)
        there, after = _descend(patch, d, here, step, points[active], (low, high))
        offset = there - here
        moved = offset[:, :1] * d.xu + offset[:, 1:] * d.xv
        uv[active] = there
        going = dot(moved, moved) > (TOLERANCE * size) ** 2
        active, here = active[going], there[going]
        d = Derivatives(*(part[going] for part in after))
    return uv


def regular(patch: NurbsPatch, uv: Floats, size: float) -> Derivatives:
    """The surface at *uv* (n, 2), with derivatives from a little off a pole where it is one."""
    d = patch.derivatives(*uv.T)
    pole = np.minimum(dot(d.xu, d.xu), dot(d.xv, d.xv)) < (_SINGULAR * size) ** 2
    if pole.any():
        inner = patch.derivatives(*np.clip(uv[pole], _INSET, 1.0 - _INSET).T)
        for part, better in zip(d[1:], inner[1:], strict=True):
            part[pole] = better
    return d


def _step(d: Derivatives, points: Points, at_low: Mask, at_high: Mask) -> Floats:
    """Newton step (n, 2) of half the squared distance, or Gauss-Newton where that is not convex."""
    r = d.x - points
    g = np.stack([dot(r, d.xu), dot(r, d.xv)], axis=1)
    e, f, h = dot(d.xu, d.xu), dot(d.xu, d.xv), dot(d.xv, d.xv)
    a, b, c = e + dot(r, d.xuu), f + dot(r, d.xuv), h + dot(r, d.xvv)
    convex = (a > _CONVEX * e) & (c > _CONVEX * h) & (a * c - b * b > _CONVEX * (e * h - f * f))
    a, b, c = (np.where(convex, x, y) for x, y in ((a, e), (b, f), (c, h)))
    held = (at_low & (g > 0.0)) | (at_high & (g < 0.0))
    g = np.where(held, 0.0, g)
    b = np.where(held.any(axis=1), 0.0, b)
    determinant = a * c - b * b
    flat = ~(determinant > 1e-14 * a * c)
    b, determinant = np.where(flat, 0.0, b), np.where(flat, a * c, determinant)
    scale = np.where(determinant > 0.0, 1.0 / np.where(determinant > 0.0, determinant, 1.0), 0.0)
    step = np.stack([b * g[:, 1] - c * g[:, 0], b * g[:, 0] - a * g[:, 1]], axis=1)
    step *= scale[:, None]
    longest = np.maximum(np.abs(step).max(axis=1, keepdims=True), _LARGEST_STEP)
    return np.asarray(step * (_LARGEST_STEP / longest))


def _descend(
    patch: NurbsPatch,
    d: Derivatives,
    here: Floats,
    step: Floats,
    points: Points,
    box: tuple[Floats, Floats],
) -> tuple[Floats, Derivatives]:
    """Take the step, halved until the distance does not grow; and the surface there."""
    away = np.linalg.norm(d.x - points, axis=1)
    limit = away * (1.0 + 1e-14)
    # a step that leaves the square ends on its side, in its own direction: still downhill
    room = np.where(step > 0.0, box[1] - here, here - box[0])
    share = np.where(np.abs(step) > room, room / np.where(step == 0.0, 1.0, np.abs(step)), 1.0)
    step = step * share.min(axis=1, keepdims=True)
    there = np.clip(here + step, *box)
    after = patch.derivatives(*there.T)
    factor = 1.0
    for _ in range(_HALVINGS):
        grows = np.flatnonzero(np.linalg.norm(after.x - points, axis=1) > limit)
        if not len(grows):
            return there, after
        factor /= 2.0
        there[grows] = np.clip(here[grows] + factor * step[grows], *box)
        again = patch.derivatives(*there[grows].T)
        for part, better in zip(after, again, strict=True):
            part[grows] = better
    grows = np.flatnonzero(np.linalg.norm(after.x - points, axis=1) > limit)
    there[grows] = here[grows]
    for part, before in zip(after, d, strict=True):
        part[grows] = before[grows]
    return there, after


def _margin(patch: NurbsPatch) -> float:
    """How far from the ends of u and v a foot stays: off a pole there, else not at all."""
    poles = patch.poles
    size = float(np.ptp(poles.reshape(-1, 3), axis=0).max())
    sides = (poles[0], poles[-1], poles[:, 0], poles[:, -1])
    singular = any(np.ptp(side, axis=0).max() < 1e-9 * size for side in sides)
    return _OFF_POLE if singular else 0.0
