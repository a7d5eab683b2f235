"""The two diagonal meshes D1 and D2 of a control mesh (Fig. 2 of the paper)."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from gridshell.arrays import Indices, Points, frozen
from gridshell.mesh.control_mesh import ControlMesh
from gridshell.mesh.stars import Stars, diagonal_stars


@dataclass(frozen=True, eq=False)
class DiagonalMesh:
    """A net of two families of polylines: one of the diagonal meshes of a control mesh.

    Parameters
    ----------
    vertices : (n, 3) positions, mm.
    edges : (m, 2) vertex indices.
    family : (m,) 1 or 2, the family of each edge.
    faces : (f, k) vertex indices counter-clockwise, padded with -1: quads around regular vertices.
    stars : neighbours of each vertex, counter-clockwise.
    spoke_edges : (n, k) the edge each spoke belongs to, padded with -1.
    control_vertices : (n,) the control mesh's index of each vertex.
    """

    vertices: Points
    edges: Indices
    family: Indices
    faces: Indices
    stars: Stars
    spoke_edges: Indices
    control_vertices: Indices

    @property
    def mean_edge(self) -> float:
        """Mean edge length, mm."""
        a, b = self.vertices[self.edges.T]
        return float(np.linalg.norm(a - b, axis=1).mean())

    def _repr_html_(self) -> str:
        """For notebooks."""
        from gridshell.mesh.showing import diagonal_mesh_html

        return diagonal_mesh_html(self)


def diagonal_meshes(control: ControlMesh) -> tuple[DiagonalMesh, DiagonalMesh]:
    """D1 and D2: each quad of the control mesh gives one edge to either."""
    stars = diagonal_stars(control.mesh)
    return _diagonal_mesh(control, stars, 0), _diagonal_mesh(control, stars, 1)


def _diagonal_mesh(control: ControlMesh, stars: Stars, colour: int) -> DiagonalMesh:
    quads = control.quads
    first = control.colour[quads[:, 0]] == colour
    edges = np.where(first[:, None], quads[:, [0, 2]], quads[:, [1, 3]])
    used = np.flatnonzero(control.colour == colour)
    local = np.full(len(control.vertices), -1, dtype=np.int64)
    local[used] = np.arange(len(used))
    centres = np.flatnonzero((control.colour == 1 - colour) & stars.closed)
    rings = control.mesh.fans[centres]
    ring_vertices = np.where(rings >= 0, local[control.mesh.target[rings]], -1)
    spokes = stars.spokes[used]
    return DiagonalMesh(
        vertices=frozen(control.vertices[used]),
        edges=frozen(local[edges], np.int64),
        family=frozen(np.where(first, 1, 2), np.int64),
        faces=frozen(ring_vertices, np.int64),
        stars=Stars(
            np.where(spokes >= 0, local[spokes], -1), stars.count[used], stars.closed[used]
        ),
        spoke_edges=frozen(control.mesh.fans[used] // 4, np.int64),
        control_vertices=frozen(used, np.int64),
    )
