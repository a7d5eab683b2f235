"""The frame every drawing sheet has: border, title block, page numbers; millimetres throughout.

A drawing is a list of pages, each a function that draws into the free area it is given. All pages
are counted before the first one is drawn, so that every title block says which of how many it is.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass
from datetime import date
from pathlib import Path

from reportlab.lib.units import mm
from reportlab.pdfbase.pdfmetrics import stringWidth
from reportlab.pdfgen.canvas import Canvas

from fabrication.errors import OutputError
from fabrication.export.stamp import now
from gridshell import SettingError

SIZES = {"A4": (297.0, 210.0), "A3": (420.0, 297.0), "A2": (594.0, 420.0), "A1": (841.0, 594.0)}
"""Landscape, mm."""

BORDER, TITLE_HEIGHT = 10.0, 22.0
"""Between paper edge and frame; height of the title block along the lower edge, mm."""

THIN, MEDIUM, THICK = 0.13, 0.25, 0.5
"""Line widths (ISO 128), mm."""

TEXT = 2.5
"""Height of ordinary text, mm."""

_FONT, _BOLD = "Helvetica", "Helvetica-Bold"
_CAP = 0.716
"""Height of capitals over the font's size."""

_RAISED = "⁻⁰⁴⁵⁶⁷⁸⁹"
"""Superscripts that the fonts have not; they have ¹²³."""

_POWER = re.compile(f"([¹²³]*[{_RAISED}][{_RAISED}¹²³]*)")
_LOWERED = str.maketrans(_RAISED + "¹²³", "-0456789123")
_SMALL, _RISE = 0.65, 0.36
"""Size of a power over that of its text, and how far above the base line it stands."""

_NEAREST = {0x2212: "-", 0x202F: "\xa0", **dict.fromkeys(range(0x20), " ")}


@dataclass(frozen=True)
class Titles:
    """What every title block says.

    Parameters
    ----------
    project, material, revision : text; empty ones are left out.
    drawn : the date.
    """

    project: str
    material: str = ""
    revision: str = ""
    drawn: date = date(2000, 1, 1)


def today() -> date:
    """The date of ``SOURCE_DATE_EPOCH`` where that is set, else today."""
    return now().date()


@dataclass(frozen=True)
class Area:
    """A rectangle of a page, mm from its lower left corner."""

    x: float
    y: float
    width: float
    height: float

    def inset(self, by: float) -> Area:
        """The same smaller on all sides."""
        return Area(self.x + by, self.y + by, self.width - 2.0 * by, self.height - 2.0 * by)


class Pen:
    """Draws on a canvas in mm."""

    def __init__(self, canvas: Canvas) -> None:
        self.canvas = canvas

    def line(
        self,
        points: Iterable[Sequence[float]],
        *,
        width: float = MEDIUM,
        closed: bool = False,
        dash: Sequence[float] = (),
        grey: float = 0.0,
        fill: float | None = None,
    ) -> None:
        """A polyline through (x, y) ...; *grey* from 0, black, to 1; *fill* likewise."""
        path = self.canvas.beginPath()
        first, *rest = points
        path.moveTo(first[0] * mm, first[1] * mm)
        for point in rest:
            path.lineTo(point[0] * mm, point[1] * mm)
        if closed:
            path.close()
        self.canvas.setLineWidth(width * mm)
        self.canvas.setDash([d * mm for d in dash])
        self.canvas.setStrokeGray(grey)
        if fill is not None:
            self.canvas.setFillGray(fill)
        self.canvas.drawPath(path, stroke=1, fill=0 if fill is None else 1)

    def circle(self, x: float, y: float, radius: float, *, width: float = MEDIUM) -> None:
        """A circle's outline."""
        self.canvas.setLineWidth(width * mm)
        self.canvas.setDash([])
        self.canvas.setStrokeGray(0.0)
        self.canvas.circle(x * mm, y * mm, radius * mm, stroke=1, fill=0)

    def text(
        self,
        x: float,
        y: float,
        text: str,
        *,
        height: float = TEXT,
        bold: bool = False,
        align: str = "left",
        angle: float = 0.0,
        within: float | None = None,
        grey: float = 0.0,
    ) -> None:
        """One line of text on the base line at (x, y); *angle* in degrees.

        *height* is that of capitals, mm. Text longer than *within* mm is made smaller.
        """
        font, size = _BOLD if bold else _FONT, height / _CAP * mm
        width = text_width(text, height, bold=bold) * mm
        if within is not None:
            fitting = min(1.0, within * mm / max(width, 1e-9))
            size, width = fitting * size, fitting * width
        self.canvas.saveState()
        self.canvas.translate(x * mm, y * mm)
        self.canvas.rotate(angle)
        self.canvas.setFillGray(grey)
        at = -{"left": 0.0, "middle": 0.5, "right": 1.0}[align] * width
        for run, raised in _runs(text):
            own = _SMALL * size if raised else size
            self.canvas.setFont(font, own)
            self.canvas.drawString(at, _RISE * size if raised else 0.0, run)
            at += stringWidth(run, font, own)
        self.canvas.restoreState()


