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

from fabrication.brep_geometry import TOLERANCE, knots, ruled_surface, side_surface
from fabrication.cut import Drill
from fabrication.errors import KernelError
from fabrication.strip_loops import DEGREE, Piece, Run, arc_images
from fabrication.tube_sides import Box
from gridshell.arrays import Floats

try:
    from OCP.BRep import BRep_Builder
    from OCP.Geom import Geom_BSplineCurve, Geom_Line, Geom_Plane
    from OCP.Geom2d import Geom2d_Circle, Geom2d_Line
    from OCP.gp import gp_Ax22d, gp_Circ2d, gp_Dir, gp_Dir2d, gp_Pnt, gp_Pnt2d, gp_Vec
    from OCP.TColgp import TColgp_Array1OfPnt
    from OCP.TopAbs import TopAbs_FORWARD, TopAbs_REVERSED
    from OCP.TopLoc import TopLoc_Location
    from OCP.TopoDS import (
        TopoDS,
        TopoDS_Edge,
        TopoDS_Face,
        TopoDS_Shell,
        TopoDS_Solid,
        TopoDS_Vertex,
        TopoDS_Wire,
    )
except ImportError as error:  # pragma: no cover - depends on the machine
    raise KernelError("The CAD kernel cannot be loaded", value=str(error)) from error

Used = tuple[TopoDS_Edge, bool]
"""An edge and whether a wire runs along it."""

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


