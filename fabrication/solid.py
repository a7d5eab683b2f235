"""Solids of strips in the CAD kernel (build123d and OCP), checked by the kernel itself."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from fabrication.colours import FAMILY_COLOURS
from fabrication.errors import KernelError, no_kernel
from fabrication.lamella import Lamella
from fabrication.parts import FlatPart
from fabrication.sides import strip_sides
from fabrication.strip_brep import strip_brep
from fabrication.strip_loops import strip_loops
from fabrication.structures import Structure
from fabrication.tube_brep import tube_brep
from fabrication.tube_sides import tube_sides

try:
    import build123d
    from OCP import Standard, StdFail
    from OCP.BRepCheck import BRepCheck_Analyzer
    from OCP.BRepGProp import BRepGProp
    from OCP.GProp import GProp_GProps
    from OCP.TopoDS import TopoDS_Solid
except ImportError as error:  # pragma: no cover - depends on the machine
    raise no_kernel(error) from error

KERNEL_ERRORS = tuple(
    kind
    for module in (Standard, StdFail)
    for kind in vars(module).values()
    if isinstance(kind, type) and issubclass(kind, Exception)
)
"""The kernel's own exceptions have no common base in Python."""

_VOLUME_ACCURACY = 1e-9


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
        solid = _made(lamella, part)
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


def _made(lamella: Lamella, part: FlatPart) -> TopoDS_Solid:
    if part.wall:
        return tube_brep(tube_sides(lamella, part), part.length, part.drills)
    return strip_brep(strip_sides(lamella, part), part.thickness, strip_loops(part))


def volume(shape: Any) -> float:
    """Volume of a kernel shape, mm3; the kernel's default integration is 1e-4 off on strips."""
    properties = GProp_GProps()
    BRepGProp.VolumePropertiesGK_s(shape, properties, _VOLUME_ACCURACY, True)
    return float(properties.Mass())
