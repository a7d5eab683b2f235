"""STEP of strips and bodies: every shape once, and one named occurrence of it per part.

Written through the kernel's own product structure: a product per shape, an assembly per kind, and
every occurrence named by its mark. The header is put in afterwards, as for lamellas.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
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

from fabrication.colours import FAMILY_COLOURS
from fabrication.errors import OutputError
from fabrication.export.step import PLACEHOLDER, quiet, sign
from fabrication.outlines import Frame
from fabrication.prisms import prism
from fabrication.shapes import Bodies, Colour
from fabrication.structures import Structure

SEGMENT = "segment"
"""Name of what is there several times, and of every occurrence before its number."""


@dataclass(frozen=True, eq=False)
class SolidKind:
    """Solids of a kind that are all different: what they are called, their colour, they by mark."""

    name: str
    colour: Colour
    solids: Mapping[str, Any]


def strip_kinds(strips: Structure, solids: Sequence[Any]) -> tuple[SolidKind, ...]:
    """The *solids* of *strips*, in their order, by family."""
    kinds = []
    for family, colour in FAMILY_COLOURS.items():
        own = {
            lamella.mark: solid.wrapped
            for lamella, solid in zip(strips.lamellas, solids, strict=True)
            if lamella.family == family
        }
        if own:
            kinds.append(SolidKind(f"family {'AB'[family - 1]}", colour, own))
    return tuple(kinds)


def write_bodies(
    bodies: Bodies, path: Path | str, *, name: str, written: datetime | None = None
) -> None:
    """Write *bodies* as an assembly called *name*, see :func:`write_assembly`."""
    write_assembly(path, name=name, bodies=bodies, written=written)


def write_assembly(
    path: Path | str,
    *,
    name: str,
    strips: Sequence[SolidKind] = (),
    bodies: Bodies | None = None,
    poses: Sequence[Frame] = (),
    written: datetime | None = None,
) -> None:
    """Write strips and bodies as an assembly called *name*, mm.

    Parameters
    ----------
    poses : where copies of it all lie, "segment-1" and so on; none for the one at its own place.
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
    bodies = Bodies((), ()) if bodies is None else bodies
    document = _document(strips, bodies, poses)
    writer = STEPCAFControl_Writer()
    writer.SetColorMode(True)
    writer.SetNameMode(True)
    Interface_Static.SetIVal_s("write.surfacecurve.mode", 0)
    done = writer.Transfer(document, STEPControl_AsIs)
    if not done or writer.Write(str(path)) != IFSelect_RetDone:
        raise OutputError("The STEP file cannot be written", where=str(path))
    names = [kind.name for kind in strips] + [kind.name for kind in bodies.kinds]
    kinds = " and ".join([", ".join(names[:-1]), names[-1]]) if len(names) > 1 else names[0]
    sign(path, name, f"Gridshell: {kinds}", written)


def _document(strips: Sequence[SolidKind], bodies: Bodies, poses: Sequence[Frame]) -> Any:
    """The kernel's document: shapes, assemblies and occurrences, named and coloured."""
    document = TDocStd_Document(_text("XmlOcaf"))
    XCAFApp_Application.GetApplication_s().NewDocument(_text("MDTV-XCAF"), document)
    tool = XCAFDoc_DocumentTool.ShapeTool_s(document.Main())
    tool.SetAutoNaming_s(False)
    colours = XCAFDoc_DocumentTool.ColorTool_s(document.Main())
    whole = tool.NewShape()
    TDataStd_Name.Set_s(whole, _text(PLACEHOLDER))
    root = whole
    if poses:
        whole = tool.NewShape()
        TDataStd_Name.Set_s(whole, _text(SEGMENT))
    for strip_kind in strips:
        group = _group(tool, whole, strip_kind.name)
        for mark, solid in strip_kind.solids.items():
            label = _product(tool, colours, solid, mark, strip_kind.colour)
            TDataStd_Name.Set_s(tool.AddComponent(group, label, TopLoc_Location()), _text(mark))
    used = Counter(body.shape for kind in bodies.kinds for body in kind.bodies)
    labels: dict[int, Any] = {}
    for kind in bodies.kinds:
        group = _group(tool, whole, kind.name)
        for body in kind.bodies:
            if body.shape not in labels:
                shape, count = bodies.shapes[body.shape], used[body.shape]
                title = shape.mark if count == 1 else f"{shape.mark}, {count} alike"
                labels[body.shape] = _product(tool, colours, prism(shape), title, kind.colour)
            placed = tool.AddComponent(group, labels[body.shape], _location(body.frame))
            TDataStd_Name.Set_s(placed, _text(body.mark))
    for number, pose in enumerate(poses, start=1):
        placed = tool.AddComponent(root, whole, _location(pose))
        TDataStd_Name.Set_s(placed, _text(f"{SEGMENT}-{number}"))
    tool.UpdateAssemblies()
    return document


def _group(tool: Any, whole: Any, name: str) -> Any:
    """An empty assembly called *name* in the *whole*."""
    group = tool.NewShape()
    TDataStd_Name.Set_s(group, _text(name))
    TDataStd_Name.Set_s(tool.AddComponent(whole, group, TopLoc_Location()), _text(name))
    return group


def _product(tool: Any, colours: Any, solid: Any, title: str, colour: Colour) -> Any:
    label = tool.AddShape(solid, False)
    TDataStd_Name.Set_s(label, _text(title))
    colours.SetColor(label, Quantity_Color(*colour, Quantity_TOC_sRGB), XCAFDoc_ColorGen)
    return label


def _location(frame: Frame) -> TopLoc_Location:
    there = gp_Ax3(
        gp_Pnt(*frame.origin.tolist()), gp_Dir(*frame.normal.tolist()), gp_Dir(*frame.x.tolist())
    )
    motion = gp_Trsf()
    motion.SetTransformation(there, gp_Ax3())
    return TopLoc_Location(motion)


def _text(text: str) -> TCollection_ExtendedString:
    return TCollection_ExtendedString(text, True)
