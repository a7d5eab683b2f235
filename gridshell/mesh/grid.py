"""Rectangular grids of quads, open or closed into a ring."""

from __future__ import annotations

import numpy as np

from gridshell.arrays import Indices


def grid_quads(rows: int, columns: int, *, ring: bool = False) -> Indices:
    """Quads of a grid with vertex (i, j) at index ``i * (columns + 1) + j``.

    Parameters
    ----------
    rows, columns : quads along i and along j.
    ring : join the last row of quads back to the first; the grid then has *rows* rows of
        vertices instead of rows + 1.

    Returns
    -------
    (rows * columns, 4) indices, counter-clockwise for i to the right and j up.
    """
    i, j = np.meshgrid(np.arange(rows), np.arange(columns), indexing="ij")
    following = (i + 1) % rows if ring else i + 1
    width = columns + 1
    corners = [i * width + j, following * width + j, following * width + j + 1, i * width + j + 1]
    return np.stack([c.ravel() for c in corners], axis=1).astype(np.int64)
