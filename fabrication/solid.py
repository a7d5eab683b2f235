"""Solids: the only module that imports the CAD kernel (build123d and OCP).

A slotted, bent and twisted lamella is built directly as a boundary representation, without any
boolean operation. Each side of the strip is a B-spline surface of degree 3 x 1 between two corner
curves; its parameters (u, v) are the strip's own (x, y) in mm, so the flat outline is literally
the trimming loop of the surface. Every vertex and edge is made once and shared by its two faces,
which makes the solid watertight by construction.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from fabrication.colours import FAMILY_COLOURS
from fabrication.errors import KernelError
from fabrication.lamella import Lamella
from fabrication.parts import FlatPart
from fabrication.sides import Side, strip_sides
from fabrication.structures import Structure
from gridshell.arrays import Floats, unit

try:
    import build123d
    from OCP import Standard, StdFail
    from OCP.BRep import BRep_Builder
    from OCP.BRepCheck import BRepCheck_Analyzer
    from OCP.BRepGProp import BRepGProp
    from OCP.Geom import Geom_BSplineCurve, Geom_BSplineSurface, Geom_Line, Geom_Plane
    from OCP.Geom2d import Geom2d_Line
    from OCP.gp import gp_Dir, gp_Dir2d, gp_Pnt, gp_Pnt2d, gp_Vec
    from OCP.GProp import GProp_GProps
    from OCP.TColgp import TColgp_Array2OfPnt
    from OCP.TColStd import TColStd_Array1OfInteger, TColStd_Array1OfReal
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
    raise KernelError(
        "The CAD kernel cannot be loaded",
        value=str(error),
        advice="install the project again; a bare Linux also needs libgl1 and libxrender1",
    ) from error

KERNEL_ERRORS = tuple(
    kind
    for module in (Standard, StdFail)
    for kind in vars(module).values()
    if isinstance(kind, type) and issubclass(kind, Exception)
)
"""The kernel's own exceptions have no common base in Python."""

_TOLERANCE = 1e-6
_VOLUME_ACCURACY = 1e-7


def solids(structure: Structure, parts: Sequence[FlatPart]) -> list[build123d.Solid]:
    """One labelled, coloured solid per lamella, in the structure's order.

    Raises
    ------
    KernelError
        When the kernel does not find a solid valid; the lamella is named.
    """
    made = []
    for lamella, part in zip(structure.lamellas, parts, strict=True):
        solid = build123d.Solid(lamella_solid(lamella, part))
        solid.label = lamella.mark
        solid.color = build123d.Color(*FAMILY_COLOURS[lamella.family])
        made.append(solid)
    return made


def lamella_solid(lamella: Lamella, part: FlatPart) -> TopoDS_Solid:
    """The bent and twisted strip with its slots.

    Raises
    ------
    KernelError
        When the kernel does not find it valid.
    """
    try:
        solid = _Builder(strip_sides(lamella, part), part.thickness).solid(part.outline)
    except KERNEL_ERRORS as error:
        raise KernelError(
            "The kernel cannot make a lamella's solid", where=lamella.mark, value=str(error)
        ) from error
    if not BRepCheck_Analyzer(solid, True, True).IsValid():
        raise KernelError(
            "The kernel refuses a lamella's solid",
            where=lamella.mark,
            advice="look at what check(structure, parts) finds of its slots",
        )
    return solid


def volume(shape: Any) -> float:
    """Volume of a kernel shape, mm3; the kernel's default integration is 1e-4 off on strips."""
    properties = GProp_GProps()
    BRepGProp.VolumePropertiesGK_s(shape, properties, _VOLUME_ACCURACY, True)
    return float(properties.Mass())


# ---- boundary representation ------------------------------------------------------------------


@dataclass(frozen=True)
class _Line:
    """An edge of the outline: runs along u (horizontal) or along v (vertical)."""

    along_u: bool
    at: float
    low: float
    high: float
    increasing: bool


