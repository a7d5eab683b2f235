"""The figures of a net quad by quad: where it is not yet as it shall be, and how the surface bends.

The whole net's figures are those of ``quality``; these are for pictures.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from gridshell.angles import Angle
from gridshell.arrays import Floats
from gridshell.curvature import principal_curvatures
from gridshell.mesh import ControlMesh, Stars
from gridshell.quality import node_angles, quad_planarity, star_planarity
from gridshell.surface import Surface
from gridshell.terms import Planarity, planar_stars, target_angles

_SAMPLES = 10_000
"""Vertices at which curvature is estimated at most; quads between have no figure."""


@dataclass(frozen=True, eq=False)
class QuadFigures:
    """Figures of f control quads.

    Parameters
    ----------
    angle_error : (f,) radians; None where no angle was asked for, or it is one between edges.
    planarity : (f,) of the quad itself, or of the worst vertex star at its corners.
    surface_distance : (f,) of its farthest corner, mm; None without a reference.
    curvature_ratio : (f,) mean over its corners of kappa1 / kappa2, the smaller one in absolute
        value first; NaN where the mesh is too small to tell.
    """

    angle_error: Floats | None
    planarity: Floats
    surface_distance: Floats | None
    curvature_ratio: Floats


def quad_figures(
    control: ControlMesh,
    *,
    planarity: Planarity = Planarity.DIAGONAL_STARS,
    angle: Angle | None = None,
    reference: Surface | None = None,
) -> QuadFigures:
    """Measure every quad of *control*; *angle* in radians, lengths in mm."""
    return QuadFigures(
        angle_error=_angle_error(control, planarity, angle),
        planarity=_planarity(control, planarity),
        surface_distance=None if reference is None else _distance(control, reference),
        curvature_ratio=_curvature_ratio(control),
    )


def _angle_error(control: ControlMesh, planarity: Planarity, angle: Angle | None) -> Floats | None:
    if angle is None or planarity is Planarity.EDGE_STARS:
        return None
    return np.asarray(np.abs(node_angles(control) - target_angles(control, planarity, angle)))


def _planarity(control: ControlMesh, planarity: Planarity) -> Floats:
    if not planarity.of_stars:
        return quad_planarity(control.vertices[control.quads])
    at_vertices = _of_stars(control.vertices, planar_stars(control, planarity))
    return np.asarray(at_vertices[control.quads].max(axis=1))


def _of_stars(vertices: Floats, stars: Stars) -> Floats:
    """(n,) planarity of the star around each vertex; 0 where there is none that must be planar."""
    counts = np.unique(stars.count[stars.count >= 3])
    measured = [np.flatnonzero(stars.count == count) for count in counts]
    found = np.zeros(len(vertices))
    if measured:
        found[np.concatenate(measured)] = star_planarity(vertices, stars)
    return found


def _distance(control: ControlMesh, reference: Surface) -> Floats:
    points = control.vertices
    away = np.linalg.norm(points - reference.closest(points).points, axis=1)
    return np.asarray(away[control.quads].max(axis=1))


def _curvature_ratio(control: ControlMesh) -> Floats:
    chosen, kappa = principal_curvatures(control.mesh, most=_SAMPLES)
    ratio = np.full(len(control.vertices), np.nan)
    small = np.where(np.abs(kappa[:, :1]) <= np.abs(kappa[:, 1:]), kappa, kappa[:, ::-1])
    ratio[chosen] = small[:, 0] / np.where(small[:, 1] == 0.0, np.inf, small[:, 1])
    at_corners = ratio[control.quads]
    known = np.isfinite(at_corners)
    total = np.where(known, at_corners, 0.0).sum(axis=1)
    return np.where(known.any(axis=1), total / np.maximum(known.sum(axis=1), 1), np.nan)
