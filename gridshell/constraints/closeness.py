"""Closeness: vertices stay near where they started."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from gridshell.arrays import Floats
from gridshell.solve import Evaluation, Pattern


@dataclass(frozen=True, eq=False)
class Closeness:
    """``x - start = 0``.

    Parameters
    ----------
    start : (k,) starting values of the first k unknowns.
    """

    start: Floats

    def pattern(self) -> Pattern:
        """One column, one row."""
        return Pattern(np.arange(len(self.start))[:, None], 1)

    def lag(self, x: Floats) -> None:
        """Nothing is held still."""

    def evaluate(self, x: Floats, lag: None) -> Evaluation:
        """Moves at unit mean edge."""
        move = x[: len(self.start)] - self.start
        return Evaluation(move[:, None], np.ones((len(move), 1, 1)))
