"""Vertices, edges, wires and faces as the CAD kernel wants them: what builders of solids share.

Everything is made once; a vertex or an edge that two faces share is one object, which makes a solid
watertight by construction.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from fabrication.brep_geometry import TOLERANCE
from fabrication.errors import no_kernel
from gridshell.arrays import Floats

try:
    from OCP.BRep import BRep_Builder
    from OCP.Geom import Geom_Line
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
    raise no_kernel(error) from error

Used = tuple[TopoDS_Edge, bool]
"""An edge and whether a wire runs along it."""


class BrepPieces:
    """The base of a builder of one solid.

    Parameters
    ----------
    tolerance : of vertices and edges, mm; a builder may raise it before it makes them.
    """

    def __init__(self, tolerance: float = TOLERANCE) -> None:
        self.tolerance = tolerance
        self._tool = BRep_Builder()

    def vertex(self, point: Floats) -> TopoDS_Vertex:
        """A vertex at *point* (3,)."""
        vertex = TopoDS_Vertex()
        self._tool.MakeVertex(vertex, gp_Pnt(*point.tolist()), self.tolerance)
        return vertex

    def edge(
        self, curve: Any, first: TopoDS_Vertex, last: TopoDS_Vertex, low: float, high: float
    ) -> TopoDS_Edge:
        """*curve* between two vertices, from parameter *low* to *high*."""
        edge = TopoDS_Edge()
        self._tool.MakeEdge(edge, curve, self.tolerance)
        self._tool.Add(edge, first.Oriented(TopAbs_FORWARD))
        self._tool.Add(edge, last.Oriented(TopAbs_REVERSED))
        self._tool.Range(edge, low, high)
        return edge

    def straight(
        self, a: Floats, b: Floats, first: TopoDS_Vertex, last: TopoDS_Vertex
    ) -> TopoDS_Edge:
        """A straight edge; its parameter is the distance from *a*, mm."""
        start, end = gp_Pnt(*a.tolist()), gp_Pnt(*b.tolist())
        line = Geom_Line(start, gp_Dir(gp_Vec(start, end)))
        return self.edge(line, first, last, 0.0, start.Distance(end))

    def trace(
        self,
        edge: TopoDS_Edge,
        surface: Any,
        origin: tuple[float, float],
        direction: tuple[float, float],
    ) -> None:
        """Give *edge* its straight line in the parameters of *surface*."""
        line = Geom2d_Line(gp_Pnt2d(*origin), gp_Dir2d(*direction))
        self._tool.UpdateEdge(edge, line, surface, TopLoc_Location(), self.tolerance)

    def wire(self, edges: Sequence[Used]) -> TopoDS_Wire:
        """A closed wire of *edges* in order."""
        wire = TopoDS_Wire()
        self._tool.MakeWire(wire)
        for edge, forward in edges:
            self._tool.Add(wire, edge.Oriented(TopAbs_FORWARD if forward else TopAbs_REVERSED))
        wire.Closed(True)
        return wire

    def face(self, surface: Any, wires: Sequence[TopoDS_Wire], *, forward: bool) -> TopoDS_Face:
        """*surface* within *wires*, which run counter-clockwise, openings clockwise."""
        face = TopoDS_Face()
        self._tool.MakeFace(face, surface, TOLERANCE)
        for wire in wires:
            self._tool.Add(face, wire)
        return face if forward else TopoDS.Face_s(face.Reversed())

    def close(self, faces: Sequence[TopoDS_Face]) -> TopoDS_Solid:
        """The solid within *faces*."""
        shell, solid = TopoDS_Shell(), TopoDS_Solid()
        self._tool.MakeShell(shell)
        for face in faces:
            self._tool.Add(shell, face)
        shell.Closed(True)
        self._tool.MakeSolid(solid)
        self._tool.Add(solid, shell)
        return solid

    def ring(
        self, edge: TopoDS_Edge, surface: Any, centre: tuple[float, float], radius: float
    ) -> None:
        """Give *edge* its circle in the parameters of *surface*."""
        axes = gp_Ax22d(gp_Pnt2d(*centre), gp_Dir2d(1.0, 0.0), gp_Dir2d(0.0, 1.0))
        circle = Geom2d_Circle(gp_Circ2d(axes, radius))
        self._tool.UpdateEdge(edge, circle, surface, TopLoc_Location(), self.tolerance)


def poles(points: Floats) -> TColgp_Array1OfPnt:
    """Points (n, 3) in the kernel's form."""
    array = TColgp_Array1OfPnt(1, len(points))
    for i, (x, y, z) in enumerate(points.tolist(), start=1):
        array.SetValue(i, gp_Pnt(x, y, z))
    return array
