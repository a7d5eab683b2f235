"""A net is judged by these figures, never by the solver's energy.

Definitions: star planarity = largest distance of a star's neighbours from the best plane through
its centre, over the star's mean edge; face planarity = distance of the two diagonals over their
mean length; angle error = difference from the target between the two diagonals of a control quad
(eq. 4), or between the two families of edges; rhombus error = difference of the two diagonals over
their mean length; sphericity = offset of a star's last neighbour from the sphere of the others,
over the star's mean edge.
"""

from __future__ import annotations

from dataclasses import dataclass, field, replace

import numpy as np

from gridshell.angles import Angle
from gridshell.arrays import Floats, Indices
from gridshell.constraints import spherical_stars
from gridshell.curvature import principal_curvatures
from gridshell.folding import collapsed, corner_angles
from gridshell.mesh import (
    ControlMesh,
    DiagonalMesh,
    Stars,
    crossing_angles,
    diagonal_meshes,
    diagonal_stars,
    edge_stars,
)
from gridshell.surface import Surface
from gridshell.terms import Planarity, crossings, planar_stars, target_angles

_SAMPLES = 10_000
"""Vertices at which curvature is estimated at most."""


@dataclass(frozen=True)
class Spread:
    """Mean and largest of a figure that should be zero."""

    mean: float
    max: float


@dataclass(frozen=True, eq=False)
class NetFigures:
    """The figures of a net element by element; what was not asked for is None.

    Parameters
    ----------
    star_planarity : (s,) of every star that shall be planar.
    face_planarity : (f,) of every face that shall be planar.
    sphericity : (s,) of every star of four that shall be spherical.
    node_angle_deg, angle_error_deg : (m,) at every crossing.
    rhombus_error : (f,) of every control quad.
    edge_ratio : (e,) length of every edge of the net over their mean.
    corner_angle_deg : (4 f,) corners of the quads.
    surface_distance_mm : (n,) of the vertices in use.
    """

    star_planarity: Floats | None
    face_planarity: Floats | None
    sphericity: Floats | None
    node_angle_deg: Floats
    angle_error_deg: Floats | None
    rhombus_error: Floats | None
    edge_ratio: Floats
    corner_angle_deg: Floats
    surface_distance_mm: Floats | None


@dataclass(frozen=True)
class NetQuality:
    """The figures of a net.

    Parameters
    ----------
    star_planarity : over all stars with three spokes or more that shall be planar: boundary and
        singular ones included. None for a net of planar faces.
    face_planarity : over all faces that shall be planar; None for a net of planar stars.
    sphericity : over all stars of four; None where they need not be spherical.
    angle_error_deg : None where no angle was asked for.
    node_angle_deg : smallest and largest angle at the crossings.
    rhombus_error : None where no rhombi were asked for.
    edge_ratio : shortest and longest edge of the net over their mean: of D1, or of the mesh itself
        where its own edges or faces are the net.
    corner_angle_deg : smallest and largest corner of a quad.
    collapsed : quads turned over, concave or squeezed to slivers.
    surface_distance_mm : None without a reference.
    curvature_ratio : median of kappa1 / kappa2 estimated from the mesh alone; for an A-net of
        constant angle it is ``-tan(angle / 2)^2``. None where the mesh is too small to tell.
    figures : what all of these are read off, element by element.
    """

    star_planarity: Spread | None
    face_planarity: Spread | None
    sphericity: Spread | None
    angle_error_deg: Spread | None
    node_angle_deg: tuple[float, float]
    rhombus_error: Spread | None
    edge_ratio: tuple[float, float]
    corner_angle_deg: tuple[float, float]
    collapsed: int
    surface_distance_mm: Spread | None
    curvature_ratio: float | None
    figures: NetFigures = field(repr=False, compare=False)


def net_quality(
    control: ControlMesh,
    *,
    planarity: Planarity = Planarity.DIAGONAL_STARS,
    angle: Angle | None = None,
    rhombus: bool = False,
    reference: Surface | None = None,
) -> NetQuality:
    """Measure *control* by what it shall be; *angle* in radians, lengths in mm."""
    found = net_figures(
        control, planarity=planarity, angle=angle, rhombus=rhombus, reference=reference
    )
    return NetQuality(
        star_planarity=_told(found.star_planarity),
        face_planarity=_told(found.face_planarity),
        sphericity=_told(found.sphericity),
        angle_error_deg=_told(found.angle_error_deg),
        node_angle_deg=_range(found.node_angle_deg),
        rhombus_error=_told(found.rhombus_error),
        edge_ratio=_range(found.edge_ratio),
        corner_angle_deg=_range(found.corner_angle_deg),
        collapsed=int(
            np.count_nonzero(collapsed(control.vertices, control.quads, control.mesh.mean_edge))
        ),
        surface_distance_mm=_told(found.surface_distance_mm),
        curvature_ratio=curvature_ratio(control),
        figures=found,
    )


def net_figures(
    control: ControlMesh,
    *,
    planarity: Planarity = Planarity.DIAGONAL_STARS,
    angle: Angle | None = None,
    rhombus: bool = False,
    reference: Surface | None = None,
) -> NetFigures:
    """The same element by element."""
    vertices, quads = control.vertices, control.quads
    angles = crossing_angles(vertices, crossings(control, planarity))
    error = None
    if angle is not None:
        error = np.degrees(np.abs(angles - target_angles(control, planarity, angle)))
    return NetFigures(
        star_planarity=star_planarity(vertices, planar_stars(control, planarity))
        if planarity.of_stars
        else None,
        face_planarity=_face_planarity(control, planarity),
        sphericity=_sphericity(control) if planarity is Planarity.SPHERICAL_STARS else None,
        node_angle_deg=np.degrees(angles),
        angle_error_deg=error,
        rhombus_error=_rhombus_error(control) if rhombus else None,
        edge_ratio=_net_edges(control, planarity),
        corner_angle_deg=np.degrees(corner_angles(vertices, quads)).ravel(),
        surface_distance_mm=None if reference is None else _distances(control, reference),
    )


