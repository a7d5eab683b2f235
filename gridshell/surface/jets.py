"""Curvature of a triangle mesh from its vertices alone, and how noisy they are.

A cubic is fitted to the rings of every vertex. On a clean mesh its residual is the part of the
surface a cubic cannot follow, and grows quickly with the rings; on a noisy one it is the noise, and
stays. That tells both apart: rings are added as long as the residual stays (after O. Lepski's
choice of bandwidth), then the operators are smoothed and the vertices placed on their own cubics.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from gridshell.arrays import Floats, Indices, frozen
from gridshell.errors import NoisyInputError, SettingError
from gridshell.surface.curved_mesh import CurvedMesh
from gridshell.surface.jet_fit import Jets, fit_jets
from gridshell.surface.neighbourhoods import vertex_rings
from gridshell.surface.tensor_smoothing import smoothed_shapes
from gridshell.surface.triangle_mesh import TriangleMesh

RINGS = 2
"""Rings on a clean mesh: 18 neighbours where six triangles meet everywhere."""

LEAST_POINTS = 16
"""Points a cubic is fitted to, at least; it has ten coefficients."""

SUSPICIOUS = 5e-4
"""Residual over edge above which more rings are tried, to see whether it is noise."""

LARGEST_NOISE = 0.3
"""Noise over edge beyond which directions mean nothing: 10 % still gives them to 2 degrees."""

MOST_RINGS = 9
"""A tenth ring would average over some 330 points; details are gone long before."""

_STAYS = 1.08
"""Growth of the residual that still counts as staying; a clean mesh has 3 from ring to ring."""

_OUTLIER = 3.0
"""A residual counts up to this many medians, so that a crease does not pass for noise."""

_SAMPLE = 2000
"""Vertices the noise is judged by."""

_SMOOTHING = 0.3
"""Length of the smoothing over the edge of the quads to come."""


@dataclass(frozen=True, eq=False)
class CurvatureEstimate:
    """The curvature of a mesh and how far it can be trusted.

    Parameters
    ----------
    curved : the mesh with its curvature; vertices of a noisy mesh lie on the fitted surface.
    residual : (n,) root mean square distance of the neighbours from each fit, over the local edge.
    noise : the root mean square of *residual* if that is noise, 0 where a cubic is too simple.
    rings : used around every vertex.
    """

    curved: CurvedMesh
    residual: Floats
    noise: float
    rings: int

    def __post_init__(self) -> None:
        object.__setattr__(self, "residual", frozen(self.residual))

    @property
    def noisy(self) -> bool:
        """Whether rings were added, operators smoothed and vertices moved because of noise."""
        return self.noise > 0.0


def curved_by_jets(mesh: TriangleMesh, *, rings: int = RINGS) -> CurvedMesh:
    """Fit cubics to *rings* rings of every vertex; the mesh itself stays as it is."""
    jets = _ring_jets(mesh, rings)
    return CurvedMesh.of_vertices(mesh, jets.normals, jets.shapes)


def estimated_curvature(mesh: TriangleMesh, *, quad_edge: float | None = None) -> CurvatureEstimate:
    """Find the curvature of a mesh, by wider fits and smoothing if the mesh is noisy.

    Parameters
    ----------
    quad_edge : edge of the quads to come, mm: noise is smoothed over 0.3 of it. Without it, over
        one mean edge of the triangles.

    Raises
    ------
    NoisyInputError
        When the noise exceeds 0.3 of the edges.
    SettingError
        When *quad_edge* is not a positive, finite length.
    """
    if quad_edge is not None and not (np.isfinite(quad_edge) and quad_edge > 0.0):
        raise SettingError(
            "The edge of the quads must be a positive length",
            where="quad_edge",
            value=f"{quad_edge} mm",
            limit="> 0 mm",
        )
    rings, noise = rings_and_noise(mesh)
    require_little_noise(noise)
    jets = _ring_jets(mesh, rings)
    residual = jets.residuals / _local_edges(mesh)
    if rings == RINGS:
        curved = CurvedMesh.of_vertices(mesh, jets.normals, jets.shapes)
        return CurvatureEstimate(curved, residual, noise, rings)
    length = smoothing_length(mesh, quad_edge)
    placed = TriangleMesh(jets.feet, mesh.triangles)
    shapes = smoothed_shapes(placed, jets.normals, jets.shapes, length=length)
    curved = CurvedMesh.of_vertices(placed, jets.normals, shapes)
    return CurvatureEstimate(curved, residual, noise, rings)


def require_little_noise(noise: float) -> None:
    """Refuse a *noise* (over the edge) that leaves no directions to find."""
    if noise > LARGEST_NOISE:
        raise NoisyInputError(
            "The vertices scatter too far about any smooth surface",
            value=f"{100.0 * noise:.0f} % of the mean edge",
            limit=f"{100.0 * LARGEST_NOISE:.0f} %",
            advice="smooth the surface in the modeller, or fit a NURBS surface to it",
        )


def smoothing_length(mesh: TriangleMesh, quad_edge: float | None) -> float:
    """Length, mm, over which the operators of a noisy mesh are averaged."""
    return mesh.mean_edge if quad_edge is None else _SMOOTHING * quad_edge


def rings_and_noise(mesh: TriangleMesh) -> tuple[int, float]:
    """How many rings to use and the noise over the edge, judged by a sample of the vertices."""
    step = max(1, len(mesh.vertices) // _SAMPLE)
    rows = np.arange(0, len(mesh.vertices), step)
    edge = _local_edges(mesh)[rows]
    first = _level(_ring_jets(mesh, RINGS, rows).residuals / edge)
    rings, noise = RINGS, 0.0
    while first > SUSPICIOUS and rings < MOST_RINGS:
        grown = _level(_ring_jets(mesh, rings + 1, rows).residuals / edge)
        if grown > _STAYS * first:
            break
        rings, noise = rings + 1, grown
    return rings, noise


def _level(residual: Floats) -> float:
    """Root mean square of residuals (n,), outliers cut."""
    cut = np.minimum(residual, _OUTLIER * np.median(residual))
    return float(np.sqrt(np.mean(cut**2)))


def _ring_jets(mesh: TriangleMesh, rings: int, rows: Indices | None = None) -> Jets:
    """Cubics at the vertices *rows* (or all); wide ones have about as many points at the edge."""
    at_edge = LEAST_POINTS if rings == RINGS else 9 * rings * (rings + 1) // 4
    around = vertex_rings(mesh, rings=rings, least=LEAST_POINTS, at_edge=at_edge, rows=rows)
    if rows is None:
        return fit_jets(mesh.vertices, mesh.vertices, mesh.vertex_normals, around)
    return fit_jets(mesh.vertices, mesh.vertices[rows], mesh.vertex_normals[rows], around)


def _local_edges(mesh: TriangleMesh) -> Floats:
    """Mean length (n,) of the half-edges at each vertex, mm."""
    n = len(mesh.vertices)
    ends = np.concatenate([mesh.origin, mesh.target])
    lengths = np.concatenate([mesh.edge_lengths, mesh.edge_lengths])
    return np.asarray(np.bincount(ends, lengths, n) / np.bincount(ends, minlength=n))
