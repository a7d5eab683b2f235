"""A bent and twisted tube as a boundary representation, made directly and without any boolean.

Four outer and four inner faces along it, all B-spline surfaces of degree 3 x 1 whose parameters are
mm along the tube and across the face; two planes with an opening at its ends; and ruled walls of
the holes that are drilled through the narrow walls. A drilled hole is a circle in the parameters of
the narrow faces. Every vertex and edge is made once and shared by its two faces.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from fabrication.brep_geometry import knots, ruled_surface, side_surface
from fabrication.brep_pieces import BrepPieces, Used, poles
from fabrication.cut import Drill
from fabrication.errors import no_kernel
from fabrication.strip_loops import DEGREE, Piece, Run, arc_images
from fabrication.tube_sides import Box
from gridshell.arrays import Floats

try:
    from OCP.Geom import Geom_BSplineCurve, Geom_Plane
    from OCP.gp import gp_Dir, gp_Pnt
    from OCP.TopoDS import TopoDS_Edge, TopoDS_Face, TopoDS_Solid, TopoDS_Vertex
except ImportError as error:  # pragma: no cover - depends on the machine
    raise no_kernel(error) from error

_FACES = ("near", "far", "top", "bottom")
_OUTWARD = {"near": False, "far": True, "top": False, "bottom": True}
"""Whether a face's natural normal, along x across, points away from the axis."""


def tube_brep(boxes: tuple[Box, Box], length: float, drills: Sequence[Drill]) -> TopoDS_Solid:
    """The solid between the outer and the inner of *boxes*, open at both ends."""
    return _Builder(boxes, length, drills).solid()


_BETWEEN = {
    "near": ("near low", "near up"),
    "far": ("far low", "far up"),
    "top": ("near up", "far up"),
    "bottom": ("near low", "far low"),
}
"""The corner curves of a face: at v = 0, and at its width."""


@dataclass(frozen=True, eq=False)
class _Circle:
    """A hole on one face: two half circles from vertex 0 to vertex 1 and back."""

    curves: list[Any]
    edges: list[TopoDS_Edge]
    points: list[Floats]
    vertices: list[TopoDS_Vertex]

    def clockwise(self) -> list[Used]:
        """As a wire that bounds the face from inside."""
        return [(edge, False) for edge in reversed(self.edges)]


