"""QuadMesh: a manifold, oriented quad mesh of any topology, and its half-edges.

Half-edge ``h = 4 f + k`` leaves corner ``k`` of quad ``f``: it runs from ``quads[f, k]`` to
``quads[f, k + 1]``. Everything about neighbourhood is read off four arrays over half-edges, so no
function that walks the mesh loops over vertices.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from functools import cached_property

import numpy as np

from gridshell.arrays import Floats, Indices, Mask, Points, frozen
from gridshell.errors import MeshError, NonManifoldError, OrientationError
from gridshell.mesh.parity import alternating_labels


@dataclass(frozen=True, eq=False)
class QuadMesh:
    """A quad mesh that is known to be manifold and oriented.

    Parameters
    ----------
    vertices : (n, 3) positions, mm.
    quads : (f, 4) vertex indices, counter-clockwise seen from the surface's positive side.

    Raises
    ------
    MeshError
        An index out of range, a repeated corner, a coordinate that is not finite.
    NonManifoldError
        An edge with more than two quads, or a vertex where two fans of quads meet.
    OrientationError
        Neighbouring quads with opposite orientation; :func:`oriented` mends what can be mended.
    """

    vertices: Points
    quads: Indices
    _twin: Indices = field(init=False, repr=False)

    def __post_init__(self) -> None:
        _check_whole(self.quads)
        vertices, quads = frozen(self.vertices), frozen(self.quads, np.int64)
        object.__setattr__(self, "vertices", vertices)
        object.__setattr__(self, "quads", quads)
        _check_arrays(vertices, quads)
        object.__setattr__(self, "_twin", frozen(_twins(vertices, quads), np.int64))
        self._check_fans()

    # ---- half-edges -------------------------------------------------------------------------

    @property
    def twin(self) -> Indices:
        """(4f,) the half-edge that runs the other way, -1 on the boundary."""
        return self._twin

    @cached_property
    def origin(self) -> Indices:
        """(4f,) the vertex each half-edge leaves."""
        return self.quads.ravel()

    @cached_property
    def target(self) -> Indices:
        """(4f,) the vertex each half-edge reaches."""
        return np.roll(self.quads, -1, axis=1).ravel()

    @cached_property
    def edges(self) -> Indices:
        """(e, 2) vertex pairs, smaller index first, sorted."""
        pairs = np.sort(np.stack([self.origin, self.target], axis=1), axis=1)
        return frozen(np.unique(pairs, axis=0), np.int64)

    @cached_property
    def valence(self) -> Indices:
        """(n,) quads around each vertex."""
        return np.bincount(self.origin, minlength=len(self.vertices))

    @cached_property
    def on_boundary(self) -> Mask:
        """(n,) whether a vertex lies on a boundary edge."""
        mask = np.zeros(len(self.vertices), dtype=bool)
        open_edges = self.twin < 0
        mask[self.origin[open_edges]] = True
        mask[self.target[open_edges]] = True
        return mask

    @cached_property
    def first_spoke(self) -> Indices:
        """(n,) the half-edge a fan around a vertex starts with, -1 for an unused vertex.

        Clockwise-most on the boundary, the one with the smallest index elsewhere.
        """
        first = np.full(len(self.vertices), -1, dtype=np.int64)
        halfedges = np.arange(len(self.origin))
        first[self.origin[::-1]] = halfedges[::-1]
        open_edges = halfedges[self.twin < 0]
        first[self.origin[open_edges]] = open_edges
        return first

    def next_spoke(self, halfedges: Indices) -> Indices:
        """The next half-edge counter-clockwise around the same origin, -1 past the boundary."""
        previous = previous_in_quad(halfedges)
        return np.where(halfedges < 0, -1, self.twin[previous])

    @cached_property
    def fans(self) -> Indices:
        """(n, largest valence) half-edges around each vertex, counter-clockwise, padded with -1."""
        columns = []
        spoke = self.first_spoke
        for _ in range(int(self.valence.max(initial=0))):
            columns.append(spoke)
            following = np.where(spoke < 0, -1, self.next_spoke(spoke))
            spoke = np.where(following == self.first_spoke, -1, following)
        return np.stack(columns, axis=1)

    @cached_property
    def boundary_loops(self) -> tuple[Indices, ...]:
        """Closed loops of boundary vertices, surface on the left, smallest vertex first."""
        open_edges = np.flatnonzero(self.twin < 0)
        following = dict(
            zip(self.origin[open_edges].tolist(), self.target[open_edges].tolist(), strict=True)
        )
        loops = []
        while following:
            start = min(following)
            loop = [start]
            vertex = following.pop(start)
            while vertex != start:
                loop.append(vertex)
                vertex = following.pop(vertex)
            loops.append(frozen(loop, np.int64))
        return tuple(loops)

    # ---- measures ---------------------------------------------------------------------------

    @cached_property
    def edge_lengths(self) -> Floats:
        """(e,) lengths in the order of :attr:`edges`, mm."""
        a, b = self.vertices[self.edges.T]
        return np.asarray(np.linalg.norm(a - b, axis=1))

    @cached_property
    def mean_edge(self) -> float:
        """Mean edge length, mm."""
        return float(self.edge_lengths.mean())

    @cached_property
    def euler_characteristic(self) -> int:
        """Vertices in use - edges + quads: 1 for a disk, 0 for an annulus."""
        return int(np.count_nonzero(self.valence)) - len(self.edges) + len(self.quads)

    def moved(self, vertices: Points) -> QuadMesh:
        """The same connectivity at other positions."""
        return QuadMesh(vertices, self.quads)

    def _repr_html_(self) -> str:
        """For notebooks."""
        from gridshell.mesh.showing import quad_mesh_html

        return quad_mesh_html(self)

    # ---- checks -----------------------------------------------------------------------------

    def _check_fans(self) -> None:
        reached = np.count_nonzero(self.fans >= 0, axis=1)
        broken = np.flatnonzero(reached != self.valence)
        if len(broken):
            v = int(broken[0])
            raise NonManifoldError(
                "Two fans of quads meet in one vertex",
                where=f"vertex {v} {position(self.vertices[v])}",
                value=f"{self.valence[v]} quads in more than one fan",
                limit="one fan",
                advice="split the vertex, remove what touches only there, mend a T-junction, or "
                "weld vertices that lie almost in one place",
            )


def previous_in_quad(halfedges: Indices) -> Indices:
    """The half-edge before each one in its own quad."""
    return np.where(halfedges % 4 == 0, halfedges + 3, halfedges - 1)


def next_in_quad(halfedges: Indices) -> Indices:
    """The half-edge after each one in its own quad."""
    return np.where(halfedges % 4 == 3, halfedges - 3, halfedges + 1)


def oriented(vertices: Points, quads: Indices) -> QuadMesh:
    """A QuadMesh from quads whose orientation may differ from face to face.

    The first quad of every component keeps its orientation.

    Raises
    ------
    OrientationError
        When no consistent orientation exists (a Moebius strip).
    """
    vertices, quads = frozen(vertices), np.array(quads, dtype=np.int64)
    _check_arrays(vertices, quads)
    origin, target = quads.ravel(), np.roll(quads, -1, axis=1).ravel()
    key = np.minimum(origin, target) * len(vertices) + np.maximum(origin, target)
    order = np.argsort(key, kind="stable")
    _check_edge_counts(vertices, key[order], order)
    same = np.flatnonzero(key[order][1:] == key[order][:-1])
    a, b = order[same], order[same + 1]
    clash = origin[a] == origin[b]
    flip = alternating_labels(len(quads), a // 4, b // 4, clash)
    broken = np.flatnonzero((flip[a // 4] != flip[b // 4]) != clash)
    if len(broken):
        f = int(a[broken[0]] // 4)
        raise OrientationError(
            "The mesh cannot be oriented: walking around it turns the surface over",
            where=f"quad {f} {position(vertices[quads[f]].mean(axis=0))}",
            limit="a two-sided surface",
            advice="cut the strip open there",
        )
    quads[flip == 1] = quads[flip == 1][:, ::-1]
    return QuadMesh(vertices, quads)


def position(point: Floats) -> str:
    """A position as people read it: ``(x, y, z) mm``."""
    return "({:.6g}, {:.6g}, {:.6g}) mm".format(*point)


def _check_whole(quads: Indices) -> None:
    values = np.asarray(quads)
    if values.dtype.kind not in "iu" and (values != np.floor(values)).any():
        raise MeshError("Vertex indices must be whole numbers", value=f"{values.dtype}")


def _check_arrays(vertices: Points, quads: Indices) -> None:
    if vertices.ndim != 2 or vertices.shape[1] != 3:
        raise MeshError("Vertices need shape (n, 3)", value=str(vertices.shape))
    if quads.ndim != 2 or quads.shape[1] != 4 or len(quads) == 0:
        raise MeshError(
            "Quads need shape (f, 4) with at least one quad",
            value=str(quads.shape),
            advice="use a mesh of quadrilaterals",
        )
    bad = np.flatnonzero(~np.isfinite(vertices).all(axis=1))
    if len(bad):
        v = int(bad[0])
        raise MeshError("A coordinate is not a number", where=f"vertex {v}", value=str(vertices[v]))
    bad = np.flatnonzero(((quads < 0) | (quads >= len(vertices))).any(axis=1))
    if len(bad):
        f = int(bad[0])
        raise MeshError(
            "A quad names a vertex that does not exist",
            where=f"quad {f}",
            value=str(quads[f].tolist()),
            limit=f"0 .. {len(vertices) - 1}",
        )
    ordered = np.sort(quads, axis=1)
    bad = np.flatnonzero((ordered[:, 1:] == ordered[:, :-1]).any(axis=1))
    if len(bad):
        f = int(bad[0])
        raise MeshError(
            "A quad uses one vertex twice",
            where=f"quad {f} {position(vertices[quads[f]].mean(axis=0))}",
            value=str(quads[f].tolist()),
            advice="remove the degenerate quad",
        )


def _check_edge_counts(vertices: Points, sorted_keys: Indices, order: Indices) -> None:
    triple = np.flatnonzero(sorted_keys[2:] == sorted_keys[:-2])
    if len(triple) == 0:
        return
    i = int(triple[0])
    a, b = divmod(int(sorted_keys[i]), len(vertices))
    faces = np.sort(order[sorted_keys == sorted_keys[i]] // 4).tolist()
    raise NonManifoldError(
        "An edge belongs to more than two quads",
        where=f"edge {a}-{b} {position((vertices[a] + vertices[b]) / 2)}, quads {faces}",
        value=f"{len(faces)} quads",
        limit="2 quads",
        advice="split the mesh along that edge",
    )


def _twins(vertices: Points, quads: Indices) -> Indices:
    origin, target = quads.ravel(), np.roll(quads, -1, axis=1).ravel()
    key = np.minimum(origin, target) * len(vertices) + np.maximum(origin, target)
    order = np.argsort(key, kind="stable")
    ordered = key[order]
    _check_edge_counts(vertices, ordered, order)
    pair = np.flatnonzero(ordered[1:] == ordered[:-1])
    a, b = order[pair], order[pair + 1]
    same_way = np.flatnonzero(origin[a] == origin[b])
    if len(same_way):
        f, g = sorted((int(a[same_way[0]]) // 4, int(b[same_way[0]]) // 4))
        raise OrientationError(
            "Neighbouring quads face opposite sides",
            where=f"quads {f} and {g} {position(vertices[quads[f]].mean(axis=0))}",
            limit="one orientation",
            advice="reverse one of them, or read the mesh with gridshell.oriented()",
        )
    twin = np.full(quads.size, -1, dtype=np.int64)
    twin[a], twin[b] = b, a
    return twin
