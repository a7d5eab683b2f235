"""Whether a surface of triangles cuts through itself.

Pairs come from trees over the triangles' bounding spheres, one tree per size of triangle; they are
judged by separating axes (S. Gottschalk, M. C. Lin, D. Manocha, OBBTree, 1996). Triangles that
share a vertex are not compared.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from gridshell.arrays import Floats, Indices, Mask, Points, unit

MOST_PAIRS = 20_000_000
"""Pairs of spheres that meet, above which nothing is said: 40 per triangle of half a million."""

_BLOCK = 1_000_000
_DEPTH = 1e-7
"""How deep triangles must cut, over their own size: touching is not cutting."""


def crossing_triangles(vertices: Points, triangles: Indices) -> Indices | None:
    """Pairs (m, 2) of triangles that cut through each other; None where there are too many to ask.

    Parameters
    ----------
    vertices : (n, 3) mm.
    triangles : (f, 3) vertex indices.
    """
    corners = vertices[triangles]
    centre, radius = _spheres(corners)
    low, high = corners.min(axis=1), corners.max(axis=1)
    found: list[Indices] = []
    pairs = _near(centre, radius)
    if pairs is None:
        return None
    for first, second in pairs:
        apart = triangles[first, 0] != triangles[second, 0]
        apart &= ((low[first] <= high[second]) & (low[second] <= high[first])).all(axis=1)
        i, j = first[apart], second[apart]
        shared = (triangles[i][:, :, None] == triangles[j][:, None]).any(axis=(1, 2))
        i, j = i[~shared], j[~shared]
        cut = _cut(corners[i], corners[j])
        found.append(np.stack([i[cut], j[cut]], axis=1))
    return np.concatenate(found) if found else np.zeros((0, 2), dtype=np.int64)


def _spheres(corners: Floats) -> tuple[Points, Floats]:
    """Centres (f, 3) and radii (f,) of spheres about triangles, the smallest but for obtuse ones.

    About the middle of the longest edge an obtuse triangle's is the smallest; an acute one's is
    larger than need be by at most 1.5.
    """
    edges = np.roll(corners, -1, axis=1) - corners
    longest = np.argmax(np.einsum("fkc,fkc->fk", edges, edges), axis=1)
    rows = np.arange(len(corners))
    a, b = corners[rows, longest], corners[rows, (longest + 1) % 3]
    middle = (a + b) / 2.0
    centroid = corners.mean(axis=1)
    around = np.linalg.norm(corners - middle[:, None], axis=2).max(axis=1)
    about = np.linalg.norm(corners - centroid[:, None], axis=2).max(axis=1)
    tighter = about < around
    return np.where(tighter[:, None], centroid, middle), np.where(tighter, about, around)


def _near(centre: Points, radius: Floats) -> list[tuple[Indices, Indices]] | None:
    """Blocks of pairs whose spheres meet; None when there are more than can be looked at."""
    from scipy.spatial import cKDTree

    size = np.floor(np.log2(radius / radius.min())).astype(np.int64)
    groups = [np.flatnonzero(size == s) for s in np.unique(size)]
    trees: list[tuple[Indices, Any, float]] = [
        (g, cKDTree(centre[g]), float(radius[g].max())) for g in groups
    ]
    blocks: list[tuple[Indices, Indices]] = []
    left = MOST_PAIRS
    for k, (own, tree, reach) in enumerate(trees):
        for other, other_tree, other_reach in trees[k:]:
            same = other is own
            left -= int(tree.count_neighbors(other_tree, reach + other_reach)) // (1 + same)
            if left < 0:
                return None
            if same:
                pairs = tree.query_pairs(2.0 * reach, output_type="ndarray")
                i, j = own[pairs[:, 0]], own[pairs[:, 1]]
            else:
                pairs = tree.sparse_distance_matrix(
                    other_tree, reach + other_reach, output_type="ndarray"
                )
                i, j = own[pairs["i"]], other[pairs["j"]]
            cuts = range(_BLOCK, len(i), _BLOCK)
            blocks.extend(zip(np.split(i, cuts), np.split(j, cuts), strict=True))
    return blocks


def _cut(a: Floats, b: Floats) -> Mask:
    """Whether triangles a and b, (m, 3, 3) each, overlap by more than touching."""
    size = np.maximum(np.ptp(a, axis=1).max(axis=1), np.ptp(b, axis=1).max(axis=1))
    depth = _DEPTH * size
    result = np.zeros(len(a), dtype=bool)
    normal_a = unit(np.cross(a[:, 1] - a[:, 0], a[:, 2] - a[:, 0]))
    normal_b = unit(np.cross(b[:, 1] - b[:, 0], b[:, 2] - b[:, 0]))
    over_a = np.einsum("mkc,mc->mk", b - a[:, :1], normal_a)
    over_b = np.einsum("mkc,mc->mk", a - b[:, :1], normal_b)
    flat = (np.abs(over_a).max(axis=1) < depth) & (np.abs(over_b).max(axis=1) < depth)
    crossing = _straddles(over_a, depth) & _straddles(over_b, depth)
    rows = np.flatnonzero(flat | crossing)
    a, b, flat, depth = a[rows], b[rows], flat[rows], depth[rows]
    edges_a, edges_b = np.roll(a, -1, axis=1) - a, np.roll(b, -1, axis=1) - b
    space = np.cross(edges_a[:, :, None], edges_b[:, None]).reshape(-1, 9, 3)
    plane = np.cross(
        np.concatenate([edges_a, edges_b], axis=1),
        np.concatenate(
            [np.repeat(normal_a[rows, None], 3, 1), np.repeat(normal_b[rows, None], 3, 1)], 1
        ),
    )
    axes = np.where(flat[:, None, None], np.concatenate([plane, plane[:, :3]], axis=1), space)
    length = np.linalg.norm(axes, axis=2)
    usable = length > 1e-9 * (size[rows] ** np.where(flat, 1.0, 2.0))[:, None]
    axes = axes / np.where(usable, length, 1.0)[..., None]
    on_a, on_b = axes @ a.transpose(0, 2, 1), axes @ b.transpose(0, 2, 1)
    gap = np.maximum(on_a.min(2) - on_b.max(2), on_b.min(2) - on_a.max(2))
    result[rows] = ((gap < -depth[:, None]) | ~usable).all(axis=1)
    return result


def _straddles(heights: Floats, depth: Floats) -> Mask:
    """Whether heights (m, 3) over a plane lie on both sides of it."""
    return np.asarray((heights.min(axis=1) < -depth) & (heights.max(axis=1) > depth))
