"""From the triangles of a file to a sound surface: what is mended, what is refused, and where.

Mended, with a remark: doubled vertices (every STL file), loose vertices, doubled and collapsed
triangles, triangles that face the other way. Refused by name: everything else.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from gridshell.arrays import Floats, Indices, Points
from gridshell.errors import (
    DegenerateSurfaceError,
    SelfIntersectionError,
    SurfaceError,
)
from gridshell.surface.self_intersection import crossing_triangles
from gridshell.surface.surface_topology import oriented, require_fans
from gridshell.surface.triangle_mesh import TriangleMesh, place
from gridshell.surface.welding import welded

WELD = 1e-7
"""Vertices closer than this times the surface's diagonal are one; single precision has 6e-8."""

LARGEST_ASPECT = 8.0
"""Longest edge over height, 1 for an equilateral triangle; beyond, curvature is poorly seen."""

USUAL_SIZE = 100.0, 1e6
"""Diagonals in mm, from a model on the table to a kilometre, outside of which a unit is suspect."""

_SIZES = 1e-9, 1e15
_ROUNDING = 1e-9
"""Coordinates may exceed the size by one over this: then the seven last digits carry the shape."""

_FLATTEST = 1e-9
"""Height of a triangle over its longest edge below which it has no area."""


@dataclass(frozen=True)
class Remark:
    """Something that was mended or is worth knowing.

    Parameters
    ----------
    code : one word for programs, as ``welded``.
    message : one clause for people, no full stop.
    value : the number that goes with it.
    where : the first place, if there is one.
    """

    code: str
    message: str
    value: float
    where: str | None = None


def sound_mesh(
    vertices: npt.ArrayLike, triangles: npt.ArrayLike
) -> tuple[TriangleMesh, tuple[Remark, ...]]:
    """Weld, clean and orient the triangles of a file, and refuse what is no surface.

    Parameters
    ----------
    vertices : (n, 3) mm.
    triangles : (f, 3) vertex indices.

    Raises
    ------
    SurfaceError
        For arrays that are no triangles.
    DegenerateSurfaceError
        For a vertex that is not finite, a triangle without area, a size that is absurd.
    NonManifoldError
        For an edge with more than two triangles or a vertex with two fans.
    DisconnectedError, OrientationError, SelfIntersectionError
        For several pieces, a one-sided surface, one that cuts through itself.
    """
    points, faces = _arrays(vertices, triangles)
    size = _size(points, faces)
    count, remarks = len(points), []
    points, faces = welded(points, faces, within=WELD * size)
    if doubled := count - len(points):
        remarks.append(Remark("welded", f"{doubled} doubled vertices welded", doubled))
    faces, more = _distinct(points, faces)
    remarks += more
    used = np.zeros(len(points), dtype=bool)
    used[faces] = True
    if not used.all():
        loose = int(np.count_nonzero(~used))
        remarks.append(Remark("loose-vertices", f"{loose} loose vertices removed", loose))
        points, faces = points[used], (np.cumsum(used) - 1)[faces]
    _require_area(points, faces)
    faces, turned = oriented(points, faces)
    if len(turned):
        where = f"triangle {turned[0]} {place(points[faces[turned[0]]].mean(axis=0))}"
        message = f"{len(turned)} triangles faced the other way and were turned"
        remarks.append(Remark("turned-triangles", message, len(turned), where))
    require_fans(points, faces)
    mesh = TriangleMesh(points, faces)
    remarks += _require_no_crossing(mesh)
    return mesh, (*remarks, *_shape_remarks(mesh, size))


def aspects(mesh: TriangleMesh) -> Floats:
    """Longest edge over height (f,), 1 for an equilateral triangle."""
    longest = mesh.edge_lengths.reshape(-1, 3).max(axis=1)
    return np.asarray(np.sqrt(0.75) * longest**2 / (2.0 * mesh.areas))


def _arrays(vertices: npt.ArrayLike, triangles: npt.ArrayLike) -> tuple[Points, Indices]:
    points = np.asarray(vertices, dtype=np.float64)
    faces = np.asarray(triangles)
    fits = points.ndim == 2 and points.shape[1] == 3 and faces.ndim == 2 and faces.shape[1] == 3
    if not fits or len(faces) == 0 or not np.issubdtype(faces.dtype, np.integer):
        raise SurfaceError(
            "A surface needs triangles over its vertices",
            value=f"vertices {points.shape}, triangles {faces.shape} of {faces.dtype}",
            limit="(n, 3) numbers and (f, 3) indices, at least one triangle",
        )
    outside = np.flatnonzero(((faces < 0) | (faces >= len(points))).any(axis=1))
    if len(outside):
        raise SurfaceError(
            "A triangle uses a vertex that is not there",
            where=f"triangle {outside[0]}",
            value=str(faces[outside[0]].tolist()),
            limit=f"0 .. {len(points) - 1}",
        )
    bad = np.flatnonzero(~np.isfinite(points).all(axis=1))
    if len(bad):
        raise DegenerateSurfaceError(
            "A vertex is not finite",
            where=f"vertex {bad[0]}",
            value=f"{points[bad[0]].tolist()}, {len(bad)} such vertices",
            limit="finite coordinates, mm",
        )
    return points, faces.astype(np.int64)