class _Builder:
    """Makes the shared vertices, edges and faces of one tube."""

    def __init__(self, boxes: tuple[Box, Box], length: float, drills: Sequence[Drill]) -> None:
        self.boxes, self.length, self.drills = boxes, length, drills
        self.tool = BRep_Builder()
        self.sides = [{name: getattr(box, name) for name in _FACES} for box in boxes]
        self.surfaces = [
            {name: side_surface(side) for name, side in sides.items()} for sides in self.sides
        ]
        self.tolerance = TOLERANCE

    def solid(self) -> TopoDS_Solid:
        """Outer faces, inner faces, ends, walls of the holes."""
        rings = [self._ring(k) for k in (0, 1)]
        holes = {name: self._holes(name) for name in ("top", "bottom")}
        faces = []
        for k, ring in enumerate(rings):
            for name in _FACES:
                wires = [self._wire(ring[name])]
                wires += [self._wire(hole[k].clockwise()) for hole in holes.get(name, [])]
                forward = _OUTWARD[name] if k == 0 else not _OUTWARD[name]
                faces.append(self._face(self.surfaces[k][name], wires, forward=forward))
        faces += [self._end(rings, at_end=at_end) for at_end in (False, True)]
        for name, found in holes.items():
            faces += [wall for hole in found for wall in self._walls(name, hole)]
        return self._close(faces)

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
        vertex = {key: [self._vertex(p) for p in points] for key, points in place.items()}
        along = {}
        for key, (side, v) in {
            "near low": ("near", 0.0),
            "near up": ("near", near.width),
            "far low": ("far", 0.0),
            "far up": ("far", far.width),
        }.items():
            curve = self.surfaces[k][side].VIso(v)
            first, last = vertex[key]
            along[key] = self._edge(curve, first, last, 0.0, self.length)
        across = [
            {
                name: self._straight(place[a][e], place[b][e], vertex[a][e], vertex[b][e])
                for name, (a, b) in _BETWEEN.items()
            }
            for e in (0, 1)
        ]
        ring: dict[str, list[Used]] = {}
        for name, (low, high) in _BETWEEN.items():
            surface, width = self.surfaces[k][name], sides[name].width
            self._trace(along[low], surface, (0.0, 0.0), (1.0, 0.0))
            self._trace(along[high], surface, (0.0, width), (1.0, 0.0))
            for e in (0, 1):
                self._trace(across[e][name], surface, (float(ends[e]), 0.0), (0.0, 1.0))
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
            wires.append(self._wire([(edges[name], up[name]) for name in order]))
        return self._face(plane, wires, forward=True)

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
        found = []
        for i in range(0, len(arcs), 2):
            points = [images.poles[i, 0, end] for end in (0, -1)]
            vertices = [self._vertex(point) for point in points]
            curves, edges = [], []
            for j in (0, 1):
                arc, poles = arcs[i + j], images.poles[i + j, 0]
                low, high = arc.low[0], arc.high[0]
                values = (low + (high - low) * shares).tolist()
                curve = Geom_BSplineCurve(_poles(poles), *knots(values, counts.tolist()), DEGREE)
                edge = self._edge(curve, vertices[j], vertices[1 - j], low, high)
                axes = gp_Ax22d(gp_Pnt2d(*arc.centre), gp_Dir2d(1.0, 0.0), gp_Dir2d(0.0, 1.0))
                circle = Geom2d_Circle(gp_Circ2d(axes, arc.at[0]))
                self.tool.UpdateEdge(edge, circle, surface, TopLoc_Location(), self.tolerance)
                curves.append(curve)
                edges.append(edge)
            found.append(_Circle(curves, edges, points, vertices))
        return found

    def _walls(self, name: str, hole: tuple[_Circle, _Circle]) -> list[TopoDS_Face]:
        """The two halves of a hole's wall, from the outer to the inner face."""
        outer, inner = hole
        depth = float(np.linalg.norm(outer.points[0] - inner.points[0]))
        links = [
            self._straight(outer.points[j], inner.points[j], outer.vertices[j], inner.vertices[j])
            for j in (0, 1)
        ]
        faces = []
        for j in (0, 1):
            surface = ruled_surface(outer.curves[j], inner.curves[j], depth)
            low, high = j * np.pi, (j + 1) * np.pi
            self._trace(outer.edges[j], surface, (0.0, 0.0), (1.0, 0.0))
            self._trace(inner.edges[j], surface, (0.0, depth), (1.0, 0.0))
            self._trace(links[j], surface, (low, 0.0), (0.0, 1.0))
            self._trace(links[1 - j], surface, (high, 0.0), (0.0, 1.0))
            wire = self._wire(
                [
                    (outer.edges[j], True),
                    (links[1 - j], True),
                    (inner.edges[j], False),
                    (links[j], False),
                ]
            )
            faces.append(self._face(surface, [wire], forward=name == "bottom"))
        return faces

    # ---- the kernel's pieces -------------------------------------------------------------------

    def _vertex(self, point: Floats) -> TopoDS_Vertex:
        vertex = TopoDS_Vertex()
        self.tool.MakeVertex(vertex, gp_Pnt(*point.tolist()), self.tolerance)
        return vertex

    def _edge(
        self, curve: Any, first: TopoDS_Vertex, last: TopoDS_Vertex, low: float, high: float
    ) -> TopoDS_Edge:
        edge = TopoDS_Edge()
        self.tool.MakeEdge(edge, curve, self.tolerance)
        self.tool.Add(edge, first.Oriented(TopAbs_FORWARD))
        self.tool.Add(edge, last.Oriented(TopAbs_REVERSED))
        self.tool.Range(edge, low, high)
        return edge

    def _straight(
        self, a: Floats, b: Floats, first: TopoDS_Vertex, last: TopoDS_Vertex
    ) -> TopoDS_Edge:
        start, end = gp_Pnt(*a.tolist()), gp_Pnt(*b.tolist())
        line = Geom_Line(start, gp_Dir(gp_Vec(start, end)))
        return self._edge(line, first, last, 0.0, start.Distance(end))

    def _trace(
        self,
        edge: TopoDS_Edge,
        surface: Any,
        origin: tuple[float, float],
        direction: tuple[float, float],
    ) -> None:
        line = Geom2d_Line(gp_Pnt2d(*origin), gp_Dir2d(*direction))
        self.tool.UpdateEdge(edge, line, surface, TopLoc_Location(), self.tolerance)

    def _wire(self, edges: Sequence[Used]) -> TopoDS_Wire:
        wire = TopoDS_Wire()
        self.tool.MakeWire(wire)
        for edge, forward in edges:
            self.tool.Add(wire, edge.Oriented(TopAbs_FORWARD if forward else TopAbs_REVERSED))
        wire.Closed(True)
        return wire

    def _face(self, surface: Any, wires: Sequence[TopoDS_Wire], *, forward: bool) -> TopoDS_Face:
        face = TopoDS_Face()
        self.tool.MakeFace(face, surface, TOLERANCE)
        for wire in wires:
            self.tool.Add(face, wire)
        return face if forward else TopoDS.Face_s(face.Reversed())

    def _close(self, faces: Sequence[TopoDS_Face]) -> TopoDS_Solid:
        shell, solid = TopoDS_Shell(), TopoDS_Solid()
        self.tool.MakeShell(shell)
        for face in faces:
            self.tool.Add(shell, face)
        shell.Closed(True)
        self.tool.MakeSolid(solid)
        self.tool.Add(solid, shell)
        return solid


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


def _poles(points: Floats) -> TColgp_Array1OfPnt:
    array = TColgp_Array1OfPnt(1, len(points))
    for i, (x, y, z) in enumerate(points.tolist(), start=1):
        array.SetValue(i, gp_Pnt(x, y, z))
    return array
