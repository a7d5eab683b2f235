"""DXF cutting sheets: the only module that imports ezdxf.

Layers: CUT holds one closed outline per part and nothing else; MARK holds single-stroke text to
engrave; TEXT is for people: the title above the sheet and the marks of each row left of it, outside
the sheet so that a machine fed with every layer engraves nothing twice; SHEET is the outline of the
raw sheet. Units are mm, the format is R2010; arcs are bulges, other curves lines. Part strip
coordinates (0, 0) lie at the outline's first corner.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np
from ezdxf import bbox, units
from ezdxf.document import Drawing
from ezdxf.entities.circle import Circle
from ezdxf.entities.dxfentity import DXFEntity
from ezdxf.entities.dxfgfx import DXFGraphic
from ezdxf.entities.lwpolyline import LWPolyline
from ezdxf.entities.text import Text
from ezdxf.enums import TextEntityAlignment
from ezdxf.filemanagement import new, readfile
from ezdxf.layouts.layout import Modelspace
from ezdxf.lldxf.const import DXFError
from HersheyFonts import HersheyFonts

from fabrication.errors import OutputError
from fabrication.nesting import NestedSheet, Placement
from fabrication.parts import Label
from gridshell import FileError
from gridshell.arrays import Floats

CUT, MARK, TEXT, SHEET = "CUT", "MARK", "TEXT", "SHEET"
_LAYERS = {CUT: 1, MARK: 5, TEXT: 8, SHEET: 9}
_APPLICATION = "GRIDSHELL"

_MANY = 12
"""Marks of a row that are told one by one."""


def write_dxf(
    sheets: Sequence[NestedSheet],
    folder: Path | str,
    *,
    name: str = "",
    material: str = "",
    prefix: str = "sheet",
    alike: Mapping[str, str] | None = None,
) -> list[Path]:
    """Write ``sheet-01.dxf``, ... into *folder* and return their paths.

    Parameters
    ----------
    name, material : of the project and of the sheets, for the title; left out where empty.
    prefix : of the files' names: what the sheets hold.
    alike : group of every mark; how many parts of a group lie on a sheet is then told below it.

    Raises
    ------
    OutputError
        When a file cannot be written.
    """
    folder = Path(folder)
    font = _StrokeFont()
    digits = max(2, len(str(len(sheets))))
    paths = []
    try:
        folder.mkdir(parents=True, exist_ok=True)
        for nested in sheets:
            path = folder / f"{prefix}-{nested.number:0{digits}d}.dxf"
            title = _title(nested, len(sheets), name, material)
            _document(nested, title, _quantities(nested, alike), font).saveas(path)
            paths.append(path)
    except OSError as error:
        raise OutputError(
            "The sheets cannot be written", where=str(folder), value=error.strerror or ""
        ) from None
    return paths


def _title(nested: NestedSheet, sheets: int, name: str, material: str) -> str:
    """One line: project, sheet of how many, material and thickness, size of the sheet, parts."""
    sheet, parts = nested.sheet, [placement.part for placement in nested.placements]
    thickness = " / ".join(f"{t:g} mm" for t in sorted({part.thickness for part in parts}))
    pieces = (
        " ".join(name.split()),
        f"sheet {nested.number} of {sheets}",
        " ".join(f"{material} {thickness}".split()),
        f"raw sheet {sheet.length:g} x {sheet.width:g} mm",
        f"{len(parts)} {'part' if len(parts) == 1 else 'parts'}",
    )
    return "  |  ".join(piece for piece in pieces if piece)


def _quantities(nested: NestedSheet, alike: Mapping[str, str] | None) -> str:
    """How many parts of each group lie on a sheet, where there are equal ones."""
    if alike is None:
        return ""
    counts = Counter(alike[placement.part.mark] for placement in nested.placements)
    several = [f"{count} x {group}" for group, count in counts.most_common() if count > 1]
    single = sum(count == 1 for count in counts.values())
    if not several:
        return "no two parts alike"
    return "alike: " + ", ".join(several) + (f"; single: {single}" if single else "")


def _document(nested: NestedSheet, title: str, below: str, font: _StrokeFont) -> Drawing:
    document = new("R2010", units=units.MM)
    document.appids.add(_APPLICATION)
    for name, colour in _LAYERS.items():
        document.layers.add(name, color=colour)
    space = document.modelspace()
    sheet = nested.sheet
    corners = [(0.0, 0.0), (sheet.length, 0.0), (sheet.length, sheet.width), (0.0, sheet.width)]
    outer: list[DXFGraphic] = [
        space.add_lwpolyline(corners, close=True, dxfattribs={"layer": SHEET})
    ]
    outer += _texts(space, nested, title, below)
    for placement in nested.placements:
        _draw(space, placement, font)
    extents = bbox.extents(outer)
    space.reset_extents(extents.extmin, extents.extmax)
    return document


def _texts(space: Modelspace, nested: NestedSheet, title: str, below: str) -> list[Text]:
    """The title above the sheet, and left of every row the marks of its parts in their order."""
    height = nested.sheet.width / 40.0
    rows: dict[float, list[Placement]] = {}
    for placement in nested.placements:
        rows.setdefault(placement.y, []).append(placement)
    above = space.add_text(title, height=height, dxfattribs={"layer": TEXT})
    above.set_placement((0.0, nested.sheet.width + height), align=TextEntityAlignment.LEFT)
    texts = [above]
    if below:
        under = space.add_text(below, height=height / 2.0, dxfattribs={"layer": TEXT})
        under.set_placement((0.0, -height), align=TextEntityAlignment.LEFT)
        texts.append(under)
    for y, row in rows.items():
        width = row[0].part.width
        marks = _listed([p.part.mark for p in sorted(row, key=lambda p: p.x)])
        beside = space.add_text(marks, height=min(height, width / 2.0), dxfattribs={"layer": TEXT})
        beside.set_placement((-height, y + width / 2.0), align=TextEntityAlignment.MIDDLE_RIGHT)
        texts.append(beside)
    return texts


def _listed(marks: Sequence[str]) -> str:
    """All *marks* of a row, or the first, the last and how many."""
    if len(marks) <= _MANY:
        return ", ".join(marks)
    return f"{marks[0]}, {marks[1]} ... {marks[-1]} ({len(marks)})"


def _draw(space: Modelspace, placement: Placement, font: _StrokeFont) -> None:
    part, offset = placement.part, np.array([placement.x, placement.y])
    rows = np.array(part.outline)
    rows[:, :2] += offset
    contour = space.add_lwpolyline(
        rows.tolist(),
        format="xy" if rows.shape[1] == 2 else "xyb",
        close=True,
        dxfattribs={"layer": CUT},
    )
    contour.set_xdata(_APPLICATION, [(1000, part.mark)])
    for x, y, diameter in part.circles.tolist():
        centre = (x + placement.x, y + placement.y)
        hole = space.add_circle(centre, diameter / 2.0, dxfattribs={"layer": CUT})
        hole.set_xdata(_APPLICATION, [(1000, part.mark)])
    for label in part.labels:
        for stroke in font.strokes(label):
            points = (stroke + offset).tolist()
            space.add_lwpolyline(points, dxfattribs={"layer": MARK})


class _StrokeFont:
    """Single-stroke capitals and digits."""

    def __init__(self) -> None:
        self._font = HersheyFonts()
        self._font.load_default_font("futural")
        self._font.normalize_rendering(1.0)
        self._cache: dict[str, list[Floats]] = {}

    def strokes(self, label: Label) -> list[Floats]:
        """Polylines (k, 2) of a label, centred on its position, in strip coordinates."""
        if label.text not in self._cache:
            self._cache[label.text] = self._centred(label.text)
        here = np.array([label.x, label.y])
        c, s = np.cos(label.angle), np.sin(label.angle)
        turn = label.height * np.array([[c, s], [-s, c]])
        return [stroke @ turn + here for stroke in self._cache[label.text]]

    def _centred(self, text: str) -> list[Floats]:
        strokes = [np.array(s, dtype=np.float64) for s in self._font.strokes_for_text(text)]
        strokes = [stroke for stroke in strokes if len(stroke) > 1]
        everything = np.concatenate(strokes)
        middle = (everything.min(axis=0) + everything.max(axis=0)) / 2.0
        return [stroke - middle for stroke in strokes]


@dataclass(frozen=True, eq=False)
class DxfPart:
    """What a sheet says of one part.

    Parameters
    ----------
    mark : from the outline's extended data.
    outline : (k, 2), or (k, 3) with bulges where it has arcs, mm, moved so that its first corner
        is (0, 0).
    circles : (m, 3) rows x, y, diameter of its round holes, in order of x, moved alike, mm.
    """

    mark: str
    outline: Floats
    circles: Floats = field(default_factory=lambda: np.zeros((0, 3)))


def read_dxf(path: Path | str) -> tuple[DxfPart, ...]:
    """Read the parts of a sheet back from the file.

    Raises
    ------
    FileError
        When the file is missing, is no DXF, is not in mm, or its cutting layer holds something
        that is not a closed outline with a mark.
    """
    try:
        document = readfile(path)
    except (OSError, DXFError, ValueError, LookupError, StopIteration) as error:
        raise FileError("The sheet cannot be read", where=str(path), value=str(error)) from None
    if document.units != units.MM:
        raise FileError("The sheet is not in mm", where=str(path), value=f"{document.units}")
    contours: dict[str, Floats] = {}
    holes: dict[str, list[tuple[float, float, float]]] = {}
    for entity in document.modelspace().query(f'*[layer=="{CUT}"]'):
        mark = _mark(path, entity)
        if isinstance(entity, Circle):
            x, y, _ = entity.dxf.center
            holes.setdefault(mark, []).append((x, y, 2.0 * entity.dxf.radius))
        else:
            contours[mark] = _contour(path, entity)
    if stray := sorted(holes.keys() - contours.keys()):
        raise FileError("A hole lies in no part", where=f"{path}, {stray[0]}")
    return tuple(_part(mark, contour, holes.get(mark, ())) for mark, contour in contours.items())


def _part(mark: str, contour: Floats, holes: Sequence[tuple[float, float, float]]) -> DxfPart:
    origin = np.r_[contour[0, :2], 0.0]
    circles = np.array(sorted(holes)).reshape(-1, 3) - origin
    outline = contour - origin
    return DxfPart(mark, outline if outline[:, 2].any() else outline[:, :2], circles)


def _mark(path: Path | str, entity: DXFEntity) -> str:
    """The mark of the part that *entity* belongs to."""
    closed = isinstance(entity, Circle) or (isinstance(entity, LWPolyline) and entity.closed)
    if not (closed and entity.has_xdata(_APPLICATION)):
        raise FileError(
            "Something on the cutting layer is no closed outline with a mark",
            where=f"{path}, {entity}",
        )
    marks = [str(tag.value) for tag in entity.get_xdata(_APPLICATION) if tag.code == 1000]
    if not marks:
        raise FileError("An outline is incomplete", where=f"{path}, {entity}")
    return marks[0]


def _contour(path: Path | str, entity: Any) -> Floats:
    """(k, 3) corners with bulges."""
    points = np.array(entity.get_points("xyb"), dtype=np.float64)
    if len(points) < 3:
        raise FileError("An outline is incomplete", where=f"{path}, {entity}")
    return points
