"""A built strip as a closed triangle mesh: columns between slot walls, on both of its sides.

Slots are as deep as their rounded floors are on average and holes are left out, as in the report's
view; the exact solid is in the STEP file.
"""

from __future__ import annotations

import numpy as np

from fabrication.export.view_meshes import columns
from fabrication.lamella import Lamella
from fabrication.parts import FlatPart
from gridshell.arrays import Indices, Points

_PER_BAY = 8


def strip_mesh(strip: Lamella, part: FlatPart) -> tuple[Points, Indices]:
    """(n, 3) points, mm, and (m, 3) triangles, closed and facing outwards."""
    x, lower, upper = columns(part, _PER_BAY)
    corner_x = np.stack([x[:-1], x[1:], x[1:], x[:-1]], axis=1)
    corner_y = np.stack([lower, lower, upper, upper], axis=1)
    flat, number = np.unique(
        np.stack([corner_x.ravel(), corner_y.ravel()], axis=1), axis=0, return_inverse=True
    )
    # a slot's wall has corners of both its columns: each column is split at its neighbours' levels
    quads = _split(flat, number.reshape(-1, 4), lower, upper)
    count = len(flat)
    station, height = flat[:, 0] + strip.start, flat[:, 1] - part.width / 2.0
    half = np.full(count, part.thickness / 2.0)
    points = np.concatenate([strip.place(station, y, height) for y in (half, -half)])
    fans = [ring[[0, k, k + 1]] for ring in quads for k in range(1, len(ring) - 1)]
    near = np.stack(fans)
    sides = np.concatenate([near[:, ::-1], near + count])  # +b faces against x cross y
    edges = np.concatenate([np.stack([ring, np.roll(ring, -1)], axis=1) for ring in quads])
    keys = edges[:, 0] * count + edges[:, 1]
    rim = edges[~np.isin(edges[:, 1] * count + edges[:, 0], keys)]
    a, b = rim.T
    walls = np.concatenate(
        [np.stack([a, b, b + count], axis=1), np.stack([a, b + count, a + count], axis=1)]
    )
    return points, np.concatenate([sides, walls])


def _split(flat: Points, quads: Indices, lower: Points, upper: Points) -> list[Indices]:
    """Columns as polygons, with their neighbours' corners on their sides, counter-clockwise."""
    rings = []
    for k, (a, b, c, d) in enumerate(quads.tolist()):
        right, left = [], []
        if k + 1 < len(quads):
            e, _, _, h = quads[k + 1].tolist()
            right = [v for v in (e, h) if lower[k] < flat[v, 1] < upper[k]]
        if k:
            _, f, g, _ = quads[k - 1].tolist()
            left = [v for v in (g, f) if lower[k] < flat[v, 1] < upper[k]]
        rings.append(np.array([a, b, *right, c, d, *left]))
    return rings
