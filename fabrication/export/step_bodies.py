"""STEP of bodies: every shape once, and one named occurrence of it per body.

Written through the kernel's own product structure: a product per shape, an assembly per kind, and
every occurrence named by its mark. The header is put in afterwards, as for lamellas.
"""

from __future__ import annotations

from collections import Counter
from datetime import datetime
from pathlib import Path
from typing import Any

from OCP.gp import gp_Ax3, gp_Dir, gp_Pnt, gp_Trsf
from OCP.IFSelect import IFSelect_RetDone
from OCP.Interface import Interface_Static
from OCP.Quantity import Quantity_Color, Quantity_TOC_sRGB
from OCP.STEPCAFControl import STEPCAFControl_Writer
from OCP.STEPControl import STEPControl_AsIs
from OCP.TCollection import TCollection_ExtendedString
from OCP.TDataStd import TDataStd_Name
from OCP.TDocStd import TDocStd_Document
from OCP.TopLoc import TopLoc_Location
from OCP.XCAFApp import XCAFApp_Application
from OCP.XCAFDoc import XCAFDoc_ColorGen, XCAFDoc_DocumentTool

from fabrication.errors import OutputError
from fabrication.export.step import PLACEHOLDER, quiet, sign
from fabrication.outlines import Frame
from fabrication.prisms import prism
from fabrication.shapes import Bodies


def write_bodies(
    bodies: Bodies, path: Path | str, *, name: str, written: datetime | None = None
) -> None:
    """Write *bodies* as an assembly called *name*, mm.

    Parameters
    ----------
    written : the time stamp, as for ``write_step``.

    Raises
    ------
    KernelError
        When the kernel does not find a solid valid.
    OutputError
        When the file cannot be written.
    """
    quiet()
    path = Path(path)
    document = _document(bodies)
    writer = STEPCAFControl_Writer()
    writer.SetColorMode(True)
    writer.SetNameMode(True)
    Interface_Static.SetIVal_s("write.surfacecurve.mode", 0)
    done = writer.Transfer(document, STEPControl_AsIs)
    if not done or writer.Write(str(path)) != IFSelect_RetDone:
        raise OutputError("The STEP file cannot be written", where=str(path))
    kinds = " and ".join([", ".join(k.name for k in bodies.kinds[:-1]), bodies.kinds[-1].name])
    sign(path, name, f"Gridshell: {kinds.removeprefix(' and ')}", written)


def _document(bodies: Bodies) -> Any:
    """The kernel's document: shapes, assemblies and occurrences, named and coloured."""
    document = TDocStd_Document(_text("XmlOcaf"))
    XCAFApp_Application.GetApplication_s().NewDocument(_text("MDTV-XCAF"), document)
    tool = XCAFDoc_DocumentTool.ShapeTool_s(document.Main())
    tool.SetAutoNaming_s(False)
    colours = XCAFDoc_DocumentTool.ColorTool_s(document.Main())
    whole = tool.NewShape()
    TDataStd_Name.Set_s(whole, _text(PLACEHOLDER))
    used = Counter(body.shape for kind in bodies.kinds for body in kind.bodies)
    labels: dict[int, Any] = {}
    for kind in bodies.kinds:
        colour = Quantity_Color(*kind.colour, Quantity_TOC_sRGB)
        group = tool.NewShape()
        TDataStd_Name.Set_s(group, _text(kind.name))
        for body in kind.bodies:
            label = labels.get(body.shape)
            if label is None:
                shape = bodies.shapes[body.shape]
                label = labels[body.shape] = tool.AddShape(prism(shape), False)
                count = used[body.shape]
                title = shape.mark if count == 1 else f"{shape.mark}, {count} alike"
                TDataStd_Name.Set_s(label, _text(title))
                colours.SetColor(label, colour, XCAFDoc_ColorGen)
            placed = tool.AddComponent(group, label, _location(body.frame))
            TDataStd_Name.Set_s(placed, _text(body.mark))
        part = tool.AddComponent(whole, group, TopLoc_Location())
        TDataStd_Name.Set_s(part, _text(kind.name))
    tool.UpdateAssemblies()
    return document


def _location(frame: Frame) -> TopLoc_Location:
    there = gp_Ax3(
        gp_Pnt(*frame.origin.tolist()), gp_Dir(*frame.normal.tolist()), gp_Dir(*frame.x.tolist())
    )
    motion = gp_Trsf()
    motion.SetTransformation(there, gp_Ax3())
    return TopLoc_Location(motion)


def _text(text: str) -> TCollection_ExtendedString:
    return TCollection_ExtendedString(text, True)
