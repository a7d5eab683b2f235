"""The key plan: the net from above and from one side, with the marks of all lamellas."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from fabrication.export.papers.sheet_frame import (
    MEDIUM,
    THICK,
    THIN,
    Area,
    Page,
    Pen,
    page_area,
    text_width,
)
from fabrication.jointed import Jointed
from fabrication.lamella import Lamella
from gridshell.arrays import Floats, Points, unit

_MARGIN, _OUT = 16.0, 4.0
_SCALES = (5, 10, 15, 20, 25, 30, 40, 50, 75, 100, 150, 200, 250, 300, 400, 500, 750, 1000)
_PER_BAY = 8


def key_plan_pages(jointed: Jointed, *, paper: str) -> Iterator[Page]:
    """The plan, and the view along y."""
    area = page_area(paper).inset(_MARGIN)
    curves = [_curve(lamella) for lamella in jointed.design.lamellas]
    views = (("Key plan", (0, 1), "xy"), ("View along y", (0, 2), "xz"))
    for title, axes, names in views:
        flat = [curve[:, axes] for curve in curves]
        low = np.min([c.min(axis=0) for c in flat], axis=0)
        size = np.max([c.max(axis=0) for c in flat], axis=0) - low
        scale = _scale(size, area)

        def draw(
            pen: Pen,
            page: Area,
            flat: list[Floats] = flat,
            low: Floats = low,
            size: Floats = size,
            scale: float = scale,
            names: str = names,
        ) -> None:
            inside = page.inset(_MARGIN)
            corner = np.array([inside.x, inside.y])
            room = np.array([inside.width, inside.height])
            place = corner + (room - size / scale) / 2.0
            marks: list[Floats] = []
            for lamella, curve in zip(jointed.design.lamellas, flat, strict=True):
                _lamella(pen, lamella, place + (curve - low) / scale, marks)
            nodes = np.array([node.position for node in jointed.design.nodes])
            axes = [0, 1] if names == "xy" else [0, 2]
            for x, y in (place + (nodes[:, axes] - low) / scale).tolist():
                pen.circle(x, y, 0.35, width=THIN)
            _axes(pen, page, names)
            _bar(pen, page, scale)

        yield Page(title, f"1:{scale:g}", draw)


def _curve(lamella: Lamella) -> Points:
    count = _PER_BAY * max(len(lamella.stations), 2)
    return np.asarray(lamella.axis.spline(np.linspace(lamella.start, lamella.end, count)))


def _scale(size: Floats, area: Area) -> float:
    least = max(size[0] / area.width, size[1] / area.height)
    return next((float(s) for s in _SCALES if s >= least), float(np.ceil(least / 1e3) * 1e3))


def _lamella(pen: Pen, lamella: Lamella, curve: Floats, taken: list[Floats]) -> None:
    """The axis, family 2 dashed, and the mark beyond either end where there is room for it."""
    dash = () if lamella.family == 1 else (2.5, 1.0)
    pen.line(curve.tolist(), width=MEDIUM, dash=dash)
    for end, before in ((curve[0], curve[1]), (curve[-1], curve[-2])):
        out = unit(end - before) if np.linalg.norm(end - before) > 1e-9 else np.array([1.0, 0.0])
        at = end + _OUT * out
        half = text_width(lamella.mark, 2.2) / 2.0 + 0.6
        if all(abs(at[0] - t[0]) > half + t[2] or abs(at[1] - t[1]) > 2.8 for t in taken):
            taken.append(np.array([at[0], at[1], half]))
            pen.text(at[0], at[1] - 1.1, lamella.mark, height=2.2, align="middle")


def _axes(pen: Pen, area: Area, names: str) -> None:
    """Directions of the two axes in the lower left corner."""
    x, y = area.x + 8.0, area.y + 8.0
    for way, name in ((np.array([1.0, 0.0]), names[0]), (np.array([0.0, 1.0]), names[1])):
        tip = np.array([x, y]) + 10.0 * way
        side = np.array([-way[1], way[0]])
        head = [tip - 2.0 * way + 0.8 * side, tip, tip - 2.0 * way - 0.8 * side]
        pen.line([(x, y), tip.tolist()], width=MEDIUM)
        pen.line([point.tolist() for point in head], width=MEDIUM)
        pen.text(tip[0] + 1.5 * way[0], tip[1] + 1.5 * way[1] - 1.0, name)


def _bar(pen: Pen, area: Area, scale: float) -> None:
    """A scale bar of a round length in the lower right corner."""
    length = 10.0 ** np.floor(np.log10(60.0 * scale))
    width = length / scale
    x, y = area.x + area.width - width - 12.0, area.y + 8.0
    pen.line([(x, y), (x + width, y)], width=THICK)
    for at in (x, x + width / 2.0, x + width):
        pen.line([(at, y), (at, y + 1.5)], width=MEDIUM)
    pen.text(x + width / 2.0, y + 2.5, f"{length / 1e3:g} m", align="middle")
    pen.text(x + width, y - 4.0, "A solid, B dashed", height=2.2, align="right")
