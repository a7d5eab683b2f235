"""TriangleMesh: a manifold, oriented triangle mesh and its half-edges.

Half-edge ``h = 3 f + k`` leaves corner ``k`` of triangle ``f``: it runs from ``triangles[f, k]`` to
``triangles[f, k + 1]``. Everything about neighbourhood is read off four arrays over half-edges.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from functools import cached_property

import numpy as np

from gridshell.arrays import Floats, Indices, Mask, Points, Vectors, frozen, unit
from gridshell.errors import SurfaceError
from gridshell.surface.surface import checked_points, checked_triangles


@dataclass(frozen=True, eq=False)
class TriangleMesh:
    """Triangles that are known to be manifold and oriented; every vertex is used.

    Parameters
    ----------
    vertices : (n, 3) positions, mm.
    triangles : (f, 3) vertex indices, counter-clockwise seen from the positive side.

    Raises
    ------
    SurfaceError
        An index out of range, a vertex that no triangle uses, an edge with more than two triangles
        or with two of opposite orientation, a vertex where two fans of triangles meet.
    """

    vertices: Points
    triangles: Indices
    twin: Indices = field(init=False, repr=False)
    """(3f,) the half-edge that runs the other way, -1 on the boundary."""

    def __post_init__(self) -> None:
        object.__setattr__(self, "vertices", frozen(checked_points(self.vertices)))
        triangles = checked_triangles(self.triangles, len(self.vertices))
        object.__setattr__(self, "triangles", triangles)
        object.__setattr__(self, "twin", frozen(self._twins(), np.int64))
        self._check_fans()

    # ---- half-edges -------------------------------------------------------------------------

    @cached_property
    def origin(self) -> Indices:
        """(3f,) the vertex each half-edge leaves."""
        return self.triangles.ravel()

    @cached_property
    def target(self) -> Indices:
        """(3f,) the vertex each half-edge reaches."""
        return np.roll(self.triangles, -1, axis=1).ravel()

    @cached_property
    def on_boundary(self) -> Mask:
        """(n,) whether a vertex lies on a boundary edge."""
        mask = np.zeros(len(self.vertices), dtype=bool)
        open_edges = self.twin < 0
        mask[self.origin[open_edges]] = True
        mask[self.target[open_edges]] = True
        return mask

    @cached_property
    def valence(self) -> Indices:
        """(n,) triangles around each vertex."""
        return np.bincount(self.origin, minlength=len(self.vertices))

    @cached_property
    def first_spoke(self) -> Indices:
        """(n,) the half-edge a fan around a vertex starts with: clockwise-most on the boundary."""
        first = np.full(len(self.vertices), -1, dtype=np.int64)
        halfedges = np.arange(len(self.origin))
        first[self.origin[::-1]] = halfedges[::-1]
        open_edges = halfedges[self.twin < 0]
        first[self.origin[open_edges]] = open_edges
        return first

    @cached_property
    def fans(self) -> Indices:
        """(n, largest valence) half-edges around each vertex, counter-clockwise, padded with -1."""
        columns = []
        spoke = self.first_spoke
        for _ in range(int(self.valence.max(initial=0))):
            columns.append(spoke)
            following = np.where(spoke < 0, -1, self.twin[before(spoke)])
            spoke = np.where(following == self.first_spoke, -1, following)
        return np.stack(columns, axis=1)

    @cached_property
    def boundary_loops(self) -> tuple[Indices, ...]:
        """Closed loops of boundary half-edges in walking order, surface on the left."""
        open_edges = np.flatnonzero(self.twin < 0)
        leaving = dict(zip(self.origin[open_edges].tolist(), open_edges.tolist(), strict=True))
        loops = []
        while leaving:
            start = min(leaving)
            loop = [leaving.pop(start)]
            while (vertex := int(self.target[loop[-1]])) != start:
                loop.append(leaving.pop(vertex))
            loops.append(frozen(loop, np.int64))
        return tuple(loops)

    # ---- measures ---------------------------------------------------------------------------

    @cached_property
    def corners(self) -> Floats:
        """(f, 3, 3) positions of the corners of every triangle, mm."""
        return np.asarray(self.vertices[self.triangles])

    @cached_property
    def face_normals(self) -> Vectors:
        """(f, 3) unit normals."""
        return unit(self._crosses)

    @cached_property
    def areas(self) -> Floats:
        """(f,) mm2."""
        return np.asarray(np.linalg.norm(self._crosses, axis=1) / 2.0)

    @cached_property
    def centroids(self) -> Points:
        """(f, 3) mm."""
        return np.asarray(self.corners.mean(axis=1))

    @cached_property
    def face_frames(self) -> Floats:
        """(f, 3, 3) rows: along edge 0, across it in the triangle's plane, normal; right-handed."""
        first = unit(self.corners[:, 1] - self.corners[:, 0])
        return np.stack([first, np.cross(self.face_normals, first), self.face_normals], axis=1)

    @cached_property
    def flat_corners(self) -> Floats:
        """(f, 3, 2) corners in the face's frame, the first at the origin, mm."""
        offset = self.corners - self.corners[:, :1]
        return np.asarray(np.einsum("fkc,fic->fki", offset, self.face_frames[:, :2]))

    @cached_property
    def edge_lengths(self) -> Floats:
        """(3f,) length of every half-edge, mm."""
        return np.asarray(
            np.linalg.norm(self.vertices[self.target] - self.vertices[self.origin], axis=1)
        )

    @cached_property
    def mean_edge(self) -> float:
        """Mean length over the edges, mm."""
        once = (self.twin < 0) | (np.arange(len(self.twin)) < self.twin)
        return float(self.edge_lengths[once].mean())

    @cached_property
    def vertex_normals(self) -> Vectors:
        """(n, 3) unit normals weighted by angle: they do not depend on how faces are cut."""
        ahead = unit(np.roll(self.corners, -1, axis=1) - self.corners)
        behind = -np.roll(ahead, 1, axis=1)
        angle = np.arccos(np.clip(np.einsum("fkc,fkc->fk", ahead, behind), -1.0, 1.0))
        pull = angle[..., None] * self.face_normals[:, None]
        total = [
            np.bincount(self.origin, pull[..., c].ravel(), len(self.vertices)) for c in range(3)
        ]
        return unit(np.stack(total, axis=1))

    @cached_property
    def euler_characteristic(self) -> int:
        """Vertices - edges + triangles: 1 for a disk, 0 for an annulus."""
        edges = (len(self.twin) + int(np.count_nonzero(self.twin < 0))) // 2
        return len(self.vertices) - edges + len(self.triangles)

    @cached_property
    def _crosses(self) -> Floats:
        a, b, c = np.moveaxis(self.corners, 1, 0)
        return np.asarray(np.cross(b - a, c - a))

    # ---- checks -----------------------------------------------------------------------------

    def _twins(self) -> Indices:
        n = len(self.vertices)
        key = np.minimum(self.origin, self.target) * n + np.maximum(self.origin, self.target)
        order = np.argsort(key, kind="stable")
        ordered = key[order]
        triple = np.flatnonzero(ordered[2:] == ordered[:-2])
        if len(triple):
            h = int(order[triple[0]])
            raise SurfaceError(
                "An edge belongs to more than two triangles",
                where=self._edge(h),
                value=f"{int((ordered == ordered[triple[0]]).sum())} triangles",
                limit="2 triangles",
                advice="split the mesh along that edge, or remove the doubled faces",
            )
        pair = np.flatnonzero(ordered[1:] == ordered[:-1])
        a, b = order[pair], order[pair + 1]
        same_way = np.flatnonzero(self.origin[a] == self.origin[b])
        if len(same_way):
            h = int(a[same_way[0]])
            raise SurfaceError(
                "Neighbouring triangles face opposite sides",
                where=self._edge(h),
                value=f"{len(same_way)} such edges",
                limit="one orientation",
                advice="unify the normals in the modeller",
            )
        twin = np.full(len(self.origin), -1, dtype=np.int64)
        twin[a], twin[b] = b, a
        return twin

    def _check_fans(self) -> None:
        unused = np.flatnonzero(self.valence == 0)
        if len(unused):
            raise SurfaceError(
                "A vertex belongs to no triangle",
                where=f"vertex {unused[0]} {place(self.vertices[unused[0]])}",
                value=f"{len(unused)} such vertices",
                advice="remove loose vertices",
            )
        reached = np.count_nonzero(self.fans >= 0, axis=1)
        broken = np.flatnonzero(reached != self.valence)
        if len(broken):
            v = int(broken[0])
            raise SurfaceError(
                "Two fans of triangles meet in one vertex",
                where=f"vertex {v} {place(self.vertices[v])}",
                value=f"{self.valence[v]} triangles in more than one fan",
                limit="one fan",
                advice="split the vertex, or remove what touches only there",
            )

    def _edge(self, halfedge: int) -> str:
        a, b = int(self.origin[halfedge]), int(self.target[halfedge])
        return f"edge {a}-{b} {place((self.vertices[a] + self.vertices[b]) / 2.0)}"


def after(halfedges: Indices) -> Indices:
    """The half-edge after each one in its own triangle."""
    return np.where(halfedges % 3 == 2, halfedges - 2, halfedges + 1)


def before(halfedges: Indices) -> Indices:
    """The half-edge before each one in its own triangle."""
    return np.where(halfedges % 3 == 0, halfedges + 2, halfedges - 1)


def place(point: Floats) -> str:
    """A position as people read it: ``(x, y, z) mm``."""
    return "({:.6g}, {:.6g}, {:.6g}) mm".format(*point)
