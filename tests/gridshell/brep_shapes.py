"""Shapes made with the CAD kernel for the tests: what a modeller would export."""

from __future__ import annotations

from typing import Any

import numpy as np

BEND = 2000.0
"""The saddle is z = (x^2 - y^2) / (2 BEND), mm."""


def bezier(poles: np.ndarray, weights: np.ndarray | None = None) -> Any:
    """A Bezier face of control points (n, m, 3)."""
    from OCP.BRepBuilderAPI import BRepBuilderAPI_MakeFace
    from OCP.Geom import Geom_BezierSurface
    from OCP.gp import gp_Pnt
    from OCP.TColgp import TColgp_Array2OfPnt
    from OCP.TColStd import TColStd_Array2OfReal

    n, m = poles.shape[:2]
    points, heavy = TColgp_Array2OfPnt(1, n, 1, m), TColStd_Array2OfReal(1, n, 1, m)
    for i in range(n):
        for j in range(m):
            points.SetValue(i + 1, j + 1, gp_Pnt(*map(float, poles[i, j])))
            heavy.SetValue(i + 1, j + 1, 1.0 if weights is None else float(weights[i, j]))
    return BRepBuilderAPI_MakeFace(Geom_BezierSurface(points, heavy), 1e-6).Face()


def saddle_poles(x0: float, y0: float, side: float) -> np.ndarray:
    """Bicubic control points of the saddle over a square."""

    def squared(start: float) -> np.ndarray:
        a, b, c = start**2, start * (start + side), (start + side) ** 2
        return np.array([a, (a + 2 * b) / 3, (2 * b + c) / 3, c])

    steps = np.arange(4) / 3 * side
    x, y = np.meshgrid(x0 + steps, y0 + steps, indexing="ij")
    z = (squared(x0)[:, None] - squared(y0)[None]) / (2 * BEND)
    return np.stack([x, y, z], axis=2)


def saddle(x0: float = -1000.0, y0: float = -1000.0, side: float = 2000.0) -> Any:
    return bezier(saddle_poles(x0, y0, side))


def compound(*shapes: Any) -> Any:
    from OCP.BRep import BRep_Builder
    from OCP.TopoDS import TopoDS_Compound

    builder, whole = BRep_Builder(), TopoDS_Compound()
    builder.MakeCompound(whole)
    for shape in shapes:
        builder.Add(whole, shape)
    return whole


def four_saddles() -> Any:
    """The saddle in four faces, one of them the other way round."""
    corners = [(-1000.0, -1000.0), (0.0, -1000.0), (-1000.0, 0.0), (0.0, 0.0)]
    faces = [saddle(x, y, 1000.0) for x, y in corners]
    return compound(faces[0], faces[1], faces[2].Reversed(), faces[3])


def cylinder(angle: float = 360.0) -> Any:
    """Radius 1000, height 1500 mm, around z."""
    import build123d as bd

    arc = bd.CenterArc((0, 0, 0), 1000, 0, angle).edge()
    return bd.Face.extrude(arc, (0, 0, 1500)).wrapped


def plate_with_hole() -> Any:
    """2000 x 1000 mm with a hole of radius 200 around (300, 0)."""
    import build123d as bd

    flat = bd.Sketch() + bd.Rectangle(2000, 1000) - bd.Pos(300, 0) * bd.Circle(200)
    return flat.faces()[0].wrapped


def hemisphere() -> Any:
    """Radius 1000 mm, with its pole at the top."""
    import build123d as bd

    faces = bd.Solid.make_sphere(1000, angle1=0, angle2=90).faces()
    return max(faces, key=lambda face: face.area).wrapped


def write(shape: Any, path: Any, unit: str = "MM") -> None:
    """Write by extension: STEP, IGES or BREP."""
    if path.suffix == ".step":
        from OCP.Interface import Interface_Static
        from OCP.STEPControl import (
            STEPControl_Controller,
            STEPControl_StepModelType,
            STEPControl_Writer,
        )

        STEPControl_Controller.Init_s()
        Interface_Static.SetCVal_s("write.step.unit", unit)
        writer = STEPControl_Writer()
        writer.Transfer(shape, STEPControl_StepModelType.STEPControl_AsIs)
        writer.Write(str(path))
        Interface_Static.SetCVal_s("write.step.unit", "MM")
    elif path.suffix == ".igs":
        from OCP.IGESControl import IGESControl_Controller, IGESControl_Writer

        IGESControl_Controller.Init_s()
        writer = IGESControl_Writer(unit, 0)
        writer.AddShape(shape)
        writer.ComputeModel()
        writer.Write(str(path))
    else:
        from OCP.BRepTools import BRepTools

        BRepTools.Write_s(shape, str(path))
