"""A node angle that depends on where the node lies: eq. 4 with a field in place of a constant."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from gridshell.arrays import Floats, Indices, Points
from gridshell.constraints.node_angle import cosines
from gridshell.solve import Evaluation, Pattern, columns_of

_STEP = 1e-5
"""Of the central differences of the field, in mean edges."""


@dataclass(frozen=True, eq=False)
class FieldAngle:
    """``d1 . d2 / (|d1| |d2|) = cos(wanted(m))`` with m the mean of the four corners.

    The field moves with the net: what it says where the net ends is met, not what it said where
    the net began.

    Parameters
    ----------
    quads : (m, 4) control quads.
    wanted : from positions (k, 3) in the units of the unknowns to angles (k,), radians.
    """

    quads: Indices
    wanted: Callable[[Points], Floats]

    def pattern(self) -> Pattern:
        """12 columns, one row."""
        return Pattern(columns_of(self.quads), 1)

    def lag(self, x: Floats) -> None:
        """Nothing is held still."""

    def evaluate(self, x: Floats, lag: None) -> Evaluation:
        """Differences of cosines; the field's gradient by central differences."""
        cosine, values = cosines(x, self.quads)
        middle = x.reshape(-1, 3)[self.quads].mean(axis=1)
        step = _STEP * np.eye(3)
        places = np.concatenate([middle, *(middle + s for s in step), *(middle - s for s in step)])
        angle = self.wanted(places).reshape(7, -1)
        gradient = (angle[1:4] - angle[4:]).T / (2.0 * _STEP)
        by_middle = np.sin(angle[0])[:, None] * gradient / 4.0
        residual = cosine - np.cos(angle[0])
        return Evaluation(residual[:, None], (values + np.tile(by_middle, 4))[:, None])
