"""The base of surfaces given by formula: exact oracles and starting shapes.

Parameters (u, v) are pure numbers that bisect the asymptotic lines: with asymptotic parameters
(p, q), u = (p + q) / 2 and v = (p - q) / 2, the lines p = u + v = const and q = u - v = const are
the asymptotic lines wherever the Gaussian curvature K is negative. In terms of the second
fundamental form L du^2 + 2 M du dv + N dv^2 this is L + N = 0 and M = 0.
"""

from __future__ import annotations

import math
from abc import ABC, abstractmethod
from functools import cached_property
from typing import TYPE_CHECKING, NamedTuple

import numpy as np
import numpy.typing as npt

from gridshell.arrays import Floats, Points, Vectors
from gridshell.errors import NotHyperbolicError, SettingError
from gridshell.surface import forms
from gridshell.surface.forms import Derivatives
from gridshell.surface.nearest import refine
from gridshell.surface.surface import Foot, checked_points

if TYPE_CHECKING:
    from scipy.spatial import cKDTree

Domain = tuple[tuple[float, float], tuple[float, float]]
"""((u_min, u_max), (v_min, v_max))."""

SEEDS = 97
"""Seeds for the closest point, per parameter."""

FLATTEST = -1e-9
"""K times the squared length scale must be below this to count as negative."""


class Limit(NamedTuple):
    """Where a formula holds: |values| < bound, else *reason*."""

    name: str
    values: Floats
    bound: float
    reason: str


class AnalyticSurface(ABC):
    """A surface x(u, v) with exact first and second derivatives, in mm.

    Every formula may be evaluated outside `domain`; only `check` says where it ends.
    """

    @property
    @abstractmethod
    def length_scale(self) -> float:
        """The length, mm, that makes K scale-free and tolerances relative."""

    @property
    @abstractmethod
    def domain(self) -> Domain:
        """The box of parameters the closest point is seeded from, inside what `check` accepts."""

    @abstractmethod
    def _derivatives(self, u: Floats, v: Floats) -> Derivatives:
        """Evaluate the closed form for parameters of one shape (...)."""

    def derivatives(self, u: npt.ArrayLike, v: npt.ArrayLike) -> Derivatives:
        """Return the point and its derivatives up to order two, each (..., 3), mm, unchecked."""
        return self._derivatives(*_pair(u, v))

    @property
    def period_u(self) -> float | None:
        """One full turn in u of a surface of revolution, None for others."""
        return None

    def point(self, u: npt.ArrayLike, v: npt.ArrayLike) -> Floats:
        """Return positions (..., 3), mm; raises SettingError as `check` does."""
        return self._checked(u, v).x

    def asymptotic_point(self, p: npt.ArrayLike, q: npt.ArrayLike) -> Floats:
        """Return positions (..., 3), mm, at asymptotic parameters; raises as `check` does."""
        p, q = _pair(p, q)
        return self.point((p + q) / 2.0, (p - q) / 2.0)

    def normal(self, u: npt.ArrayLike, v: npt.ArrayLike) -> Vectors:
        """Return unit normals (..., 3) along xu x xv; raises as `check` does."""
        return forms.unit_normal(self._checked(u, v))

    def curvatures(self, u: npt.ArrayLike, v: npt.ArrayLike) -> tuple[Floats, Floats]:
        """Return Gaussian K, 1/mm^2, and mean H, 1/mm, each (...); raises as `check` does."""
        return forms.gauss_and_mean(self._checked(u, v))

    def principal_curvatures(self, u: npt.ArrayLike, v: npt.ArrayLike) -> Floats:
        """Return kappa1 <= kappa2, (..., 2), 1/mm, signed by `normal`; raises as `check` does."""
        return forms.principal(self._checked(u, v))

    def check(self, u: npt.ArrayLike, v: npt.ArrayLike) -> None:
        """Refuse parameters that are not finite or where the formula is singular.

        Raises
        ------
        SettingError
            Naming the first such parameter, its index, value and limit.
        """
        for name, values, bound, reason in self._limits(*_pair(u, v)):
            bad = np.flatnonzero(~(np.abs(values) < bound))
            if len(bad):
                raise SettingError(
                    f"{type(self).__name__}: {reason}",
                    where=f"{name}, point {_index(int(bad[0]), values)}",
                    value=f"{values.flat[bad[0]]:.17g}",
                    limit=f"|{name}| < {bound:.17g}",
                    advice=f"shrink the range of {name}",
                )

    def require_hyperbolic(self, u: npt.ArrayLike, v: npt.ArrayLike) -> None:
        """Refuse parameters where the surface has no two asymptotic directions.

        The threshold is scale-free: K times the squared `length_scale` must be below -1e-9.

        Raises
        ------
        NotHyperbolicError
            Naming the point with the largest K.
        SettingError
            As `check` does.
        """
        u, v = _pair(u, v)
        d = self._checked(u, v)
        curvature = forms.gauss_and_mean(d)[0]
        flat = ~(curvature * self.length_scale**2 <= FLATTEST)
        if not flat.any():
            return
        worst = int(np.argmax(curvature))
        x, y, z = d.x.reshape(-1, 3)[worst]
        raise NotHyperbolicError(
            f"{type(self).__name__}: the Gaussian curvature K is not clearly negative, so there "
            "are no two asymptotic directions",
            where=f"point {_index(worst, curvature)}, (u, v) = ({u.flat[worst]:.6g}, "
            f"{v.flat[worst]:.6g}), position ({x:.6g}, {y:.6g}, {z:.6g}) mm",
            value=f"K = {curvature.flat[worst]:.6g} 1/mm^2",
            limit=f"K < {FLATTEST / self.length_scale**2:.3g} 1/mm^2",
            advice="keep the net where the surface is saddle-shaped, or choose another surface",
        )

    def closest(self, points: Points) -> Foot:
        """Find the feet of *points* (n, 3), mm: the nearest seed, then damped Newton iteration.

        The foot is the local minimum next to the nearest seed, hence the closest point wherever
        the offset is small against the radii of curvature.

        Raises
        ------
        InputError
            When *points* is not (n, 3) or not finite.
        """
        d = self.derivatives(*self._foot_parameters(checked_points(points)))
        return Foot(d.x, forms.unit_normal(d), forms.principal(d))

    def _checked(self, u: npt.ArrayLike, v: npt.ArrayLike) -> Derivatives:
        self.check(u, v)
        return self.derivatives(u, v)

    def _limits(self, u: Floats, v: Floats) -> tuple[Limit, ...]:
        """List the bounds of the formula; each surface adds its own to these."""
        reason = "a parameter is not finite"
        return Limit("u", u, math.inf, reason), Limit("v", v, math.inf, reason)

    def _confine(self, u: Floats, v: Floats) -> tuple[Floats, Floats]:
        """Bring parameters back inside `_limits`; most formulas hold everywhere."""
        return u, v

    def _foot_parameters(self, points: Points) -> tuple[Floats, Floats]:
        """Find the parameters (u, v), each (n,), of the feet of *points* (n, 3)."""
        u, v, tree = self._seeds
        nearest = tree.query(points)[1]
        return refine(
            self.derivatives,
            self._confine,
            (u[nearest], v[nearest]),
            points,
            length=self.length_scale,
        )

    @cached_property
    def _seeds(self) -> tuple[Floats, Floats, cKDTree]:
        """Parameters (u, v), each (n,), to start from and the tree of their points."""
        from scipy.spatial import cKDTree

        u, v = self._seed_parameters()
        return u, v, cKDTree(self.derivatives(u, v).x)

    def _seed_parameters(self) -> tuple[Floats, Floats]:
        """List the parameters (u, v), each (n,), to seed from: a grid over the domain."""
        return seed_grid(self.domain)


