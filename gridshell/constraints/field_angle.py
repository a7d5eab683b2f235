"""A node angle that depends on where the node lies: eq. 4 with a field in place of a constant."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field

import numpy as np

from gridshell.arrays import Floats, Indices, Points
from gridshell.constraints.node_angle import NodeAngle
from gridshell.solve import Evaluation, Pattern

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
    _right: NodeAngle = field(init=False, repr=False)

    def __post_init__(self) -> None:
        right = np.full(len(self.quads), np.pi / 2.0)
        object.__setattr__(self, "_right", NodeAngle(self.quads, right))

    def pattern(self) -> Pattern:
        """12 columns, one row."""
        return self._right.pattern()

    def lag(self, x: Floats) -> None:
        """Nothing is held still."""

    def evaluate(self, x: Floats, lag: None) -> Evaluation:
        """Differences of cosines; the field's gradient by central differences."""
        found = self._right.evaluate(x, None)
        middle = x.reshape(-1, 3)[self.quads].mean(axis=1)
        step = _STEP * np.eye(3)
        places = np.concatenate([middle, *(middle + s for s in step), *(middle - s for s in step)])
        angle = self.wanted(places).reshape(7, -1)
        gradient = (angle[1:4] - angle[4:]).T / (2.0 * _STEP)
        by_middle = np.sin(angle[0])[:, None] * gradient / 4.0
        residual = found.residual[:, 0] + np.cos(np.pi / 2.0) - np.cos(angle[0])
        return Evaluation(residual[:, None], found.values + np.tile(by_middle, 4)[:, None])
