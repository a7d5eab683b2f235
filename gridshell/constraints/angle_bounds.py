"""Bounds of the node angle: the two diagonals of a control quad meet within a range of angles."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from gridshell.arrays import Floats, Indices
from gridshell.constraints.node_angle import cosines
from gridshell.solve import Evaluation, Pattern, columns_of


@dataclass(frozen=True, eq=False)
class AngleBounds:
    """``c - clip(c, cos(highest), cos(lowest)) = 0`` with the cosine c of eq. 4.

    Rows within the bounds are zero and keep their place in the pattern.

    Parameters
    ----------
    quads : (m, 4) control quads.
    lowest, highest : (m,) radians.
    """

    quads: Indices
    lowest: Floats
    highest: Floats

    def pattern(self) -> Pattern:
        """12 columns, one row."""
        return Pattern(columns_of(self.quads), 1)

    def lag(self, x: Floats) -> None:
        """Nothing is held still."""

    def evaluate(self, x: Floats, lag: None) -> Evaluation:
        """How far the cosines are outside, and the derivatives of those that are."""
        cosine, values = cosines(x, self.quads)
        outside = cosine - np.clip(cosine, np.cos(self.highest), np.cos(self.lowest))
        active = outside != 0.0
        return Evaluation(outside[:, None], (values * active[:, None])[:, None])
