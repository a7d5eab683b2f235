"""Equal diagonals (eq. 5): the black parallelogram of a control quad is a rhombus."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from gridshell.arrays import Floats, Indices
from gridshell.solve import Evaluation, Pattern, columns_of


@dataclass(frozen=True, eq=False)
class EqualDiagonals:
    """``(|d1|^2 - |d2|^2) / (|d1|^2 + |d2|^2) = 0`` with d1 = v2 - v0 and d2 = v3 - v1.

    The paper's ``|d1|^2 - |d2|^2`` falls when a quad shrinks; the quotient only when it becomes a
    rhombus, and near zero it is the difference of the lengths over their mean.

    Parameters
    ----------
    quads : (m, 4) control quads.
    as_printed : eq. 5 without the denominator, at unit mean edge.
    """

    quads: Indices
    as_printed: bool = False

    def pattern(self) -> Pattern:
        """12 columns, one row."""
        return Pattern(columns_of(self.quads), 1)

    def lag(self, x: Floats) -> None:
        """Nothing is held still."""

    def evaluate(self, x: Floats, lag: None) -> Evaluation:
        """Differences of squares and their exact derivatives."""
        corners = x.reshape(-1, 3)[self.quads]
        d = corners[:, 2:] - corners[:, :2]
        first, second = np.moveaxis(np.einsum("mkc,mkc->mk", d, d), 1, 0)
        total = np.ones_like(first) if self.as_printed else np.maximum(first + second, 1e-24)
        residual = (first - second) / total
        drift = np.zeros_like(residual) if self.as_printed else residual
        by_first = (2.0 * (1.0 - drift) / total)[:, None] * d[:, 0]
        by_second = (-2.0 * (1.0 + drift) / total)[:, None] * d[:, 1]
        values = np.stack([-by_first, -by_second, by_first, by_second], axis=1)
        return Evaluation(residual[:, None], values.reshape(len(corners), 1, 12))
