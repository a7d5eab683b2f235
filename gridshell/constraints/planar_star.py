"""Planar vertex stars (eq. 7): a vertex and its neighbours lie in one plane.

The normal is eliminated: a star of four spans its plane by its two pairs of opposite spokes, a
star on the boundary or around a singular vertex by three spokes in a row. The paper's own
formulation, with the normal among the unknowns, is in ``across_normal``.
"""

from __future__ import annotations

import numpy as np

from gridshell.arrays import Indices
from gridshell.constraints.coplanarity import Coplanarity
from gridshell.mesh import Stars

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
