"""Symmetry about a plane: vertices stay mirror images of each other, or on the plane."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from gridshell.arrays import Floats, Indices, Vectors
from gridshell.solve import Evaluation, Pattern, columns_of


@dataclass(frozen=True, eq=False)
class Symmetry:
    """``b = a - 2 ((a - origin) . normal) normal``; a vertex that is its own partner is on it.

    The residual is split along the normal and across it, so that both kinds have full rank: a pair
    gives three rows, and a vertex on the plane only the first (the others vanish).

    Parameters
    ----------
    pairs : (m, 2) vertex indices, each pair once; (i, i) for a vertex on the plane.
    origin, normal : of the plane, the normal of length one.
    """

    pairs: Indices
    origin: Floats
    normal: Vectors

    def pattern(self) -> Pattern:
        """6 columns, three rows."""
        return Pattern(columns_of(self.pairs), 3)

    def lag(self, x: Floats) -> None:
        """Nothing is held still."""

    def evaluate(self, x: Floats, lag: None) -> Evaluation:
        """Offsets from the mirror image, half of them along the normal, and their derivatives."""
        a, b = x.reshape(-1, 3)[self.pairs.T] - self.origin
        along = np.outer(self.normal, self.normal)
        across = np.eye(3) - along
        by_a = along / 2.0 - across
        by_b = along / 2.0 + across
        values = np.broadcast_to(np.concatenate([by_a, by_b], axis=1), (len(a), 3, 6))
        return Evaluation(a @ by_a.T + b @ by_b.T, values)
