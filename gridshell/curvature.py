"""Curvature estimated from a quad mesh alone: cubic height functions over two rings.

Around each vertex the height over the tangent plane is fitted by a cubic polynomial (osculating
jet, Cazals and Pottmann 2005); two passes, the second over the plane the first one found.
"""

from __future__ import annotations

from functools import lru_cache

import numpy as np

from gridshell.arrays import Floats, Indices, Points, Vectors, frozen, unit
from gridshell.errors import NotHyperbolicError
from gridshell.mesh import QuadMesh, position

_LEAST_SAMPLES = 14
_FLAT = 1e-8
_TOLERATED = 0.01
_KEPT = 4
"""Meshes whose curvatures are kept: a net is judged more than once."""


@lru_cache(maxsize=_KEPT)
def principal_curvatures(mesh: QuadMesh, *, most: int | None = None) -> tuple[Indices, Floats]:
    """Principal curvatures at the vertices whose two rings hold enough neighbours.

    Parameters
    ----------
    most : vertices measured at most, evenly spread over their numbers; None measures all.

    Returns
    -------
    vertices : (m,) interior vertices with at least 14 neighbours.
    curvatures : (m, 2) kappa1 <= kappa2, 1/mm; positive where the surface bends towards the
        normal of its counter-clockwise side.
    """
    centre, neighbours = _two_rings(mesh, most)
    if len(centre) == 0:
        return centre, frozen(np.empty((0, 2)))
    inside = neighbours >= 0
    normals = vertex_normals(mesh)[centre]
    for _ in range(2):
        frames = _frames(normals)
        offset = mesh.vertices[neighbours] - mesh.vertices[centre][:, None, :]
        local = (offset @ frames.swapaxes(1, 2)) * inside[..., None]
        size = np.abs(local[..., :2]).max(axis=(1, 2), keepdims=True)
        jet = _fit(local / size, inside)
        gradient = np.concatenate([-jet[:, :2], np.ones((len(jet), 1))], axis=1)
        normals = unit(np.einsum("mi,mic->mc", gradient, frames))
    return frozen(centre, np.int64), frozen(_curvatures(jet) / size[:, 0])


def require_hyperbolic(mesh: QuadMesh) -> None:
    """Refuse a mesh that is not negatively curved: it carries no asymptotic directions.

    Up to one vertex in a hundred may fail, which is noise and not shape.

    Raises
    ------
    NotHyperbolicError
        Naming the vertex of largest Gaussian curvature.
    """
    vertices, kappa = principal_curvatures(mesh)
    if len(vertices) == 0:
        return
    gauss = kappa[:, 0] * kappa[:, 1]
    failing = gauss * mesh.mean_edge**2 > -_FLAT
    if failing.mean() > _TOLERATED:
        worst = int(np.argmax(gauss))
        v = int(vertices[worst])
        raise NotHyperbolicError(
            "An asymptotic net needs negative Gaussian curvature",
            where=f"vertex {v} {position(mesh.vertices[v])}",
            value=f"{gauss[worst]:.3g} 1/mm2, and {failing.mean():.0%} of the vertices fail",
            limit="below 0",
            advice="a saddle-shaped part of the surface, or a planar-quad net",
        )


def vertex_normals(mesh: QuadMesh) -> Vectors:
    """(n, 3) unit normals: the sum of the quads' diagonal cross products."""
    corners = mesh.vertices[mesh.quads]
    cross = np.cross(corners[:, 2] - corners[:, 0], corners[:, 3] - corners[:, 1])
    total = np.zeros_like(mesh.vertices)
    np.add.at(total, mesh.quads.ravel(), np.repeat(cross, 4, axis=0))
    return unit(total)


def _two_rings(mesh: QuadMesh, most: int | None) -> tuple[Indices, Indices]:
    """Interior vertices and their neighbours over two rings of quads, padded with -1."""
    from scipy.sparse import csr_matrix

    f = np.repeat(np.arange(len(mesh.quads)), 4)
    incidence = csr_matrix((np.ones(len(f)), (mesh.quads.ravel(), f)))
    one = incidence @ incidence.T
    two = (one @ one).tocsr()
    two.resize((len(mesh.vertices), len(mesh.vertices)))
    counts = np.diff(two.indptr)
    inner = ~mesh.on_boundary & (mesh.valence > 0) & (counts > _LEAST_SAMPLES)
    centre = np.flatnonzero(inner)
    if most is not None and len(centre) > most:
        centre = centre[:: -(-len(centre) // most)]
    neighbours = np.full((len(centre), int(counts[centre].max(initial=0))), -1, dtype=np.int64)
    slots = np.arange(neighbours.shape[1])
    valid = slots < counts[centre][:, None]
    neighbours[valid] = two.indices[(two.indptr[centre][:, None] + slots)[valid]]
    return centre, neighbours


def _frames(normals: Vectors) -> Floats:
    """(m, 3, 3) rows: two tangents and the normal, right-handed."""
    helper = np.eye(3)[np.argmin(np.abs(normals), axis=1)]
    first = unit(np.cross(helper, normals))
    return np.stack([first, np.cross(normals, first), normals], axis=1)


def _fit(local: Points, inside: np.ndarray) -> Floats:
    """(m, 9) coefficients of x, y, x^2, xy, y^2 and the cubic terms, distance weighted."""
    x, y, z = np.ascontiguousarray(np.moveaxis(local, -1, 0))
    xx, xy, yy = x * x, x * y, y * y
    weight = inside * np.exp(-2.0 * (xx + yy))
    basis = np.empty((len(x), 9, x.shape[1]))
    for k, term in enumerate((x, y, xx, xy, yy, xx * x, xx * y, x * yy, yy * y)):
        np.multiply(term, weight, out=basis[:, k])
    gram = basis @ basis.swapaxes(1, 2) + 1e-12 * np.eye(9)
    right = basis @ (z * weight)[..., None]
    return np.linalg.solve(gram, right)[..., 0]


def _curvatures(jet: Floats) -> Floats:
    fx, fy = jet[:, 0], jet[:, 1]
    fxx, fxy, fyy = 2.0 * jet[:, 2], jet[:, 3], 2.0 * jet[:, 4]
    square = 1.0 + fx * fx + fy * fy
    gauss = (fxx * fyy - fxy * fxy) / square**2
    mean = ((1 + fy**2) * fxx - 2 * fx * fy * fxy + (1 + fx**2) * fyy) / (2 * square**1.5)
    spread = np.sqrt(np.maximum(mean * mean - gauss, 0.0))
    return np.stack([mean - spread, mean + spread], axis=1)
