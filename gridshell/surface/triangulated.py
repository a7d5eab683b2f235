"""A surface given as triangles: exact closest points, interpolated normals, curvature per triangle.

Closest points on triangles after C. Ericson, Real-Time Collision Detection, section 5.1.5.
Curvature from the differences of vertex normals after S. Rusinkiewicz, Estimating curvatures and
their derivatives on triangle meshes, 3DPVT 2004.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Any, NamedTuple

import numpy as np

from gridshell.arrays import Floats, Indices, Points, Vectors, frozen, unit
from gridshell.errors import SurfaceError
from gridshell.surface.forms import dot
from gridshell.surface.surface import Foot, checked_points, checked_triangles

_FIRST_CANDIDATES = 8
_UNUSUAL = 1.5
"""Times the median reach of the triangles: what reaches further is quartered for the search."""

_MOST_PIECES = 4
"""Pieces per triangle at most, when the triangles differ much in size."""

_BLOCK = 200_000
"""Pairs of point and triangle looked at together: bounds the memory."""


@dataclass(frozen=True, eq=False)
class TriangulatedSurface:
    """Triangles whose normals are interpolated between the vertices.

    Parameters
    ----------
    vertices : (n, 3) mm.
    triangles : (f, 3) vertex indices, counter-clockwise seen from the positive side.

    Raises
    ------
    SurfaceError
        For no triangles, a triangle without area, or an index outside the vertices.
    """

    vertices: Points
    triangles: Indices

    def __post_init__(self) -> None:
        object.__setattr__(self, "vertices", frozen(checked_points(self.vertices)))
        triangles = checked_triangles(self.triangles, len(self.vertices))
        object.__setattr__(self, "triangles", triangles)
        area = np.linalg.norm(self._crosses, axis=1)
        size = float(np.ptp(self.vertices, axis=0).max())
        empty = np.flatnonzero(area <= 1e-14 * size**2)
        if len(empty):
            raise SurfaceError(
                "A triangle has no area",
                where=f"triangle {empty[0]}",
                value=f"{len(empty)} such triangles",
                advice="remove degenerate triangles in the modeller",
            )

    @classmethod
    def of_quads(cls, vertices: Points, quads: Indices) -> TriangulatedSurface:
        """Both halves of every quad (f, 4)."""
        halves = np.concatenate([quads[:, [0, 1, 2]], quads[:, [0, 2, 3]]])
        used, compact = np.unique(halves, return_inverse=True)
        return cls(vertices[used], compact.reshape(-1, 3))

    def closest(self, points: Points) -> Foot:
        """Find the feet of *points* (n, 3), mm."""
        points = checked_points(points)
        triangle, weights = self.locate(points)
        corners = self.triangles[triangle]
        feet = np.einsum("nk,nkc->nc", weights, self.vertices[corners])
        normals = unit(np.einsum("nk,nkc->nc", weights, self._vertex_normals[corners]))
        return Foot(feet, normals, self._curvatures[triangle])

    def locate(self, points: Points) -> tuple[Indices, Floats]:
        """Nearest triangle (n,) and barycentric weights (n, 3) of the foot in it.

        Candidates are the triangles of the nearest middles; a foot is final when no triangle of one
        further away can reach closer, and otherwise looked for among twice as many.
        """
        middles = self._middles
        best = np.zeros(len(points), dtype=np.int64)
        weights = np.zeros((len(points), 3))
        most = len(middles.owner)
        rows, count = np.arange(len(points)), min(_FIRST_CANDIDATES, most)
        while len(rows):
            unsure = []
            for block in np.array_split(rows, max(1, len(rows) * count // _BLOCK)):
                away, near = middles.tree.query(points[block], k=count)
                away = away.reshape(len(block), -1)
                near = middles.owner[near.reshape(len(block), -1)]
                share, distance = self.nearest_in(points[block], near)
                pick = np.argmin(distance, axis=1)
                line = np.arange(len(block))
                best[block], weights[block] = near[line, pick], share[line, pick]
                reach = distance[line, pick] + middles.reach
                unsure.append(block[(away[:, -1] < reach) & (count < most)])
            rows, count = np.concatenate(unsure), min(2 * count, most)
        return best, weights

    def nearest_in(self, points: Points, near: Indices) -> tuple[Floats, Floats]:
        """Barycentric weights (n, k, 3) and distances (n, k) in candidate triangles (n, k)."""
        corners = self.vertices[self.triangles[near]]
        weights = _barycentric(points[:, None], corners)
        feet = np.einsum("nkj,nkjc->nkc", weights, corners)
        return weights, np.linalg.norm(points[:, None] - feet, axis=2)

    # ---- what is asked of every triangle -------------------------------------------------------

    @cached_property
    def _crosses(self) -> Floats:
        a, b, c = np.moveaxis(self.vertices[self.triangles], 1, 0)
        return np.asarray(np.cross(b - a, c - a))

    @cached_property
    def _middles(self) -> _Middles:
        return _middles(self.vertices[self.triangles])

    @cached_property
    def _vertex_normals(self) -> Vectors:
        """(n, 3) weighted by angle, so that they do not depend on how faces are cut."""
        corners = self.vertices[self.triangles]
        ahead = unit(np.roll(corners, -1, axis=1) - corners)
        behind = -np.roll(ahead, 1, axis=1)
        angle = np.arccos(np.clip(dot(ahead, behind), -1.0, 1.0))
        pull = angle[..., None] * unit(self._crosses)[:, None]
        total = np.stack(
            [
                np.bincount(self.triangles.ravel(), pull[..., c].ravel(), len(self.vertices))
                for c in range(3)
            ],
            axis=1,
            dtype=np.float64,
        )
        return unit(total)

    @cached_property
    def _curvatures(self) -> Floats:
        """(f, 2) principal curvatures of every triangle, 1/mm."""
        corners, normals = self.vertices[self.triangles], self._vertex_normals[self.triangles]
        edges = np.roll(corners, -1, axis=1) - corners
        turns = np.roll(normals, -1, axis=1) - normals
        e1 = unit(edges[:, 0])
        e2 = np.cross(unit(self._crosses), e1)
        x, y = dot(edges, e1[:, None]), dot(edges, e2[:, None])
        tx, ty = -dot(turns, e1[:, None]), -dot(turns, e2[:, None])
        zero = np.zeros_like(x)
        rows = np.concatenate(
            [np.stack([x, y, zero], axis=-1), np.stack([zero, x, y], axis=-1)], axis=1
        )
        right = np.concatenate([tx, ty], axis=1)
        gram = np.einsum("fri,frj->fij", rows, rows)
        a, b, c = np.linalg.solve(gram, np.einsum("fri,fr->fi", rows, right)[..., None])[..., 0].T
        mean, half = (a + c) / 2.0, np.hypot((a - c) / 2.0, b)
        return np.stack([mean - half, mean + half], axis=-1)


class _Middles(NamedTuple):
    """Middles of triangles, and of the pieces of those much larger than the others."""

    tree: Any
    owner: Indices
    """(m,) the triangle each middle belongs to."""
    reach: float
    """No point of a piece is further from its middle, mm."""


def _middles(corners: Floats) -> _Middles:
    """Quarter the triangles (f, 3, 3) that reach far, so that one reach holds for all closely."""
    from scipy.spatial import cKDTree

    pieces, owner = corners, np.arange(len(corners))
    usual = _UNUSUAL * float(np.median(_reaches(corners)))
    while len(pieces) < _MOST_PIECES * len(corners):
        large = _reaches(pieces) > usual
        if not large.any():
            break
        a, b, c = np.moveaxis(pieces[large], 1, 0)
        ab, bc, ca = (a + b) / 2.0, (b + c) / 2.0, (c + a) / 2.0
        quarters = [(a, ab, ca), (ab, b, bc), (ca, bc, c), (ab, bc, ca)]
        split = [np.stack(quarter, axis=1) for quarter in quarters]
        pieces = np.concatenate([pieces[~large], *split])
        owner = np.concatenate([owner[~large], np.tile(owner[large], 4)])
    return _Middles(cKDTree(pieces.mean(axis=1)), owner, float(_reaches(pieces).max()))


def _reaches(corners: Floats) -> Floats:
    """(f,) largest distance of a corner from the middle of its triangle, mm."""
    offset = corners - corners.mean(axis=1, keepdims=True)
    return np.asarray(np.linalg.norm(offset, axis=2).max(axis=1))


def _barycentric(points: Points, corners: Floats) -> Floats:
    """(..., 3) weights of the closest points in triangles (..., 3, 3): inside, edge or corner."""
    a, b, c = np.moveaxis(corners, -2, 0)
    inside = _plane_weights(points, a, b, c)
    best, found = inside, np.where((inside >= 0.0).all(axis=-1), 0.0, np.inf)
    for i, j in ((0, 1), (1, 2), (2, 0)):
        start, along = corners[..., i, :], corners[..., j, :] - corners[..., i, :]
        share = np.clip(dot(points - start, along) / dot(along, along), 0.0, 1.0)
        offset = points - start - share[..., None] * along
        weights = np.zeros_like(inside)
        weights[..., i], weights[..., j] = 1.0 - share, share
        closer = dot(offset, offset) < np.where(found == 0.0, -1.0, found)
        best = np.where(closer[..., None], weights, best)
        found = np.where(closer, dot(offset, offset), found)
    return best


def _plane_weights(points: Points, a: Points, b: Points, c: Points) -> Floats:
    """Barycentric weights of the foot in the triangle's plane; negative outside of it."""
    ab, ac, ap = b - a, c - a, points - a
    d00, d01, d11 = dot(ab, ab), dot(ab, ac), dot(ac, ac)
    d20, d21 = dot(ap, ab), dot(ap, ac)
    determinant = d00 * d11 - d01 * d01
    v = (d11 * d20 - d01 * d21) / determinant
    w = (d00 * d21 - d01 * d20) / determinant
    return np.stack([1.0 - v - w, v, w], axis=-1)
