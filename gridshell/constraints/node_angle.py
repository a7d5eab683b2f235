"""Node angle (eq. 4): the two diagonals of a control quad meet at a given angle."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from gridshell.arrays import Floats, Indices
from gridshell.solve import Evaluation, Pattern, columns_of


@dataclass(frozen=True, eq=False)
class NodeAngle:
    """``d1 . d2 / (|d1| |d2|) = cos(angle)`` with d1 = v2 - v0 and d2 = v3 - v1.

    Parameters
    ----------
    quads : (m, 4) control quads.
    angle : (m,) target angles, radians.
    lag_lengths : take the lengths from the previous step, as the paper suggests below eq. 4;
        otherwise the derivative is exact.
    """

    quads: Indices
    angle: Floats
    lag_lengths: bool = False

    def pattern(self) -> Pattern:
        """12 columns, one row."""
        return Pattern(columns_of(self.quads), 1)

    def lag(self, x: Floats) -> Floats | None:
        """(m, 2, 1) diagonal lengths when they are held still."""
        return _lengths(_diagonals(x, self.quads)) if self.lag_lengths else None

    def evaluate(self, x: Floats, lag: Floats | None) -> Evaluation:
        """Differences of cosines and their derivatives."""
        cosine, values = cosines(x, self.quads, lag)
        return Evaluation((cosine - np.cos(self.angle))[:, None], values[:, None])


def cosines(x: Floats, quads: Indices, lengths: Floats | None = None) -> tuple[Floats, Floats]:
    """(m,) cosines between the diagonals of *quads* (eq. 4), and (m, 12) their derivatives.

    Parameters
    ----------
    x : (3 n,) positions.
    lengths : (m, 2, 1) of the diagonals where they are held still.
    """
    d = _diagonals(x, quads)
    length = _lengths(d) if lengths is None else lengths
    d = d / length
    cosine = np.einsum("mc,mc->m", d[:, 0], d[:, 1])
    by_d = d[:, ::-1].copy()
    if lengths is None:
        by_d -= cosine[:, None, None] * d
    by_d /= length
    values = np.stack([-by_d[:, 0], -by_d[:, 1], by_d[:, 0], by_d[:, 1]], axis=1)
    return cosine, values.reshape(len(d), 12)


def _diagonals(x: Floats, quads: Indices) -> Floats:
    corners = x.reshape(-1, 3)[quads]
    return np.asarray(corners[:, 2:] - corners[:, :2])


def _lengths(diagonals: Floats) -> Floats:
    return np.asarray(np.maximum(np.linalg.norm(diagonals, axis=2, keepdims=True), 1e-12))
