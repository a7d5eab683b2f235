"""Planar vertex stars (eq. 7): a vertex and its neighbours lie in one plane.

The normal is eliminated: a star of four spans its plane by its two pairs of opposite spokes, a
star on the boundary or around a singular vertex by three spokes in a row. The paper's own
formulation, with the normal among the unknowns, is :class:`StarWithNormal`.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from gridshell.arrays import Floats, Indices
from gridshell.constraints.coplanarity import Coplanarity
from gridshell.mesh import Stars
from gridshell.solve import Evaluation, Pattern, columns_of

_CENTRE, _B0, _B1, _B2, _B3 = np.eye(5)


def regular_stars(stars: Stars) -> Coplanarity:
    """Stars of four spokes b0 .. b3 around v: two rows each, the plane spanned by b2-b0, b3-b1."""
    centre = stars.regular()
    return Coplanarity(
        points=np.column_stack([centre, stars.spokes[centre, :4]]),
        p=_B2 - _B0,
        q=_B3 - _B1,
        w=np.stack([(_B0 + _B2) / 2.0 - _CENTRE, (_B1 + _B3) / 2.0 - _CENTRE]),
    )


def other_stars(stars: Stars) -> Coplanarity:
    """Every other star with three spokes or more: one row for any three spokes in a row."""
    triples = [_consecutive(stars, int(k)) for k in np.unique(stars.count) if k >= 3 and k != 4]
    points = np.concatenate(triples) if triples else np.empty((0, 4), dtype=np.int64)
    centre, b0, b1, b2 = np.eye(4)
    return Coplanarity(points=points, p=b2 - b0, q=b1 - centre, w=(b0 - centre)[None, :])


def _consecutive(stars: Stars, count: int) -> Indices:
    """(m, 4) rows (centre, three spokes in a row) of the stars with *count* spokes."""
    rows = []
    for closed in (True, False):
        centre = np.flatnonzero((stars.count == count) & (stars.closed == closed))
        for i in range(count if closed else count - 2):
            spokes = stars.spokes[centre][:, (i + np.arange(3)) % count]
            rows.append(np.column_stack([centre, spokes]))
    return np.concatenate(rows)


@dataclass(frozen=True, eq=False)
class StarWithNormal:
    """Eq. 7 as printed: rows ``n . (b_j - v)`` with the star's normal n among the unknowns.

    Parameters
    ----------
    points : (m, 6) indices of v, b0 .. b3 and of the normal, which is stored as a point.
    """

    points: Indices

    def pattern(self) -> Pattern:
        """18 columns, four rows."""
        return Pattern(columns_of(self.points), 4)

    def lag(self, x: Floats) -> None:
        """Nothing is held still."""

    def evaluate(self, x: Floats, lag: None) -> Evaluation:
        """Distances at unit mean edge and their exact derivatives."""
        corners = x.reshape(-1, 3)[self.points]
        normal = corners[:, 5]
        spokes = corners[:, 1:5] - corners[:, :1]
        values = np.zeros((len(corners), 4, 6, 3))
        values[:, np.arange(4), np.arange(1, 5)] = normal[:, None]
        values[:, :, 0] = -normal[:, None]
        values[:, :, 5] = spokes
        return Evaluation(
            np.einsum("mjc,mc->mj", spokes, normal), values.reshape(len(corners), 4, 18)
        )
