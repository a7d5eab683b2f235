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
    spokes : (n, k >= 4) neighbours of each vertex, counter-clockwise, padded with -1.
    count : (n,) neighbours of each vertex.
    closed : (n,) whether the spokes go all the way around.
    """

    spokes: Indices
    count: Indices
    closed: Mask

    def regular(self) -> Indices:
        """Vertices with four spokes whose opposite ones continue each other."""
        return np.flatnonzero(self.count == 4)

    def through(self) -> Indices:
        """(m, 3) rows (vertex, slot, opposite slot) of the spokes that continue each other.

        Spokes i and i + 2 do in a star of four, and the outer two in an open star of three.
        Polylines end in singular vertices and at corners.
        """
        four = np.flatnonzero(self.count == 4)
        three = np.flatnonzero((self.count == 3) & ~self.closed)
        centre = np.concatenate([four, four, three])
        slot = np.repeat([0, 1, 0], [len(four), len(four), len(three)])
        return np.stack([centre, slot, slot + 2], axis=1)

    def continuations(self) -> Indices:
        """(m, 3) rows (neighbour, vertex, opposite neighbour) of polylines that run through."""
        centre, slot, opposite = self.through().T
        return np.stack([self.spokes[centre, slot], centre, self.spokes[centre, opposite]], axis=1)


def diagonal_stars(mesh: QuadMesh) -> Stars:
    """Stars of the diagonal meshes: the opposite corners of the quads around each vertex."""
    fans = mesh.fans
    face, corner = fans // 4, fans % 4
    opposite = mesh.quads[face, (corner + 2) % 4]
    spokes = _padded(np.where(fans >= 0, opposite, -1))
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
    return Stars(_padded(spokes[:, :keep]), count, ~mesh.on_boundary & (mesh.valence > 0))


def _padded(spokes: Indices) -> Indices:
    """At least four columns, so that a net without a regular star has slots for one."""
    missing = max(0, 4 - spokes.shape[1])
    return np.pad(spokes, ((0, 0), (0, missing)), constant_values=-1)