def seed_grid(box: Domain) -> tuple[Floats, Floats]:
    """List the parameters of a regular grid over *box*, each (SEEDS^2,)."""
    axes = (np.linspace(low, high, SEEDS) for low, high in box)
    first, second = np.meshgrid(*axes, indexing="ij")
    return first.ravel(), second.ravel()


def require_size(key: str, value: float) -> None:
    """Refuse a size that is not a positive, finite length.

    Raises
    ------
    SettingError
        Naming *key* and *value*, mm.
    """
    if not (math.isfinite(value) and value > 0.0):
        raise SettingError(
            "A size must be a positive, finite length",
            where=key,
            value=f"{value} mm",
            limit="> 0 mm",
            advice=f"give {key} in mm",
        )


def vectors(x: Floats, y: Floats, z: Floats) -> Floats:
    """Stack coordinates (...), broadcast against each other, to vectors (..., 3)."""
    return np.stack(np.broadcast_arrays(x, y, z), axis=-1)


def _pair(u: npt.ArrayLike, v: npt.ArrayLike) -> tuple[Floats, Floats]:
    """Broadcast both parameters to floats of one shape."""
    first, second = np.broadcast_arrays(np.asarray(u, np.float64), np.asarray(v, np.float64))
    return first, second


def _index(flat: int, values: Floats) -> str:
    """Write the index of an entry as an array of that shape would be subscripted."""
    if values.ndim < 2:
        return str(flat)
    return str(tuple(int(i) for i in np.unravel_index(flat, values.shape)))
