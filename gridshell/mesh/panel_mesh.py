"""PanelMesh: flat panels, the edges between them, and an axis at every node.

Do not confuse: a *panel mesh* is a skin that is built, with polygons of any number of corners and
node axes; a *quad mesh* or *control mesh* is what is optimised.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from gridshell.arrays import Floats, Indices, Mask, Points, Vectors, frozen, unit
from gridshell.errors import MeshError, NonManifoldError
from gridshell.mesh.quad_mesh import position


@dataclass(frozen=True, eq=False)
class PanelMesh:
    """A skin of panels; build it with ``skin`` or :func:`panel_mesh`.

    Parameters
    ----------
    vertices : (n, 3) nodes, mm.
    faces : (f, k) vertex indices, counter-clockwise, padded with -1.
    axes : (n, 3) unit node axes, on the counter-clockwise side.
    partial : (n,) nodes whose axis comes from an incomplete ring, at the rim of the net.
    black : (f,) the black parallelograms of the checkerboard pattern.
    edges : (m, 2) vertex pairs, smaller index first, sorted.
    edge_faces : (m, 2) the panel left of the edge, the panel right of it; -1 for none.
    face_edges : (f, k) the edge from each corner to the next, padded with -1.
    """

    vertices: Points
    faces: Indices
    axes: Vectors
    partial: Mask
    black: Mask
    edges: Indices
    edge_faces: Indices
    face_edges: Indices

    @cached_property
    def corners(self) -> Indices:
        """(f,) number of corners of each panel."""
        return np.asarray(np.count_nonzero(self.faces >= 0, axis=1))

    @cached_property
    def boundary(self) -> Mask:
        """(n,) nodes on an edge with one panel."""
        mask = np.zeros(len(self.vertices), dtype=bool)
        mask[self.edges[(self.edge_faces < 0).any(axis=1)]] = True
        return mask

    @cached_property
    def edge_lengths(self) -> Floats:
        """(m,) mm."""
        a, b = self.vertices[self.edges.T]
        return np.asarray(np.linalg.norm(b - a, axis=1))

    def corner_points(self, face: int) -> Points:
        """(k, 3) the corners of one panel, mm."""
        return np.asarray(self.vertices[self.faces[face, : self.corners[face]]])

    def normals(self) -> Vectors:
        """(f, 3) unit normals of the panels: the direction of their area."""
        return unit(area_vectors(self.vertices, self.faces))

    def with_axes(self, axes: Vectors) -> PanelMesh:
        """The same skin with other node axes (n, 3), none of them from a partial ring."""
        return panel_mesh(self.vertices, self.faces, axes, black=self.black)

    def _repr_html_(self) -> str:
        """For notebooks."""
        from gridshell.mesh.showing import panel_mesh_html

        return panel_mesh_html(self)


def panel_mesh(
    vertices: Points,
    faces: Indices,
    axes: Vectors,
    *,
    partial: Mask | None = None,
    black: Mask | None = None,
) -> PanelMesh:
    """Panels from corners and node axes; vertices that no panel uses are left out.

    Parameters
    ----------
    vertices, axes : (n, 3); the axes need not be unit.
    faces : (f, k) padded with -1 behind the last corner.
    partial, black : (n,) and (f,); nowhere unless said otherwise.

    Raises
    ------
    MeshError
        For a mesh without panels, an axis of length nought, or a value that is not a number.
    NonManifoldError
        Where more than two panels share an edge, or two run along it in the same direction.
    """
    faces = np.asarray(faces, dtype=np.int64)
    if faces.ndim != 2 or len(faces) == 0:
        raise MeshError(
            "The net is too small to hold a single panel",
            value=f"{len(faces)} panels",
            advice="a finer mesh, or another skin",
        )
    used, compact = np.unique(faces[faces >= 0], return_inverse=True)
    local = np.full(faces.shape, -1, dtype=np.int64)
    local[faces >= 0] = compact.ravel()
    points, directions = vertices[used], unit(np.asarray(axes, dtype=np.float64)[used])
    _check_numbers(points, directions)
    edges, edge_faces, face_edges = _edges(points, local)
    none = np.zeros(len(vertices), dtype=bool)
    return PanelMesh(
        vertices=frozen(points),
        faces=frozen(local, np.int64),
        axes=frozen(directions),
        partial=frozen((none if partial is None else partial)[used], bool),
        black=frozen(np.zeros(len(faces)) if black is None else black, bool),
        edges=frozen(edges, np.int64),
        edge_faces=frozen(edge_faces, np.int64),
        face_edges=frozen(face_edges, np.int64),
    )


def averaged_normals(mesh: PanelMesh) -> Vectors:
    """(n, 3) the classical node axes: unit panel normals, averaged around every node."""
    total = np.zeros_like(mesh.vertices)
    inside = mesh.faces >= 0
    np.add.at(total, mesh.faces[inside], np.repeat(mesh.normals(), mesh.corners, axis=0))
    return unit(total)


def area_vectors(vertices: Points, polygons: Indices) -> Floats:
    """(f, 3) area vectors of polygons (f, k), padded with -1, mm2; whole also where they bend."""
    inside = polygons >= 0
    first = vertices[polygons[:, :1]]
    arms = np.where(inside[..., None], vertices[polygons] - first, 0.0)
    # beyond the last corner the arms are nought, as the first one's is
    return np.asarray(np.cross(arms[:, :-1], arms[:, 1:]).sum(axis=1) / 2.0)


def _edges(points: Points, faces: Indices) -> tuple[Indices, Indices, Indices]:
    inside = faces >= 0
    following = np.roll(faces, -1, axis=1)
    rows = np.arange(len(faces))
    following[rows, np.count_nonzero(inside, axis=1) - 1] = faces[:, 0]
    face, slot = np.nonzero(inside)
    origin, target = faces[inside], following[inside]
    ends = np.stack([np.minimum(origin, target), np.maximum(origin, target)], axis=1)
    edges, name = np.unique(ends, axis=0, return_inverse=True)
    side = (origin > target).astype(np.int64)
    taken = np.bincount(2 * name.ravel() + side, minlength=2 * len(edges))
    if (taken > 1).any():
        i, j = edges[int(np.argmax(taken)) // 2]
        raise NonManifoldError(
            "Panels overlap along an edge",
            where=f"edge {i}-{j} {position((points[i] + points[j]) / 2.0)}",
            limit="one panel on either side",
        )
    edge_faces = np.full((len(edges), 2), -1, dtype=np.int64)
    edge_faces[name.ravel(), side] = face
    face_edges = np.full(faces.shape, -1, dtype=np.int64)
    face_edges[face, slot] = name.ravel()
    return edges, edge_faces, face_edges


def _check_numbers(points: Points, axes: Vectors) -> None:
    good = np.isfinite(points).all(axis=1) & (np.abs(np.linalg.norm(axes, axis=1) - 1.0) < 1e-6)
    bad = np.flatnonzero(~good)
    if len(bad):
        v = int(bad[0])
        raise MeshError(
            "A node has no axis, or no place",
            where=f"node {v} {position(points[v])}",
            value=str(axes[v].tolist()),
            limit="finite numbers, an axis that is not nought",
            advice="a net without degenerate quads",
        )
