"""Fairness: second differences along polylines (Pottmann et al. 2007).

With a target of zero the polylines straighten, and a net whose boundary is free drifts towards a
plane, where every condition holds trivially. With the start's own second differences as target it
is the *change* that stays fair: the net keeps its shape while its conditions are met.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from gridshell.arrays import Floats, Indices
from gridshell.solve import Evaluation, Pattern


@dataclass(frozen=True, eq=False)
class Fairness:
    """``a - 2 v + b = target`` for a vertex v and its neighbours a, b on a polyline.

    Parameters
    ----------
    triples : (m, 3) vertex indices (a, v, b).
    target : (m, 3) second differences to keep.
    """

    triples: Indices
    target: Floats

    def pattern(self) -> Pattern:
        """One element per triple and coordinate: 3 columns, one row."""
        columns = 3 * self.triples[:, None, :] + np.arange(3)[None, :, None]
        return Pattern(columns.reshape(-1, 3), 1)

    def lag(self, x: Floats) -> None:
        """Nothing is held still."""

    def evaluate(self, x: Floats, lag: None) -> Evaluation:
        """Second differences at unit mean edge and their constant derivatives."""
        residual = (second_differences(x, self.triples) - self.target).reshape(-1, 1)
        values = np.broadcast_to(np.array([1.0, -2.0, 1.0]), (len(residual), 1, 3))
        return Evaluation(residual, values)


def second_differences(x: Floats, triples: Indices) -> Floats:
    """``a - 2 v + b`` of every triple, (m, 3)."""
    a, v, b = (x.reshape(-1, 3)[column] for column in triples.T)
    return np.asarray(a - 2.0 * v + b)
