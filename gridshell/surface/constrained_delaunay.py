"""Delaunay triangulation of a polygon with holes: every boundary edge kept, the outside taken away.

Missing edges are recovered by flips after S. W. Sloan, A fast algorithm for generating constrained
Delaunay triangulations, Computers & Structures 47 (1993).
"""

from __future__ import annotations

from collections import deque
from collections.abc import Sequence

import numpy as np

from gridshell.arrays import Floats, Indices, Mask
from gridshell.errors import SurfaceError

_FRAME = np.array([[-1.0, -1.2], [1.1, -1.0], [1.0, 1.2], [-1.1, 1.0]])
"""Far corners, in sizes of the domain: with them every point has triangles all around."""


def constrained_delaunay(points: Floats, edges: Indices) -> Indices:
    """Triangulate *points* (n, 2) inside *edges*.

    Parameters
    ----------
    points : (n, 2), all of them on or inside the boundary.
    edges : (k, 2) directed boundary edges, the domain on their left.

    Returns
    -------
    Triangles (f, 3), counter-clockwise.

    Raises
    ------
    SurfaceError
        When boundary edges cross, or points coincide.
    """
    from scipy.spatial import Delaunay

    n = len(points)
    middle, size = points.mean(axis=0), float(np.ptp(points, axis=0).max())
    everything = np.concatenate([(points - middle) / size, 3.0 * _FRAME])
    found = Delaunay(everything)
    if len(found.coplanar):
        raise SurfaceError(
            "Points of the parameter domain coincide",
            where=f"point {found.coplanar[0, 0]}",
            value=f"{len(found.coplanar)} such points",
            advice="give a longer edge, or remove tiny edges of the outline",
        )
    triangles = found.simplices.astype(np.int64)
    a, b, c = np.moveaxis(everything[triangles], 1, 0)
    turned = np.cross(np.pad(b - a, ((0, 0), (0, 1))), np.pad(c - a, ((0, 0), (0, 1))))[:, 2] < 0.0
    triangles[turned] = triangles[turned][:, ::-1]
    triangles = _with_edges(everything, triangles, edges)
    return _left_of(triangles, edges, n + 4)


def inside(points: Floats, polygons: Sequence[Floats]) -> Mask:
    """Whether points (n, 2) lie inside closed polygons (k, 2), by the even-odd rule."""
    order = np.argsort(points[:, 1], kind="stable")
    x, y = points[order].T
    within = np.zeros(len(points), dtype=bool)
    for polygon in polygons:
        ends = np.roll(polygon, -1, axis=0)
        low = np.searchsorted(y, np.minimum(polygon[:, 1], ends[:, 1]), side="right")
        high = np.searchsorted(y, np.maximum(polygon[:, 1], ends[:, 1]), side="right")
        for (x0, y0), (x1, y1), i, j in zip(polygon, ends, low, high, strict=True):
            if j > i:
                within[i:j] ^= x[i:j] < x0 + (y[i:j] - y0) * ((x1 - x0) / (y1 - y0))
    result = np.empty(len(points), dtype=bool)
    result[order] = within
    return result


