"""Vertices in the same place made one, as files without shared vertices (STL) need it."""

from __future__ import annotations

import numpy as np

from gridshell.arrays import Indices, Points


def welded(points: Points, faces: Indices, *, within: float) -> tuple[Points, Indices]:
    """Make one of vertices in the same place; the first one's position and the order stay.

    Parameters
    ----------
    points : (n, 3) mm.
    faces : (f, 3) vertex indices.
    within : distance, mm, that counts as the same place; chains of such vertices become one.
    """
    first, label = _same(points)
    near = _close(points[first], within)
    kept = np.unique(near, return_index=True)[1]
    return points[first[kept]], near[label][faces]


def _same(points: Points) -> tuple[Indices, Indices]:
    """The first of equal points, in order, and the place (n,) each has among them."""
    bits = np.ascontiguousarray(points + 0.0).view(np.uint64).reshape(-1, 3)
    factors = np.array([0x9E3779B97F4A7C15, 0xC2B2AE3D27D4EB4F, 0x165667B19E3779F9], np.uint64)
    mixed = (bits ^ (bits >> np.uint64(29))) * factors
    key = mixed[:, 0] ^ (mixed[:, 1] >> np.uint64(7)) ^ (mixed[:, 2] << np.uint64(3))
    first, label = np.unique(key, return_index=True, return_inverse=True)[1:]
    if not (points[first[label]] == points).all():  # two places share a key
        first, label = np.unique(points, axis=0, return_index=True, return_inverse=True)[1:]
    order = np.argsort(first, kind="stable")
    rank = np.empty(len(first), dtype=np.int64)
    rank[order] = np.arange(len(first))
    return first[order], rank[label.ravel()]


def _close(points: Points, tolerance: float) -> Indices:
    """Labels (n,) of chains of points closer than *tolerance*, numbered by their first point."""
    from scipy import sparse
    from scipy.sparse.csgraph import connected_components
    from scipy.spatial import cKDTree

    n = len(points)
    pairs = cKDTree(points).query_pairs(tolerance, output_type="ndarray")
    if not len(pairs):
        return np.arange(n)
    links = sparse.coo_matrix((np.ones(len(pairs)), (pairs[:, 0], pairs[:, 1])), shape=(n, n))
    label = connected_components(links, directed=False)[1]
    first = np.unique(label, return_index=True)[1]
    rank = np.empty(len(first), dtype=np.int64)
    rank[np.argsort(first)] = np.arange(len(first))
    return np.asarray(rank[label])
