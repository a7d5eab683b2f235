"""Spherical vertex stars: a vertex and its four neighbours lie on a sphere.

The discrete principal symmetric nets of the paper's remark (after Schling et al. 2018): the normal
curvatures of both families agree. With spokes d_k from the vertex, a sphere through it satisfies
``|d_k|^2 = 2 d_k . c``, so the five points lie on one sphere (or plane) exactly when

    det [ d_k , |d_k|^2 ] = 0   (k = 0 .. 3).
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from gridshell.arrays import Floats, Indices
from gridshell.mesh import Stars
from gridshell.solve import Evaluation, Pattern, columns_of

_OTHERS = np.array([[1, 2, 3], [0, 2, 3], [0, 1, 3], [0, 1, 2]])
_SIGNS = np.array([-1.0, 1.0, -1.0, 1.0])


@dataclass(frozen=True, eq=False)
class SphericalStar:
    """The determinant over the star's own size, lagged: about twice the offset from the sphere.

    Parameters
    ----------
    points : (m, 5) indices of v, b0 .. b3.
    """

    points: Indices

    def pattern(self) -> Pattern:
        """15 columns, one row."""
        return Pattern(columns_of(self.points), 1)

    def lag(self, x: Floats) -> Floats:
        """(m,) area times squared spoke of every star, the size of the determinant's minors."""
        d = _spokes(x, self.points)
        area = np.linalg.norm(np.cross(d[:, 2] - d[:, 0], d[:, 3] - d[:, 1]), axis=1)
        square = np.einsum("mkc,mkc->mk", d, d).mean(axis=1)
        return np.asarray(np.maximum(area * square, 1e-24) / 2.0)

    def evaluate(self, x: Floats, lag: Floats) -> Evaluation:
        """Scaled determinants and their derivatives."""
        d = _spokes(x, self.points)
        square = np.einsum("mkc,mkc->mk", d, d)
        a, b, c = (d[:, _OTHERS[:, i]] for i in range(3))
        minors = np.einsum("mkc,mkc->mk", a, np.cross(b, c)) * _SIGNS
        by_square = minors[:, :, None] * 2.0 * d
        rising = _SIGNS * square
        # d(minor)/d(spoke): the cross product of the other two in the minor's row
        pulls = np.stack([np.cross(b, c), np.cross(c, a), np.cross(a, b)], axis=2)
        by_spoke = by_square
        for k, others in enumerate(_OTHERS):
            for place, spoke in enumerate(others):
                by_spoke[:, spoke] += rising[:, k, None] * pulls[:, k, place]
        by_spoke = by_spoke / lag[:, None, None]
        residual = np.einsum("mk,mk->m", minors, square) / lag
        values = np.concatenate([-by_spoke.sum(axis=1, keepdims=True), by_spoke], axis=1)
        return Evaluation(residual[:, None], values.reshape(len(d), 1, 15))


def spherical_stars(stars: Stars) -> SphericalStar:
    """Every star of four spokes."""
    centre = stars.regular()
    return SphericalStar(np.column_stack([centre, stars.spokes[centre, :4]]))


def _spokes(x: Floats, points: Indices) -> Floats:
    corners = x.reshape(-1, 3)[points]
    return np.asarray(corners[:, 1:] - corners[:, :1])
