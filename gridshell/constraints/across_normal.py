"""The paper's own planarity (eqs. 6 and 7): vectors across a normal that is itself an unknown."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from gridshell.arrays import Floats, Indices
from gridshell.mesh import Stars
from gridshell.solve import Evaluation, Pattern, columns_of


@dataclass(frozen=True, eq=False)
class AcrossNormal:
    """``n . w = 0`` for vectors w that are fixed combinations of points.

    Parameters
    ----------
    points : (m, j + 1) point indices; the last one is the normal, which is stored as a point.
    w : (rows, j) coefficients of the vectors.
    """

    points: Indices
    w: Floats

    def pattern(self) -> Pattern:
        """3 columns per point, one row per vector."""
        return Pattern(columns_of(self.points), len(self.w))

    def lag(self, x: Floats) -> None:
        """Nothing is held still."""

    def evaluate(self, x: Floats, lag: None) -> Evaluation:
        """Products at unit mean edge and their exact derivatives."""
        corners = x.reshape(-1, 3)[self.points]
        normal = corners[:, -1]
        vectors = np.einsum("rj,mjc->mrc", self.w, corners[:, :-1])
        by_points = self.w[None, :, :, None] * normal[:, None, None, :]
        values = np.concatenate([by_points, vectors[:, :, None, :]], axis=2)
        return Evaluation(
            np.einsum("mrc,mc->mr", vectors, normal),
            values.reshape(len(corners), len(self.w), 3 * self.points.shape[1]),
        )


def stars_across_normals(diagonal_stars: Stars, first_normal: int) -> AcrossNormal:
    """Eq. 7 as printed: spokes ``b_j - v`` of every regular star across the normal of v."""
    centre = diagonal_stars.regular()
    points = np.column_stack([centre, diagonal_stars.spokes[centre, :4], first_normal + centre])
    return AcrossNormal(points, np.column_stack([-np.ones(4), np.eye(4)]))


def white_quads_across_normals(edge_stars: Stars, first_normal: int) -> AcrossNormal:
    """Eq. 6 as printed: edges ``a_j - a_(j+1)`` of every regular white quad across its normal."""
    centre = np.flatnonzero(edge_stars.closed & (edge_stars.count == 4))
    points = np.column_stack([edge_stars.spokes[centre, :4], first_normal + centre])
    return AcrossNormal(points, np.eye(4) - np.roll(np.eye(4), 1, axis=1))
