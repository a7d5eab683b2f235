"""STEP: one assembly with a named, coloured part per lamella (cadquery's product structure)."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import build123d
import cadquery
from cadquery.occ_impl.exporters.assembly import exportAssembly
from OCP.Message import Message

from fabrication.colours import FAMILY_COLOURS
from fabrication.errors import OutputError
from fabrication.structures import Structure


def assembly(
    solids: Sequence[build123d.Solid], structure: Structure, *, name: str
) -> cadquery.Assembly:
    """An assembly of *solids*, one child per lamella named by its mark.

    Parameters
    ----------
    solids : from ``fabrication.solid.solids``, in the structure's order.
    name : of the whole.
    """
    whole = cadquery.Assembly(name=name)
    for solid, lamella in zip(solids, structure.lamellas, strict=True):
        colour = cadquery.Color(*FAMILY_COLOURS[lamella.family])
        whole.add(cadquery.Shape.cast(solid.wrapped), name=lamella.mark, color=colour)
    return whole


def write_step(whole: cadquery.Assembly, path: Path | str) -> None:
    """Write the assembly in mm, without parameter curves: other programs compute their own.

    Raises
    ------
    OutputError
        When the file cannot be written.
    """
    quiet()
    if not exportAssembly(whole, str(path), write_pcurves=False):
        raise OutputError("The STEP file cannot be written", where=str(path))


def quiet() -> None:
    """Keep the kernel's banners off the terminal."""
    messenger = Message.DefaultMessenger_s()
    for printer in list(messenger.Printers()):
        messenger.RemovePrinter(printer)
