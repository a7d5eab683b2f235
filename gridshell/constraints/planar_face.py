"""Planar faces: of a mesh itself, and the white quads of its checkerboard pattern (eq. 6).

The normal is eliminated: a quad lies in a plane when its two diagonals do not pass each other at a
distance. A larger face is planar when every four corners in a row are.
"""

from __future__ import annotations

import numpy as np

from gridshell.arrays import Indices
from gridshell.constraints.coplanarity import Coplanarity
from gridshell.mesh import Stars

_A0, _A1, _A2, _A3 = np.eye(4)


def planar_faces(quads: Indices) -> Coplanarity:
    """One row per quad, (m, 4): the distance of its diagonals."""
    return Coplanarity(points=quads, p=_A2 - _A0, q=_A3 - _A1, w=(_A1 - _A0)[None, :])


def planar_white_faces(edge_stars: Stars) -> Coplanarity:
    """White faces: the neighbours a0 .. a(k-1) of every interior vertex, twice their true size.

    A face of k > 4 corners, around a singular vertex, gives one row for any four in a row. On the
    boundary a white face has three corners and is planar anyway.
    """
    rows = []
    for count in np.unique(edge_stars.count[edge_stars.closed]).tolist():
        ring = edge_stars.spokes[edge_stars.closed & (edge_stars.count == count), :count]
        if count == 4:
            rows.append(ring)
        elif count > 4:
            rows += [ring[:, (i + np.arange(4)) % count] for i in range(count)]
    return planar_faces(np.concatenate(rows) if rows else np.empty((0, 4), dtype=np.int64))
