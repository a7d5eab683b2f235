"""Smoothing of shape operators over a mesh: the mean curvature, and the rest as a 2-RoSy field.

Solves (M + l^2 / 2 L) z = M z0 with the lumped mass M and the cotangent Laplacian L, once for the
mean curvature and once for the trace-free part, a complex number per vertex that turns twice as
fast as the tangent frame and is carried along edges by the smallest rotation between normals.

Source: K. Crane, F. de Goes, M. Desbrun, P. Schroeder, Digital geometry processing with discrete
exterior calculus (2013), for L; F. Knoeppel et al., Globally optimal direction fields (2013), for
the transported one.
"""

from __future__ import annotations

from typing import Any

import numpy as np
import numpy.typing as npt

from gridshell.arrays import Floats, Indices, Vectors
from gridshell.surface.jet_fit import tangent_frames
from gridshell.surface.triangle_mesh import TriangleMesh, before

_TOLERANCE = 1e-8
"""Of the iteration, relative; far below what noise leaves."""


def smoothed_shapes(
    mesh: TriangleMesh, normals: Vectors, shapes: Floats, *, length: float
) -> Floats:
    """Shape operators (n, 3, 3), 1/mm, averaged over about *length*, mm.

    Parameters
    ----------
    normals : (n, 3) unit normals the operators (n, 3, 3) are tangential to.
    """
    frames = tangent_frames(normals)
    tangents = frames[:, :2]
    local = tangents @ shapes @ tangents.transpose(0, 2, 1)
    mean = (local[:, 0, 0] + local[:, 1, 1]) / 2.0
    rest = (local[:, 0, 0] - local[:, 1, 1]) / 2.0 + 1j * local[:, 0, 1]
    a, b, weight = _edge_weights(mesh)
    turn = _turns(frames, a, b)
    mean = _solved(mesh, a, b, weight, np.ones(len(a)), mean, length).real
    rest = _solved(mesh, a, b, weight, np.exp(2j * turn), rest, length)
    local = np.empty_like(local)
    local[:, 0, 0], local[:, 1, 1] = mean + rest.real, mean - rest.real
    local[:, 0, 1] = local[:, 1, 0] = rest.imag
    return tangents.transpose(0, 2, 1) @ local @ tangents


def _edge_weights(mesh: TriangleMesh) -> tuple[Indices, Indices, Floats]:
    """Ends (e,), (e,) and cotangent weights (e,) of the edges; an obtuse pair counts nothing."""
    corner = mesh.vertices[mesh.origin[before(np.arange(len(mesh.origin)))]]
    p, q = mesh.vertices[mesh.origin] - corner, mesh.vertices[mesh.target] - corner
    area = np.repeat(mesh.areas, 3)
    cot = np.einsum("hc,hc->h", p, q) / np.maximum(2.0 * area, 1e-300)
    inner = mesh.twin >= 0
    cot = cot + np.where(inner, cot[mesh.twin], 0.0)
    once = ~inner | (np.arange(len(cot)) < mesh.twin)
    return mesh.origin[once], mesh.target[once], np.clip(cot[once] / 2.0, 0.0, 10.0)


def _turns(frames: Floats, a: Indices, b: Indices) -> Floats:
    """Angle (e,) in the frame of *b* of the first tangent of *a*, carried there, radians."""
    start, end = frames[a, 2], frames[b, 2]
    axis = np.cross(start, end)
    cosine = np.einsum("ec,ec->e", start, end)
    first = frames[a, 0]
    along = np.einsum("ec,ec->e", axis, first) / np.maximum(1.0 + cosine, 1e-12)
    carried = cosine[:, None] * first + np.cross(axis, first) + along[:, None] * axis
    x = np.einsum("ec,ec->e", carried, frames[b, 0])
    y = np.einsum("ec,ec->e", carried, frames[b, 1])
    return np.asarray(np.arctan2(y, x))


def _solved(
    mesh: TriangleMesh,
    a: Indices,
    b: Indices,
    weight: Floats,
    turn: npt.NDArray[Any],
    start: npt.NDArray[Any],
    length: float,
) -> npt.NDArray[Any]:
    """The smoothed values (n,); *turn* (e,) carries a value from a to b."""
    from scipy import sparse
    from scipy.sparse.linalg import cg

    n = len(start)
    mass = np.bincount(mesh.origin, np.repeat(mesh.areas / 3.0, 3), n)
    pull = weight * length**2 / 2.0
    diagonal = mass + np.bincount(a, pull, n) + np.bincount(b, pull, n)
    own = np.arange(n)
    matrix = sparse.csr_matrix(
        (
            np.concatenate([diagonal, -pull * turn, -pull * np.conj(turn)]),
            (np.concatenate([own, b, a]), np.concatenate([own, a, b])),
        ),
        shape=(n, n),
    )
    inverse = sparse.diags(1.0 / diagonal)
    found, _ = cg(matrix, mass * start, x0=start, rtol=_TOLERANCE, maxiter=500, M=inverse)
    return np.asarray(found)
