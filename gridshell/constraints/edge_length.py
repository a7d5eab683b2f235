"""Prescribed lengths: two vertices keep a given distance."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from gridshell.arrays import Floats, Indices
from gridshell.solve import Evaluation, Pattern, columns_of


@dataclass(frozen=True, eq=False)
class EdgeLength:
    """``|b - a| - length = 0``.

    Parameters
    ----------
    edges : (m, 2) vertex indices.
    length : (m,) in the units of the unknowns.
    """

    edges: Indices
    length: Floats

    def pattern(self) -> Pattern:
        """6 columns, one row."""
        return Pattern(columns_of(self.edges), 1)

    def lag(self, x: Floats) -> None:
        """Nothing is held still."""

    def evaluate(self, x: Floats, lag: None) -> Evaluation:
        """Differences of length and their exact derivatives."""
        a, b = x.reshape(-1, 3)[self.edges.T]
        found = np.maximum(np.linalg.norm(b - a, axis=1), 1e-12)
        along = (b - a) / found[:, None]
        values = np.concatenate([-along, along], axis=1)
        return Evaluation((found - self.length)[:, None], values[:, None, :])
