"""How vertices (and, in the paper's own formulation, star normals) lie in the unknown vector."""

from __future__ import annotations

import numpy as np

from gridshell.arrays import Indices


def columns_of(points: Indices) -> Indices:
    """Unknown indices of points stored one after the other as (x, y, z).

    Parameters
    ----------
    points : (m, j) point indices.

    Returns
    -------
    (m, 3j) columns in the order x, y, z of the first point, then of the second, ...
    """
    points = np.asarray(points, dtype=np.int64)
    return (3 * points[..., None] + np.arange(3)).reshape(len(points), 3 * points.shape[1])
