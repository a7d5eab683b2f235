"""Whether triangles make one manifold, orientable surface: edges, pieces, sides, fans."""

from __future__ import annotations

import numpy as np

from gridshell.arrays import Indices, Points
from gridshell.errors import DisconnectedError, NonManifoldError, OrientationError
from gridshell.surface.triangle_mesh import place


def oriented(points: Points, faces: Indices) -> tuple[Indices, Indices]:
    """Turn the fewest triangles so that neighbours face the same side.

    Every triangle is two nodes, as it is and turned; neighbours link the nodes that agree. A
    surface with two sides falls into two parts, a Moebius strip into one. Returns the triangles
    (f, 3) and which of them were turned.

    Raises
    ------
    NonManifoldError
        For an edge with more than two triangles.
    DisconnectedError, OrientationError
        For several pieces, and for a surface with one side.
    """
    from scipy import sparse
    from scipy.sparse.csgraph import connected_components

    f, n = len(faces), len(points)
    start, end = faces.ravel(), np.roll(faces, -1, axis=1).ravel()
    key = np.minimum(start, end) * n + np.maximum(start, end)
    order = np.argsort(key, kind="stable")
    ordered = key[order]
    triple = np.flatnonzero(ordered[2:] == ordered[:-2])
    if len(triple):
        h = order[triple[0]]
        raise NonManifoldError(
            "An edge belongs to more than two triangles",
            where=f"edge {start[h]}-{end[h]} {place((points[start[h]] + points[end[h]]) / 2.0)}",
            value=f"{int((ordered == ordered[triple[0]]).sum())} triangles, "
            f"{len(np.unique(ordered[triple]))} such edges",
            limit="2 triangles",
            advice="split the surface along that edge, or remove what is doubled",
        )
    pair = np.flatnonzero(ordered[1:] == ordered[:-1])
    one, other = order[pair], order[pair + 1]
    turned = (start[one] == start[other]).astype(np.int64)
    one, other = one // 3, other // 3
    rows = np.concatenate([one, one + f])
    columns = np.concatenate([other + f * turned, other + f * (1 - turned)])
    links = sparse.coo_matrix((np.ones(len(rows)), (rows, columns)), shape=(2 * f, 2 * f))
    count, label = connected_components(links, directed=False)
    _require_one_piece(points, faces, np.minimum(label[:f], label[f:]))
    if count == 1:
        raise OrientationError(
            "The surface has only one side, as a Moebius strip",
            value=f"{f} triangles",
            limit="two sides",
            advice="cut it open",
        )
    odd = label[:f] != label[0]
    if 2 * np.count_nonzero(odd) > f:
        odd = ~odd
    return np.where(odd[:, None], faces[:, ::-1], faces), np.flatnonzero(odd)


def _require_one_piece(points: Points, faces: Indices, label: Indices) -> None:
    """Refuse several pieces; *label* (f,) is the same within one."""
    first, count = np.unique(label, return_index=True, return_counts=True)[1:]
    if len(first) > 1:
        order = np.argsort(-count, kind="stable")
        shown = ", ".join(str(c) for c in count[order[:6]]) + (", ..." if len(count) > 6 else "")
        smaller = faces[first[order[1]]]
        raise DisconnectedError(
            "The surface is in several pieces",
            where=f"one of them at {place(points[smaller].mean(axis=0))}",
            value=f"{len(count)} pieces of {shown} triangles",
            limit="one piece",
            advice="join the pieces, or give each a file of its own",
        )


def require_fans(points: Points, faces: Indices) -> None:
    """Refuse a vertex whose triangles form more than one fan around it.

    Corners at a vertex are linked where their triangles share an edge there; a fan is a part.
    """
    from scipy import sparse
    from scipy.sparse.csgraph import connected_components

    n, corners = len(points), np.arange(faces.size)
    start, end = faces.ravel(), np.roll(faces, -1, axis=1).ravel()
    following = np.where(corners % 3 == 2, corners - 2, corners + 1)
    order = np.argsort(np.minimum(start, end) * n + np.maximum(start, end), kind="stable")
    key = (np.minimum(start, end) * n + np.maximum(start, end))[order]
    pair = np.flatnonzero(key[1:] == key[:-1])
    a, b = order[pair], order[pair + 1]
    rows, columns = np.concatenate([a, following[a]]), np.concatenate([following[b], b])
    links = sparse.coo_matrix((np.ones(len(rows)), (rows, columns)), shape=(faces.size,) * 2)
    label = connected_components(links, directed=False)[1]
    fans = np.bincount(start[np.unique(label, return_index=True)[1]], minlength=n)
    broken = np.flatnonzero(fans > 1)
    if len(broken):
        raise NonManifoldError(
            "Two fans of triangles meet in one vertex",
            where=f"vertex {broken[0]} {place(points[broken[0]])}",
            value=f"{fans[broken[0]]} fans, {len(broken)} such vertices",
            limit="one fan",
            advice="remove what touches only there",
        )
