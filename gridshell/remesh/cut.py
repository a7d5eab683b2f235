"""Signs and cuts: a pair of line fields becomes two vector fields on a surface cut open.

The frame of a triangle can meet its neighbour's as it is or turned by pi, nothing else (see
`gridshell.field`). Signs are chosen so that few neighbours disagree; the edges of the cut carry
what is left, and opened along them the surface has single-valued frames.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.sparse import coo_matrix, csr_matrix
from scipy.sparse.csgraph import breadth_first_order, dijkstra, minimum_spanning_tree

from gridshell.arrays import Floats, Indices, Mask
from gridshell.surface import TriangleMesh
from gridshell.surface.triangle_mesh import before

_DEAR = 1e6
"""Cost of crossing an edge whose frames disagree, in mean edges."""


@dataclass(frozen=True, eq=False)
class Cut:
    """How the surface is opened and the frames are signed.

    Parameters
    ----------
    signs : (f,) +1 or -1 by which both directions of a triangle are multiplied.
    on_cut : (3f,) whether a half-edge lies on the cut; both sides of an edge agree.
    flips : (3f,) +1 or -1: the sign between the signed frames on both sides; +1 off the cut.
    """

    signs: Indices
    on_cut: Mask
    flips: Indices


def cut_open(mesh: TriangleMesh, matches: Indices, mismatch: Floats, half: Mask) -> Cut:
    """Sign the frames and find where to cut.

    Parameters
    ----------
    matches : (3f,) +1 or -1 between the frames of a half-edge's triangle and its twin's.
    mismatch : (3f,) angle by which the matched frames differ, radians.
    half : (n,) interior vertices around which the frame turns over: the cut must reach them.
    """
    inner = np.flatnonzero(mesh.twin > np.arange(len(mesh.twin)))
    a, b = inner // 3, mesh.twin[inner] // 3
    signs = _signs(len(mesh.triangles), a, b, matches[inner], np.abs(mismatch[inner]))
    flips = np.ones(len(mesh.twin), dtype=np.int64)
    flips[inner] = signs[a] * matches[inner] * signs[b]
    flips[mesh.twin[inner]] = flips[inner]
    tree = _short_tree(mesh, inner, flips)
    on_cut = np.zeros(len(mesh.twin), dtype=bool)
    on_cut[inner] = ~tree
    on_cut[mesh.twin[inner]] = ~tree
    return Cut(signs, _pruned(mesh, on_cut, half), flips)


def _signs(count: int, a: Indices, b: Indices, matches: Indices, mismatch: Floats) -> Indices:
    """Continue the first triangle's sign over the tree of least mismatch."""
    graph = coo_matrix((1e-6 + mismatch, (a, b)), shape=(count, count)).tocsr()
    tree = minimum_spanning_tree(graph)
    order, parents = breadth_first_order(tree, 0, directed=False)
    match = csr_matrix((np.r_[matches, matches], (np.r_[a, b], np.r_[b, a])), shape=(count, count))
    step = np.ones(count, dtype=np.int64)
    children = order[1:]
    step[children] = np.asarray(match[children, parents[children]]).ravel()
    return _product_to_root(step, np.where(parents < 0, np.arange(count), parents))


def _product_to_root(step: Indices, parents: Indices) -> Indices:
    """Product of *step* from every item up to its root, by doubling."""
    total, ahead = step.copy(), parents.copy()
    while (ahead != ahead[ahead]).any():
        total, ahead = total * total[ahead], ahead[ahead]
    return total


def _short_tree(mesh: TriangleMesh, inner: Indices, flips: Indices) -> Mask:
    """(len(inner),) the edges crossed by a shortest-path tree over the triangles."""
    a, b = inner // 3, mesh.twin[inner] // 3
    length = np.linalg.norm(mesh.centroids[a] - mesh.centroids[b], axis=1) / mesh.mean_edge
    cost = np.where(flips[inner] < 0, _DEAR, 0.0) + length + 1e-9
    count = len(mesh.triangles)
    graph = csr_matrix((np.r_[cost, cost], (np.r_[a, b], np.r_[b, a])), shape=(count, count))
    middle = np.linalg.norm(mesh.centroids - mesh.centroids.mean(axis=0), axis=1)
    _, parents = dijkstra(graph, indices=int(np.argmin(middle)), return_predecessors=True)
    child = np.flatnonzero(parents >= 0)
    pairs = np.minimum(child, parents[child]) * count + np.maximum(child, parents[child])
    return np.isin(np.minimum(a, b) * count + np.maximum(a, b), pairs)


def _pruned(mesh: TriangleMesh, on_cut: Mask, half: Mask) -> Mask:
    """Take away free ends until every end is on the boundary or at a vertex of half index."""
    edges = np.flatnonzero(on_cut & (mesh.twin > np.arange(len(mesh.twin))))
    ends = np.stack([mesh.origin[edges], mesh.target[edges]], axis=1)
    kept = mesh.on_boundary | half
    degree = np.bincount(ends.ravel(), minlength=len(kept))
    only = np.zeros(len(kept), dtype=np.int64)  # xor of the edges left: of a free end, its edge
    np.bitwise_xor.at(only, ends.ravel(), np.repeat(np.arange(len(edges)), 2))
    alive = np.ones(len(edges), dtype=bool)
    front = np.flatnonzero((degree == 1) & ~kept)
    while len(front):
        gone = np.unique(only[front])
        alive[gone] = False
        np.subtract.at(degree, ends[gone].ravel(), 1)
        np.bitwise_xor.at(only, ends[gone].ravel(), np.repeat(gone, 2))
        front = np.unique(ends[gone])
        front = front[(degree[front] == 1) & ~kept[front]]
    left = np.zeros_like(on_cut)
    left[edges[alive]] = True
    left[mesh.twin[edges[alive]]] = True
    return left


def next_around(mesh: TriangleMesh, spokes: Indices) -> Indices:
    """The next spoke counter-clockwise around the same vertex, -1 past the boundary."""
    return np.where(spokes < 0, -1, mesh.twin[before(spokes)])
