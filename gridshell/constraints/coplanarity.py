"""Signed distance of points from a plane spanned by themselves: the kernel of every planarity.

Every element has a few points X. With three fixed linear combinations p = P X, q = Q X and, per
row, w = W X, the residual is ``r = w . n`` with the unit vector n along p x q: no normal among the
unknowns. Its derivative is exact: with ``s = w - r n``,

    dr = dw . n + (dp . (q x s) + dq . (s x p)) / |p x q|.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from gridshell.arrays import Floats, Indices
from gridshell.solve import Evaluation, Pattern, columns_of


@dataclass(frozen=True, eq=False)
class Coplanarity:
    """Rows ``w . n = 0`` over elements of j points each.

    Parameters
    ----------
    points : (m, j) vertex indices.
    p, q : (j,) coefficients of the two spanning vectors.
    w : (rows, j) coefficients of the vectors that must lie in the plane.
    """

    points: Indices
    p: Floats
    q: Floats
    w: Floats

    def pattern(self) -> Pattern:
        """3 columns per point, one row per vector."""
        return Pattern(columns_of(self.points), len(self.w))

    def lag(self, x: Floats) -> None:
        """Nothing is held still."""

    def evaluate(self, x: Floats, lag: None) -> Evaluation:
        """Distances at unit mean edge and their exact derivatives."""
        corners = x.reshape(-1, 3)[self.points]
        p = np.einsum("j,mjc->mc", self.p, corners)
        q = np.einsum("j,mjc->mc", self.q, corners)
        w = np.einsum("rj,mjc->mrc", self.w, corners)
        normal = np.cross(p, q)
        area = np.maximum(np.linalg.norm(normal, axis=1), 1e-12)[:, None]
        normal /= area
        residual = np.einsum("mrc,mc->mr", w, normal)
        across = (w - residual[:, :, None] * normal[:, None, :]) / area[:, None, :]
        by_p = np.cross(q[:, None, :], across)
        by_q = np.cross(across, p[:, None, :])
        values = (
            self.p[:, None] * by_p[:, :, None, :]
            + self.q[:, None] * by_q[:, :, None, :]
            + self.w[:, :, None] * normal[:, None, None, :]
        )
        return Evaluation(residual, values.reshape(len(corners), len(self.w), 3 * len(self.p)))
