"""The only module of gridshell that calls the CAD kernel: shapes in, arrays out.

The kernel takes seconds to load, so every import of it is inside a function. Shapes are typed Any:
the kernel has no type hints.
"""

from __future__ import annotations

import contextlib
from collections.abc import Iterator
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from gridshell.arrays import Floats, Points
from gridshell.errors import FileError, NotOnePatchError, SurfaceError
from gridshell.surface.brep_model import BrepEdge, BrepFace, BrepModel, Coedge, oriented
from gridshell.surface.nurbs import NurbsCurve, NurbsPatch
from gridshell.surface.planar_mesher import signed_area

STEP, IGES, BREP = "STEP", "IGES", "BREP"
FORMATS = {".step": STEP, ".stp": STEP, ".iges": IGES, ".igs": IGES, ".brep": BREP, ".brp": BREP}


class Loaded(NamedTuple):
    """A kernel shape in mm, and the units, mm, the file says it was drawn in (none for BREP)."""

    shape: Any
    units: tuple[float, ...]


def load_shape(path: Path) -> Loaded:
    """Read a STEP, IGES or BREP file.

    Raises
    ------
    FileError
        When it is missing, has another extension, or holds nothing the kernel can read.
    """
    kind = FORMATS.get(path.suffix.lower())
    if kind is None:
        raise FileError(
            "The file is not a B-rep",
            where=str(path),
            value=repr(path.suffix),
            limit=", ".join(sorted(FORMATS)),
        )
    if not path.is_file():
        raise FileError("The surface file is missing", where=str(path), advice="check the path")
    with _quiet():
        loaded = {STEP: _step, IGES: _iges, BREP: _brep}[kind](path)
    if loaded is None or loaded.shape is None or loaded.shape.IsNull():
        raise FileError(
            f"The {kind} file cannot be read",
            where=str(path),
            value="nothing that the CAD kernel understands",
            advice="export it again, as STEP AP214 or AP242",
        )
    return loaded


def model_of(shape: Any, *, tolerance: float | None = None) -> BrepModel:
    """Sew the faces of *shape* into one patch and take them out as arrays.

    Parameters
    ----------
    shape : a TopoDS_Shape, such as ``build123d_face.wrapped``.
    tolerance : gaps up to this are sewn, in the shape's unit; a 50,000th of its size when None.

    Raises
    ------
    NotOnePatchError
        No faces, a solid, several patches, or one that branches.
    SurfaceError
        A patch with one side only, or a broken outline.
    """
    _require_faces(shape)
    nurbs = _as_nurbs(_sewn(shape, tolerance))
    edges, vertices = _map(nurbs, "EDGE"), _map(nurbs, "VERTEX")
    faces = tuple(_face(n, f, edges) for n, f in enumerate(_parts(nurbs, "FACE")))
    model = BrepModel(
        faces,
        tuple(_edge(edges.FindKey(i + 1), vertices) for i in range(edges.Extent())),
        _positions(vertices),
    )
    return oriented(model)


def curves_of(shape: Any) -> list[NurbsCurve]:
    """Every edge of *shape* once, as a curve in space over t from 0 to 1."""
    edges = _map(_as_nurbs(shape), "EDGE")
    found = [_edge_curve(edges.FindKey(i + 1)) for i in range(edges.Extent())]
    return [curve for curve in found if curve is not None]


def has_faces(shape: Any) -> bool:
    """Whether any face is in *shape*."""
    return bool(_parts(shape, "FACE"))


# ---- files -------------------------------------------------------------------------------------


@contextlib.contextmanager
def _quiet() -> Iterator[None]:
    """Keep the kernel's own messages off the terminal: errors are raised instead."""
    from OCP.Message import Message, Message_Gravity

    printers = list(Message.DefaultMessenger_s().Printers())
    before = [printer.GetTraceLevel() for printer in printers]
    for printer in printers:
        printer.SetTraceLevel(Message_Gravity.Message_Fail)
    try:
        yield
    finally:
        for printer, level in zip(printers, before, strict=True):
            printer.SetTraceLevel(level)


