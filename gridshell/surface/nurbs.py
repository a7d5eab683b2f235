"""B-spline and NURBS curves and surfaces, evaluated for many parameters at once.

Basis functions and their derivatives by the recurrences of L. Piegl and W. Tiller, The NURBS Book,
2nd edition, eqs. 2.5 and 2.9; rational derivatives by the quotient rule, eqs. 4.8 and 4.20.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from gridshell.arrays import Floats, Indices, frozen
from gridshell.errors import SurfaceError
from gridshell.surface.forms import Derivatives

_BLOCK = 20_000
"""Parameters evaluated together: bounds the memory."""


@dataclass(frozen=True, eq=False)
class NurbsCurve:
    """A curve of any dimension d over the parameter range of its knots.

    Parameters
    ----------
    knots : (n + degree + 1,) not decreasing.
    poles : (n, d) control points.
    weights : (n,) positive.

    Raises
    ------
    SurfaceError
        When the three do not belong together.
    """

    knots: Floats
    poles: Floats
    weights: Floats

    def __post_init__(self) -> None:
        for key in ("knots", "poles", "weights"):
            object.__setattr__(self, key, frozen(getattr(self, key)))
        _check(self.poles.shape[:1], (self.knots,), self.weights)

    @property
    def degree(self) -> int:
        """Polynomial degree."""
        return len(self.knots) - len(self.poles) - 1

    def derivatives(self, t: Floats) -> tuple[Floats, Floats, Floats]:
        """Return the points (n, d) at *t* (n,) and the first and second derivatives in t."""
        first, basis = basis_functions(self.knots, self.degree, t)
        window = first[:, None] + np.arange(self.degree + 1)
        weighted = np.concatenate(
            [self.poles * self.weights[:, None], self.weights[:, None]], axis=1
        )
        a, b, c = np.einsum("kna,nad->knd", basis, weighted[window])
        w, w1, w2 = a[:, -1:], b[:, -1:], c[:, -1:]
        x = a[:, :-1] / w
        x1 = (b[:, :-1] - w1 * x) / w
        return x, x1, (c[:, :-1] - 2.0 * w1 * x1 - w2 * x) / w

    def point(self, t: Floats) -> Floats:
        """Return the points (n, d) at *t* (n,)."""
        return self.derivatives(t)[0]


@dataclass(frozen=True, eq=False)
class NurbsPatch:
    """A tensor-product surface over the unit square: knots run from 0 to 1 in u and v.

    Parameters
    ----------
    knots_u, knots_v : (n + degree + 1,) and (m + degree + 1,), clamped, not decreasing.
    poles : (n, m, 3) control points, mm.
    weights : (n, m) positive.
    closed : whether u and v may be taken modulo 1.

    Raises
    ------
    SurfaceError
        When the arrays do not belong together.
    """

    knots_u: Floats
    knots_v: Floats
    poles: Floats
    weights: Floats
    closed: tuple[bool, bool] = (False, False)

    def __post_init__(self) -> None:
        for key in ("knots_u", "knots_v", "poles", "weights"):
            object.__setattr__(self, key, frozen(getattr(self, key)))
        _check(self.poles.shape[:2], (self.knots_u, self.knots_v), self.weights)

    @property
    def degrees(self) -> tuple[int, int]:
        """Polynomial degrees in u and v."""
        n, m = self.weights.shape
        return len(self.knots_u) - n - 1, len(self.knots_v) - m - 1

    def derivatives(self, u: Floats, v: Floats) -> Derivatives:
        """Return the points and derivatives up to order two, each (n, 3), mm, at u, v (n,)."""
        u, v = np.asarray(u, dtype=np.float64), np.asarray(v, dtype=np.float64)
        starts = range(0, max(len(u), 1), _BLOCK)
        blocks = [self._block(u[i : i + _BLOCK], v[i : i + _BLOCK]) for i in starts]
        return Derivatives(*(np.concatenate(parts) for parts in zip(*blocks, strict=True)))

    def confine(self, u: Floats, v: Floats) -> tuple[Floats, Floats]:
        """Bring parameters into the unit square, except along a closed direction."""
        return (
            u if self.closed[0] else np.clip(u, 0.0, 1.0),
            v if self.closed[1] else np.clip(v, 0.0, 1.0),
        )

    def _block(self, u: Floats, v: Floats) -> Derivatives:
        u = _wrapped(u) if self.closed[0] else u
        v = _wrapped(v) if self.closed[1] else v
        p, q = self.degrees
        first_u, basis_u = basis_functions(self.knots_u, p, u)
        first_v, basis_v = basis_functions(self.knots_v, q, v)
        rows = first_u[:, None] + np.arange(p + 1)
        columns = first_v[:, None] + np.arange(q + 1)
        window = self._weighted[rows[:, :, None], columns[:, None, :]]
        half = np.einsum("kna,nabd->knbd", basis_u, window, optimize=True)
        a = np.einsum("nb,nbd->nd", basis_v[0], half[0])
        au = np.einsum("nb,nbd->nd", basis_v[0], half[1])
        av = np.einsum("nb,nbd->nd", basis_v[1], half[0])
        auu = np.einsum("nb,nbd->nd", basis_v[0], half[2])
        auv = np.einsum("nb,nbd->nd", basis_v[1], half[1])
        avv = np.einsum("nb,nbd->nd", basis_v[2], half[0])
        w, wu, wv = a[:, 3:], au[:, 3:], av[:, 3:]
        x = a[:, :3] / w
        xu = (au[:, :3] - wu * x) / w
        xv = (av[:, :3] - wv * x) / w
        xuu = (auu[:, :3] - 2.0 * wu * xu - auu[:, 3:] * x) / w
        xuv = (auv[:, :3] - wu * xv - wv * xu - auv[:, 3:] * x) / w
        xvv = (avv[:, :3] - 2.0 * wv * xv - avv[:, 3:] * x) / w
        return Derivatives(x, xu, xv, xuu, xuv, xvv)

    @property
    def _weighted(self) -> Floats:
        w = self.weights[..., None]
        return np.concatenate([self.poles * w, w], axis=2)


def basis_functions(knots: Floats, degree: int, t: Floats) -> tuple[Indices, Floats]:
    """Evaluate the basis functions that do not vanish at *t* (n,).

    Outside the knots the first or last polynomial piece goes on.

    Returns
    -------
    The index (n,) of the first of them and their values, first and second derivatives
    (3, n, degree + 1).
    """
    count = len(knots) - degree - 1
    span = np.searchsorted(knots, t, side="right") - 1
    inner = np.flatnonzero(np.diff(knots[degree : count + 1]) > 0.0) + degree
    span = inner[np.clip(np.searchsorted(inner, span, side="right") - 1, 0, len(inner) - 1)]
    value = np.ones((len(t), 1))
    first, second = np.zeros_like(value), np.zeros_like(value)
    for p in range(1, degree + 1):
        i = span[:, None] - p + np.arange(p + 1)
        left, right = _inverse(knots[i + p] - knots[i]), knots[i + p + 1]
        right_inverse = _inverse(right - knots[i + 1])
        low, high = _shifted(value)
        d_low, d_high = _shifted(first)
        second = p * (d_low * left - d_high * right_inverse)
        first = p * (low * left - high * right_inverse)
        value = (t[:, None] - knots[i]) * left * low + (right - t[:, None]) * right_inverse * high
    return span - degree, np.stack([value, first, second])


def _shifted(values: Floats) -> tuple[Floats, Floats]:
    """Values (n, p) of the functions i and i + 1 for i over one more function."""
    padded = np.pad(values, ((0, 0), (1, 1)))
    return padded[:, :-1], padded[:, 1:]


def _inverse(values: Floats) -> Floats:
    """1 / values, 0 where a knot is repeated (0/0 counts as 0 in the recurrence)."""
    return np.where(values > 0.0, 1.0 / np.where(values > 0.0, values, 1.0), 0.0)


def _wrapped(t: Floats) -> Floats:
    """*t* modulo 1, keeping 1 itself."""
    return np.where((t >= 0.0) & (t <= 1.0), t, t - np.floor(t))


def _check(counts: tuple[int, ...], knots: tuple[Floats, ...], weights: Floats) -> None:
    degrees = [len(k) - n - 1 for k, n in zip(knots, counts, strict=True)]
    if weights.shape != counts or min(degrees) < 1 or not (weights > 0.0).all():
        raise SurfaceError(
            "Knots, poles and weights do not belong together",
            value=f"poles {counts}, knots {[len(k) for k in knots]}, weights {weights.shape}",
            limit="knots = poles + degree + 1, degree >= 1, positive weights",
        )