class _Builder:
    """Makes the shared vertices, edges and faces of one strip."""

    def __init__(self, sides: tuple[Side, Side], thickness: float) -> None:
        self.sides, self.thickness = sides, thickness
        self.tool = BRep_Builder()
        self.tolerance = _TOLERANCE
        self.surfaces = [_side_surface(side) for side in sides]

    def solid(self, outline: Floats) -> TopoDS_Solid:
        """The solid over *outline* (k, 2), counter-clockwise with axis-parallel edges."""
        corners = [side.points(outline[:, 0], outline[:, 1]) for side in self.sides]
        lines = [_outline_line(outline, i) for i in range(len(outline))]
        planes, self.tolerance = _wall_planes(corners, lines, self.thickness)
        vertices = [[self._vertex(p) for p in points] for points in corners]
        across = [
            self._straight(corners[0][i], corners[1][i], vertices[0][i], vertices[1][i])
            for i in range(len(outline))
        ]
        rims = [
            [self._rim(k, line, corners[k], vertices[k], i) for i, line in enumerate(lines)]
            for k in (0, 1)
        ]
        faces = [self._side_face(k, lines, rims[k]) for k in (0, 1)]
        for i, line in enumerate(lines):
            near, far = rims[0][i], rims[1][i]
            low, high = across[i], across[(i + 1) % len(outline)]
            if not line.increasing:
                low, high = high, low
            surface = planes.get(i) or self._edge_surface(line, near, far, low, high)
            wire = self._wire([(near, True), (high, True), (far, False), (low, False)])
            faces.append(self._face(surface, wire, forward=line.increasing))
        return self._close(faces)

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

    def _rim(
        self, k: int, line: _Line, corners: Floats, vertices: Sequence[TopoDS_Vertex], i: int
    ) -> TopoDS_Edge:
        """The edge over *line* on side *k*, in the direction of the growing parameter."""
        following = (i + 1) % len(vertices)
        a, b = (i, following) if line.increasing else (following, i)
        if line.along_u:
            curve = self.surfaces[k].VIso(line.at)
            curve.Segment(line.low, line.high)
            edge = self._edge(curve, vertices[a], vertices[b], line.low, line.high)
            self._trace(edge, self.surfaces[k], (0.0, line.at), (1.0, 0.0))
        else:
            edge = self._straight(corners[a], corners[b], vertices[a], vertices[b])
            self._trace(edge, self.surfaces[k], (line.at, line.low), (0.0, 1.0))
        return edge

    def _edge_surface(
        self,
        line: _Line,
        near: TopoDS_Edge,
        far: TopoDS_Edge,
        low: TopoDS_Edge,
        high: TopoDS_Edge,
    ) -> Geom_BSplineSurface:
        """The ruled surface over a horizontal *line*; w runs from side 0 to side 1."""
        curves = []
        for surface in self.surfaces:
            curve = surface.VIso(line.at)
            curve.Segment(line.low, line.high)
            curves.append(curve)
        surface = _ruled_surface(curves[0], curves[1], self.thickness)
        self._trace(near, surface, (0.0, 0.0), (1.0, 0.0))
        self._trace(far, surface, (0.0, self.thickness), (1.0, 0.0))
        self._trace(low, surface, (line.low, 0.0), (0.0, 1.0))
        self._trace(high, surface, (line.high, 0.0), (0.0, 1.0))
        return surface

    def _trace(
        self,
        edge: TopoDS_Edge,
        surface: Any,
        origin: tuple[float, float],
        direction: tuple[float, float],
    ) -> None:
        """Give *edge* its line in the parameters of *surface*."""
        line = Geom2d_Line(gp_Pnt2d(*origin), gp_Dir2d(*direction))
        self.tool.UpdateEdge(edge, line, surface, TopLoc_Location(), self.tolerance)

    def _side_face(
        self, k: int, lines: Sequence[_Line], rims: Sequence[TopoDS_Edge]
    ) -> TopoDS_Face:
        """Side 0 (+t/2) faces along b against its natural normal, side 1 with it."""
        wire = self._wire([(e, line.increasing) for e, line in zip(rims, lines, strict=True)])
        return self._face(self.surfaces[k], wire, forward=k == 1)

    def _wire(self, edges: Sequence[tuple[TopoDS_Edge, bool]]) -> TopoDS_Wire:
        wire = TopoDS_Wire()
        self.tool.MakeWire(wire)
        for edge, forward in edges:
            self.tool.Add(wire, edge.Oriented(TopAbs_FORWARD if forward else TopAbs_REVERSED))
        wire.Closed(True)
        return wire

    def _face(self, surface: Any, wire: TopoDS_Wire, *, forward: bool) -> TopoDS_Face:
        face = TopoDS_Face()
        self.tool.MakeFace(face, surface, _TOLERANCE)
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


