"""Closed forms of revolution about the z axis: catenoid, hyperboloid, torus, sphere."""

from __future__ import annotations

import math
from abc import abstractmethod
from dataclasses import dataclass
from typing import NamedTuple, final

import numpy as np

from gridshell.arrays import Floats, Points, Vectors
from gridshell.errors import SettingError
from gridshell.surface.analytic import AnalyticSurface, Domain, Limit, require_size, vectors
from gridshell.surface.forms import Derivatives, dot
from gridshell.surface.surface import Foot, checked_points


class Profile(NamedTuple):
    """Distance from the axis and height along a meridian, with derivatives in v; (...), mm."""

    r: Floats
    r1: Floats
    r2: Floats
    z: Floats
    z1: Floats
    z2: Floats


class RevolutionSurface(AnalyticSurface):
    """A surface of revolution about z; u is the angle of rotation in radians."""

    @property
    def period_u(self) -> float:
        """2 pi."""
        return 2.0 * math.pi

    @abstractmethod
    def _profile(self, v: Floats) -> Profile:
        """Evaluate the meridian at *v* (...)."""

    def _derivatives(self, u: Floats, v: Floats) -> Derivatives:
        m, cos, sin, none = self._profile(v), np.cos(u), np.sin(u), np.zeros_like(u)
        return Derivatives(
            vectors(m.r * cos, m.r * sin, m.z),
            vectors(-m.r * sin, m.r * cos, none),
            vectors(m.r1 * cos, m.r1 * sin, m.z1),
            vectors(-m.r * cos, -m.r * sin, none),
            vectors(-m.r1 * sin, m.r1 * cos, none),
            vectors(m.r2 * cos, m.r2 * sin, m.z2),
        )


@final
@dataclass(frozen=True)
class Catenoid(RevolutionSurface):
    """The catenoid radius (cosh v cos u, cosh v sin u, v), normals away from the axis.

    K = -1 / (radius^2 cosh^4 v). The domain |v| <= 3 is one full turn, ten times as wide at the
    ends as at the waist.

    Parameters
    ----------
    radius : of the waist circle, mm.

    Raises
    ------
    SettingError
        When *radius* is not a positive, finite length.
    """

    radius: float

    def __post_init__(self) -> None:
        require_size("radius", self.radius)

    @property
    def length_scale(self) -> float:
        """The waist radius, mm."""
        return self.radius

    @property
    def domain(self) -> Domain:
        """|u| <= pi, |v| <= 3."""
        return (-math.pi, math.pi), (-3.0, 3.0)

    def _limits(self, u: Floats, v: Floats) -> tuple[Limit, ...]:
        reason = "cosh v leaves the range of floating point"
        return (*super()._limits(u, v), Limit("v", v, 100.0, reason))

    def _profile(self, v: Floats) -> Profile:
        a, none = self.radius, np.zeros_like(v)
        cosh, sinh = a * np.cosh(v), a * np.sinh(v)
        return Profile(cosh, sinh, cosh, a * v, none + a, none)


@final
@dataclass(frozen=True)
class Hyperboloid(RevolutionSurface):
    """The hyperboloid of one sheet (x^2 + y^2) / radius^2 - z^2 / height^2 = 1.

    The point is (radius cos u / cos v, radius sin u / cos v, height tan v) for |v| < pi / 2;
    u + v = const and u - v = const are the straight rulings. K at the waist is -1 / height^2. The
    domain |v| <= 1.4 seeds |z| <= 5.8 height.

    Parameters
    ----------
    radius : of the waist circle, mm.
    height : above the waist, mm, at which the circle is sqrt(2) radius.

    Raises
    ------
    SettingError
        When either is not a positive, finite length.
    """

    radius: float
    height: float

    def __post_init__(self) -> None:
        require_size("radius", self.radius)
        require_size("height", self.height)

    @property
    def length_scale(self) -> float:
        """The height, mm."""
        return self.height

    @property
    def domain(self) -> Domain:
        """|u| <= pi, |v| <= 1.4."""
        return (-math.pi, math.pi), (-1.4, 1.4)

    def _limits(self, u: Floats, v: Floats) -> tuple[Limit, ...]:
        reason = "the rulings reach infinity at v = pi / 2"
        return (*super()._limits(u, v), Limit("v", v, math.pi / 2.0, reason))

    def _confine(self, u: Floats, v: Floats) -> tuple[Floats, Floats]:
        edge = math.pi / 2.0 - 1e-6
        return u, np.clip(v, -edge, edge)

    def _profile(self, v: Floats) -> Profile:
        sec, tan = 1.0 / np.cos(v), np.tan(v)
        r, h = self.radius * sec, self.height * sec**2
        return Profile(r, r * tan, r * (tan**2 + sec**2), self.height * tan, h, 2.0 * h * tan)