def _step(path: Path) -> Loaded | None:
    from OCP.IFSelect import IFSelect_ReturnStatus
    from OCP.STEPControl import STEPControl_Reader
    from OCP.TColStd import TColStd_SequenceOfAsciiString

    reader = STEPControl_Reader()
    if reader.ReadFile(str(path)) != IFSelect_ReturnStatus.IFSelect_RetDone:
        return None
    lengths, angles, solid = (TColStd_SequenceOfAsciiString() for _ in range(3))
    reader.FileUnits(lengths, angles, solid)
    names = {lengths.Value(i + 1).ToCString().lower() for i in range(lengths.Length())}
    reader.TransferRoots()
    return Loaded(reader.OneShape(), tuple(sorted(_STEP_UNITS.get(n, np.nan) for n in names)))


_STEP_UNITS = {
    "millimetre": 1.0,
    "centimetre": 10.0,
    "decimetre": 100.0,
    "metre": 1000.0,
    "inch": 25.4,
    "foot": 304.8,
}


def _iges(path: Path) -> Loaded | None:
    from OCP.IFSelect import IFSelect_ReturnStatus
    from OCP.IGESControl import IGESControl_Reader

    if path.read_bytes()[72:73] != b"S":  # column 73 of every IGES file's first line
        return None
    reader = IGESControl_Reader()
    if reader.ReadFile(str(path)) != IFSelect_ReturnStatus.IFSelect_RetDone:
        return None
    unit = reader.IGESModel().GlobalSection().UnitValue()
    reader.TransferRoots()
    return Loaded(reader.OneShape(), (float(unit),))


def _brep(path: Path) -> Loaded | None:
    from OCP.BRep import BRep_Builder
    from OCP.BRepTools import BRepTools
    from OCP.TopoDS import TopoDS_Shape

    if b"CASCADE Topology" not in path.read_bytes()[:2000]:
        return None
    shape = TopoDS_Shape()
    return Loaded(shape, ()) if BRepTools.Read_s(shape, str(path), BRep_Builder()) else None


# ---- shapes ------------------------------------------------------------------------------------


def _require_faces(shape: Any) -> None:
    solids, faces = len(_parts(shape, "SOLID")), len(_parts(shape, "FACE"))
    if solids:
        raise NotOnePatchError(
            "The shape is a solid, not a surface",
            value=f"{solids} solids with {faces} faces",
            limit="faces of one skin",
            advice="explode the solid and export the faces of the skin only",
        )
    if not faces:
        raise NotOnePatchError(
            "The shape holds no faces",
            value=f"{len(_parts(shape, 'EDGE'))} edges",
            limit="1 face or more",
            advice="export surfaces, or read the curves as the boundary of a minimal surface",
        )


def _sewn(shape: Any, tolerance: float | None) -> Any:
    from OCP.BRepBuilderAPI import BRepBuilderAPI_Sewing
    from OCP.BRepLib import BRepLib

    BRepLib.BuildCurves3d_s(shape)
    sewing = BRepBuilderAPI_Sewing(_size(shape) / 50_000.0 if tolerance is None else tolerance)
    for face in _parts(shape, "FACE"):
        sewing.Add(face)
    sewing.Perform()
    return sewing.SewedShape()


def _size(shape: Any) -> float:
    from OCP.Bnd import Bnd_Box
    from OCP.BRepBndLib import BRepBndLib

    box = Bnd_Box()
    BRepBndLib.Add_s(shape, box)
    return float(np.sqrt(box.SquareExtent()))


def _as_nurbs(shape: Any) -> Any:
    from OCP.BRepBuilderAPI import BRepBuilderAPI_NurbsConvert

    return BRepBuilderAPI_NurbsConvert(shape, True).Shape()


def _parts(shape: Any, kind: str) -> list[Any]:
    from OCP import TopoDS
    from OCP.TopAbs import TopAbs_ShapeEnum
    from OCP.TopExp import TopExp_Explorer

    explorer = TopExp_Explorer(shape, getattr(TopAbs_ShapeEnum, f"TopAbs_{kind}"))
    cast = getattr(TopoDS.TopoDS, f"{kind.title()}_s")
    found = []
    while explorer.More():
        found.append(cast(explorer.Current()))
        explorer.Next()
    return found


