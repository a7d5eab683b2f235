"""Quads that are turned over or squeezed flat, and the guard that keeps the solver from making one.

At each corner of a quad the sine of its angle is signed by the quad's own normal (the cross
product of its diagonals): negative where the corner points inwards or the quad is folded over. Two
quads that share an edge are folded onto each other where their normals point to opposite sides.
"""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np

from gridshell.arrays import Floats, Indices, Mask, unit
from gridshell.mesh import QuadMesh

LEAST_SINE = 0.02
"""Of a corner's angle; below it a quad counts as collapsed (1.1 degrees)."""

SHORTEST_EDGE = 0.01
"""Over the mean edge of the mesh at the start; below it a quad counts as collapsed."""


def corner_sines(vertices: Floats, quads: Indices) -> Floats:
    """(m, 4) signed sine of the angle at every corner; 0 where an edge has no length."""
    corners = vertices[quads]
    ahead = unit(np.roll(corners, -1, axis=1) - corners)
    normal = _normals(corners)
    behind = -np.roll(ahead, 1, axis=1)
    return np.asarray(np.einsum("mkc,mc->mk", np.cross(ahead, behind), normal))


def corner_angles(vertices: Floats, quads: Indices) -> Floats:
    """(m, 4) angle at every corner between its two edges, radians."""
    corners = vertices[quads]
    ahead = np.roll(corners, -1, axis=1) - corners
    behind = -np.roll(ahead, 1, axis=1)
    across = np.linalg.norm(np.cross(ahead, behind), axis=2)
    return np.asarray(np.arctan2(across, np.einsum("mkc,mkc->mk", ahead, behind)))


def collapsed(vertices: Floats, quads: Indices, mean_edge: float) -> Mask:
    """(m,) whether a quad is turned over, concave, or squeezed to a sliver."""
    corners = vertices[quads]
    edges = np.linalg.norm(np.roll(corners, -1, axis=1) - corners, axis=2)
    thin = corner_sines(vertices, quads).min(axis=1) < LEAST_SINE
    return np.asarray(thin | (edges.min(axis=1) < SHORTEST_EDGE * mean_edge))


def folded_pairs(vertices: Floats, mesh: QuadMesh) -> Indices:
    """(k, 2) neighbouring quads whose normals point to opposite sides."""
    pairs = neighbours(mesh)
    return pairs[_opposite(vertices, mesh.quads, pairs)]


def neighbours(mesh: QuadMesh) -> Indices:
    """(k, 2) quads that share an edge."""
    inner = np.flatnonzero(mesh.twin > np.arange(len(mesh.twin)))
    return np.stack([inner // 4, mesh.twin[inner] // 4], axis=1)


def _opposite(vertices: Floats, quads: Indices, pairs: Indices) -> Mask:
    normal = _normals(vertices[quads])
    a, b = pairs.T
    return np.asarray(np.einsum("kc,kc->k", normal[a], normal[b]) < 0.0)


def _normals(corners: Floats) -> Floats:
    return unit(np.cross(corners[:, 2] - corners[:, 0], corners[:, 3] - corners[:, 1]))


@dataclass(frozen=True, eq=False)
class NoFolding:
    """Refuses a step that turns over or collapses a quad, or folds two onto each other.

    What is broken at the start may stay so: it is not the step's doing.

    Parameters
    ----------
    mesh : its vertices are the start, at unit mean edge; of the unknowns the first 3 n are moved.
    """

    mesh: QuadMesh
    _sound: Mask = field(init=False, repr=False)
    _pairs: Indices = field(init=False, repr=False)

    def __post_init__(self) -> None:
        start, pairs = self.mesh.vertices, neighbours(self.mesh)
        object.__setattr__(self, "_sound", ~collapsed(start, self.mesh.quads, 1.0))
        object.__setattr__(self, "_pairs", pairs[~_opposite(start, self.mesh.quads, pairs)])

    def broken(self, x: Floats) -> Indices:
        """Quads that *x* breaks."""
        vertices = x[: self.mesh.vertices.size].reshape(-1, 3)
        fallen = np.flatnonzero(self._sound & collapsed(vertices, self.mesh.quads, 1.0))
        folded = self._pairs[_opposite(vertices, self.mesh.quads, self._pairs)]
        return np.unique(np.r_[fallen, folded.ravel()])
