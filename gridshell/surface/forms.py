"""First and second fundamental form of a parametrised surface, in an orthonormal tangent frame.

Source: M. P. do Carmo, Differential Geometry of Curves and Surfaces, sections 2-5, 3-2 and 3-3.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from gridshell.arrays import Floats, Vectors, unit


class Derivatives(NamedTuple):
    """A point of a surface and its derivatives in (u, v), each (..., 3), mm."""

    x: Floats
    xu: Floats
    xv: Floats
    xuu: Floats
    xuv: Floats
    xvv: Floats


def dot(a: Floats, b: Floats) -> Floats:
    """Return inner products (...) of vectors (..., 3)."""
    product: Floats = np.einsum("...i,...i->...", a, b)
    return product


class Frame(NamedTuple):
    """The frame e1 = xu / length, e2 = (xv - skew xu) / width, orthonormal in the tangent plane.

    All are (...); *length* and *width* in mm, *skew* without unit.
    """

    length: Floats
    skew: Floats
    width: Floats

    def covector(self, bu: Floats, bv: Floats) -> tuple[Floats, Floats]:
        """Return components on (e1, e2) of the linear form with components (bu, bv) on (xu, xv)."""
        return bu / self.length, (bv - self.skew * bu) / self.width

    def form(self, buu: Floats, buv: Floats, bvv: Floats) -> tuple[Floats, Floats, Floats]:
        """Return components (11, 12, 22) on (e1, e2) of a quadratic form given on (xu, xv)."""
        mixed = buv - self.skew * buu
        last = bvv - self.skew * (buv + mixed)
        return buu / self.length**2, mixed / (self.length * self.width), last / self.width**2

    def parameters(self, s1: Floats, s2: Floats) -> tuple[Floats, Floats]:
        """Return steps (du, dv) that move the point by s1 e1 + s2 e2 to first order."""
        dv = s2 / self.width
        return s1 / self.length - self.skew * dv, dv


def frame(d: Derivatives) -> Frame:
    """Build the orthonormal tangent frame; xu and xv must not be parallel."""
    skew = dot(d.xu, d.xv) / dot(d.xu, d.xu)
    across = d.xv - skew[..., None] * d.xu
    return Frame(np.sqrt(dot(d.xu, d.xu)), skew, np.sqrt(dot(across, across)))


def unit_normal(d: Derivatives) -> Vectors:
    """Return unit normals (..., 3) along xu x xv."""
    return unit(np.cross(unit(d.xu), unit(d.xv)))


def shape_operator(d: Derivatives) -> tuple[Floats, Floats, Floats]:
    """Return the symmetric shape operator (11, 12, 22) in the frame, each (...), 1/mm."""
    normal = unit_normal(d)
    return frame(d).form(dot(d.xuu, normal), dot(d.xuv, normal), dot(d.xvv, normal))


def gauss_and_mean(d: Derivatives) -> tuple[Floats, Floats]:
    """Return Gaussian curvature K, 1/mm^2, and mean curvature H = (kappa1 + kappa2) / 2, 1/mm."""
    a, b, c = shape_operator(d)
    return a * c - b * b, (a + c) / 2.0


def principal(d: Derivatives) -> Floats:
    """Return principal curvatures kappa1 <= kappa2, (..., 2), 1/mm.

    Taken from the shape operator instead of H -+ sqrt(H^2 - K), which loses half of the digits
    near umbilics.
    """
    a, b, c = shape_operator(d)
    mean, half = (a + c) / 2.0, np.hypot((a - c) / 2.0, b)
    return np.stack([mean - half, mean + half], axis=-1)