def _map(shape: Any, kind: str) -> Any:
    from OCP.TopAbs import TopAbs_ShapeEnum
    from OCP.TopExp import TopExp
    from OCP.TopTools import TopTools_IndexedMapOfShape

    found = TopTools_IndexedMapOfShape()
    TopExp.MapShapes_s(shape, getattr(TopAbs_ShapeEnum, f"TopAbs_{kind}"), found)
    return found


def _positions(vertices: Any) -> Points:
    from OCP.BRep import BRep_Tool
    from OCP.TopoDS import TopoDS

    points = (
        BRep_Tool.Pnt_s(TopoDS.Vertex_s(vertices.FindKey(i + 1))) for i in range(vertices.Extent())
    )
    return np.array([[p.X(), p.Y(), p.Z()] for p in points]).reshape(-1, 3)


def _edge(shape: Any, vertices: Any) -> BrepEdge:
    from OCP.TopAbs import TopAbs_Orientation
    from OCP.TopExp import TopExp
    from OCP.TopoDS import TopoDS

    forward = TopoDS.Edge_s(shape.Oriented(TopAbs_Orientation.TopAbs_FORWARD))
    ends = TopExp.FirstVertex_s(forward, True), TopExp.LastVertex_s(forward, True)
    start, end = (vertices.FindIndex(v) - 1 for v in ends)
    return BrepEdge(_edge_curve(forward), start, end)


def _edge_curve(shape: Any) -> NurbsCurve | None:
    from OCP.BRep import BRep_Tool
    from OCP.Geom import Geom_TrimmedCurve
    from OCP.GeomConvert import GeomConvert
    from OCP.TopoDS import TopoDS

    edge = TopoDS.Edge_s(shape)
    curve = None if BRep_Tool.Degenerated_s(edge) else BRep_Tool.Curve_s(edge, 0.0, 1.0)
    if curve is None:
        return None
    first, last = BRep_Tool.Range_s(edge)
    return _curve(GeomConvert.CurveToBSplineCurve_s(Geom_TrimmedCurve(curve, first, last)))


def _curve(spline: Any) -> NurbsCurve:
    """A kernel B-spline, in the plane or in space, over t from 0 to 1."""
    if spline.IsPeriodic():
        spline.SetNotPeriodic()
    count = range(1, spline.NbPoles() + 1)
    poles = [spline.Pole(i) for i in count]
    rows = [[p.X(), p.Y(), *([p.Z()] if hasattr(p, "Z") else [])] for p in poles]
    knots = [spline.Knot(i + 1) for i in range(spline.NbKnots())]
    times = [spline.Multiplicity(i + 1) for i in range(spline.NbKnots())]
    flat, _ = _unit_knots(knots, times, len(rows))
    return NurbsCurve(flat, np.array(rows), np.array([spline.Weight(i) for i in count]))


def _face(number: int, face: Any, edges: Any) -> BrepFace:
    from OCP.TopAbs import TopAbs_Orientation
    from OCP.TopoDS import TopoDS

    patch, box = _patch(face)
    forward = TopoDS.Face_s(face.Oriented(TopAbs_Orientation.TopAbs_FORWARD))
    loops = [_loop(number, forward, wire, edges, box) for wire in _parts(forward, "WIRE")]
    if not loops:
        raise SurfaceError("A face has no outline", where=f"face {number}")
    areas = [signed_area(np.concatenate([_walk(c) for c in loop])) for loop in loops]
    outline = int(np.argmax(np.abs(areas)))
    turned = [
        loop if (area > 0.0) == (n == outline) else _reversed(loop)
        for n, (loop, area) in enumerate(zip(loops, areas, strict=True))
    ]
    reversed_face = face.Orientation() == TopAbs_Orientation.TopAbs_REVERSED
    return BrepFace(patch, tuple(turned), -1 if reversed_face else 1)


