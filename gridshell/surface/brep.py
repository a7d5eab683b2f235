"""BrepSurface: trimmed NURBS faces, sewn into one patch, as a design surface.

Everything is exact: closest points by Newton's method on the faces and on the curves that trim
them, normals and curvature from the derivatives of the NURBS. The CAD kernel only hands the arrays
over; it is not called for points.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np

from gridshell.arrays import Floats, Indices, Points, unit
from gridshell.surface import forms
from gridshell.surface.brep_mesh import (
    FacePart,
    Tessellation,
    face_area,
    tessellated,
    trimming_polygons,
)
from gridshell.surface.brep_model import BrepFace, BrepModel
from gridshell.surface.constrained_delaunay import inside
from gridshell.surface.curved_mesh import CurvedMesh
from gridshell.surface.exact_curvature import normals_and_shapes, on_triangles
from gridshell.surface.forms import Derivatives, dot
from gridshell.surface.nurbs import NurbsCurve
from gridshell.surface.patch_foot import regular, settle
from gridshell.surface.surface import Foot, checked_points
from gridshell.surface.triangle_mesh import TriangleMesh

_SEED_TRIANGLES = 6000
_NEAR = 12  # seeds looked at per point
_NEAR_EDGES = 6
_CURVE_STEPS = 30
_SIDE = 1e-9
_INSET = 1e-3  # of the way to the next triangle, where derivatives at a pole are taken


@dataclass(frozen=True, eq=False)
class BrepSurface:
    """One patch of trimmed NURBS faces; the normals of all lie on the side of the first one.

    Normals and curvature at a vertex shared by faces are the mean of the faces': right where the
    faces meet smoothly, and a compromise on a crease (see `largest_crease`).
    """

    model: BrepModel

    @classmethod
    def of_shape(cls, shape: Any, *, tolerance: float | None = None) -> BrepSurface:
        """The faces of a CAD kernel shape (``build123d_face.wrapped``), mm.

        Parameters
        ----------
        tolerance : gaps up to this are sewn, mm; a 50,000th of the size when None.

        Raises
        ------
        NotOnePatchError
            No faces, a solid, several patches, or one that branches.
        SurfaceError
            A patch with one side only, or a broken outline.
        """
        from gridshell.surface.brep_kernel import model_of

        return cls(model_of(shape, tolerance=tolerance))

    @cached_property
    def area(self) -> float:
        """Area to about one per cent, mm2."""
        return sum(face_area(face) for face in self.model.faces)

    @cached_property
    def largest_crease(self) -> float:
        """Largest angle, radians, between the normals of two faces along an edge they share."""
        largest = 0.0
        for edge, uses in enumerate(self.model.uses):
            curve = self.model.edges[edge].curve
            if len(uses) != 2 or curve is None:
                continue
            t = np.linspace(0.05, 0.95, 19)
            first, second = self._beside(edge, t, curve.point(t))
            largest = max(largest, float(np.arccos(np.clip(dot(first, second), -1, 1)).max()))
        return largest

    def curved_mesh(self, edge: float) -> CurvedMesh:
        """Triangulate with edges of about *edge* mm and the exact curvature.

        ``face_shapes`` are those of the surface at the foot of each triangle's centroid.

        Raises
        ------
        SettingError
            When *edge* makes too many triangles.
        SurfaceError
            When a face is too small for *edge*, or closed so tightly that triangles coincide.
        """
        found = tessellated(self.model, edge=edge)
        mesh = TriangleMesh(found.vertices, found.triangles)
        n = len(mesh.vertices)
        normals, shapes, count = np.zeros((n, 3)), np.zeros((n, 3, 3)), np.zeros(n)
        feet = []
        for face, part in zip(self.model.faces, found.parts, strict=True):
            used = np.unique(part.triangles)
            uv = _inset(part)[used]
            normal, shape = normals_and_shapes(face.patch.derivatives(*uv.T), face.side)
            np.add.at(normals, part.ids[used], normal)
            np.add.at(shapes, part.ids[used], shape)
            np.add.at(count, part.ids[used], 1.0)
            middle = part.parameters[part.triangles].mean(axis=1)
            centroid = mesh.vertices[part.ids[part.triangles]].mean(axis=1)
            foot = settle(face.patch, middle, centroid, self._size)
            feet.append(normals_and_shapes(face.patch.derivatives(*foot.T), face.side))
        face_normals, face_operators = (np.concatenate(x) for x in zip(*feet, strict=True))
        return CurvedMesh(
            mesh,
            unit(normals),
            shapes / count[:, None, None],
            on_triangles(mesh, face_normals, face_operators),
        )

    def closest(self, points: Points) -> Foot:
        """Find the feet of *points* (n, 3), mm, on the trimmed faces.

        The foot is the nearest of the local minima next to the nearest seeds of every face, or the
        nearest point of an edge where those lie outside of the trimming curves.

        Raises
        ------
        InputError
            When *points* is not (n, 3) or not finite.
        """
        points = checked_points(points)
        best = _Best(len(points))
        rows, faces, starts = self._pairs(points)
        ask_edges = np.zeros(len(points), dtype=bool)
        for number in np.unique(faces):
            face, here = self.model.faces[number], faces == number
            uv = settle(face.patch, starts[here], points[rows[here]], self._size)
            uv = _unrolled(face, uv, self._polygons[number])
            d = regular(face.patch, uv, self._size)
            bound = ((uv <= _SIDE) | (uv >= 1.0 - _SIDE)) & ~np.array(face.patch.closed)
            within = inside(uv, self._polygons[number])
            ask_edges[rows[here][~within | bound.any(axis=1)]] = True
            hit = within | bound.any(axis=1) & inside(_nudged(uv), self._polygons[number])
            best.offer(rows[here][hit], d, hit, points, face.side)
        ask_edges |= ~np.isfinite(best.distance)
        self._from_edges(best, np.flatnonzero(ask_edges), points)
        return Foot(best.feet, best.normals, best.curvature)

    # ---- seeds and candidates ---------------------------------------------------------------

    @cached_property
    def _size(self) -> float:
        return self.model.size

    @cached_property
    def _polygons(self) -> list[list[Floats]]:
        return [trimming_polygons(face) for face in self.model.faces]

    @cached_property
    def _coarse(self) -> Tessellation:
        return tessellated(self.model, edge=float(np.sqrt(self.area / _SEED_TRIANGLES / 0.433)))

    @cached_property
    def _seeds(self) -> tuple[Any, Indices, Floats]:
        """Tree of seed points, the face of each and its parameters (n, 2)."""
        from scipy.spatial import cKDTree

        uv = [
            np.concatenate([_inset(p), p.parameters[p.triangles].mean(axis=1)])
            for p in self._coarse.parts
        ]
        places = [
            face.patch.derivatives(*rows.T).x
            for face, rows in zip(self.model.faces, uv, strict=True)
        ]
        owner = np.repeat(np.arange(len(uv)), [len(rows) for rows in uv])
        return cKDTree(np.concatenate(places)), owner, np.concatenate(uv)

    def _pairs(self, points: Points) -> tuple[Indices, Indices, Floats]:
        """Point, face and start (k, 2) of every face that has a seed near a point."""
        tree, owner, uv = self._seeds
        near = tree.query(points, k=min(_NEAR, len(owner)))[1].reshape(len(points), -1)
        key = np.arange(len(points))[:, None] * len(self.model.faces) + owner[near]
        pair, first = np.unique(key.ravel(), return_index=True)
        faces = len(self.model.faces)
        return pair // faces, pair % faces, uv[near.ravel()[first]]

    @cached_property
    def _edge_seeds(self) -> tuple[Any, Indices, Floats]:
        """Tree of points on the edges, the edge of each and its t."""
        from scipy.spatial import cKDTree

        places, owner, values = [], [], []
        for number, edge in enumerate(self.model.edges):
            if edge.curve is not None:
                t = np.linspace(0.0, 1.0, 65 + 8 * len(edge.curve.poles))
                places.append(edge.curve.point(t))
                owner.append(np.full(len(t), number))
                values.append(t)
        return cKDTree(np.concatenate(places)), np.concatenate(owner), np.concatenate(values)

    def _from_edges(self, best: _Best, rows: Indices, points: Points) -> None:
        """Offer the nearest points of the edges for *rows*."""
        if not len(rows):
            return
        tree, owner, values = self._edge_seeds
        near = tree.query(points[rows], k=min(_NEAR_EDGES, len(owner)))[1].reshape(len(rows), -1)
        key = np.arange(len(rows))[:, None] * len(self.model.edges) + owner[near]
        pair, first = np.unique(key.ravel(), return_index=True)
        which, edges = pair // len(self.model.edges), pair % len(self.model.edges)
        start = values[near.ravel()[first]]
        for number in np.unique(edges).tolist():
            here, curve = edges == number, self.model.edges[number].curve
            face_number = self.model.uses[number][0][0]
            target = rows[which[here]]
            t = _curve_foot(curve, start[here], points[target])
            d = self._on_face(face_number, number, t, curve.point(t))
            everywhere = np.ones(len(t), dtype=bool)
            best.offer(target, d, everywhere, points, self.model.faces[face_number].side)

    def _on_face(self, face_number: int, edge: int, t: Floats, points: Points) -> Derivatives:
        """A face at *points* (n, 3) of one of its edges, with x replaced by the points."""
        face = self.model.faces[face_number]
        coedge = next(c for loop in face.loops for c in loop if c.edge == edge)
        uv = settle(face.patch, coedge.curve.point(t), points, self._size)
        return regular(face.patch, uv, self._size)._replace(x=points)

    def _beside(self, edge: int, t: Floats, points: Points) -> list[Floats]:
        """Normals (n, 3) of every face along *edge*."""
        return [
            self.model.faces[f].side * forms.unit_normal(self._on_face(f, edge, t, points))
            for f, _ in self.model.uses[edge]
        ]


class _Best:
    """The nearest foot of every point so far."""

    def __init__(self, count: int) -> None:
        self.distance = np.full(count, np.inf)
        self.feet, self.normals = np.zeros((count, 3)), np.zeros((count, 3))
        self.curvature = np.zeros((count, 2))

    def offer(self, rows: Indices, d: Derivatives, hit: Any, points: Points, side: int) -> None:
        """Take the places ``d[hit]`` for *rows* where they are nearer."""
        d = Derivatives(*(part[hit] for part in d))
        away = np.linalg.norm(d.x - points[rows], axis=1)
        closer = away < self.distance[rows]
        d, rows = Derivatives(*(part[closer] for part in d)), rows[closer]
        self.distance[rows], self.feet[rows] = away[closer], d.x
        self.normals[rows] = side * forms.unit_normal(d)
        kappa = forms.principal(d)
        self.curvature[rows] = kappa if side > 0 else -kappa[:, ::-1]


def _curve_foot(curve: NurbsCurve, t: Floats, points: Points) -> Floats:
    """Values of t (n,) at the feet of *points* (n, 3) next to *t*, within 0 .. 1 or around."""
    ends = curve.point(np.array([0.0, 1.0]))
    closed = bool(np.linalg.norm(ends[1] - ends[0]) <= 1e-9 * np.abs(ends).max())
    for _ in range(_CURVE_STEPS):
        x, x1, x2 = curve.derivatives(t)
        slope, square = dot(x - points, x1), dot(x1, x1)
        bend = np.maximum(square + dot(x - points, x2), 0.1 * square)
        t = t - slope / np.where(bend > 0.0, bend, 1.0)
        t = t % 1.0 if closed else np.clip(t, 0.0, 1.0)
    return t


def _unrolled(face: BrepFace, uv: Floats, polygons: list[Floats]) -> Floats:
    """Parameters in the turn of a closed direction in which the trimming curves lie."""
    low = np.concatenate(polygons).min(axis=0)
    return np.where(face.patch.closed, low + (uv - low) % 1.0, uv)


def _nudged(uv: Floats) -> Floats:
    """Parameters moved a little into the unit square."""
    return np.clip(uv, 1e-9, 1.0 - 1e-9)


def _inset(part: FacePart) -> Floats:
    """Parameters (k, 2), at poles moved a little into one of the triangles there."""
    uv = part.parameters.copy()
    middle = uv[part.triangles].mean(axis=1)
    inner = uv.copy()
    inner[part.triangles.ravel()] = np.repeat(middle, 3, axis=0)
    uv[part.at_pole] += _INSET * (inner - uv)[part.at_pole]
    return uv
