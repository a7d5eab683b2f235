"""Unit normals: the second sum of eqs. 6 and 7, ``n . n = 1``."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from gridshell.arrays import Floats, Indices
from gridshell.solve import Evaluation, Pattern, columns_of


@dataclass(frozen=True, eq=False)
class UnitNormal:
    """Normals stored as points have length one.

    Parameters
    ----------
    points : (m,) their point indices.
    """

    points: Indices

    def pattern(self) -> Pattern:
        """3 columns, one row."""
        return Pattern(columns_of(self.points[:, None]), 1)

    def lag(self, x: Floats) -> None:
        """Nothing is held still."""

    def evaluate(self, x: Floats, lag: None) -> Evaluation:
        """``n . n - 1`` and its derivative 2 n."""
        normal = x.reshape(-1, 3)[self.points]
        residual = np.einsum("mc,mc->m", normal, normal) - 1.0
        return Evaluation(residual[:, None], 2.0 * normal[:, None, :])
