"""The checkerboard pattern P: the mid-edge subdivision of a control mesh (Fig. 2 of the paper)."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from gridshell.arrays import Indices, Points, frozen
from gridshell.mesh.control_mesh import ControlMesh


@dataclass(frozen=True, eq=False)
class CheckerboardPattern:
    """Black parallelograms and white faces over the edge midpoints.

    Parameters
    ----------
    vertices : (e, 3) midpoints in the order of the control mesh's edges, mm.
    black : (f, 4) one parallelogram in each quad, its edges half the quad's diagonals.
    white : (w, k) one face around each interior vertex, padded with -1: half a face of D1 or D2.
    """

    vertices: Points
    black: Indices
    white: Indices


def checkerboard(control: ControlMesh) -> CheckerboardPattern:
    """Join the edge midpoints of every quad of the control mesh."""
    mesh = control.mesh
    a, b = mesh.vertices[mesh.edges.T]
    ends = np.sort(np.stack([mesh.origin, mesh.target], axis=1), axis=1)
    keys = mesh.edges[:, 0] * len(mesh.vertices) + mesh.edges[:, 1]
    edge_of = np.searchsorted(keys, ends[:, 0] * len(mesh.vertices) + ends[:, 1])
    inner = np.flatnonzero(~mesh.on_boundary & (mesh.valence > 0))
    rings = mesh.fans[inner]
    return CheckerboardPattern(
        vertices=frozen((a + b) / 2.0),
        black=frozen(edge_of.reshape(-1, 4), np.int64),
        white=frozen(np.where(rings >= 0, edge_of[rings], -1), np.int64),
    )
