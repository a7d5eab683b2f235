"""A net is judged by these figures, never by the solver's energy.

Definitions: star planarity = largest distance of a star's neighbours from the best plane through
its centre, over the star's mean edge; angle error = difference from the target between the two
diagonals of a control quad (eq. 4).
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from gridshell.arrays import Floats
from gridshell.curvature import principal_curvatures
from gridshell.mesh import ControlMesh, DiagonalMesh, Stars, diagonal_meshes
from gridshell.surface import Surface


@dataclass(frozen=True)
class Spread:
    """Mean and largest of a figure that should be zero."""

    mean: float
    max: float


@dataclass(frozen=True)
class NetQuality:
    """The figures of an asymptotic net.

    Parameters
    ----------
    star_planarity : over all stars with three spokes or more, of D1 and D2.
    angle_error_deg : None where no angle was asked for.
    node_angle_deg : smallest and largest angle between the diagonals.
    edge_ratio : shortest and longest edge of D1 over their mean.
    surface_distance_mm : None without a reference.
    curvature_ratio : median of kappa1 / kappa2 estimated from the mesh alone; for an A-net of
        constant angle it is ``-tan(angle / 2)^2``. None where the mesh is too small to tell.
    """

    star_planarity: Spread
    angle_error_deg: Spread | None
    node_angle_deg: tuple[float, float]
    edge_ratio: tuple[float, float]
    surface_distance_mm: Spread | None
    curvature_ratio: float | None


def net_quality(
    control: ControlMesh, *, angle: float | None = None, reference: Surface | None = None
) -> NetQuality:
    """Measure the diagonal meshes of *control*; *angle* in radians."""
    first, second = diagonal_meshes(control)
    planarity = np.concatenate([star_planarity(m.vertices, m.stars) for m in (first, second)])
    angles = node_angles(control)
    error = None if angle is None else _spread(np.degrees(np.abs(angles - angle)))
    return NetQuality(
        star_planarity=_spread(planarity),
        angle_error_deg=error,
        node_angle_deg=(float(np.degrees(angles.min())), float(np.degrees(angles.max()))),
        edge_ratio=edge_ratio(first),
        surface_distance_mm=None if reference is None else _distance(control, reference),
        curvature_ratio=curvature_ratio(control),
    )


def star_planarity(vertices: Floats, stars: Stars) -> Floats:
    """(m,) planarity of every star with three spokes or more, relative to its mean edge."""
    figures = []
    for count in np.unique(stars.count[stars.count >= 3]):
        centre = np.flatnonzero(stars.count == count)
        spokes = vertices[stars.spokes[centre, :count]] - vertices[centre][:, None, :]
        normal = np.linalg.svd(spokes)[2][:, 2]
        distance = np.abs(np.einsum("mkc,mc->mk", spokes, normal)).max(axis=1)
        figures.append(distance / np.linalg.norm(spokes, axis=2).mean(axis=1))
    return np.concatenate(figures) if figures else np.zeros(0)


def node_angles(control: ControlMesh) -> Floats:
    """(f,) angle from diagonal v0-v2 to diagonal v1-v3 of every control quad, radians."""
    corners = control.vertices[control.quads]
    a, b = corners[:, 2] - corners[:, 0], corners[:, 3] - corners[:, 1]
    across, along = np.linalg.norm(np.cross(a, b), axis=1), np.einsum("mc,mc->m", a, b)
    return np.asarray(np.arctan2(across, along))


def edge_ratio(net: DiagonalMesh) -> tuple[float, float]:
    """Shortest and longest edge over the mean edge."""
    a, b = net.vertices[net.edges.T]
    length = np.linalg.norm(a - b, axis=1)
    return float(length.min() / length.mean()), float(length.max() / length.mean())


def curvature_ratio(control: ControlMesh) -> float | None:
    """Median of kappa1 / kappa2, smaller curvature in absolute value first.

    For ``kappa1 / kappa2 = -tan(angle / 2)^2`` with an angle of at most 90 degrees.
    """
    _, kappa = principal_curvatures(control.mesh)
    if len(kappa) == 0:
        return None
    small = np.where(np.abs(kappa[:, :1]) <= np.abs(kappa[:, 1:]), kappa, kappa[:, ::-1])
    return float(np.median(small[:, 0] / np.where(small[:, 1] == 0.0, np.inf, small[:, 1])))


def _distance(control: ControlMesh, reference: Surface) -> Spread:
    points = control.vertices[control.mesh.valence > 0]
    return _spread(np.linalg.norm(points - reference.closest(points).points, axis=1))


def _spread(figures: Floats) -> Spread:
    return Spread(float(figures.mean()), float(figures.max())) if len(figures) else Spread(0.0, 0.0)