class _Builder(BrepPieces):
    """Makes the shared vertices, edges and faces of one tube."""

    def __init__(self, boxes: tuple[Box, Box], length: float, drills: Sequence[Drill]) -> None:
        super().__init__()
        self.length, self.drills = length, drills
        self.sides = [{name: getattr(box, name) for name in _FACES} for box in boxes]
        self.surfaces = [
            {name: side_surface(side) for name, side in sides.items()} for sides in self.sides
        ]

    def solid(self) -> TopoDS_Solid:
        """Outer faces, inner faces, ends, walls of the holes."""
        rings = [self._ring(k) for k in (0, 1)]
        holes = {name: self._holes(name) for name in ("top", "bottom")}
        faces = []
        for k, ring in enumerate(rings):
            for name in _FACES:
                wires = [self.wire(ring[name])]
                wires += [self.wire(hole[k].clockwise()) for hole in holes.get(name, [])]
                forward = _OUTWARD[name] if k == 0 else not _OUTWARD[name]
                faces.append(self.face(self.surfaces[k][name], wires, forward=forward))
        faces += [self._end(rings, at_end=at_end) for at_end in (False, True)]
        for name, found in holes.items():
            faces += [wall for hole in found for wall in self._walls(name, hole)]
        return self.close(faces)

    # ---- the four faces of a box ---------------------------------------------------------------

    def _ring(self, k: int) -> dict[str, list[Used]]:
        """The boundary of every face of box *k*, counter-clockwise in its parameters.

        Also under "start" and "end": near, far, top, bottom edges across, in their natural sense.
        """
        sides = self.sides[k]
        near, far = sides["near"], sides["far"]
        ends = np.array([0.0, self.length])
        place = {
            "near low": near.points(ends, np.zeros(2)),
            "near up": near.points(ends, np.full(2, near.width)),
            "far low": far.points(ends, np.zeros(2)),
            "far up": far.points(ends, np.full(2, far.width)),
        }
        vertex = {key: [self.vertex(p) for p in points] for key, points in place.items()}
        along = {}
        for key, (side, v) in {
            "near low": ("near", 0.0),
            "near up": ("near", near.width),
            "far low": ("far", 0.0),
            "far up": ("far", far.width),
        }.items():
            curve = self.surfaces[k][side].VIso(v)
            first, last = vertex[key]
            along[key] = self.edge(curve, first, last, 0.0, self.length)
        across = [
            {
                name: self.straight(place[a][e], place[b][e], vertex[a][e], vertex[b][e])
                for name, (a, b) in _BETWEEN.items()
            }
            for e in (0, 1)
        ]
        ring: dict[str, list[Used]] = {}
        for name, (low, high) in _BETWEEN.items():
            surface, width = self.surfaces[k][name], sides[name].width
            self.trace(along[low], surface, (0.0, 0.0), (1.0, 0.0))
            self.trace(along[high], surface, (0.0, width), (1.0, 0.0))
            for e in (0, 1):
                self.trace(across[e][name], surface, (float(ends[e]), 0.0), (0.0, 1.0))
            ring[name] = [
                (along[low], True),
                (across[1][name], True),
                (along[high], False),
                (across[0][name], False),
            ]
        for e, name in ((0, "start"), (1, "end")):
            ring[name] = [(across[e][face], True) for face in _FACES]
        return ring

    def _end(self, rings: Sequence[dict[str, list[Used]]], *, at_end: bool) -> TopoDS_Face:
        """The plane with an opening at one end, facing away from the tube."""
        x = np.array([self.length if at_end else 0.0])
        outer = self.sides[0]
        a, b, c = (
            outer[name].points(x, np.array([v]))[0]
            for name, v in (("near", 0.0), ("near", outer["near"].width), ("far", 0.0))
        )
        normal = np.cross(a - c, b - a) * (1.0 if at_end else -1.0)
        plane = Geom_Plane(gp_Pnt(*((b + c) / 2.0).tolist()), gp_Dir(*normal.tolist()))
        wires = []
        for k, ring in enumerate(rings):
            across = (edge for edge, _ in ring["end" if at_end else "start"])
            edges = dict(zip(_FACES, across, strict=True))
            left = (k == 0) == at_end  # counter-clockwise about the direction of the tube
            order = ("near", "top", "far", "bottom") if left else ("near", "bottom", "far", "top")
            up = {"near": left, "top": left, "far": not left, "bottom": not left}
            wires.append(self.wire([(edges[name], up[name]) for name in order]))
        return self.face(plane, wires, forward=True)

    # ---- holes ---------------------------------------------------------------------------------

    def _holes(self, name: str) -> list[tuple[_Circle, _Circle]]:
        """For every drill its circle on the outer and on the inner face."""
        if not self.drills:
            return []
        outer, inner = (self._circles(k, name) for k in (0, 1))
        return list(zip(outer, inner, strict=True))

    def _circles(self, k: int, name: str) -> list[_Circle]:
        side, surface = self.sides[k][name], self.surfaces[k][name]
        arcs = [arc for drill in self.drills for arc in _halves(drill, side.width / 2.0)]
        images = arc_images([side], arcs)
        self.tolerance = max(self.tolerance, 2.0 * images.off)
        shares, counts = np.unique(images.knots, return_counts=True)
        circles = []
        for i in range(0, len(arcs), 2):
            points = [images.poles[i, 0, end] for end in (0, -1)]
            vertices = [self.vertex(point) for point in points]
            curves, edges = [], []
            for j in (0, 1):
                arc, found = arcs[i + j], images.poles[i + j, 0]
                low, high = arc.low[0], arc.high[0]
                values = (low + (high - low) * shares).tolist()
                curve = Geom_BSplineCurve(poles(found), *knots(values, counts.tolist()), DEGREE)
                edge = self.edge(curve, vertices[j], vertices[1 - j], low, high)
                self.ring(edge, surface, arc.centre, arc.at[0])
                curves.append(curve)
                edges.append(edge)
            circles.append(_Circle(curves, edges, points, vertices))
        return circles

    def _walls(self, name: str, hole: tuple[_Circle, _Circle]) -> list[TopoDS_Face]:
        """The two halves of a hole's wall, from the outer to the inner face."""
        outer, inner = hole
        depth = float(np.linalg.norm(outer.points[0] - inner.points[0]))
        links = [
            self.straight(outer.points[j], inner.points[j], outer.vertices[j], inner.vertices[j])
            for j in (0, 1)
        ]
        faces = []
        for j in (0, 1):
            surface = ruled_surface(outer.curves[j], inner.curves[j], depth)
            low, high = j * np.pi, (j + 1) * np.pi
            self.trace(outer.edges[j], surface, (0.0, 0.0), (1.0, 0.0))
            self.trace(inner.edges[j], surface, (0.0, depth), (1.0, 0.0))
            self.trace(links[j], surface, (low, 0.0), (0.0, 1.0))
            self.trace(links[1 - j], surface, (high, 0.0), (0.0, 1.0))
            wire = self.wire(
                [
                    (outer.edges[j], True),
                    (links[1 - j], True),
                    (inner.edges[j], False),
                    (links[j], False),
                ]
            )
            faces.append(self.face(surface, [wire], forward=name == "bottom"))
        return faces


def _halves(drill: Drill, middle: float) -> list[Piece]:
    """The two half circles of a drill on a narrow face, counter-clockwise; *middle* is its v."""
    radius = drill.diameter / 2.0
    turns = ((0.0, np.pi), (np.pi, 2.0 * np.pi))
    return [
        Piece(
            run=Run.ARC,
            first=0,
            last=1,
            forward=False,
            low=(low, low),
            high=(high, high),
            at=(radius, radius),
            centre=(drill.x, middle),
        )
        for low, high in turns
    ]
