"""Vertex stars: a vertex and its neighbours along the edges or along the diagonals."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from gridshell.arrays import Indices, Mask
from gridshell.mesh.quad_mesh import QuadMesh, previous_in_quad


@dataclass(frozen=True, eq=False)
class Stars:
    """Stars of all vertices of a mesh.

    Parameters
    ----------
    spokes : (n, k) neighbours of each vertex, counter-clockwise, padded with -1.
    count : (n,) neighbours of each vertex.
    closed : (n,) whether the spokes go all the way around.
    """

    spokes: Indices
    count: Indices
    closed: Mask

    def regular(self) -> Indices:
        """Vertices with four spokes whose opposite ones continue each other."""
        return np.flatnonzero(self.count == 4)

    def continuations(self) -> Indices:
        """(m, 3) rows (neighbour, vertex, opposite neighbour) of polylines that run through.

        Spokes i and i + 2 continue each other in a star of four, and in an open star of three
        spokes or more than that of an edge star's boundary vertex. Polylines end in singular
        vertices and at corners.
        """
        four = np.flatnonzero(self.count == 4)
        three = np.flatnonzero((self.count == 3) & ~self.closed)
        centre = np.concatenate([four, four, three])
        before = np.concatenate([self.spokes[four, :2].T.ravel(), self.spokes[three, 0]])
        after = np.concatenate([self.spokes[four, 2:4].T.ravel(), self.spokes[three, 2]])
        return np.stack([before, centre, after], axis=1)


def diagonal_stars(mesh: QuadMesh) -> Stars:
    """Stars of the diagonal meshes: the opposite corners of the quads around each vertex."""
    fans = mesh.fans
    face, corner = fans // 4, fans % 4
    opposite = mesh.quads[face, (corner + 2) % 4]
    spokes = np.where(fans >= 0, opposite, -1)
    return Stars(spokes, mesh.valence, ~mesh.on_boundary & (mesh.valence > 0))


def edge_stars(mesh: QuadMesh) -> Stars:
    """Stars of the mesh itself: the ends of the edges at each vertex."""
    fans = mesh.fans
    n, width = fans.shape
    spokes = np.full((n, width + 1), -1, dtype=np.int64)
    spokes[:, :width] = np.where(fans >= 0, mesh.target[fans], -1)
    rim = np.flatnonzero(mesh.on_boundary)
    last = fans[rim, mesh.valence[rim] - 1]
    spokes[rim, mesh.valence[rim]] = mesh.origin[previous_in_quad(last)]
    count = mesh.valence + mesh.on_boundary
    keep = int(count.max(initial=0))
    return Stars(spokes[:, :keep], count, ~mesh.on_boundary & (mesh.valence > 0))
