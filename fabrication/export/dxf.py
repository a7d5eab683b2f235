"""DXF cutting sheets.

Layers: CUT holds one closed outline per part, its round holes, and nothing else; MARK holds
single-stroke text to engrave; TEXT is for people: the title above the sheet and the marks of each
row left of it, outside the sheet so that a machine fed with every layer engraves nothing twice;
SHEET is the outline of the raw sheet. Units are mm, the format is R2010; arcs are bulges, other
curves lines. Part strip coordinates (0, 0) lie at the outline's first corner. A shop's process
names the layers and the files otherwise, gives holes a layer of their own, and moves the lines out
by half a kerf.
"""

from __future__ import annotations

import logging
from collections import Counter
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from pathlib import Path

import numpy as np
from ezdxf import bbox, units
from ezdxf.document import Drawing
from ezdxf.entities.dxfgfx import DXFGraphic
from ezdxf.entities.text import Text
from ezdxf.enums import TextEntityAlignment
from ezdxf.filemanagement import new
from ezdxf.layouts.layout import Modelspace
from HersheyFonts import HersheyFonts

from fabrication.errors import OutputError
from fabrication.export.dxf_content import APPLICATION
from fabrication.export.dxf_reader import DxfPart as DxfPart
from fabrication.export.dxf_reader import read_dxf as read_dxf
from fabrication.export.sheet_files import sheet_files, sheet_thickness
from fabrication.kerf import moved_out
from fabrication.nesting import NestedSheet, Placement
from fabrication.parts import Label
from fabrication.shapes import with_bulges
from fabrication.shop import DxfVersion, Process
from gridshell import SettingError
from gridshell.arrays import Floats

_COLOURS = {"cut": 1, "mark": 5, "text": 8, "sheet": 9, "drill": 3}
"""Of the layers, by what lies on them."""

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
    process: Process | None = None,
) -> list[Path]:
    """Write ``sheet-01.dxf``, ... into *folder* and return their paths.

    Parameters
    ----------
    name, material : of the project and of the sheets, for the title; left out where empty.
    prefix : of the files' names: what the sheets hold.
    alike : group of every mark; how many parts of a group lie on a sheet is then told below it.
    process : names of layers and files, format, and whether lines are moved out by half a kerf.

    Raises
    ------
    OutputError
        When a file cannot be written.
    SettingError
        When the kerf leaves nothing of a cut.
    """
    process = Process() if process is None else process
    folder = Path(folder)
    font = _StrokeFont()
    files = sheet_files(sheets, name=name, material=material, prefix=prefix, process=process)
    paths = []
    try:
        folder.mkdir(parents=True, exist_ok=True)
        for nested, file in zip(sheets, files, strict=True):
            path = folder / f"{file}.dxf"
            title = _title(nested, len(sheets), name, material)
            document = _Writer(process, font).document(nested, title, _quantities(nested, alike))
            with _quiet():
                document.saveas(path)
            paths.append(path)
    except OSError as error:
        raise OutputError(
            "The sheets cannot be written", where=str(folder), value=error.strerror or ""
        ) from None
    return paths


@contextmanager
def _quiet() -> Iterator[None]:
    """Keep the library's warning about R12 off the terminal: nothing in the file is newer."""
    logger = logging.getLogger("ezdxf")
    before = logger.level
    logger.setLevel(logging.ERROR)
    try:
        yield
    finally:
        logger.setLevel(before)


def _title(nested: NestedSheet, sheets: int, name: str, material: str) -> str:
    """One line: project, sheet of how many, material and thickness, size of the sheet, parts."""
    sheet, parts = nested.sheet, [placement.part for placement in nested.placements]
    thickness = sheet_thickness(nested)
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


def _listed(marks: Sequence[str]) -> str:
    """All *marks* of a row, or the first, the last and how many."""
    if len(marks) <= _MANY:
        return ", ".join(marks)
    return f"{marks[0]}, {marks[1]} ... {marks[-1]} ({len(marks)})"


