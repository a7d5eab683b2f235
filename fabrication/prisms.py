"""Prisms in the CAD kernel: an outline of lines and arcs pushed straight, without any boolean.

Besides ``solid`` the only module below the exporters that imports the kernel.
"""

from __future__ import annotations

import numpy as np

from fabrication.errors import KernelError, no_kernel
from fabrication.shapes import Shape
from fabrication.solid import KERNEL_ERRORS
from gridshell.arrays import Floats

try:
    from OCP.BRepBuilderAPI import (
        BRepBuilderAPI_MakeEdge,
        BRepBuilderAPI_MakeFace,
        BRepBuilderAPI_MakeWire,
    )
    from OCP.BRepCheck import BRepCheck_Analyzer
    from OCP.BRepPrimAPI import BRepPrimAPI_MakePrism
    from OCP.GC import GC_MakeArcOfCircle
    from OCP.gp import gp_Dir, gp_Pln, gp_Pnt, gp_Vec
    from OCP.TopoDS import TopoDS, TopoDS_Edge, TopoDS_Shape, TopoDS_Wire
except ImportError as error:  # pragma: no cover - depends on the machine
    raise no_kernel(error) from error


def prism(shape: Shape) -> TopoDS_Shape:
    """The solid of *shape* in its own coordinates.

    Raises
    ------
    KernelError
        When the kernel cannot make it or does not find it valid; the part is named.
    """
    try:
        plane = gp_Pln(gp_Pnt(0.0, 0.0, shape.low), gp_Dir(0.0, 0.0, 1.0))
        face = BRepBuilderAPI_MakeFace(plane, _wire(shape.outline, shape.low))
        for opening in shape.openings:
            face.Add(TopoDS.Wire_s(_wire(opening, shape.low).Reversed()))
        up = gp_Vec(0.0, 0.0, shape.high - shape.low)
        solid = BRepPrimAPI_MakePrism(face.Face(), up).Shape()
    except KERNEL_ERRORS as error:
        raise KernelError(
            "The kernel cannot make a solid", where=shape.mark, value=str(error)
        ) from error
    if not BRepCheck_Analyzer(solid).IsValid():
        raise KernelError("The kernel refuses a solid", where=shape.mark)
    return solid


def _wire(outline: Floats, z: float) -> TopoDS_Wire:
    """The closed wire of an outline with bulges at height *z*."""
    wire = BRepBuilderAPI_MakeWire()
    for a, b in zip(outline, np.roll(outline, -1, axis=0), strict=True):
        wire.Add(_edge(a, b, z))
    return wire.Wire()


def _edge(a: Floats, b: Floats, z: float) -> TopoDS_Edge:
    """From corner *a* to *b*, rows x, y, bulge; the arc by its middle point."""
    start, end = gp_Pnt(float(a[0]), float(a[1]), z), gp_Pnt(float(b[0]), float(b[1]), z)
    if a[2] == 0.0:
        return BRepBuilderAPI_MakeEdge(start, end).Edge()
    chord, middle = b[:2] - a[:2], (a[:2] + b[:2]) / 2.0
    top = middle + a[2] / 2.0 * np.array([chord[1], -chord[0]])
    arc = GC_MakeArcOfCircle(start, gp_Pnt(float(top[0]), float(top[1]), z), end)
    return BRepBuilderAPI_MakeEdge(arc.Value()).Edge()