def _outline_line(outline: Floats, i: int) -> _Line:
    a, b = outline[i], outline[(i + 1) % len(outline)]
    along_u = abs(b[0] - a[0]) > abs(b[1] - a[1])
    runs, fixed = (0, 1) if along_u else (1, 0)
    low, high = sorted((float(a[runs]), float(b[runs])))
    return _Line(along_u, float(a[fixed]), low, high, bool(b[runs] > a[runs]))


# ---- geometry in the kernel's types -------------------------------------------------------------


def _knots(
    values: Sequence[float], counts: Sequence[int]
) -> tuple[TColStd_Array1OfReal, TColStd_Array1OfInteger]:
    reals = TColStd_Array1OfReal(1, len(values))
    integers = TColStd_Array1OfInteger(1, len(values))
    for i, (value, count) in enumerate(zip(values, counts, strict=True), start=1):
        reals.SetValue(i, value)
        integers.SetValue(i, count)
    return reals, integers


def _wall_planes(
    corners: Sequence[Floats], lines: Sequence[_Line], thickness: float
) -> tuple[dict[int, Geom_Plane], float]:
    """Planes of the vertical walls by outline edge, and the tolerance that they need.

    A normal points in the direction of the strip. The tolerance covers what walls are out of plane
    and straight edges off their length; both come from interpolating the corner curves and stay
    around 1e-6 mm on smooth strips.
    """
    walls = [i for i, line in enumerate(lines) if not line.along_u]
    near, far = corners
    first, second = np.asarray(walls), (np.asarray(walls) + 1) % len(near)
    points = np.stack([near[first], near[second], far[second], far[first]], axis=1)
    middle = points.mean(axis=1)
    normal = unit(np.cross(points[:, 2] - points[:, 0], points[:, 3] - points[:, 1]))
    offset = np.abs(np.einsum("mkc,mc->mk", points - middle[:, None], normal))
    heights = np.array([lines[i].high - lines[i].low for i in walls])
    across = np.abs(np.linalg.norm(near - far, axis=1) - thickness)
    up = [np.abs(np.linalg.norm(side[second] - side[first], axis=1) - heights) for side in corners]
    tolerance = max(_TOLERANCE, *(2.0 * float(np.max(x)) for x in (offset, across, *up)))
    along = normal * np.where([lines[i].increasing for i in walls], 1.0, -1.0)[:, None]
    planes = {
        i: Geom_Plane(gp_Pnt(*point), gp_Dir(*direction))
        for i, point, direction in zip(walls, middle.tolist(), along.tolist(), strict=True)
    }
    return planes, tolerance


def _side_surface(side: Side) -> Geom_BSplineSurface:
    points = TColgp_Array2OfPnt(1, len(side.lower), 1, 2)
    for column, poles in enumerate((side.lower, side.upper), start=1):
        for row, pole in enumerate(poles.tolist(), start=1):
            points.SetValue(row, column, gp_Pnt(*pole))
    values, counts = np.unique(side.knots, return_counts=True)
    u, u_counts = _knots(values.tolist(), counts.tolist())
    v, v_counts = _knots((0.0, side.width), (2, 2))
    return Geom_BSplineSurface(points, u, v, u_counts, v_counts, 3, 1)


def _ruled_surface(
    near: Geom_BSplineCurve, far: Geom_BSplineCurve, thickness: float
) -> Geom_BSplineSurface:
    """Between two curves with the same knots; the second parameter runs from 0 to *thickness*."""
    count = near.NbPoles()
    points = TColgp_Array2OfPnt(1, count, 1, 2)
    for column, curve in enumerate((near, far), start=1):
        for row in range(1, count + 1):
            points.SetValue(row, column, curve.Pole(row))
    w, w_counts = _knots((0.0, thickness), (2, 2))
    u = TColStd_Array1OfReal(1, near.NbKnots())
    u_counts = TColStd_Array1OfInteger(1, near.NbKnots())
    near.Knots(u)
    near.Multiplicities(u_counts)
    return Geom_BSplineSurface(points, u, w, u_counts, w_counts, near.Degree(), 1)