class _Writer:
    """Draws sheets as a shop wants them."""

    def __init__(self, process: Process, font: _StrokeFont) -> None:
        self._process, self._font = process, font
        self._layer = dict(process.layers.named)

    def document(self, nested: NestedSheet, title: str, below: str) -> Drawing:
        """One sheet."""
        version = self._process.version
        oldest = version is DxfVersion.R12
        document = new("R2000" if oldest else version.value, units=units.MM)
        document.dxfversion = version.value
        document.appids.add(APPLICATION)
        for key, name in self._layer.items():
            if name not in document.layers:
                document.layers.add(name, color=_COLOURS[key])
        space = document.modelspace()
        sheet = nested.sheet
        corners = np.array([[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]])
        outer = [self._line(space, corners * (sheet.length, sheet.width), "sheet", closed=True)]
        if oldest:
            title += "  |  all lengths in mm"
        outer += self._texts(space, nested, title, below)
        for placement in nested.placements:
            self._draw(space, placement)
        extents = bbox.extents(outer)
        space.reset_extents(extents.extmin, extents.extmax)
        return document

    def _line(self, space: Modelspace, points: Floats, key: str, *, closed: bool) -> DXFGraphic:
        """A polyline (k, 2), or (k, 3) with bulges, in the kind the format has."""
        attributes, rows = {"layer": self._layer[key]}, with_bulges(points).tolist()
        if self._process.version is DxfVersion.R12:
            return space.add_polyline2d(rows, format="xyb", close=closed, dxfattribs=attributes)
        return space.add_lwpolyline(rows, format="xyb", close=closed, dxfattribs=attributes)

    def _texts(
        self, space: Modelspace, nested: NestedSheet, title: str, below: str
    ) -> list[DXFGraphic]:
        """The title above the sheet, and left of every row the marks of its parts in order."""
        height = nested.sheet.width / 40.0
        rows: dict[float, list[Placement]] = {}
        for placement in nested.placements:
            rows.setdefault(placement.y, []).append(placement)
        above = self._text(space, title, height)
        above.set_placement((0.0, nested.sheet.width + height), align=TextEntityAlignment.LEFT)
        texts: list[DXFGraphic] = [above]
        if below:
            under = self._text(space, below, height / 2.0)
            under.set_placement((0.0, -height), align=TextEntityAlignment.LEFT)
            texts.append(under)
        for y, row in rows.items():
            width = row[0].part.width
            marks = _listed([p.part.mark for p in sorted(row, key=lambda p: p.x)])
            beside = self._text(space, marks, min(height, width / 2.0))
            beside.set_placement((-height, y + width / 2.0), align=TextEntityAlignment.MIDDLE_RIGHT)
            texts.append(beside)
        return texts

    def _text(self, space: Modelspace, words: str, height: float) -> Text:
        return space.add_text(words, height=height, dxfattribs={"layer": self._layer["text"]})

    def _draw(self, space: Modelspace, placement: Placement) -> None:
        part, away = placement.part, self._process.offset
        offset = np.array([placement.x, placement.y])
        rows = np.array(moved_out(part.outline, away))
        rows[:, :2] += offset
        contour = self._line(space, rows, "cut", closed=True)
        contour.set_xdata(APPLICATION, [(1000, part.mark)])
        for x, y, diameter in part.circles.tolist():
            if not diameter > 2.0 * away:
                raise SettingError(
                    "The kerf leaves nothing of a hole",
                    where=part.mark,
                    value=f"{diameter:g} mm",
                    limit=f"more than the kerf, {2.0 * away:g} mm",
                    advice="larger holes, or drill them on a layer of their own",
                )
            centre = (x + placement.x, y + placement.y)
            attributes = {"layer": self._layer["drill"]}
            hole = space.add_circle(centre, diameter / 2.0 - away, dxfattribs=attributes)
            hole.set_xdata(APPLICATION, [(1000, part.mark)])
        for label in part.labels:
            for stroke in self._font.strokes(label):
                self._line(space, stroke + offset, "mark", closed=False)


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
