"""Where the integer lines of a chart cross: the vertices of the quad mesh and their ports.

Everything here is in exact integers: chart positions are multiples of ``1 / UNIT``. A crossing lies
at a vertex of the triangles, on an edge, or inside a triangle. A *port* is one of the axis
directions 0, 1, 2, 3 (+u, +v, -u, -v) in which a line leaves a crossing. A direction belongs to the
sector (start, end] of one triangle: a line along an edge runs in the triangle on its right.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from gridshell.arrays import Floats, Indices, Mask
from gridshell.surface import TriangleMesh
from gridshell.surface.triangle_mesh import after, before

UNIT = 2**20
"""Integer coordinates of one cell."""

AXES = np.array([[1, 0], [0, 1], [-1, 0], [0, -1]], dtype=np.int64)

_SECOND_SIDE = 8
_REACH = 2**36
"""More than the length of an edge in the chart, in ``1 / UNIT`` of a cell."""


@dataclass(frozen=True, eq=False)
class ExactChart:
    """A seamless chart in integers.

    Parameters
    ----------
    mesh : the triangles.
    corners : (f, 3, 2) positions, in ``1 / UNIT`` of a cell.
    flips : (3f,) +1 or -1 by which positions are multiplied across a half-edge.
    shifts : (3f, 2) what is added then.
    """

    mesh: TriangleMesh
    corners: Indices
    flips: Indices
    shifts: Indices

    @classmethod
    def of(cls, mesh: TriangleMesh, corners: Floats, flips: Indices) -> ExactChart:
        """Take real corners (f, 3, 2), which are multiples of ``1 / UNIT``."""
        whole = np.rint(corners * UNIT).astype(np.int64)
        flat = whole.reshape(-1, 2)
        inner = np.flatnonzero(mesh.twin >= 0)
        shifts = np.zeros_like(flat)
        shifts[inner] = flat[after(mesh.twin[inner])] - flips[inner, None] * flat[inner]
        return cls(mesh, whole, flips, shifts)

    @property
    def flat(self) -> Indices:
        """(3f, 2) the corners by half-edge."""
        return self.corners.reshape(-1, 2)

    def along(self, halfedges: Indices) -> Indices:
        """(..., 2) chart vectors of half-edges."""
        return np.asarray(self.flat[after(halfedges)] - self.flat[halfedges])

    def carried(self, axes: Indices, halfedges: Indices) -> Indices:
        """*axes* as they are called on the other side of half-edges."""
        return np.where(self.flips[halfedges] > 0, axes, (axes + 2) % 4)


def cross(a: Indices, b: Indices) -> Indices:
    """Cross products (...) of vectors (..., 2)."""
    return np.asarray(a[..., 0] * b[..., 1] - a[..., 1] * b[..., 0])


@dataclass(frozen=True, eq=False)
class Ports:
    """Crossings of integer lines, c of them, and their ports, p of them.

    Parameters
    ----------
    face, at : (c,) a triangle with the crossing in it, and (c, 2) its position in that chart.
    whole : (c,) whether it is surrounded by the surface.
    owner : (p,) crossing of every port, ascending; its ports go round counter-clockwise.
    faces, starts, axes : (p,), (p, 2), (p,) the triangle a port starts into, the crossing's
        position and the axis in that chart.
    rim : (p,) lines along the boundary with the surface on their left: run in the triangle there.
    keys, order : (p,) ascending keys ``4 place + axis`` and the port of each.
    edge_keys : (e,) ascending keys of crossings on edges: half-edge and distance from its origin.
    face_keys : (i,) ascending keys of crossings inside triangles.
    """

    face: Indices
    at: Indices
    whole: Mask
    owner: Indices
    faces: Indices
    starts: Indices
    axes: Indices
    rim: Mask
    keys: Indices
    order: Indices
    edge_keys: Indices
    face_keys: Indices


def ports(chart: ExactChart) -> Ports:
    """All crossings of the chart's integer lines and the ports they have."""
    mesh = chart.mesh
    corner, vertex = _on_vertices(chart)
    edge, on_edge, edge_keys = _on_edges(chart)
    face, in_face, face_keys = _in_faces(chart)
    names, number = np.unique(vertex, return_inverse=True)
    first_edge, first_face = len(names), len(names) + len(edge)
    size = len(mesh.twin)
    rows = [_vertex_rows(chart, corner, number)]
    sides = ((edge, on_edge, 0), _other_side(chart, edge, on_edge))
    for halfedge, at, side in sides:
        item = np.flatnonzero(halfedge >= 0)
        place = size + 2 * item + side
        rows.append(_edge_rows(chart, halfedge[item], at[item], first_edge + item, place, side))
    item = np.arange(len(face))
    rows.append(_face_rows(face, in_face, first_face + item, size + 2 * len(edge) + item))
    owner, rank, place, faces, starts, axes = (
        np.concatenate([row[i] for row in rows]) for i in range(6)
    )
    rim: Mask = np.concatenate([row[6] for row in rows])
    order = np.lexsort((rank, owner))
    owner, place, faces, starts, axes = (x[order] for x in (owner, place, faces, starts, axes))
    key = 4 * place + axes
    by_key = np.argsort(key, kind="stable")
    some = np.unique(number, return_index=True)[1]
    return Ports(
        face=np.concatenate([corner[some] // 3, edge // 3, face]),
        at=np.concatenate([chart.flat[corner[some]], on_edge, in_face]),
        whole=np.concatenate(
            [~mesh.on_boundary[names], mesh.twin[edge] >= 0, np.ones(len(face), dtype=bool)]
        ),
        owner=owner,
        faces=faces,
        starts=starts,
        axes=axes,
        rim=rim[order],
        keys=key[by_key],
        order=by_key,
        edge_keys=edge_keys,
        face_keys=face_keys,
    )


# ---- crossings ----------------------------------------------------------------------------------


def _on_vertices(chart: ExactChart) -> tuple[Indices, Indices]:
    """Corners at lattice points, and their vertices."""
    corner = np.flatnonzero((chart.flat % UNIT == 0).all(axis=1))
    return corner, chart.mesh.origin[corner]


def _on_edges(chart: ExactChart) -> tuple[Indices, Indices, Indices]:
    """Lattice points strictly inside edges: half-edge, position in its chart, key; by key."""
    twin = chart.mesh.twin
    once = np.flatnonzero((twin < 0) | (np.arange(len(twin)) < twin))
    a, b = chart.flat[once], chart.flat[after(once)]
    row, at = _lattice_in(np.minimum(a, b), np.maximum(a, b))
    offset, along = at - a[row], (b - a)[row]
    reach = (offset * along).sum(axis=1)
    inside = (cross(along, offset) == 0) & (reach > 0) & ((at != b[row]).any(axis=1))
    inside &= reach < (along * along).sum(axis=1)
    halfedge, at = once[row[inside]], at[inside]
    key = halfedge * _REACH + np.abs(at - chart.flat[halfedge]).sum(axis=1)
    order = np.argsort(key, kind="stable")
    return halfedge[order], at[order], key[order]


def _in_faces(chart: ExactChart) -> tuple[Indices, Indices, Indices]:
    """Lattice points strictly inside triangles: triangle, position, key; by key."""
    low, high = chart.corners.min(axis=1), chart.corners.max(axis=1)
    row, at = _lattice_in(low, high)
    inside = np.ones(len(row), dtype=bool)
    for k in range(3):
        a, b = chart.corners[row, k], chart.corners[row, (k + 1) % 3]
        inside &= cross(b - a, at - a) > 0
    face, at = row[inside], at[inside]
    key = face_key(chart, face, at)
    order = np.argsort(key, kind="stable")
    return face[order], at[order], key[order]


def _lattice_in(low: Indices, high: Indices) -> tuple[Indices, Indices]:
    """Lattice points in closed boxes (b, 2): number of the box and position, for every point."""
    first, last = -(-low // UNIT), high // UNIT
    count = np.maximum(last - first + 1, 0)
    row = np.repeat(np.arange(len(low)), count.prod(axis=1))
    total = count.prod(axis=1)
    item = np.arange(len(row)) - np.repeat(np.cumsum(total) - total, total)
    columns = np.maximum(count[row, 1], 1)
    cell = first[row] + np.stack([item // columns, item % columns], axis=1)
    return row, cell * UNIT


def face_key(chart: ExactChart, face: Indices, at: Indices) -> Indices:
    """One number for a lattice point inside a triangle."""
    cell = at // UNIT - chart.corners[face].min(axis=1) // UNIT
    return np.asarray((face * 2**16 + cell[:, 0]) * 2**16 + cell[:, 1])


def edge_key(chart: ExactChart, halfedge: Indices, at: Indices) -> Indices:
    """One number for a lattice point on an edge, the same from both of its sides.

    Parameters
    ----------
    halfedge, at : (m,) the side it is seen from, and (m, 2) its position in that chart.
    """
    twin = chart.mesh.twin[halfedge]
    own = (twin < 0) | (halfedge < twin)
    start = np.where(own, halfedge, after(halfedge))
    name = np.where(own, halfedge, twin)
    return np.asarray(name * _REACH + np.abs(at - chart.flat[start]).sum(axis=1))


# ---- ports --------------------------------------------------------------------------------------

Rows = tuple[Indices, Indices, Indices, Indices, Indices, Indices, Mask]
"""Owner, rank around it, place in the key, triangle, position, axis, rim."""


def quarter(vectors: Indices) -> Indices:
    """The axis at or clockwise before every vector (..., 2)."""
    x, y = vectors[..., 0], vectors[..., 1]
    return np.where((x > 0) & (y >= 0), 0, np.where((x <= 0) & (y > 0), 1, np.where((x < 0), 2, 3)))


def _vertex_rows(chart: ExactChart, corner: Indices, owner: Indices) -> Rows:
    mesh = chart.mesh
    rank = np.empty(len(mesh.twin), dtype=np.int64)
    line, column = np.nonzero(mesh.fans >= 0)
    rank[mesh.fans[line, column]] = column
    start = chart.along(corner)
    end = chart.flat[before(corner)] - chart.flat[corner]
    item, axis = np.divmod(np.arange(4 * len(corner)), 4)
    d, a, b = AXES[axis], start[item], end[item]
    rim = (mesh.twin[corner[item]] < 0) & (cross(a, d) == 0) & ((a * d).sum(axis=1) > 0)
    keep = ((cross(a, d) > 0) & (cross(d, b) >= 0)) | rim
    item, axis, rim = item[keep], axis[keep], rim[keep]
    c = corner[item]
    around = 4 * rank[c] + (axis - quarter(start[item])) % 4
    return owner[item], around, c, c // 3, chart.flat[c], axis, rim


def _other_side(chart: ExactChart, edge: Indices, at: Indices) -> tuple[Indices, Indices, int]:
    """The same crossings seen from the twins: half-edge (-1 on the boundary), position, side 1."""
    return chart.mesh.twin[edge], chart.flips[edge, None] * at + chart.shifts[edge], 1


def _edge_rows(
    chart: ExactChart, halfedge: Indices, at: Indices, owner: Indices, place: Indices, side: int
) -> Rows:
    start = chart.along(halfedge)
    item, axis = np.divmod(np.arange(4 * len(halfedge)), 4)
    d, a = AXES[axis], start[item]
    turn, reach = cross(a, d), (a * d).sum(axis=1)
    rim = (chart.mesh.twin[halfedge[item]] < 0) & (turn == 0) & (reach > 0)
    keep = (turn > 0) | ((turn == 0) & (reach < 0)) | rim
    item, axis, rim = item[keep], axis[keep], rim[keep]
    around = _SECOND_SIDE * side + (axis - quarter(start[item])) % 4
    return owner[item], around, place[item], halfedge[item] // 3, at[item], axis, rim


def _face_rows(face: Indices, at: Indices, owner: Indices, place: Indices) -> Rows:
    item, axis = np.divmod(np.arange(4 * len(face)), 4)
    none = np.zeros(len(item), dtype=bool)
    return owner[item], axis, place[item], face[item], at[item], axis, none
