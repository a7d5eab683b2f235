"""Which points describe the surface around a vertex: rings of a mesh, or the nearest of a cloud.

A neighbourhood list is two arrays as in a CSR matrix: the points of row i are
``members[starts[i] : starts[i + 1]]``.
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np

from gridshell.arrays import Floats, Indices, Mask, Points, Vectors
from gridshell.surface.triangle_mesh import TriangleMesh

_MOST_RINGS = 12
"""Growing stops here: a mesh this small has no more points to give."""


class Neighbourhoods(NamedTuple):
    """The points that describe each of m places."""

    starts: Indices
    """(m + 1,) where each row begins in *members*."""
    members: Indices
    """(sum of sizes,) indices into the points."""

    @property
    def sizes(self) -> Indices:
        """(m,) points per row."""
        return np.diff(self.starts)


def adjacency(mesh: TriangleMesh) -> Any:
    """The sparse (n, n) matrix of ones where two vertices share an edge, or are the same."""
    from scipy import sparse

    n = len(mesh.vertices)
    own = np.arange(n)
    rows = np.concatenate([mesh.origin, mesh.target, own])
    columns = np.concatenate([mesh.target, mesh.origin, own])
    ones = np.ones(len(rows), dtype=np.float32)
    matrix = sparse.csr_matrix((ones, (rows, columns)), shape=(n, n))
    matrix.data[:] = 1.0
    return matrix


def vertex_rings(
    mesh: TriangleMesh, *, rings: int, least: int, at_edge: int, rows: Indices | None = None
) -> Neighbourhoods:
    """Every vertex with its *rings* rings, more of them where that gives too few points.

    Parameters
    ----------
    least : points (the vertex among them) below which another ring is added.
    at_edge : the same for vertices on the boundary, which see only one side.
    rows : (m,) the vertices asked for; all of them if not given.
    """
    one = adjacency(mesh)
    grown = one if rows is None else one[rows]
    for _ in range(rings - 1):
        grown = grown @ one
    edge = mesh.on_boundary if rows is None else mesh.on_boundary[rows]
    wanted = np.where(edge, at_edge, least)
    few = np.flatnonzero(np.diff(grown.indptr) < wanted)
    replaced: list[tuple[Indices, Any]] = []
    part = grown[few]
    for _ in range(_MOST_RINGS):
        if not len(few):
            break
        part = part @ one
        enough = np.diff(part.indptr) >= wanted[few]
        replaced.append((few[enough], part[np.flatnonzero(enough)]))
        few, part = few[~enough], part[np.flatnonzero(~enough)]
    replaced.append((few, part))
    return _merged(grown, replaced)


def _merged(matrix: Any, replaced: list[tuple[Indices, Any]]) -> Neighbourhoods:
    """The rows of *matrix*, some of them replaced by the rows of others."""
    rows = np.concatenate([r for r, _ in replaced])
    if not len(rows):
        return Neighbourhoods(matrix.indptr.astype(np.int64), matrix.indices.astype(np.int64))
    sizes = np.diff(matrix.indptr).astype(np.int64)
    kept = np.ones(len(sizes), dtype=bool)
    kept[rows] = False
    members = np.concatenate(
        [matrix.indices[np.repeat(kept, sizes)], *(m.indices for _, m in replaced)]
    ).astype(np.int64)
    order = np.concatenate([np.flatnonzero(kept), rows])
    lengths = np.concatenate([sizes[kept], *(np.diff(m.indptr) for _, m in replaced)])
    begins = np.concatenate([[0], np.cumsum(lengths)[:-1]])
    begin, size = np.empty(len(order), np.int64), np.empty(len(order), np.int64)
    begin[order], size[order] = begins, lengths
    starts = np.concatenate([[0], np.cumsum(size)])
    gather = np.arange(starts[-1]) + np.repeat(begin - starts[:-1], size)
    return Neighbourhoods(starts, members[gather])


def nearest_members(
    points: Points, normals: Vectors, places: Points, place_normals: Vectors, *, count: int
) -> Neighbourhoods:
    """The *count* points nearest to each place, without those of a sheet that faces another way.

    Parameters
    ----------
    points, normals : (n, 3) the cloud, mm, and its unit normals.
    places, place_normals : (m, 3) where neighbourhoods are asked for.
    """
    from scipy.spatial import cKDTree

    _, near = cKDTree(points).query(places, k=min(count, len(points)), workers=-1)
    near = near.reshape(len(places), -1)
    facing: Floats = np.einsum("mkc,mc->mk", normals[near], place_normals)
    fits: Mask = facing > 0.5
    fits[:, 0] = True
    starts = np.concatenate([[0], np.cumsum(fits.sum(axis=1))]).astype(np.int64)
    return Neighbourhoods(starts, near[fits].astype(np.int64))
