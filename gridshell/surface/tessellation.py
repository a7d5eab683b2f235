"""Triangles over surfaces given by formula, with exact curvature: the oracle of the pipeline."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from gridshell.arrays import Floats, Indices, unit
from gridshell.errors import SettingError
from gridshell.surface.analytic import AnalyticSurface, Domain
from gridshell.surface.curved_mesh import CurvedMesh
from gridshell.surface.exact_curvature import normals_and_shapes, on_triangles
from gridshell.surface.nearest import refine
from gridshell.surface.planar_mesher import mesh_domain
from gridshell.surface.triangle_mesh import TriangleMesh

_DENSE = 600
_FEWEST = 6
"""Samples around a circle in the parameters, at least."""


@dataclass(frozen=True)
class ParameterDisk:
    """A circle in the (u, v) plane: an outline, or a hole; *radius* is a pure number."""

    u: float
    v: float
    radius: float


def tessellate(
    surface: AnalyticSurface,
    *,
    edge: float,
    over: Domain | ParameterDisk | None = None,
    holes: Sequence[ParameterDisk] = (),
) -> CurvedMesh:
    """Triangulate a part of *surface* with edges of about *edge* mm and the exact curvature.

    Parameters
    ----------
    edge : mm.
    over : ((u0, u1), (v0, v1)) or a disk in the parameters; the surface's domain when None. A
        range of u of one whole period closes into a ring.
    holes : disks cut out, apart from each other and from the outline.

    Returns
    -------
    Normals along xu x xv; ``face_shapes`` are those of the surface at the foot of each centroid.

    Raises
    ------
    SettingError
        When *edge* makes too many triangles, the range is empty or the formula does not hold there.
    SurfaceError
        When holes cross each other or the outline.
    """
    over = surface.domain if over is None else over
    if isinstance(over, ParameterDisk):
        outline, closed = [_circle(over)], False
    else:
        outline, closed = _sides(over), _is_ring(surface, over)
    loops = [_sampled(surface, outline, edge)]
    loops += [_sampled(surface, [_circle(hole)], edge)[::-1] for hole in holes]
    border = np.concatenate(loops)
    surface.check(border[:, 0], border[:, 1])
    uv, triangles = mesh_domain(surface.derivatives, loops, edge=edge)
    if closed:
        uv, triangles, parameters = _glued(uv, triangles, loops[0], surface.period_u or 0.0)
    else:
        parameters = uv[triangles]
    d = surface.derivatives(uv[:, 0], uv[:, 1])
    mesh = TriangleMesh(d.x, triangles)
    normals, shapes = normals_and_shapes(d)
    return CurvedMesh(mesh, normals, shapes, _face_shapes(surface, mesh, parameters.mean(axis=1)))


def _face_shapes(surface: AnalyticSurface, mesh: TriangleMesh, middle: Floats) -> Floats:
    """Exact operators (f, 3) at the feet of the centroids, found from parameters (f, 2)."""
    foot = refine(
        surface.derivatives,
        lambda u, v: (u, v),
        (middle[:, 0], middle[:, 1]),
        mesh.centroids,
        length=surface.length_scale,
    )
    normals, shapes = normals_and_shapes(surface.derivatives(*foot))
    return on_triangles(mesh, unit(normals), shapes)


def _sides(over: Domain) -> list[Floats]:
    """The four sides of the box, counter-clockwise, each (k, 2); v0, u1, v1, u0."""
    (u0, u1), (v0, v1) = over
    if not (u1 > u0 and v1 > v0):
        raise SettingError(
            "The range of parameters is empty", where="over", value=str(over), limit="low < high"
        )
    corners = np.array([(u0, v0), (u1, v0), (u1, v1), (u0, v1), (u0, v0)])
    t = np.linspace(0.0, 1.0, _DENSE)[:, None]
    return [a + t * (b - a) for a, b in pairwise(corners)]


def _circle(disk: ParameterDisk) -> Floats:
    angle = np.linspace(0.0, 2.0 * np.pi, _DENSE)
    ring = np.stack([np.cos(angle), np.sin(angle)], axis=1)
    points: Floats = np.array([disk.u, disk.v]) + disk.radius * ring
    return points


def _is_ring(surface: AnalyticSurface, over: Domain) -> bool:
    period, width = surface.period_u, over[0][1] - over[0][0]
    if period is not None and width > period * (1.0 + 1e-9):
        raise SettingError(
            "The range of u laps over itself",
            where="over",
            value=f"{width:.6g}",
            limit=f"one period, {period:.6g}",
        )
    return period is not None and math.isclose(width, period, rel_tol=1e-9)


def _sampled(surface: AnalyticSurface, sides: list[Floats], edge: float) -> Floats:
    """A loop (k, 2) of points about *edge* apart in space along the sides."""
    loop = []
    for side in sides:
        x = surface.derivatives(side[:, 0], side[:, 1]).x
        length = np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(x, axis=0), axis=1))])
        fewest = _FEWEST if len(sides) == 1 or np.allclose(x[0], x[-1]) else 1
        wanted = length[-1] / edge if edge > 0.0 else 0.0
        count = max(fewest, round(min(wanted, 1e6)))
        steps = np.linspace(0.0, length[-1], count + 1)[:-1]
        loop.append(np.stack([np.interp(steps, length, side[:, k]) for k in range(2)], axis=1))
    return np.concatenate(loop)


def _glued(
    uv: Floats, triangles: Indices, outline: Floats, period: float
) -> tuple[Floats, Indices, Floats]:
    """Join the two sides u0 and u1 of a ring: parameters, triangles and corners (f, 3, 2)."""
    low, corners = float(outline[:, 0].min()), uv[triangles]
    left = np.flatnonzero(outline[:, 0] <= low + 1e-12 * period)
    right = np.flatnonzero(outline[:, 0] >= low + period * (1.0 - 1e-12))
    left, right = left[np.argsort(outline[left, 1])], right[np.argsort(outline[right, 1])]
    name = np.arange(len(uv))
    name[right] = left
    used, compact = np.unique(name[triangles], return_inverse=True)
    return uv[used], compact.reshape(-1, 3), corners
