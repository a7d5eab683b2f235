"""The angle at which two directions of a net cross."""

from __future__ import annotations

import numpy as np

from gridshell.arrays import Floats, Indices, Points


def crossing_angles(vertices: Points, crossings: Indices) -> Floats:
    """(m,) angle from direction c - a to direction d - b, radians.

    Parameters
    ----------
    crossings : (m, 4) rows a, b, c, d: the corners of a control quad, or the ends of a star.
    """
    corners = vertices[crossings]
    a, b = corners[:, 2] - corners[:, 0], corners[:, 3] - corners[:, 1]
    across, along = np.linalg.norm(np.cross(a, b), axis=1), np.einsum("mc,mc->m", a, b)
    return np.asarray(np.arctan2(across, along))