def _patch(face: Any) -> tuple[NurbsPatch, Floats]:
    """The face's surface over the unit square, and the box (2, 2) of its own parameters."""
    from OCP.BRep import BRep_Tool
    from OCP.GeomConvert import GeomConvert

    surface = GeomConvert.SurfaceToBSplineSurface_s(BRep_Tool.Surface_s(face))
    closed = (surface.IsUPeriodic(), surface.IsVPeriodic())
    if closed[0]:
        surface.SetUNotPeriodic()
    if closed[1]:
        surface.SetVNotPeriodic()
    rows, columns = range(1, surface.NbUPoles() + 1), range(1, surface.NbVPoles() + 1)
    poles = [[surface.Pole(i, j) for j in columns] for i in rows]
    flat, box = [], []
    for letter, poles_along in (("U", rows), ("V", columns)):
        count = getattr(surface, f"Nb{letter}Knots")()
        knots = [getattr(surface, f"{letter}Knot")(i + 1) for i in range(count)]
        times = [getattr(surface, f"{letter}Multiplicity")(i + 1) for i in range(count)]
        along, ends = _unit_knots(knots, times, len(poles_along))
        flat.append(along)
        box.append(ends)
    places = np.array([[[p.X(), p.Y(), p.Z()] for p in row] for row in poles])
    weights = np.array([[surface.Weight(i, j) for j in columns] for i in rows])
    return NurbsPatch(flat[0], flat[1], places, weights, closed), np.array(box)


def _unit_knots(
    knots: list[float], times: list[int], count: int
) -> tuple[Floats, tuple[float, float]]:
    """Flat knots scaled so that the curve runs from 0 to 1, and the range it had before.

    The range starts at the knot whose number is the degree: a spline that was periodic has knots
    outside of it.
    """
    flat = np.repeat(np.array(knots), times)
    degree = len(flat) - count - 1
    first, last = float(flat[degree]), float(flat[count])
    return (flat - first) / (last - first), (first, last)


def _loop(number: int, face: Any, wire: Any, edges: Any, box: Floats) -> tuple[Coedge, ...]:
    from OCP.BRepTools import BRepTools_WireExplorer

    explorer, found = BRepTools_WireExplorer(wire, face), []
    while explorer.More():
        found.append(_coedge(explorer.Current(), face, edges, box))
        explorer.Next()
    if len(found) != len(_parts(wire, "EDGE")):
        raise SurfaceError(
            "The outline of a face is not closed",
            where=f"face {number}",
            value=f"{len(found)} of {len(_parts(wire, 'EDGE'))} edges follow each other",
            advice="mend the trimming curves in the modeller",
        )
    return tuple(found)


def _coedge(edge: Any, face: Any, edges: Any, box: Floats) -> Coedge:
    from OCP.BRep import BRep_Tool
    from OCP.Geom2d import Geom2d_TrimmedCurve
    from OCP.Geom2dConvert import Geom2dConvert
    from OCP.TopAbs import TopAbs_Orientation

    curve = BRep_Tool.CurveOnSurface_s(edge, face, 0.0, 1.0)
    first, last = BRep_Tool.Range_s(edge, face)
    found = _curve(Geom2dConvert.CurveToBSplineCurve_s(Geom2d_TrimmedCurve(curve, first, last)))
    poles = (found.poles - box[:, 0]) / np.ptp(box, axis=1)
    backwards = edge.Orientation() == TopAbs_Orientation.TopAbs_REVERSED
    return Coedge(
        edges.FindIndex(edge) - 1, NurbsCurve(found.knots, poles, found.weights), backwards
    )


def _walk(coedge: Coedge) -> Floats:
    points = coedge.curve.point(np.linspace(0.0, 1.0, 33))
    return (points[::-1] if coedge.backwards else points)[:-1]


def _reversed(loop: tuple[Coedge, ...]) -> tuple[Coedge, ...]:
    return tuple(Coedge(c.edge, c.curve, not c.backwards) for c in reversed(loop))
