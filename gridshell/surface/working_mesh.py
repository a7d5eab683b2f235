"""A mesh of the right fineness for the quads to come, with the curvature the input had.

Too coarse a mesh is halved at the middles of its edges, lifted onto its own quadrics. Too fine a
one is thinned by quadric errors (M. Garland and P. Heckbert, 1997, by fast-simplification); its
boundary is put back on the input's, and cubics fitted to the *input's* vertices around the ones
that stay give their places and curvature, so that nothing is lost but triangles.
"""

from __future__ import annotations

import numpy as np

from gridshell.arrays import Floats, Indices, Points, unit
from gridshell.errors import PoorTriangulationError, SettingError, SurfaceError
from gridshell.surface.curved_mesh import CurvedMesh
from gridshell.surface.jet_fit import fit_jets
from gridshell.surface.jets import (
    RINGS,
    CurvatureEstimate,
    estimated_curvature,
    require_little_noise,
    rings_and_noise,
    smoothing_length,
)
from gridshell.surface.neighbourhoods import adjacency, nearest_members
from gridshell.surface.smooth_surface import blend
from gridshell.surface.surface_checks import LARGEST_ASPECT, aspects
from gridshell.surface.tensor_smoothing import smoothed_shapes
from gridshell.surface.triangle_mesh import TriangleMesh, place

LEAST_PER_QUAD, MOST_PER_QUAD = 6, 120
"""Triangles per quad: fewer blur the directions, more do not improve them."""

MOST_TRIANGLES = 60_000
"""Of a working mesh, unless the quads themselves need more."""

MOST_SLIVERS = 0.25
"""Share of the area beyond which the corners of slivers no longer tell the curvature."""

_CLOUD = 24
"""Input vertices a cubic is fitted to on a clean mesh."""

_LARGEST_CLOUD = 400
_CORNER = np.radians(30.0)
"""Turn of the boundary that counts as a corner and keeps its place."""

_TRIES = 3
_EVENINGS = 3


def working_mesh(mesh: TriangleMesh, *, quads: int) -> CurvatureEstimate:
    """Bring a mesh to 6 .. 120 triangles per quad, at most 60,000, and find its curvature.

    Parameters
    ----------
    quads : faces of the quad mesh to come.

    Raises
    ------
    SettingError
        When *quads* is below 1.
    PoorTriangulationError
        When slivers cover more than a quarter of the surface.
    NoisyInputError
        As `estimated_curvature` does.
    """
    if quads < 1:
        raise SettingError("There must be quads", where="quads", value=str(quads), limit=">= 1")
    require_good_triangles(mesh)
    quad_edge = float(np.sqrt(mesh.areas.sum() / quads))
    most = max(min(MOST_PER_QUAD * quads, MOST_TRIANGLES), 2 * LEAST_PER_QUAD * quads)
    if len(mesh.triangles) > most and (thin := thinned(mesh, triangles=most)) is not None:
        return _curvature_from(mesh, thin, quad_edge)
    estimate = estimated_curvature(mesh, quad_edge=quad_edge)
    curved, residual = estimate.curved, estimate.residual
    while len(curved.mesh.triangles) < LEAST_PER_QUAD * quads:
        ends = _edges(curved.mesh)
        residual = np.concatenate([residual, residual[ends].mean(axis=1)])
        curved = halved(curved)
    return CurvatureEstimate(curved, residual, estimate.noise, estimate.rings)


def require_good_triangles(mesh: TriangleMesh) -> None:
    """Refuse a mesh that consists of slivers.

    Raises
    ------
    PoorTriangulationError
        Naming the share of the area and the worst triangle.
    """
    aspect = aspects(mesh)
    share = float(mesh.areas[aspect > LARGEST_ASPECT].sum() / mesh.areas.sum())
    if share > MOST_SLIVERS:
        worst = int(np.argmax(aspect))
        raise PoorTriangulationError(
            "The surface consists of slivers, whose corners do not tell its curvature",
            where=f"the worst, triangle {worst} {place(mesh.centroids[worst])}",
            value=f"{100.0 * share:.0f} % of the area beyond 1 : {LARGEST_ASPECT:g}",
            limit=f"{100.0 * MOST_SLIVERS:.0f} %",
            advice="export the surface with even triangles, or as STEP",
        )