def quad_planarity(corners: Floats) -> Floats:
    """(m,) distance of the diagonals over their mean length, for corners (m, 4, 3)."""
    first, second = corners[:, 2] - corners[:, 0], corners[:, 3] - corners[:, 1]
    normal = np.cross(first, second)
    area = np.maximum(np.linalg.norm(normal, axis=1), 1e-300)
    mean = (np.linalg.norm(first, axis=1) + np.linalg.norm(second, axis=1)) / 2.0
    offset = np.einsum("mc,mc->m", corners[:, 1] - corners[:, 0], normal)
    return np.asarray(np.abs(offset) / area / mean)


def _face_planarity(control: ControlMesh, planarity: Planarity) -> Floats | None:
    if planarity is Planarity.FACES:
        return quad_planarity(control.vertices[control.quads])
    if planarity is Planarity.WHITE_FACES:
        rings = _white_rings(edge_stars(control.mesh))
        return np.concatenate([_ring_planarity(control.vertices[r]) for r in rings])
    return None


def _white_rings(stars: Stars) -> list[Indices]:
    counts = np.unique(stars.count[stars.closed])
    found = [stars.spokes[stars.closed & (stars.count == k), :k] for k in counts.tolist()]
    return found or [np.empty((0, 4), dtype=np.int64)]


def _ring_planarity(corners: Floats) -> Floats:
    """(m,) planarity of polygons (m, k, 3): for more than four corners from the best plane."""
    if corners.shape[1] == 4:
        return quad_planarity(corners)
    offset = corners - corners.mean(axis=1, keepdims=True)
    normal = np.linalg.svd(offset)[2][:, 2]
    distance = np.abs(np.einsum("mkc,mc->mk", offset, normal)).max(axis=1)
    return np.asarray(distance / (2.0 * np.linalg.norm(offset, axis=2).mean(axis=1)))


def _sphericity(control: ControlMesh) -> Floats:
    constraint, x = spherical_stars(diagonal_stars(control.mesh)), control.vertices.ravel()
    offset = np.abs(constraint.evaluate(x, constraint.lag(x)).residual[:, 0])
    corners = control.vertices[constraint.points]
    spokes = np.linalg.norm(corners[:, 1:] - corners[:, :1], axis=2).mean(axis=1)
    return np.asarray(offset / spokes)


def _rhombus_error(control: ControlMesh) -> Floats:
    corners = control.vertices[control.quads]
    length = np.linalg.norm(corners[:, 2:] - corners[:, :2], axis=2)
    return np.asarray(np.abs(length[:, 0] - length[:, 1]) / length.mean(axis=1))


def _net_edges(control: ControlMesh, planarity: Planarity) -> Floats:
    if planarity in (Planarity.EDGE_STARS, Planarity.FACES):
        length = control.mesh.edge_lengths
        return np.asarray(length / length.mean())
    second = planarity is Planarity.SECOND_DIAGONAL_STARS
    return _edge_ratios(diagonal_meshes(control)[int(second)])


def _edge_ratios(net: DiagonalMesh) -> Floats:
    """(e,) lengths over their mean."""
    a, b = net.vertices[net.edges.T]
    length = np.linalg.norm(a - b, axis=1)
    return np.asarray(length / length.mean())


def _range(figures: Floats) -> tuple[float, float]:
    return (float(figures.min()), float(figures.max())) if figures.size else (0.0, 0.0)


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
    return crossing_angles(control.vertices, control.quads)


def edge_ratio(net: DiagonalMesh) -> tuple[float, float]:
    """Shortest and longest edge over the mean edge."""
    return _range(_edge_ratios(net))


def curvature_ratio(control: ControlMesh) -> float | None:
    """Median of kappa1 / kappa2, smaller curvature in absolute value first.

    For ``kappa1 / kappa2 = -tan(angle / 2)^2`` with an angle of at most 90 degrees.
    """
    _, kappa = principal_curvatures(control.mesh, most=_SAMPLES)
    if len(kappa) == 0:
        return None
    small = np.where(np.abs(kappa[:, :1]) <= np.abs(kappa[:, 1:]), kappa, kappa[:, ::-1])
    return float(np.median(small[:, 0] / np.where(small[:, 1] == 0.0, np.inf, small[:, 1])))


def measured_against(quality: NetQuality, control: ControlMesh, reference: Surface) -> NetQuality:
    """*quality* of *control* with its distance from *reference*, kept to it or not."""
    away = _distances(control, reference)
    figures = replace(quality.figures, surface_distance_mm=away)
    return replace(quality, surface_distance_mm=_spread(away), figures=figures)


def _distances(control: ControlMesh, reference: Surface) -> Floats:
    """(n,) of the vertices in use, mm."""
    points = control.vertices[control.mesh.valence > 0]
    return np.asarray(np.linalg.norm(points - reference.closest(points).points, axis=1))


def _spread(figures: Floats) -> Spread:
    return Spread(float(figures.mean()), float(figures.max())) if len(figures) else Spread(0.0, 0.0)


def _told(figures: Floats | None) -> Spread | None:
    return None if figures is None else _spread(figures)