def _size(points: Points, faces: Indices) -> float:
    """Diagonal of the box about the triangles, mm; absurd ones are refused."""
    corners = points[faces.ravel()]
    size = float(np.linalg.norm(np.ptp(corners, axis=0)))
    furthest = float(np.abs(corners).max())
    if not _SIZES[0] < size < _SIZES[1]:
        raise DegenerateSurfaceError(
            "The surface has no sensible size",
            value=f"diagonal {size:.3g} mm",
            limit=f"{_SIZES[0]:g} .. {_SIZES[1]:g} mm",
            advice="check the unit of the file",
        )
    if furthest * _ROUNDING > size:
        raise DegenerateSurfaceError(
            "The surface lies too far from the origin to keep its shape",
            value=f"{furthest:.3g} mm away at a size of {size:.3g} mm",
            limit=f"{size / _ROUNDING:.3g} mm",
            advice="move it to the origin in the modeller",
        )
    return size


def _distinct(points: Points, faces: Indices) -> tuple[Indices, list[Remark]]:
    """Without triangles that collapsed to an edge or are there twice."""
    remarks = []
    a, b, c = faces.T
    collapsed = np.flatnonzero((a == b) | (b == c) | (c == a))
    if len(collapsed):
        where = f"triangle {collapsed[0]} {place(points[a[collapsed[0]]])}"
        message = f"{len(collapsed)} triangles between two vertices removed"
        remarks.append(Remark("collapsed-triangles", message, len(collapsed), where))
        faces = np.delete(faces, collapsed, axis=0)
    kept = np.sort(np.unique(np.sort(faces, axis=1), axis=0, return_index=True)[1])
    if len(kept) == 0:
        raise DegenerateSurfaceError("No triangle has an area", advice="check the unit of the file")
    if doubled := len(faces) - len(kept):
        message = f"{doubled} doubled triangles removed"
        remarks.append(Remark("doubled-triangles", message, doubled))
    return faces[kept], remarks


def _require_area(points: Points, faces: Indices) -> None:
    corners = points[faces]
    edges = np.roll(corners, -1, axis=1) - corners
    longest = np.einsum("fkc,fkc->fk", edges, edges).max(axis=1)
    area = np.linalg.norm(np.cross(edges[:, 0], edges[:, 1]), axis=1)
    empty = np.flatnonzero(area <= _FLATTEST * longest)
    if len(empty):
        raise DegenerateSurfaceError(
            "A triangle has no area",
            where=f"triangle {faces[empty[0]].tolist()} {place(corners[empty[0]].mean(axis=0))}",
            value=f"{len(empty)} such triangles",
            limit=f"height above {_FLATTEST:g} of the longest edge",
            advice="remove degenerate triangles in the modeller",
        )


def _require_no_crossing(mesh: TriangleMesh) -> list[Remark]:
    pairs = crossing_triangles(mesh.vertices, mesh.triangles)
    if pairs is None:
        return [Remark("crossings-unknown", "too uneven to ask whether it cuts itself", np.nan)]
    if len(pairs):
        i, j = pairs[0]
        raise SelfIntersectionError(
            "The surface cuts through itself",
            where=f"triangles {i} and {j} {place(mesh.centroids[[i, j]].mean(axis=0))}",
            value=f"{len(pairs)} pairs of triangles",
            limit="none",
            advice="trim the surface where it crosses",
        )
    return []


def _shape_remarks(mesh: TriangleMesh, size: float) -> list[Remark]:
    """Remarks on slivers and on a size that hints at a wrong unit."""
    remarks = []
    aspect = aspects(mesh)
    poor = np.flatnonzero(aspect > LARGEST_ASPECT)
    if len(poor):
        worst = int(np.argmax(aspect))
        share = float(mesh.areas[poor].sum() / mesh.areas.sum())
        message = f"{len(poor)} triangles are slivers, {100.0 * share:.1f} % of the area"
        where = f"triangle {worst} {place(mesh.centroids[worst])}"
        remarks.append(Remark("slivers", message, share, where))
    if not USUAL_SIZE[0] <= size <= USUAL_SIZE[1]:
        message = f"the surface measures {size:.3g} mm: check the unit of the file"
        remarks.append(Remark("unusual-size", message, size))
    return remarks