def _left_of(triangles: Indices, edges: Indices, count: int) -> Indices:
    """The triangles that can be reached from the left of *edges* without crossing one."""
    from scipy.sparse import coo_array
    from scipy.sparse.csgraph import connected_components

    origin, target = triangles.ravel(), np.roll(triangles, -1, axis=1).ravel()
    forward, backward = origin * count + target, target * count + origin
    walls = np.concatenate([edges[:, 0] * count + edges[:, 1], edges[:, 1] * count + edges[:, 0]])
    order = np.argsort(forward)
    at = np.searchsorted(forward[order], backward)
    twin = order[np.minimum(at, len(order) - 1)]
    open_edge = (forward[twin] == backward) & ~np.isin(forward, walls)
    here = np.flatnonzero(open_edge)
    graph = coo_array(
        (np.ones(len(here)), (here // 3, twin[here] // 3)), shape=(len(triangles),) * 2
    )
    _, label = connected_components(graph, directed=False)
    left = np.unique(label[np.flatnonzero(np.isin(forward, walls[: len(edges)])) // 3])
    right = np.unique(label[np.flatnonzero(np.isin(forward, walls[len(edges) :])) // 3])
    if len(np.intersect1d(left, right)):
        raise _crossing(edges[0], "the outline does not separate inside from outside")
    return triangles[np.isin(label, left)]


def _with_edges(points: Floats, triangles: Indices, edges: Indices) -> Indices:
    """The triangulation with every one of *edges* in it."""
    count = len(points)
    keys = (triangles * count + np.roll(triangles, -1, axis=1)).ravel()
    missing = edges[~np.isin(edges[:, 0] * count + edges[:, 1], keys)]
    if not len(missing):
        return triangles
    web = _Web(points, triangles)
    kept = {(int(a), int(b)) for a, b in edges} | {(int(b), int(a)) for a, b in edges}
    for a, b in missing.tolist():
        web.recover(a, b, kept)
    return web.triangles()


class _Web:
    """Triangles as a table from directed edges to the opposite corner: easy to flip one by one."""

    def __init__(self, points: Floats, triangles: Indices) -> None:
        self.xy = points.tolist()
        self.corner: dict[tuple[int, int], int] = {}
        self.around: dict[int, set[int]] = {}
        for a, b, c in triangles.tolist():
            self._add(a, b, c)

    def triangles(self) -> Indices:
        """Each triangle once."""
        rows = {min((a, b, c), (b, c, a), (c, a, b)) for (a, b), c in self.corner.items()}
        return np.array(sorted(rows), dtype=np.int64)

    def recover(self, a: int, b: int, kept: set[tuple[int, int]]) -> None:
        """Flip the edges that cross a-b until it is an edge itself."""
        queue = deque(self._crossed(a, b, kept))
        patience = 50 * len(queue) * len(queue) + 1000
        while queue:
            p, q = queue.popleft()
            r, s = self.corner[p, q], self.corner[q, p]
            patience -= 1
            if patience < 0:
                raise _crossing((a, b), "no sequence of flips reaches the edge")
            if self._turn(r, s, q) <= 0.0 or self._turn(s, r, p) <= 0.0:
                queue.append((p, q))
                continue
            self._remove(p, q, r)
            self._remove(q, p, s)
            self._add(r, s, q)
            self._add(s, r, p)
            if {r, s}.isdisjoint((a, b)) and self._turn(a, b, r) * self._turn(a, b, s) < 0.0:
                queue.append((r, s))

    def _crossed(self, a: int, b: int, kept: set[tuple[int, int]]) -> list[tuple[int, int]]:
        for p in sorted(self.around[a]):
            q = self.corner[a, p]
            if self._turn(a, b, p) <= 0.0 < self._turn(a, b, q) and self._turn(p, q, b) < 0.0:
                break
        else:
            raise _crossing((a, b), "a point lies on the edge")
        found = [(p, q)]
        while (r := self.corner[q, p]) != b:
            if (p, q) in kept:
                raise _crossing((a, b), f"edge {p}-{q} crosses it")
            p, q = (r, q) if self._turn(a, b, r) <= 0.0 else (p, r)
            found.append((p, q))
        if (p, q) in kept:
            raise _crossing((a, b), f"edge {p}-{q} crosses it")
        return found

    def _add(self, a: int, b: int, c: int) -> None:
        for p, q, r in ((a, b, c), (b, c, a), (c, a, b)):
            self.corner[p, q] = r
            self.around.setdefault(p, set()).add(q)

    def _remove(self, a: int, b: int, c: int) -> None:
        for p, q in ((a, b), (b, c), (c, a)):
            del self.corner[p, q]
            self.around[p].discard(q)

    def _turn(self, a: int, b: int, c: int) -> float:
        """Twice the area of a, b, c: positive when they turn left."""
        (ax, ay), (bx, by), (cx, cy) = self.xy[a], self.xy[b], self.xy[c]
        return float((bx - ax) * (cy - ay) - (by - ay) * (cx - ax))


def _crossing(edge: Sequence[int] | Indices, value: str) -> SurfaceError:
    return SurfaceError(
        "The outline of a parameter domain crosses itself",
        where=f"boundary edge {int(edge[0])}-{int(edge[1])}",
        value=value,
        advice="give a shorter edge, or mend the outline in the modeller",
    )
