"""Adhesive labels, 70 x 37 mm, three by eight on A4: one per part."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from reportlab.lib.pagesizes import A4
from reportlab.lib.units import mm
from reportlab.pdfbase.pdfmetrics import stringWidth
from reportlab.pdfgen.canvas import Canvas

from fabrication.errors import OutputError
from fabrication.export.papers.sheet_frame import printable
from fabrication.parts import FlatPart

_WIDTH, _HEIGHT = 70.0, 37.0
_COLUMNS, _ROWS = 3, 8
_INSIDE = 5.0
"""Free edge of a label, mm."""


def write_labels(
    path: Path | str, parts: Sequence[FlatPart], *, name: str, material: str = ""
) -> Path:
    """Write one label per part: mark, length, first and last partner, project and material.

    The same input gives the same bytes.

    Parameters
    ----------
    name : of the project.
    material : left out where empty.

    Raises
    ------
    OutputError
        When the file cannot be written.
    """
    path = Path(path)
    canvas = Canvas(str(path), pagesize=A4, invariant=1)
    canvas.setTitle(f"{name}: labels")
    every = [part for part in parts for _ in range(part.quantity)]
    for k, part in enumerate(every):
        place = k % (_COLUMNS * _ROWS)
        if k and not place:
            canvas.showPage()
        row, column = divmod(place, _COLUMNS)
        _label(canvas, part, column * _WIDTH, 296.5 - (row + 1) * _HEIGHT, name, material)
    try:
        canvas.save()
    except OSError as error:
        raise OutputError(
            "The labels cannot be written", where=str(path), value=error.strerror or ""
        ) from None
    return path


def _label(canvas: Canvas, part: FlatPart, x: float, y: float, name: str, material: str) -> None:
    """Draw the label whose lower left corner is (x, y), mm."""
    partners = [slot.partner for slot in part.slots]
    between = f"{partners[0]} ... {partners[-1]}" if partners else "no partners"
    size = f"{part.length:.1f} x {part.width:g} x {part.thickness:g} mm"
    lines = (
        ("Helvetica-Bold", 20.0, 22.0, part.mark),
        ("Helvetica", 10.0, 16.0, size),
        ("Helvetica", 10.0, 11.0, between),
        ("Helvetica", 8.0, 6.0, ", ".join(word for word in (name, material) if word)),
    )
    for font, largest, up, line in lines:
        text = printable(line)
        room = (_WIDTH - 2.0 * _INSIDE) * mm
        fitting = largest * min(1.0, room / max(stringWidth(text, font, largest), 1.0))
        canvas.setFont(font, fitting)
        canvas.drawString((x + _INSIDE) * mm, (y + up) * mm, text)
