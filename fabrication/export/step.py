"""STEP: one assembly with a named, coloured part per lamella (cadquery's product structure).

cadquery hands names to the kernel byte by byte and leaves the kernel's own header, so the name of
the whole and the header are put in after the kernel has written: strings in the seven-bit form of
ISO 10303-21, and the same bytes for the same solids apart from the time stamp and the colours at
the end, whose order the kernel takes from where they lie in memory.
"""

from __future__ import annotations

import re
from collections.abc import Sequence
from datetime import datetime
from itertools import count
from pathlib import Path

import build123d
import cadquery
from cadquery.occ_impl.exporters.assembly import exportAssembly
from OCP.Message import Message

from fabrication.colours import FAMILY_COLOURS
from fabrication.errors import OutputError
from fabrication.export.stamp import now, program
from fabrication.export.step_text import compact
from fabrication.structures import Structure

PLACEHOLDER = "@whole@"
"""Stands for the name of the whole until `sign`."""

_SCHEMA = re.compile(rb"FILE_SCHEMA\(.*?\);", re.DOTALL)
_PROCESSOR = re.compile(rb"'(Open CASCADE STEP processor[^']*)'")
_OCCURRENCE = re.compile(rb"(NEXT_ASSEMBLY_USAGE_OCCURRENCE\()\s*'\d+'([^;]*;)")


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


def write_step(
    whole: cadquery.Assembly, path: Path | str, *, written: datetime | None = None
) -> None:
    """Write the assembly in mm, without parameter curves: other programs compute their own.

    Parameters
    ----------
    written : the time stamp of the file. Left out it is the environment's ``SOURCE_DATE_EPOCH``
        (seconds since 1970) where that is set, and else now.

    Raises
    ------
    OutputError
        When the file cannot be written.
    """
    quiet()
    path = Path(path)
    nameless = cadquery.Assembly(whole.obj, whole.loc, PLACEHOLDER, whole.color)
    nameless.children = whole.children
    if not exportAssembly(nameless, str(path), write_pcurves=False):
        raise OutputError("The STEP file cannot be written", where=str(path))
    sign(path, whole.name, "Gridshell lamellas, bent and twisted into place", written)


def sign(path: Path, name: str, description: str, written: datetime | None) -> None:
    """Put our header and *name* into a file the kernel wrote; errors as `write_step`."""
    try:
        content = path.read_bytes()
        path.write_bytes(_signed(content, name, path.name, description, written or now()))
    except OSError as error:
        raise OutputError(
            "The STEP file cannot be written", where=str(path), value=error.strerror or ""
        ) from None


def _signed(content: bytes, name: str, file: str, description: str, written: datetime) -> bytes:
    """The kernel's file with our header, *name* as the product, occurrences numbered from 1.

    The kernel numbers occurrences on from the last file it wrote in the same process.
    """
    head, data = content.split(b"DATA;", 1)
    schema, processor = _SCHEMA.search(head), _PROCESSOR.search(head)
    header = [
        "ISO-10303-21;",
        "HEADER;",
        f"FILE_DESCRIPTION(({step_string(description)}),'2;1');",
        f"FILE_NAME({step_string(file)},'{written:%Y-%m-%dT%H:%M:%S}',(''),(''),",
        f"  '{processor[1].decode() if processor else ''}','{program()}','');",
        schema[0].decode() if schema else "FILE_SCHEMA(('AUTOMOTIVE_DESIGN'));",
        "ENDSEC;",
        "DATA;",
    ]
    numbers = count(1)

    def renumbered(found: re.Match[bytes]) -> bytes:
        rest = re.sub(rb"\n *", b"", found[2])  # lines break by the number's length
        return b"%s'%d'%s" % (found[1], next(numbers), rest)

    data = data.replace(f"'{PLACEHOLDER}'".encode(), step_string(name).encode())
    data = _OCCURRENCE.sub(renumbered, data)
    return "\n".join(header).encode() + compact(data)


def step_string(text: str) -> str:
    r"""*text* as a quoted string of ISO 10303-21: seven bits, the rest as \X2\ or \X4\ codes."""
    pieces = []
    for run in re.findall(r"[ -~]+|[^ -~\U00010000-\U0010ffff]+|[\U00010000-\U0010ffff]+", text):
        if run[0] > "\uffff":
            pieces.append("\\X4\\" + "".join(f"{ord(c):08X}" for c in run) + "\\X0\\")
        elif not " " <= run[0] <= "~":
            pieces.append("\\X2\\" + "".join(f"{ord(c):04X}" for c in run) + "\\X0\\")
        else:
            pieces.append(run.replace("\\", "\\\\").replace("'", "''"))
    return "'" + "".join(pieces) + "'"


def quiet() -> None:
    """Keep the kernel's banners off the terminal."""
    messenger = Message.DefaultMessenger_s()
    for printer in list(messenger.Printers()):
        messenger.RemovePrinter(printer)
