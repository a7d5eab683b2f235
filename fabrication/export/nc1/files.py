"""Steel plates as NC1 files, one per distinct plate, and the list that says which is which."""

from __future__ import annotations

import csv
import re
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np

from fabrication.errors import OutputError
from fabrication.export.cut_sets import Counted, CutSet, counted
from fabrication.export.nc1.blocks import circle_of, contour, holes, marks, plain
from fabrication.parts import FlatPart, Label
from fabrication.stock import Material
from gridshell import SettingError
from gridshell.arrays import Floats

INDEX = "index.csv"
"""Of the folder: which parts are in which file."""


@dataclass(frozen=True, eq=False)
class Plate:
    """A flat bar or a plate.

    Parameters
    ----------
    mark : the piece's.
    profile : as lists call it: "FL2.5*100", "PL4*76.5".
    outline : (k, 2), or (k, 3) with bulges, counter-clockwise, within (0, 0) ..
        (length, width), mm.
    circles : (m, 3) rows x, y, diameter of round holes, mm.
    labels : texts to stamp.
    length, width, thickness : mm.
    quantity : how many are made.
    openings : outlines of further openings, as the outline; round ones are drilled.
    """

    mark: str
    profile: str
    outline: Floats
    circles: Floats
    labels: tuple[Label, ...]
    length: float
    width: float
    thickness: float
    material: Material
    quantity: int = 1
    openings: tuple[Floats, ...] = field(default=())


def nc1_text(plate: Plate, *, order: str, phase: str = "1") -> str:
    """The content of the file of *plate*.

    Parameters
    ----------
    order : identification of the order: the project's name.
    phase : identification of the phase.
    """
    drilled = [circle_of(opening) for opening in plate.openings]
    circles = [*plate.circles.tolist(), *(circle for circle in drilled if circle is not None)]
    inner = [o for o, circle in zip(plate.openings, drilled, strict=True) if circle is None]
    lines = [
        *_header(plate, plain(order), plain(phase)),
        *contour("AK", plate.outline),
        *(line for opening in inner for line in contour("IK", opening)),
        *holes(_rows(circles)),
        *marks(plate.labels),
        "EN",
    ]
    return "\n".join(lines) + "\n"


def write_nc1(folder: Path, name: str, sets: Sequence[CutSet]) -> list[Path]:
    """Write ``A1.nc1``, ... of all steel parts and ``index.csv`` into *folder*.

    Parameters
    ----------
    name : of the project.

    Raises
    ------
    SettingError
        Where no part is of steel, or a part is no plate with square ends.
    OutputError
        When a file cannot be written.
    """
    steel = [cut for cut in sets if cut.material.is_steel]
    found = [(cut, one) for cut in steel for one in counted(cut)]
    if not found:
        raise SettingError(
            "NC1 files are of steel parts, and there are none",
            where="export.formats",
            value=", ".join(sorted({cut.material.name for cut in sets})),
            advice="leave nc1 out; the DXF sheets hold these parts",
        )
    names = _file_names([(cut.kind, one.mark) for cut, one in found])
    paths = []
    try:
        folder.mkdir(parents=True, exist_ok=True)
        for (cut, one), file in zip(found, names, strict=True):
            path = folder / f"{file}.nc1"
            text = nc1_text(plate_of(one, cut.material), order=name)
            path.write_text(text, encoding="ascii", newline="\r\n")
            paths.append(path)
        _write_index(folder / INDEX, found, names)
    except OSError as error:
        raise OutputError(
            "The NC1 files cannot be written", where=str(folder), value=error.strerror or ""
        ) from None
    return paths


def plate_of(one: Counted, material: Material) -> Plate:
    """A flat part as a plate; where equal parts carry other texts, its own mark alone stays.

    Raises
    ------
    SettingError
        For a tube, or ends that are not square.
    """
    part = one.part
    strip = isinstance(part, FlatPart)
    if isinstance(part, FlatPart) and (part.wall or part.bevels != (0.0, 0.0)):
        raise SettingError(
            "An NC1 plate is flat and has square ends",
            where="export.formats",
            value=f"{one.mark}, {'a hollow section' if part.wall else 'bevelled ends'}",
            advice="leave nc1 out" if part.wall else "joint.square_ends = true, or leave nc1 out",
        )
    return Plate(
        mark=one.mark,
        profile=f"{'FL' if strip else 'PL'}{part.thickness:g}*{round(part.width, 1):g}",
        outline=part.outline,
        circles=part.circles,
        labels=part.labels if one.alike else part.labels[:1],
        length=part.length,
        width=part.width,
        thickness=part.thickness,
        material=material,
        quantity=one.quantity,
    )


def _header(plate: Plate, order: str, phase: str) -> Iterator[str]:
    """ST: what the piece is, a line per value; masses and surfaces are of the plate uncut."""
    mark, width, thickness = plain(plate.mark), plate.width, plate.thickness
    per_metre = width * thickness * plate.material.density * 1e-6
    yield from ("ST", f"** {mark}.nc1")
    for text in (order, mark, phase, mark, plain(plate.material.name)):
        yield f"  {text}"
    yield f"  {plate.quantity}"
    yield f"  {plate.profile}"
    yield "  B"
    sizes = (plate.length, width, thickness, thickness, thickness, 0.0)  # no radius
    surface = 2.0 * (width + thickness) * 1e-3
    for value in (*sizes, per_metre, surface, 0.0, 0.0, 0.0, 0.0):  # square ends
        yield f"  {value:11.3f}"
    yield from ("  ",) * 4


def _rows(circles: Sequence[Sequence[float]]) -> Floats:
    return np.array(circles, dtype=np.float64).reshape(-1, 3)


def _file_names(parts: Sequence[tuple[str, str]]) -> list[str]:
    """A name per part from its mark; one that is taken gets its kind in front, then a number."""
    taken: set[str] = set()
    names = []
    for kind, mark in parts:
        safe = re.sub(r"[^A-Za-z0-9._-]", "_", mark) or "_"
        tries = (safe, f"{kind}-{safe}", *(f"{kind}-{safe}-{n}" for n in range(2, len(parts) + 2)))
        name = next(one for one in tries if one.lower() not in taken)
        taken.add(name.lower())
        names.append(name)
    return names


def _write_index(path: Path, found: Sequence[tuple[CutSet, Counted]], names: Sequence[str]) -> None:
    with path.open("w", encoding="utf-8", newline="") as file:
        rows = csv.writer(file)
        rows.writerow(["file", "kind", "quantity", "material", "thickness_mm", "marks"])
        for (cut, one), name in zip(found, names, strict=True):
            size = f"{one.part.thickness:g}"
            listed = " ".join(one.marks)
            rows.writerow([f"{name}.nc1", cut.kind, one.quantity, cut.material.name, size, listed])
