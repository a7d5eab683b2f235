"""What a surface must carry before directions are read off it, and what to say if it does not."""

from __future__ import annotations

import numpy as np

from gridshell.arrays import Floats, Mask, Points
from gridshell.errors import (
    FlatSurfaceError,
    TooManySingularitiesError,
    UmbilicRegionError,
)
from gridshell.field.frame_field import FrameField, singularities
from gridshell.field.principal_frames import principal_frames
from gridshell.surface.curved_mesh import CurvedMesh
from gridshell.surface.triangle_mesh import TriangleMesh, place

FLAT = 1e-3
"""Largest curvature times the diagonal of the bounding box; below it a surface is a plane."""

UMBILIC = 0.05
"""D / max|kappa| below which curvature does not tell directions apart."""

MOST_UMBILIC = 0.3
"""Fraction of the area that may be so: a paraboloid of revolution has 0.2, a sphere 1."""

MOST_SINGULAR = 0.05
"""Singular points per cell of the quad mesh."""


def distinctness(curved: CurvedMesh) -> Floats:
    """(f,) how clearly curvature tells directions apart: D / max|kappa| of each triangle.

    0 at an umbilic, 1/2 on a cylinder, 1 on a minimal surface. A triangle counts as flat, hence as
    0, as far as its curvature is below what makes a whole surface a plane.
    """
    frames = principal_frames(curved)
    least = FLAT / diagonal(curved.mesh)
    return np.asarray(frames.half / np.maximum(frames.largest, least))


def umbilic(curved: CurvedMesh) -> Mask:
    """(f,) triangles whose curvature does not tell directions apart."""
    return np.asarray(distinctness(curved) < UMBILIC)


def diagonal(mesh: TriangleMesh) -> float:
    """Diagonal of the bounding box, mm."""
    return float(np.linalg.norm(np.ptp(mesh.vertices, axis=0)))


def require_curvature(curved: CurvedMesh) -> None:
    """Refuse a plane.

    Raises
    ------
    FlatSurfaceError
        When the largest curvature times the diagonal of the bounding box is below 0.001.
    """
    largest = curved.largest_curvature * diagonal(curved.mesh)
    if not largest >= FLAT:
        raise FlatSurfaceError(
            "The surface is flat: no curvature tells one direction from another",
            value=f"largest curvature times size {largest:.3g}",
            limit=f"at least {FLAT:g}",
            advice="draw guide lines for principal directions, or give the directions yourself",
        )


def require_distinct(curved: CurvedMesh, reached: Mask | None = None) -> None:
    """Refuse a surface that bends alike in all directions over a large part of its area.

    Parameters
    ----------
    reached : (f,) triangles whose direction a guide line gives; they are no obstacle.

    Raises
    ------
    UmbilicRegionError
        When more than 30 % of the area is umbilic, naming the fraction and the middle of it.
    """
    mesh = curved.mesh
    free = umbilic(curved) & (True if reached is None else ~reached)
    weight = np.where(free, mesh.areas, 0.0)
    fraction = float(weight.sum() / mesh.areas.sum())
    if fraction > MOST_UMBILIC:
        middle = weight @ mesh.centroids / weight.sum()
        away = np.where(free, np.linalg.norm(mesh.centroids - middle, axis=1), np.inf)
        nearest = int(np.argmin(away))
        raise UmbilicRegionError(
            "The surface bends alike in all directions, as a sphere or a plane does, so it has no "
            "principal directions there",
            where=f"triangle {nearest} {place(mesh.centroids[nearest])}, in the middle of it",
            value=f"{100.0 * fraction:.3g} % of the area",
            limit=f"{100.0 * MOST_UMBILIC:g} % of the area",
            advice="draw guide lines there and keep to 90 degrees, or give the directions yourself",
        )


def require_few_singularities(field: FrameField, spacing: float) -> None:
    """Refuse a field that turns too often for quads of edge *spacing*, mm.

    Raises
    ------
    TooManySingularitiesError
        When there are more than 5 % of the cells (and more than the surface itself demands), or
        two are closer than two edges.
    """
    mesh = field.mesh
    found = singularities(field)
    positions = found.positions(mesh)
    cell = spacing**2 * float(mesh.areas @ np.sin(field.angle) / mesh.areas.sum())
    cells = float(mesh.areas.sum()) / cell
    # a closed surface needs 2 |Euler characteristic| of index +-1/2
    most = max(MOST_SINGULAR * cells, 2.0 * abs(mesh.euler_characteristic))
    advice = "smooth the surface if it is noisy, or ask for smaller quads"
    if len(positions) > most:
        raise TooManySingularitiesError(
            "The directions turn around too many points for quads of this size",
            where=f"vertex {found.vertices[0]} {place(positions[0])}, the first of them",
            value=f"{len(positions)} singular points in about {cells:.0f} quads",
            limit=f"{most:.0f}",
            advice=advice,
        )
    pair, distance = _closest_pair(positions)
    if distance < 2.0 * spacing:
        raise TooManySingularitiesError(
            "Two singular points of the directions are too close for quads of this size",
            where=f"{place(positions[pair[0]])} and {place(positions[pair[1]])}",
            value=f"{distance:.4g} mm apart",
            limit=f"two edges, {2.0 * spacing:.4g} mm",
            advice=advice,
        )


def _closest_pair(positions: Points) -> tuple[tuple[int, int], float]:
    from scipy.spatial import cKDTree

    if len(positions) < 2:
        return (0, 0), np.inf
    away, other = cKDTree(positions).query(positions, k=2)
    first = int(np.argmin(away[:, 1]))
    return (first, int(other[first, 1])), float(away[first, 1])
