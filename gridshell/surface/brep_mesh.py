"""Triangles over all faces of a B-rep: shared edges are sampled once, so that nothing gapes."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from gridshell.arrays import Floats, Indices, Mask, Points
from gridshell.errors import SurfaceError
from gridshell.surface.brep_model import BrepFace, BrepModel, Coedge
from gridshell.surface.constrained_delaunay import inside
from gridshell.surface.forms import dot
from gridshell.surface.nurbs import NurbsCurve
from gridshell.surface.patch_foot import settle
from gridshell.surface.planar_mesher import mesh_domain, require_few

_LARGEST_TURN = np.pi / 3.0  # of an edge's direction between two of its samples
_TINY = 0.25  # of the edge length: shorter edges shrink to a vertex
_POLE_COPIES = 24
_DENSE = 512


@dataclass(frozen=True, eq=False)
class FacePart:
    """What one face contributes.

    Parameters
    ----------
    parameters : (k, 2) u and v.
    ids : (k,) vertices of the whole; a seam or a pole names one vertex more than once.
    triangles : (g, 3) into *parameters*, counter-clockwise seen from the positive side.
    at_pole : (k,) where the parametrisation is singular.
    """

    parameters: Floats
    ids: Indices
    triangles: Indices
    at_pole: Mask


@dataclass(frozen=True, eq=False)
class Tessellation:
    """Vertices (n, 3), mm, and the part of every face."""

    vertices: Points
    parts: tuple[FacePart, ...]

    @property
    def triangles(self) -> Indices:
        """(f, 3) vertices, face after face."""
        return np.concatenate([part.ids[part.triangles] for part in self.parts])


def tessellated(model: BrepModel, *, edge: float) -> Tessellation:
    """Triangulate every face with edges of about *edge*, mm; edges far shorter are closed up.

    Raises
    ------
    SettingError
        When *edge* makes too many triangles.
    SurfaceError
        When a face is too small or too thin for *edge*, or its outline crosses itself.
    """
    require_few(sum(face_area(face) for face in model.faces), edge)
    border = _Border(model, edge)
    vertices, count = [border.positions], len(border.positions)
    parts = []
    for number, face in enumerate(model.faces):
        loops, ids, at_pole = border.loops(number, face)
        uv, triangles = mesh_domain(face.patch.derivatives, loops, edge=edge)
        fresh = uv[len(ids) :]
        vertices.append(face.patch.derivatives(*fresh.T).x)
        ids = np.concatenate([ids, count + np.arange(len(fresh))])
        at_pole = np.concatenate([at_pole, np.zeros(len(fresh), dtype=bool)])
        count += len(fresh)
        named = ids[triangles]
        whole = (named != np.roll(named, -1, axis=1)).all(axis=1)
        triangles = triangles[whole] if face.side > 0 else triangles[whole][:, ::-1]
        parts.append(FacePart(uv, ids, triangles, at_pole))
    return _compact(Tessellation(np.concatenate(vertices), tuple(parts)))


def face_area(face: BrepFace) -> float:
    """Area inside the loops to about one per cent, mm2."""
    polygons = trimming_polygons(face)
    low, high = np.concatenate(polygons).min(axis=0), np.concatenate(polygons).max(axis=0)
    steps = (np.arange(40) + 0.5) / 40.0
    u, v = np.meshgrid(*(low[:, None] + steps * (high - low)[:, None]), indexing="ij")
    grid = np.stack([u.ravel(), v.ravel()], axis=1)
    grid = grid[inside(grid, polygons)]
    d = face.patch.derivatives(*grid.T)
    cell = float(np.prod(high - low)) / 1600.0
    return float(np.linalg.norm(np.cross(d.xu, d.xv), axis=1).sum()) * cell


def trimming_polygons(face: BrepFace) -> list[Floats]:
    """The loops of a face as fine polygons (k, 2) in its parameters."""
    return [np.concatenate([_walked(c, _dense(c.curve))[:-1] for c in loop]) for loop in face.loops]


def _walked(coedge: Coedge, t: Floats) -> Floats:
    points = coedge.curve.point(t)
    return points[::-1] if coedge.backwards else points


def _dense(curve: NurbsCurve) -> Floats:
    straight = curve.degree == 1 and len(curve.poles) == 2
    return np.linspace(0.0, 1.0, 3 if straight else _DENSE + 8 * len(curve.poles) + 1)


class _Border:
    """Samples of every edge: parameters t, and the vertex each sample is."""

    def __init__(self, model: BrepModel, edge: float) -> None:
        self.model, self.size = model, model.size
        self.t = [_sampled(e.curve, edge) for e in model.edges]
        root = list(range(len(model.vertices)))
        for number, item in enumerate(model.edges):
            if len(self.t[number]) == 2 and item.start != item.end and item.curve is not None:
                ends = item.curve.point(np.array([0.0, 1.0]))
                if np.linalg.norm(ends[1] - ends[0]) < _TINY * edge:
                    keep, drop = sorted((root[item.start], root[item.end]))
                    root = [keep if r == drop else r for r in root]
        positions, count = [model.vertices], len(model.vertices)
        self.ids: list[Indices] = []
        for item, t in zip(model.edges, self.t, strict=True):
            inner = max(len(t) - 2, 0) if item.curve is not None else 0
            ids = np.concatenate([[root[item.start]], count + np.arange(inner), [root[item.end]]])
            if item.curve is None:
                ids = np.full(len(t), root[item.start])
            else:
                positions.append(item.curve.point(t[1:-1]))
            self.ids.append(ids.astype(np.int64))
            count += inner
        self.positions = np.concatenate(positions)
        self.poles = {root[e.start] for e in model.edges if e.curve is None}

    def loops(self, number: int, face: BrepFace) -> tuple[list[Floats], Indices, Mask]:
        """Loops in the face's parameters, and for all their points the vertex and if at a pole."""
        loops, ids = [], []
        for loop in face.loops:
            parts = [self._coedge(c) for c in loop]
            loops.append(np.concatenate([uv for uv, _ in parts]))
            ids.append(np.concatenate([names for _, names in parts]))
            if len(ids[-1]) < 3:
                raise SurfaceError(
                    "A face is too small for the edge length",
                    where=f"face {number}",
                    value=f"{len(ids[-1])} points on its outline",
                    limit="3 or more",
                    advice="give a shorter edge, or remove the face",
                )
        named = np.concatenate(ids)
        singular = {
            self.model.edges[c.edge].start
            for lo in face.loops
            for c in lo
            if self.model.edges[c.edge].curve is None
        }
        at_pole = np.isin(named, sorted(self.poles if singular else set()))
        uv = np.concatenate(loops)
        uv[~at_pole] = settle(face.patch, uv[~at_pole], self.positions[named[~at_pole]], self.size)
        cuts = np.cumsum([len(loop) for loop in loops])[:-1]
        return np.split(uv, cuts), named, at_pole

    def _coedge(self, coedge: Coedge) -> tuple[Floats, Indices]:
        """Parameters (k, 2) and vertices (k,) along a coedge, without its last point."""
        uv, ids = _walked(coedge, self.t[coedge.edge]), self.ids[coedge.edge]
        ids = ids[::-1] if coedge.backwards else ids
        if len(ids) == 2 and ids[0] == ids[1] and self.model.edges[coedge.edge].curve is not None:
            return uv[:0], ids[:0]
        return uv[:-1], ids[:-1]


