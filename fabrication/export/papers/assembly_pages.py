"""How the shell goes together: the order of strips, and the flat scissor state."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from fabrication.assembling import Assembly
from fabrication.export.papers.key_plan import _SCALES
from fabrication.export.papers.sheet_frame import MEDIUM, Area, Page, Pen, page_area
from fabrication.export.papers.tables import Column, table_pages
from fabrication.flat_state import FlatState

_COLUMNS = (
    Column("step", 0.4, "right"),
    Column("parts", 1.6),
    Column("what", 7.0),
)
_MARGIN, _PER_BAY = 16.0, 8
_LISTED = 6


def assembly_pages(assembly: Assembly, *, paper: str) -> Iterator[Page]:
    """The steps in their order."""
    if not assembly.steps:
        return
    rows = []
    for step in assembly.steps:
        marks = " ".join(step.marks[:_LISTED]) + (" ..." if len(step.marks) > _LISTED else "")
        rows.append((f"{step.number}", marks, step.what))
    yield from table_pages("Assembly", _COLUMNS, rows, paper=paper)


def flat_pages(flat: FlatState | None, *, paper: str) -> Iterator[Page]:
    """The flat scissor state to scale: what is slotted on the ground before pulling up."""
    if flat is None:
        return
    area = page_area(paper).inset(_MARGIN)
    curves = [(strip, np.asarray(strip.points(_PER_BAY))) for strip in flat.strips]
    low = np.min([c.min(axis=0) for _, c in curves], axis=0)
    size = np.max([c.max(axis=0) for _, c in curves], axis=0) - low
    least = max(size[0] / area.width, size[1] / (area.height - 14.0))
    scale = next((float(s) for s in _SCALES if s >= least), float(np.ceil(least)))
    section = flat.section()
    told = (
        f"{size[0] / 1e3:.2f} x {size[1] / 1e3:.2f} m on the ground; node angles "
        f"{section['angle_deg']['min']:.1f} to {section['angle_deg']['max']:.1f} degrees; slots "
        f"slip by {section['slip_mm']:.2f} mm at most; strips bend to {flat.radius / 1e3:.2f} m"
    )

    def draw(pen: Pen, page: Area) -> None:
        inside = page.inset(_MARGIN)
        place = np.array([inside.x, inside.y + 7.0])
        for strip, curve in curves:
            points = place + (curve - low) / scale
            dash = () if strip.mark.startswith("A") else (2.5, 1.0)
            pen.line(points.tolist(), width=MEDIUM, dash=dash)
            way = points[-1] - points[-2]
            at = points[-1] + 4.0 * way / max(float(np.linalg.norm(way)), 1e-9)
            pen.text(at[0], at[1] - 1.1, strip.mark, height=2.2, align="middle")
        pen.text(page.x + 8.0, page.y + 5.0, told, height=2.5, within=page.width - 16.0)

    yield Page("Flat state", f"1:{scale:g}", draw)