@final
@dataclass(frozen=True)
class Torus(RevolutionSurface):
    """The torus, parametrised on its inner half, where K < 0; normals out of the tube.

    The angle phi around the tube follows dphi/dv = sqrt(-(major + minor cos phi) cos phi / minor),
    which makes L + N = 0. From the inner equator phi = pi at v = 0 this integrates to

        tan((phi - pi) / 2) = k' sn(s) / dn(s),  s = v sqrt(major / (2 minor)),

    with Jacobi functions of parameter m = (major + minor) / (2 major) and k'^2 = 1 - m. The
    parabolic circles phi = pi -+ pi / 2, at the bottom and the top, are reached at
    |v| = sqrt(2 minor / major) K(m), where xv vanishes; the domain keeps to 95 % of that.
    K = cos phi / (minor (major + minor cos phi)). `closest` covers the whole torus.

    Parameters
    ----------
    major : radius of the circle of tube centres, mm.
    minor : radius of the tube, mm, less than *major*.

    Raises
    ------
    SettingError
        When either is not a positive, finite length, or *minor* is not below *major*.

    Notes
    -----
    Source: NIST Digital Library of Mathematical Functions, 22.15 (inverse functions as integrals).
    """

    major: float
    minor: float

    def __post_init__(self) -> None:
        require_size("major", self.major)
        require_size("minor", self.minor)
        if self.minor >= self.major:
            raise SettingError(
                "A torus cuts through itself when its tube is wider than its hole",
                where="minor",
                value=f"{self.minor} mm",
                limit=f"< major, {self.major} mm",
                advice="reduce minor or increase major",
            )

    @property
    def length_scale(self) -> float:
        """The geometric mean of both radii, mm; K is about -1 over its square."""
        return math.sqrt(self.major) * math.sqrt(self.minor)

    @property
    def domain(self) -> Domain:
        """|u| <= pi and |v| up to 95 % of the parabolic circles."""
        edge = 0.95 * self._parabolic
        return (-math.pi, math.pi), (-edge, edge)

    def closest(self, points: Points) -> Foot:
        """Find the feet of *points* (n, 3), mm, on the whole torus, in closed form.

        A point on the axis gets the foot in the half plane y = 0 < x among its equals, a point on
        the circle of tube centres the foot on the outer equator.

        Raises
        ------
        InputError
            When *points* is not (n, 3) or not finite.
        """
        targets = checked_points(points)
        flat = targets * (1.0, 1.0, 0.0)
        radial = _directions(flat, np.array([1.0, 0.0, 0.0]))
        centres = self.major * radial
        normals = _directions(targets - centres, radial)
        cos = dot(normals, radial)
        along = -cos / (self.major + self.minor * cos)
        around = np.full_like(along, -1.0 / self.minor)
        feet = centres + self.minor * normals
        return Foot(feet, normals, np.stack([around, along], axis=-1))

    @property
    def _parameter(self) -> tuple[float, float]:
        """Parameter m of the elliptic functions and 1 - m."""
        ratio = self.minor / self.major
        return (1.0 + ratio) / 2.0, (1.0 - ratio) / 2.0

    @property
    def _parabolic(self) -> float:
        """Bound of |v|, at the parabolic circles."""
        from scipy.special import ellipkm1

        return math.sqrt(2.0 * self.minor / self.major) * float(ellipkm1(self._parameter[1]))

    def _limits(self, u: Floats, v: Floats) -> tuple[Limit, ...]:
        reason = "the inner half ends at the parabolic circles"
        return (*super()._limits(u, v), Limit("v", v, self._parabolic, reason))

    def _profile(self, v: Floats) -> Profile:
        from scipy.special import ellipj

        (m, m1), r, ratio = self._parameter, self.minor, self.minor / self.major
        rate = math.sqrt(0.5 / ratio)
        sn, cn, dn, _ = ellipj(rate * v, m)
        full = dn * dn + m1 * sn * sn
        # psi = phi - pi, from tan(psi / 2) without cancellation at the parabolic circles
        cos, sin = cn * cn / full, 2.0 * math.sqrt(m1) * sn * dn / full
        psi1 = 2.0 * math.sqrt(m1) * rate * cn / full
        psi2 = sin * (cos - 0.5 / ratio)
        return Profile(
            self.major - r * cos,
            r * sin * psi1,
            r * (cos * psi1**2 + sin * psi2),
            -r * sin,
            -r * cos * psi1,
            r * (sin * psi1**2 - cos * psi2),
        )


@final
@dataclass(frozen=True)
class Sphere(RevolutionSurface):
    """The sphere in longitude u and latitude v, normals outwards.

    K = 1 / radius^2 > 0: there are no asymptotic lines, u + v = const and u - v = const have no
    geometric meaning, and `require_hyperbolic` always raises. The domain stops 0.07 rad short of
    the poles, where the formula is singular; `closest` covers the whole sphere.

    Parameters
    ----------
    radius : mm.

    Raises
    ------
    SettingError
        When *radius* is not a positive, finite length.
    """

    radius: float

    def __post_init__(self) -> None:
        require_size("radius", self.radius)

    @property
    def length_scale(self) -> float:
        """The radius, mm."""
        return self.radius

    @property
    def domain(self) -> Domain:
        """|u| <= pi, |v| <= 1.5."""
        return (-math.pi, math.pi), (-1.5, 1.5)

    def closest(self, points: Points) -> Foot:
        """Find the feet of *points* (n, 3), mm, in closed form; the centre gets the north pole.

        Raises
        ------
        InputError
            When *points* is not (n, 3) or not finite.
        """
        normals = _directions(checked_points(points), np.array([0.0, 0.0, 1.0]))
        curvature = np.full((len(normals), 2), -1.0 / self.radius)
        return Foot(self.radius * normals, normals, curvature)

    def _limits(self, u: Floats, v: Floats) -> tuple[Limit, ...]:
        reason = "longitude has no meaning at a pole"
        return (*super()._limits(u, v), Limit("v", v, math.pi / 2.0, reason))

    def _profile(self, v: Floats) -> Profile:
        cos, sin = self.radius * np.cos(v), self.radius * np.sin(v)
        return Profile(cos, -sin, -cos, sin, cos, -sin)


def _directions(rows: Vectors, otherwise: Vectors) -> Vectors:
    """Scale rows (n, 3) to length one, a zero row replaced by *otherwise*, (3,) or (n, 3)."""
    length = np.linalg.norm(rows, axis=-1, keepdims=True)
    directions: Vectors = np.where(
        length > 0.0, rows / np.where(length > 0.0, length, 1.0), otherwise
    )
    return directions
