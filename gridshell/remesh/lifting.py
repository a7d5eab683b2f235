"""Points on the flat triangles lifted onto the quadrics of their corners."""

from __future__ import annotations

import numpy as np

from gridshell.arrays import Floats, Indices, Points
from gridshell.surface import CurvedMesh


def lifted(curved: CurvedMesh, faces: Indices, weights: Floats) -> Points:
    """(m, 3) points at barycentric *weights* (m, 3) in *faces* (m,), on the blended quadrics.

    Around vertex i the surface is ``x + n_i (t . S_i t / 2 - z)``, t and z the tangential and the
    normal part of the way from the vertex; the three are blended by the weights.
    """
    mesh = curved.mesh
    flat = np.einsum("mk,mkc->mc", weights, mesh.corners[faces])
    result = np.zeros_like(flat)
    for k in range(3):
        v = mesh.triangles[faces, k]
        way = flat - mesh.vertices[v]
        normal = curved.normals[v]
        height = np.einsum("mc,mc->m", way, normal)
        tangent = way - height[:, None] * normal
        bend = 0.5 * np.einsum("mi,mij,mj->m", tangent, curved.shapes[v], tangent)
        result += weights[:, k, None] * (flat + normal * (bend - height)[:, None])
    return result
