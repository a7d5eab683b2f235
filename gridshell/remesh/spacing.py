"""Integrating factor: a spacing that lets one family of lines be level lines exactly.

A single family always has one locally: the covector q with its lines as kernel, times exp(sigma),
can be a gradient. Between neighbours sigma must jump as the log of q along their common edge does.
"""

from __future__ import annotations

import numpy as np
from scipy.sparse import csr_matrix

from gridshell.arrays import Floats, Indices
from gridshell.solve import Engine, solve_definite
from gridshell.surface import TriangleMesh

_SMOOTH = 1e-3
_HELD = 1e-9


def integrating_factor(
    mesh: TriangleMesh, q: Floats, flips: Indices, engine: Engine | None = None
) -> Floats:
    """(f,) positive factors on the covectors *q* (f, 2), about one on average.

    Parameters
    ----------
    q : in the faces' frames, 1/mm; an edge along the lines, their kernel, says nothing.
    flips : (3f,) sign between the covectors on both sides.
    engine : solver of the linear system.

    Raises
    ------
    SolveError
        When the linear system cannot be factored.
    """
    inner = np.flatnonzero(mesh.twin > np.arange(len(mesh.twin)))
    other = mesh.twin[inner]
    f, g = inner // 3, other // 3
    corners = mesh.flat_corners
    edges = (np.roll(corners, -1, axis=1) - corners).reshape(-1, 2)
    length = np.linalg.norm(edges[inner], axis=1)
    along_f = (q[f] * edges[inner]).sum(axis=1) / length
    along_g = -(q[g] * edges[other]).sum(axis=1) * flips[inner] / length
    size = np.linalg.norm(q, axis=1)
    trusted = (along_f * along_g) > 0.0
    jump = np.zeros(len(inner))
    jump[trusted] = np.log(along_g[trusted] / along_f[trusted])
    least = np.minimum(np.abs(along_f) / size[f], np.abs(along_g) / size[g]) ** 2
    dual = np.linalg.norm(mesh.centroids[f] - mesh.centroids[g], axis=1)
    weight = np.where(trusted, least, 0.0) * length / dual
    # sigma_f - sigma_g = log(q_g / q_f) along the edge
    total = weight + _SMOOTH * length / dual
    n = len(mesh.triangles)
    rows = np.r_[f, g, f, g, np.arange(n)]
    columns = np.r_[f, g, g, f, np.arange(n)]
    data = np.r_[total, total, -total, -total, np.full(n, _HELD)]
    matrix = csr_matrix((data, (rows, columns)), shape=(n, n))
    pull = weight * jump
    right = np.bincount(f, pull, n) - np.bincount(g, pull, n)
    sigma = solve_definite(matrix, np.asarray(right, dtype=np.float64)[:, None], engine)[:, 0]
    return np.asarray(np.exp(sigma - np.average(sigma, weights=mesh.areas)))