def printable(text: str) -> str:
    """*text* in the letters of the built-in fonts; others become question marks.

    Powers of ten are written with a ^, minus signs as hyphens: for a file's title; a ``Pen`` raises
    powers.
    """
    return "".join(f"^{run}" if raised else run for run, raised in _runs(text))


def _runs(text: str) -> Iterator[tuple[str, bool]]:
    """Pieces of *text* in the letters of the built-in fonts, and whether they are raised."""
    for k, piece in enumerate(_POWER.split(text)):
        nearest = piece.translate(_LOWERED if k % 2 else _NEAREST)
        if nearest:
            yield nearest.encode("cp1252", errors="replace").decode("cp1252"), bool(k % 2)


def text_width(text: str, height: float = TEXT, *, bold: bool = False) -> float:
    """Length of a line of text, mm."""
    font, size = _BOLD if bold else _FONT, height / _CAP
    runs = _runs(text)
    return float(sum(stringWidth(run, font, _SMALL * size if up else size) for run, up in runs))


@dataclass(frozen=True)
class Page:
    """One sheet: its title, its scale as text, and what draws into its area."""

    title: str
    scale: str
    draw: Callable[[Pen, Area], None]


def page_area(paper: str) -> Area:
    """The free area within frame and title block of a sheet.

    Raises
    ------
    SettingError
        For a size that is not known.
    """
    if paper not in SIZES:
        raise SettingError(
            "No such size of paper", where="paper", value=paper, limit=", ".join(SIZES)
        )
    width, height = SIZES[paper]
    return Area(
        BORDER,
        BORDER + TITLE_HEIGHT,
        width - 2.0 * BORDER,
        height - 2.0 * BORDER - TITLE_HEIGHT,
    )


def write_pages(
    path: Path | str, pages: Sequence[Page], titles: Titles, *, paper: str = "A3"
) -> Path:
    """Write *pages* as one PDF; the same input gives the same bytes.

    Raises
    ------
    SettingError
        For a size of paper that is not known.
    OutputError
        When the file cannot be written.
    """
    path, area = Path(path), page_area(paper)
    width, height = SIZES[paper]
    canvas = Canvas(str(path), pagesize=(width * mm, height * mm), invariant=1, pageCompression=1)
    canvas.setTitle(f"{printable(titles.project)}: drawings")
    pen = Pen(canvas)
    for number, page in enumerate(pages, start=1):
        _frame(pen, area, titles, page, f"{number} / {len(pages)}")
        page.draw(pen, area)
        canvas.showPage()
    try:
        canvas.save()
    except OSError as error:
        raise OutputError(
            "The drawings cannot be written", where=str(path), value=error.strerror or ""
        ) from None
    return path


_NOTE = "All dimensions in mm. Not checked: loads, buckling, connections."


def _frame(pen: Pen, area: Area, titles: Titles, page: Page, number: str) -> None:
    """Frame and title block."""
    x, low, right = area.x, BORDER, area.x + area.width
    top = area.y + area.height
    pen.line([(x, low), (right, low), (right, top), (x, top)], width=THICK, closed=True)
    pen.line([(x, area.y), (right, area.y)], width=THICK)
    cells = (
        ("Project", titles.project, 0.26),
        ("Drawing", page.title, 0.26),
        ("Scale", page.scale, 0.12),
        ("Material", titles.material, 0.14),
        ("Date", titles.drawn.isoformat(), 0.08),
        ("Revision", titles.revision or "-", 0.06),
        ("Sheet", number, 0.08),
    )
    middle = low + 7.0
    for label, text, share in cells:
        width = share * area.width
        pen.text(x + 1.5, area.y - 4.0, label, height=1.8, grey=0.35)
        pen.text(
            x + 1.5, middle + 3.0, text, height=3.2, bold=label == "Drawing", within=width - 3.0
        )
        x += width
        if x < right - 1.0:
            pen.line([(x, middle), (x, area.y)], width=THIN)
    pen.line([(area.x, middle), (right, middle)], width=THIN)
    pen.text(area.x + 1.5, low + 2.4, _NOTE, height=2.2)
