"""The polylines of a net by family: what becomes a lamella."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from gridshell.arrays import Indices, frozen
from gridshell.mesh.diagonals import DiagonalMesh
from gridshell.mesh.quad_mesh import QuadMesh
from gridshell.mesh.stars import edge_stars


@dataclass(frozen=True, eq=False)
class Polyline:
    """A maximal run of edges of one family.

    Parameters
    ----------
    family : 1 or 2.
    vertices : (k,) indices into the net; a closed polyline does not repeat its first vertex.
    closed : whether the last vertex is joined to the first.
    """

    family: int
    vertices: Indices
    closed: bool


def polylines(net: DiagonalMesh) -> tuple[Polyline, ...]:
    """All polylines, family 1 first, each family in the order of its smallest edge.

    Polylines run through regular vertices, along the boundary and around reflex corners; they
    end at singular vertices and where the net ends.
    """
    found = [
        Polyline(int(net.family[order[0]]), frozen(vertices, np.int64), loop)
        for order, vertices, loop in strands(net.edges, _linked_edges(net))
    ]
    return tuple(sorted(found, key=lambda line: line.family))


def strands(edges: Indices, links: Indices) -> list[tuple[Indices, Indices, bool]]:
    """Maximal runs of *edges* (m, 2) that continue each other, in the order of their first edges.

    Parameters
    ----------
    links : (l, 2) pairs of edges that continue each other, at most one at either end of an edge.

    Returns
    -------
    Of every run its edges in order, the vertices it meets, and whether it is closed.
    """
    chain, rank, closed = _chains(len(edges), links)
    return [
        (order, _walk(edges[order], loop), bool(loop))
        for loop, order in zip(closed, _split(chain, rank), strict=True)
    ]


def edge_strands(mesh: QuadMesh) -> list[Indices]:
    """The vertices of every run of edges of *mesh* through its regular vertices and along rims."""
    edges, stars = mesh.edges, edge_stars(mesh)
    keys = edges[:, 0] * len(mesh.vertices) + edges[:, 1]
    centre, slot, opposite = stars.through().T
    ends = np.stack([stars.spokes[centre, slot], stars.spokes[centre, opposite]], axis=1)
    low, high = np.minimum(ends, centre[:, None]), np.maximum(ends, centre[:, None])
    links = np.searchsorted(keys, low * len(mesh.vertices) + high)
    return [
        np.r_[vertices, vertices[:1]] if closed else vertices
        for _, vertices, closed in strands(edges, links)
    ]


def _linked_edges(net: DiagonalMesh) -> Indices:
    """(l, 2) pairs of edges that continue each other."""
    centre, slot, opposite = net.stars.through().T
    pairs = [net.spoke_edges[centre, slot], net.spoke_edges[centre, opposite]]
    return np.stack(pairs, axis=1) if len(centre) else np.empty((0, 2), dtype=np.int64)


def _chains(n: int, links: Indices) -> tuple[Indices, Indices, np.ndarray]:
    """Chain of each edge, rank within it, and for each chain whether it is closed.

    The rank is the number of steps from the chain's first edge: the smaller of its two ends, or
    the smallest edge of a loop, which is cut open behind it.
    """
    from scipy.sparse import coo_matrix
    from scipy.sparse.csgraph import connected_components, dijkstra

    def graph(pairs: Indices) -> coo_matrix:
        ones = np.ones(len(pairs), dtype=np.int8)
        return coo_matrix((ones, (pairs[:, 0], pairs[:, 1])), shape=(n, n)).tocsr()

    count, chain = connected_components(graph(links), directed=False)
    degree = np.bincount(links.ravel(), minlength=n)
    edges = np.arange(n)
    end = np.full(count, n)
    np.minimum.at(end, chain[degree < 2], edges[degree < 2])
    closed = end == n
    smallest = np.full(count, n)
    np.minimum.at(smallest, chain, edges)
    start = np.where(closed, smallest, end)
    cut = _one_link_each(links, start[closed])
    steps = dijkstra(
        graph(np.delete(links, cut, axis=0)),
        directed=False,
        indices=start,
        unweighted=True,
        min_only=True,
    )
    return chain, steps.astype(np.int64), closed


def _one_link_each(links: Indices, loop_starts: Indices) -> Indices:
    """For each loop, the first link at its starting edge: where it is cut open."""
    touching = np.isin(links, loop_starts)
    rows = np.flatnonzero(touching.any(axis=1))
    owner = np.where(touching[rows, 0], links[rows, 0], links[rows, 1])
    _, first = np.unique(owner, return_index=True)
    return rows[first]


def _split(chain: Indices, rank: Indices) -> list[Indices]:
    order = np.lexsort((rank, chain))
    return np.split(order, np.flatnonzero(np.diff(chain[order])) + 1)


def _walk(edges: Indices, closed: bool) -> Indices:
    """Vertices met along edges in order, (k,)."""
    if len(edges) == 1:
        return np.asarray(edges[0])
    a, b = edges[:-1], edges[1:]
    shared = np.where((a[:, :1] == b).any(axis=1), a[:, 0], a[:, 1])
    start = edges[0].sum() - shared[0]
    end = edges[-1].sum() - shared[-1]
    return np.asarray(np.r_[start, shared] if closed else np.r_[start, shared, end])
