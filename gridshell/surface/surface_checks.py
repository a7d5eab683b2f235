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
    DisconnectedError,
    NonManifoldError,
    OrientationError,
    SelfIntersectionError,
    SurfaceError,
)
from gridshell.surface.self_intersection import crossing_triangles
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
    faces, more = _oriented(points, faces)
    remarks += more
    _require_fans(points, faces)
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


def _oriented(points: Points, faces: Indices) -> tuple[Indices, list[Remark]]:
    """Turn the fewest triangles so that neighbours face the same side.

    Every triangle is two nodes, as it is and turned; neighbours link the nodes that agree. A
    surface with two sides falls into two parts, a Moebius strip into one.
    """
    from scipy import sparse
    from scipy.sparse.csgraph import connected_components

    f, n = len(faces), len(points)
    start, end = faces.ravel(), np.roll(faces, -1, axis=1).ravel()
    key = np.minimum(start, end) * n + np.maximum(start, end)
    order = np.argsort(key, kind="stable")
    ordered = key[order]
    triple = np.flatnonzero(ordered[2:] == ordered[:-2])
    if len(triple):
        h = order[triple[0]]
        raise NonManifoldError(
            "An edge belongs to more than two triangles",
            where=f"edge {start[h]}-{end[h]} {place((points[start[h]] + points[end[h]]) / 2.0)}",
            value=f"{int((ordered == ordered[triple[0]]).sum())} triangles, "
            f"{len(np.unique(ordered[triple]))} such edges",
            limit="2 triangles",
            advice="split the surface along that edge, or remove what is doubled",
        )
    pair = np.flatnonzero(ordered[1:] == ordered[:-1])
    one, other = order[pair], order[pair + 1]
    turned = (start[one] == start[other]).astype(np.int64)
    one, other = one // 3, other // 3
    rows = np.concatenate([one, one + f])
    columns = np.concatenate([other + f * turned, other + f * (1 - turned)])
    links = sparse.coo_matrix((np.ones(len(rows)), (rows, columns)), shape=(2 * f, 2 * f))
    count, label = connected_components(links, directed=False)
    _require_one_piece(points, faces, np.minimum(label[:f], label[f:]))
    if count == 1:
        raise OrientationError(
            "The surface has only one side, as a Moebius strip",
            value=f"{f} triangles",
            limit="two sides",
            advice="cut it open",
        )
    odd = label[:f] != label[0]
    if 2 * np.count_nonzero(odd) > f:
        odd = ~odd
    turns = np.flatnonzero(odd)
    if not len(turns):
        return faces, []
    where = f"triangle {turns[0]} {place(points[faces[turns[0]]].mean(axis=0))}"
    message = f"{len(turns)} triangles faced the other way and were turned"
    result = np.where(odd[:, None], faces[:, ::-1], faces)
    return result, [Remark("turned-triangles", message, len(turns), where)]


def _require_one_piece(points: Points, faces: Indices, label: Indices) -> None:
    """Refuse several pieces; *label* (f,) is the same within one."""
    first, count = np.unique(label, return_index=True, return_counts=True)[1:]
    if len(first) > 1:
        order = np.argsort(-count, kind="stable")
        shown = ", ".join(str(c) for c in count[order[:6]]) + (", ..." if len(count) > 6 else "")
        smaller = faces[first[order[1]]]
        raise DisconnectedError(
            "The surface is in several pieces",
            where=f"one of them at {place(points[smaller].mean(axis=0))}",
            value=f"{len(count)} pieces of {shown} triangles",
            limit="one piece",
            advice="join the pieces, or give each a file of its own",
        )


def _require_fans(points: Points, faces: Indices) -> None:
    """Refuse a vertex whose triangles form more than one fan around it.

    Corners at a vertex are linked where their triangles share an edge there; a fan is a part.
    """
    from scipy import sparse
    from scipy.sparse.csgraph import connected_components

    n, corners = len(points), np.arange(faces.size)
    start, end = faces.ravel(), np.roll(faces, -1, axis=1).ravel()
    following = np.where(corners % 3 == 2, corners - 2, corners + 1)
    order = np.argsort(np.minimum(start, end) * n + np.maximum(start, end), kind="stable")
    key = (np.minimum(start, end) * n + np.maximum(start, end))[order]
    pair = np.flatnonzero(key[1:] == key[:-1])
    a, b = order[pair], order[pair + 1]
    rows, columns = np.concatenate([a, following[a]]), np.concatenate([following[b], b])
    links = sparse.coo_matrix((np.ones(len(rows)), (rows, columns)), shape=(faces.size,) * 2)
    label = connected_components(links, directed=False)[1]
    fans = np.bincount(start[np.unique(label, return_index=True)[1]], minlength=n)
    broken = np.flatnonzero(fans > 1)
    if len(broken):
        raise NonManifoldError(
            "Two fans of triangles meet in one vertex",
            where=f"vertex {broken[0]} {place(points[broken[0]])}",
            value=f"{fans[broken[0]]} fans, {len(broken)} such vertices",
            limit="one fan",
            advice="remove what touches only there",
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
