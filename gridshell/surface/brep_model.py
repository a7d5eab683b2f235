"""BrepModel: trimmed NURBS faces and the edges they share, as arrays; no CAD kernel in here.

Every edge has one curve in space over t from 0 to 1. A face lists its boundary as loops of
*coedges*: the same edge seen in the face's own parameters. With t running forward along the loop
the face lies on the left in (u, v), for the outline and for holes alike.
"""

from __future__ import annotations

from collections import deque
from dataclasses import dataclass, replace

import numpy as np

from gridshell.arrays import Floats, Points
from gridshell.errors import NotOnePatchError, SurfaceError
from gridshell.surface.nurbs import NurbsCurve, NurbsPatch
from gridshell.surface.triangle_mesh import place


@dataclass(frozen=True, eq=False)
class BrepEdge:
    """A curve in space, None where the edge is a single point (a pole), and its end vertices."""

    curve: NurbsCurve | None
    start: int
    end: int


@dataclass(frozen=True, eq=False)
class Coedge:
    """An edge in the parameters of a face: curve (2-d, over the same t), walked backwards or not.

    *curve* is a first guess as exact as the file; feet are found on the face from it.
    """

    edge: int
    curve: NurbsCurve
    backwards: bool


@dataclass(frozen=True, eq=False)
class BrepFace:
    """A patch inside its loops; *side* is +1 where the surface's normal is xu x xv, else -1."""

    patch: NurbsPatch
    loops: tuple[tuple[Coedge, ...], ...]
    side: int


@dataclass(frozen=True, eq=False)
class BrepModel:
    """Faces, the edges between them and vertices (n, 3), mm."""

    faces: tuple[BrepFace, ...]
    edges: tuple[BrepEdge, ...]
    vertices: Points

    def scaled(self, factor: float) -> BrepModel:
        """The model with every length times *factor*."""
        if factor == 1.0:
            return self
        faces = tuple(
            replace(f, patch=replace(f.patch, poles=f.patch.poles * factor)) for f in self.faces
        )
        edges = tuple(
            e
            if e.curve is None
            else replace(e, curve=replace(e.curve, poles=e.curve.poles * factor))
            for e in self.edges
        )
        return BrepModel(faces, edges, self.vertices * factor)

    @property
    def uses(self) -> list[list[tuple[int, int]]]:
        """For every edge the faces that have it and the direction, +1 or -1, they walk it in."""
        found: list[list[tuple[int, int]]] = [[] for _ in self.edges]
        for number, face in enumerate(self.faces):
            for coedge in (c for loop in face.loops for c in loop):
                found[coedge.edge].append((number, -1 if coedge.backwards else 1))
        return found

    @property
    def size(self) -> float:
        """Diagonal of the box around the edges, mm."""
        curves = [
            e.curve.point(np.linspace(0.0, 1.0, 9)) for e in self.edges if e.curve is not None
        ]
        corners = np.concatenate([*curves, *(f.patch.poles.reshape(-1, 3) for f in self.faces)])
        return float(np.linalg.norm(np.ptp(corners, axis=0)))


def oriented(model: BrepModel) -> BrepModel:
    """The model with the faces turned to the side of the first one.

    Raises
    ------
    SurfaceError
        When the faces cannot be oriented (a Moebius strip), naming the place.
    NotOnePatchError
        When the faces are not one connected patch, or when more than two meet in an edge.
    """
    uses = model.uses
    sides = {0: model.faces[0].side}
    queue = deque([0])
    beside: list[list[tuple[int, int, int]]] = [[] for _ in model.faces]
    for edge, both in enumerate(uses):
        if len(both) > 2:
            raise NotOnePatchError(
                "More than two faces meet in an edge",
                where=_middle(model, edge),
                value=f"{len(both)} faces",
                limit="2 faces",
                advice="keep one skin: delete the faces that branch off",
            )
        if len(both) == 2:
            (a, way_a), (b, way_b) = both
            beside[a].append((b, -way_a * way_b, edge))
            beside[b].append((a, -way_a * way_b, edge))
    while queue:
        a = queue.popleft()
        for b, same, edge in beside[a]:
            if b not in sides:
                sides[b] = sides[a] * same
                queue.append(b)
            elif sides[b] != sides[a] * same:
                raise SurfaceError(
                    "The faces cannot be oriented: the surface has one side only",
                    where=_middle(model, edge),
                    advice="cut the strip open along an edge",
                )
    if len(sides) < len(model.faces):
        lost = next(n for n in range(len(model.faces)) if n not in sides)
        centre = model.faces[lost].patch.poles.reshape(-1, 3).mean(axis=0)
        raise NotOnePatchError(
            "The faces are not one connected patch",
            where=f"face {lost} {place(centre)}",
            value=f"{len(model.faces) - len(sides)} of {len(model.faces)} faces apart from face 0",
            limit="one patch",
            advice="join the faces in the modeller, or raise the tolerance they are sewn with",
        )
    faces = [replace(f, side=sides[n]) for n, f in enumerate(model.faces)]
    return replace(model, faces=tuple(faces))


def polygon(curve: NurbsCurve, count: int) -> Floats:
    """Points (count, d) at equal steps of t, both ends included."""
    return curve.point(np.linspace(0.0, 1.0, count))


def _middle(model: BrepModel, edge: int) -> str:
    curve = model.edges[edge].curve
    point = (
        model.vertices[model.edges[edge].start]
        if curve is None
        else curve.point(np.array([0.5]))[0]
    )
    return f"edge {edge} {place(point)}"
