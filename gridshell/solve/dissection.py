"""Nested dissection: an elimination order that keeps a sparse factor small, in numpy alone.

A. George, Nested dissection of a regular finite element mesh, SIAM J. Numer. Anal. 10 (1973); the
separators are levels of a breadth-first search from a far vertex (George and Liu 1978). All parts
of one depth are searched and split together, so the work is vectorised whatever their number.
"""

from __future__ import annotations

import numpy as np
from scipy.sparse import csr_matrix
from scipy.sparse.csgraph import connected_components

from gridshell.arrays import Indices

_SMALL = 48
"""Parts of fewer vertices are not split further."""


def dissection_order(graph: csr_matrix) -> Indices:
    """(n,) vertices of a symmetric *graph* in the order of their elimination.

    Separators come after the parts they separate.
    """
    n = graph.shape[0]
    step = np.full(n, -1, dtype=np.int64)
    depth = 0
    while True:
        _, part = connected_components(graph, directed=False)
        sizes = np.bincount(part)
        large = (step < 0) & (sizes[part] > _SMALL)
        if not large.any():
            return np.lexsort((part, np.where(step < 0, -n, -step)))
        level = _levels(graph, part, large)
        separator = large & (level == _middle_levels(part, level, large)[part])
        step[separator] = depth
        graph = _without(graph, separator)
        depth += 1


def _levels(graph: csr_matrix, part: Indices, large: Indices) -> Indices:
    """(n,) distance of every vertex of a large part from a far vertex of its part."""
    _, seeds = np.unique(np.where(large, part, -1), return_index=True)
    seeds = seeds[large[seeds]]
    first = _search(graph, seeds)
    last = np.lexsort((first, part))
    ends = last[np.flatnonzero(np.diff(part[last], append=-1))]
    return _search(graph, ends[large[ends]])


def _search(graph: csr_matrix, seeds: Indices) -> Indices:
    """(n,) breadth-first distance from the nearest seed, -1 where none is reached."""
    level = np.full(graph.shape[0], -1, dtype=np.int64)
    front, distance = seeds, 0
    while len(front):
        level[front] = distance
        starts, counts = graph.indptr[front], np.diff(graph.indptr)[front]
        offsets = np.arange(counts.sum()) - np.repeat(np.cumsum(counts) - counts, counts)
        found = graph.indices[np.repeat(starts, counts) + offsets]
        found = found[level[found] < 0]
        level[found] = distance + 1
        front = np.unique(found)
        distance += 1
    return level


def _middle_levels(part: Indices, level: Indices, large: Indices) -> Indices:
    """Per part the level that halves it."""
    rows = np.flatnonzero(large)
    order = rows[np.lexsort((level[rows], part[rows]))]
    first = np.flatnonzero(np.diff(part[order], prepend=-1))
    middle = (first + np.r_[first[1:], len(order)]) // 2
    result = np.full(int(part.max()) + 1, -1, dtype=np.int64)
    result[part[order[middle]]] = level[order[middle]]
    return result


def _without(graph: csr_matrix, separator: Indices) -> csr_matrix:
    """The graph without the edges at the separator's vertices."""
    tail = np.repeat(np.arange(graph.shape[0]), np.diff(graph.indptr))
    keep = ~(separator[tail] | separator[graph.indices])
    indptr = np.r_[0, np.cumsum(np.bincount(tail[keep], minlength=graph.shape[0]))]
    return csr_matrix((graph.data[keep], graph.indices[keep], indptr), shape=graph.shape)