def halved(curved: CurvedMesh) -> CurvedMesh:
    """Every triangle in four, the new vertices lifted onto the surface's quadrics."""
    mesh = curved.mesh
    n, halfedges = len(mesh.vertices), np.arange(len(mesh.twin))
    once = (mesh.twin < 0) | (halfedges < mesh.twin)
    number = np.empty(len(halfedges), dtype=np.int64)
    number[once] = n + np.arange(np.count_nonzero(once))
    number[~once] = number[mesh.twin[~once]]
    chosen = halfedges[once]
    weights = np.full((len(chosen), 3), 0.5)
    weights[np.arange(len(chosen)), (chosen + 2) % 3] = 0.0
    points, normals, shapes = blend(curved, chosen // 3, weights)
    across = np.eye(3) - normals[:, :, None] * normals[:, None, :]
    a, b, c = mesh.triangles.T
    ab, bc, ca = number.reshape(-1, 3).T
    quarters = np.stack([a, ab, ca, ab, b, bc, ca, bc, c, ab, bc, ca], axis=1).reshape(-1, 3)
    return CurvedMesh.of_vertices(
        TriangleMesh(np.concatenate([mesh.vertices, points]), quarters),
        np.concatenate([curved.normals, normals]),
        np.concatenate([curved.shapes, across @ shapes @ across]),
    )


def _edges(mesh: TriangleMesh) -> Indices:
    """Ends (e, 2) of the edges, in the order `halved` places vertices on them."""
    once = (mesh.twin < 0) | (np.arange(len(mesh.twin)) < mesh.twin)
    return np.stack([mesh.origin[once], mesh.target[once]], axis=1)


def thinned(mesh: TriangleMesh, *, triangles: int) -> TriangleMesh | None:
    """A mesh of about *triangles* with the same topology and boundary; None if there is none.

    Thinning that breaks the surface is tried again with more triangles.
    """
    import fast_simplification

    # the package does not take read-only arrays
    points, faces = mesh.vertices.copy(), mesh.triangles.astype(np.int32)
    for attempt in range(_TRIES):
        wanted = int(triangles * 1.5**attempt)
        if wanted >= len(faces):
            return None
        found, coarse = fast_simplification.simplify(points, faces, target_count=wanted, agg=5.0)
        used, compact = np.unique(coarse, return_inverse=True)
        try:
            thin = TriangleMesh(found[used], compact.reshape(-1, 3))
            thin = TriangleMesh(_on_boundary(mesh, thin), thin.triangles)
            thin = _evened(thin)
        except SurfaceError:
            continue
        whole = thin.euler_characteristic == mesh.euler_characteristic
        whole &= len(thin.boundary_loops) == len(mesh.boundary_loops)
        if whole and float(aspects(thin).max(initial=0.0)) < 1e6:
            return thin
    return None


def _evened(mesh: TriangleMesh) -> TriangleMesh:
    """Inner vertices drawn towards the middle of their neighbours, which opens slivers."""
    from scipy import sparse

    links = adjacency(mesh)
    mean = sparse.diags(1.0 / np.asarray(links.sum(axis=1)).ravel()) @ links
    vertices, inner = mesh.vertices.copy(), ~mesh.on_boundary
    for _ in range(_EVENINGS):
        vertices[inner] = (mean @ vertices)[inner]
    return TriangleMesh(vertices, mesh.triangles)


def _on_boundary(mesh: TriangleMesh, thin: TriangleMesh) -> Points:
    """Vertices of *thin* with its boundary moved to boundary vertices of *mesh*, corners first."""
    from scipy.spatial import cKDTree

    vertices = thin.vertices.copy()
    rim = np.flatnonzero(thin.on_boundary)
    if not len(rim):
        return vertices
    dense = mesh.vertices[mesh.on_boundary]
    vertices[rim] = dense[cKDTree(dense).query(vertices[rim])[1]]
    corners = _corners(mesh)
    if len(corners):
        nearest = cKDTree(vertices[rim]).query(mesh.vertices[corners])[1]
        vertices[rim[nearest]] = mesh.vertices[corners]
    return vertices


def _corners(mesh: TriangleMesh) -> Indices:
    """Boundary vertices where the boundary turns by more than 30 degrees."""
    found = []
    for loop in mesh.boundary_loops:
        along = unit(mesh.vertices[mesh.target[loop]] - mesh.vertices[mesh.origin[loop]])
        cosine = np.einsum("ec,ec->e", along, np.roll(along, 1, axis=0))
        found.append(mesh.origin[loop][cosine < np.cos(_CORNER)])
    return np.concatenate(found) if found else np.zeros(0, dtype=np.int64)


def _curvature_from(dense: TriangleMesh, thin: TriangleMesh, quad_edge: float) -> CurvatureEstimate:
    """Place the vertices of *thin* on cubics fitted to the vertices of *dense* around them."""
    rings, noise = rings_and_noise(dense)
    require_little_noise(noise)
    count = _CLOUD if rings == RINGS else min(3 * rings * (rings + 1) + 1, _LARGEST_CLOUD)
    normals = thin.vertex_normals
    around = nearest_members(
        dense.vertices, dense.vertex_normals, thin.vertices, normals, count=count
    )
    jets = fit_jets(dense.vertices, thin.vertices, normals, around)
    placed = TriangleMesh(jets.feet, thin.triangles)
    shapes: Floats = jets.shapes
    if noise > 0.0:
        length = smoothing_length(placed, quad_edge)
        shapes = smoothed_shapes(placed, jets.normals, shapes, length=length)
    curved = CurvedMesh.of_vertices(placed, jets.normals, shapes)
    return CurvatureEstimate(curved, jets.residuals / dense.mean_edge, noise, rings)
