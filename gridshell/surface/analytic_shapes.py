"""Closed forms without an axis of revolution: Enneper, helicoid, hyperbolic paraboloid, Scherk."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import final

import numpy as np

from gridshell.arrays import Floats, Points
from gridshell.surface.analytic import (
    AnalyticSurface,
    Domain,
    Limit,
    require_size,
    seed_grid,
    vectors,
)
from gridshell.surface.forms import Derivatives


@final
@dataclass(frozen=True)
class Enneper(AnalyticSurface):
    """Enneper's minimal surface in its curvature-line parameters.

    K = -4 / (scale^2 (1 + u^2 + v^2)^4). Embedded for u^2 + v^2 < 3; the domain is the largest
    round box (|u|, |v| <= 1.2) inside that circle, beyond it the surface cuts through itself.

    Parameters
    ----------
    scale : mm; the principal radii at the centre are scale / 2.

    Raises
    ------
    SettingError
        When *scale* is not a positive, finite length.
    """

    scale: float

    def __post_init__(self) -> None:
        require_size("scale", self.scale)

    @property
    def length_scale(self) -> float:
        """The scale, mm."""
        return self.scale

    @property
    def domain(self) -> Domain:
        """|u|, |v| <= 1.2."""
        return (-1.2, 1.2), (-1.2, 1.2)

    def _derivatives(self, u: Floats, v: Floats) -> Derivatives:
        s, uu, vv, uv2 = self.scale, u * u, v * v, 2.0 * u * v
        two, none = np.full_like(u, 2.0), np.zeros_like(u)
        return Derivatives(
            s * vectors(u - u * uu / 3.0 + u * vv, v * vv / 3.0 - v - v * uu, uu - vv),
            s * vectors(1.0 - uu + vv, -uv2, 2.0 * u),
            s * vectors(uv2, vv - uu - 1.0, -2.0 * v),
            s * vectors(-2.0 * u, -2.0 * v, two),
            s * vectors(2.0 * v, -2.0 * u, none),
            s * vectors(2.0 * u, 2.0 * v, -two),
        )


@final
@dataclass(frozen=True)
class Helicoid(AnalyticSurface):
    """The helicoid in asymptotic parameters p along the rulings and q around the axis.

    With c = pitch / (2 pi) the point is c (sinh p cos q, sinh p sin q, q): q = u - v = const are
    the rulings, p = u + v = const the helices. (p, q) are isothermal, the helicoid being the
    conjugate of the catenoid, and K = -1 / (c^2 cosh^4 p). The domain |u|, |v| <= 2.5 keeps |p| and
    |q| to 5; the closest point is sought from |p| <= 3, ten times c, on the turns near the height
    of the point, since the surface is invariant under screwing.

    Parameters
    ----------
    pitch : rise per full turn, mm.

    Raises
    ------
    SettingError
        When *pitch* is not a positive, finite length.
    """

    pitch: float

    def __post_init__(self) -> None:
        require_size("pitch", self.pitch)

    @property
    def length_scale(self) -> float:
        """Rise per radian, mm."""
        return self.pitch / (2.0 * math.pi)

    @property
    def domain(self) -> Domain:
        """|u|, |v| <= 2.5."""
        return (-2.5, 2.5), (-2.5, 2.5)

    def _limits(self, u: Floats, v: Floats) -> tuple[Limit, ...]:
        reason = "sinh p leaves the range of floating point"
        return (*super()._limits(u, v), Limit("u + v", u + v, 100.0, reason))

    def _derivatives(self, u: Floats, v: Floats) -> Derivatives:
        p, q = u + v, u - v
        sinh, cosh, cos, sin = np.sinh(p), np.cosh(p), np.cos(q), np.sin(q)
        one, none = np.ones_like(p), np.zeros_like(p)
        return _from_asymptotic(
            self.length_scale,
            vectors(sinh * cos, sinh * sin, q),
            vectors(cosh * cos, cosh * sin, none),
            vectors(-sinh * sin, sinh * cos, one),
            vectors(sinh * cos, sinh * sin, none),
            vectors(-cosh * sin, cosh * cos, none),
            vectors(-sinh * cos, -sinh * sin, none),
        )

    def _seed_parameters(self) -> tuple[Floats, Floats]:
        p, q = seed_grid(((-3.0, 3.0), (-1.5 * math.pi, 1.5 * math.pi)))
        return (p + q) / 2.0, (p - q) / 2.0

    def _foot_parameters(self, points: Points) -> tuple[Floats, Floats]:
        turns = np.round(points[:, 2] / self.pitch)
        u, v = super()._foot_parameters(points - np.outer(turns, (0.0, 0.0, self.pitch)))
        return u + math.pi * turns, v - math.pi * turns


@final
@dataclass(frozen=True)
class Hypar(AnalyticSurface):
    """The hyperbolic paraboloid z = x y / scale in p = x / scale and q = y / scale.

    All asymptotic lines are straight. K = -1 / (scale^2 (1 + p^2 + q^2)^2). Regular everywhere;
    the domain |u|, |v| <= 2 seeds |x| + |y| <= 4 scale.

    Parameters
    ----------
    scale : mm; z = scale where x = y = scale.

    Raises
    ------
    SettingError
        When *scale* is not a positive, finite length.
    """

    scale: float

    def __post_init__(self) -> None:
        require_size("scale", self.scale)

    @property
    def length_scale(self) -> float:
        """The scale, mm."""
        return self.scale

    @property
    def domain(self) -> Domain:
        """|u|, |v| <= 2."""
        return (-2.0, 2.0), (-2.0, 2.0)

    def _derivatives(self, u: Floats, v: Floats) -> Derivatives:
        p, q = u + v, u - v
        one, none = np.ones_like(p), np.zeros_like(p)
        straight = vectors(none, none, none)
        return _from_asymptotic(
            self.scale,
            vectors(p, q, p * q),
            vectors(one, none, q),
            vectors(none, one, p),
            straight,
            vectors(none, none, one),
            straight,
        )


@final
@dataclass(frozen=True)
class Scherk(AnalyticSurface):
    """Scherk's doubly periodic minimal surface z = scale log(cos(y / scale) / cos(x / scale)).

    x = scale gd(u) and y = scale gd(v) with the Gudermannian gd(t) = 2 atan(tanh(t / 2)), so that
    z = scale (log cosh u - log cosh v). The tile |x|, |y| < pi / 2 scale is reached for infinite
    (u, v) only; beyond 18 the distance to its vertical edge is lost in rounding. The domain
    |u|, |v| <= 3 covers 94 % of the tile's sides. A point beyond the vertical line over a corner of
    the tile gets its foot on that line.

    Parameters
    ----------
    scale : mm; the tile is pi scale wide.

    Raises
    ------
    SettingError
        When *scale* is not a positive, finite length.
    """

    scale: float

    def __post_init__(self) -> None:
        require_size("scale", self.scale)

    @property
    def length_scale(self) -> float:
        """The scale, mm."""
        return self.scale

    @property
    def domain(self) -> Domain:
        """|u|, |v| <= 3."""
        return (-3.0, 3.0), (-3.0, 3.0)

    def _limits(self, u: Floats, v: Floats) -> tuple[Limit, ...]:
        reason = "{} reaches the vertical edge of the tile at pi / 2 scale"
        return (
            *super()._limits(u, v),
            Limit("u", u, _SCHERK_EDGE, reason.format("x")),
            Limit("v", v, _SCHERK_EDGE, reason.format("y")),
        )

    def _confine(self, u: Floats, v: Floats) -> tuple[Floats, Floats]:
        edge, a, b = _SCHERK_EDGE - 1e-6, np.abs(u), np.abs(v)
        # over a corner of the tile both shrink alike, which keeps the height
        corner = np.minimum(a, b) > edge / 2.0
        excess = np.where(corner, np.maximum(np.maximum(a, b) - edge, 0.0), 0.0)
        a, b = np.minimum(a - excess, edge), np.minimum(b - excess, edge)
        return np.copysign(a, u), np.copysign(b, v)

    def _derivatives(self, u: Floats, v: Floats) -> Derivatives:
        s, none = self.scale, np.zeros_like(u)
        (su, tu), (sv, tv) = ((1.0 / np.cosh(t), np.tanh(t)) for t in (u, v))
        height = np.logaddexp(u, -u) - np.logaddexp(v, -v)
        return Derivatives(
            s * vectors(_gudermannian(u), _gudermannian(v), height),
            s * vectors(su, none, tu),
            s * vectors(none, sv, -tv),
            s * vectors(-su * tu, none, su * su),
            s * vectors(none, none, none),
            s * vectors(none, -sv * tv, -sv * sv),
        )


_SCHERK_EDGE = 18.0


def _gudermannian(t: Floats) -> Floats:
    return 2.0 * np.arctan(np.tanh(t / 2.0))


def _from_asymptotic(
    scale: float, x: Floats, xp: Floats, xq: Floats, xpp: Floats, xpq: Floats, xqq: Floats
) -> Derivatives:
    """Convert derivatives in p = u + v and q = u - v to u and v, times *scale*."""
    return Derivatives(
        scale * x,
        scale * (xp + xq),
        scale * (xp - xq),
        scale * (xpp + 2.0 * xpq + xqq),
        scale * (xpp - xqq),
        scale * (xpp - 2.0 * xpq + xqq),
    )