def _sampled(curve: NurbsCurve | None, edge: float) -> Floats:
    """Values of t, ends included, about *edge* apart and not turning by more than 60 degrees."""
    if curve is None:
        return np.linspace(0.0, 1.0, _POLE_COPIES + 1)
    t = np.linspace(0.0, 1.0, _DENSE + 16 * len(curve.poles) + 1)
    x, x1, _ = curve.derivatives(t)
    length = np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(x, axis=0), axis=1))])
    rate = np.linalg.norm(x1, axis=1, keepdims=True)
    ahead = x1 / np.where(rate > 0.0, rate, 1.0)
    turn = np.arccos(np.clip(dot(ahead[1:], ahead[:-1]), -1.0, 1.0)).sum()
    count = max(1, round(length[-1] / edge), int(np.ceil(turn / _LARGEST_TURN - 1e-6)))
    steps: Floats = np.interp(np.arange(count + 1) / count * length[-1], length, t)
    steps[0], steps[-1] = 0.0, 1.0
    return steps


def _compact(found: Tessellation) -> Tessellation:
    """Without the vertices that no triangle uses."""
    used = np.zeros(len(found.vertices), dtype=bool)
    used[found.triangles.ravel()] = True
    number = np.cumsum(used) - 1
    parts = (
        FacePart(p.parameters, np.where(used[p.ids], number[p.ids], -1), p.triangles, p.at_pole)
        for p in found.parts
    )
    return Tessellation(found.vertices[used], tuple(parts))
