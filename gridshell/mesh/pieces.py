"""What hangs together: pieces of quads joined over edges, and quads that are only hinged on."""

from __future__ import annotations

import numpy as np

from gridshell.arrays import Indices, Mask

_ROUNDS = 50


def main_piece(quads: Indices) -> Mask:
    """(f,) quads of the largest piece joined over edges, without those hinged on in a vertex.

    What is left is one manifold piece with a single fan of quads around every vertex; nothing is
    left of no quads.
    """
    kept = np.arange(len(quads))
    for _ in range(_ROUNDS):
        if len(kept) == 0:
            break
        kept = kept[_largest(quads[kept])]
        hinged = _hinged(quads[kept])
        if not hinged.any():
            break
        kept = kept[~hinged]
    mask = np.zeros(len(quads), dtype=bool)
    mask[kept] = True
    return mask


def _largest(quads: Indices) -> Mask:
    from scipy.sparse import coo_matrix
    from scipy.sparse.csgraph import connected_components

    ends = np.sort(np.stack([quads, np.roll(quads, -1, axis=1)], axis=-1).reshape(-1, 2), axis=1)
    name = ends[:, 0] * (int(quads.max()) + 1) + ends[:, 1]
    order = np.argsort(name, kind="stable")
    same = np.flatnonzero(np.diff(name[order]) == 0)
    a, b = order[same] // 4, order[same + 1] // 4
    graph = coo_matrix((np.ones(len(a), dtype=np.int8), (a, b)), shape=(len(quads), len(quads)))
    _, part = connected_components(graph, directed=False)
    return np.asarray(part == np.argmax(np.bincount(part)))


def _hinged(quads: Indices) -> Mask:
    """(f,) quads of the smaller fans at vertices where fans of quads meet."""
    from scipy.sparse import coo_matrix
    from scipy.sparse.csgraph import connected_components

    vertex, n = quads.ravel(), int(quads.max()) + 1
    ahead = vertex * n + np.roll(quads, -1, axis=1).ravel()
    back = vertex * n + np.roll(quads, 1, axis=1).ravel()
    # around a vertex a corner is followed by the one whose edge ahead is this one's edge back
    order = np.argsort(ahead, kind="stable")
    spot = np.minimum(np.searchsorted(ahead[order], back), len(order) - 1)
    corner = np.flatnonzero(ahead[order[spot]] == back)
    pairs = (corner, order[spot[corner]])
    size = len(vertex)
    graph = coo_matrix((np.ones(len(corner), dtype=np.int8), pairs), shape=(size, size))
    count, fan = connected_components(graph, directed=False)
    rank = np.bincount(fan)[fan] * (count + 1) + fan
    largest = np.zeros(n, dtype=np.int64)
    np.maximum.at(largest, vertex, rank)
    return np.asarray((rank != largest[vertex]).reshape(-1, 4).any(axis=1))
