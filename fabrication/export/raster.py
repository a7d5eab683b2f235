"""Scenes side by side as one small PNG: painted three times too large, then made smooth."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from math import ceil
from pathlib import Path

import numpy as np

from fabrication.errors import OutputError
from gridshell.arrays import Floats
from gridshell.painter import Dots, Layer, Lines, View, bounds, in_order

_FINER = 3
"""Pixels painted for each that is kept, either way."""

_MARGIN, _TITLE = 12, 26
_PAPER, _INK = (255, 255, 255), (28, 36, 46)
_COLOURS = 128


@dataclass(frozen=True, eq=False)
class Scene:
    """One picture among others.

    Parameters
    ----------
    title : one line.
    layers : what is drawn.
    view : where the eye stands.
    pen : what the widths of lines and the radii of dots are multiplied by.
    """

    title: str
    layers: tuple[Layer, ...]
    view: View
    pen: float = 1.0


def write_png(
    path: Path, scenes: Sequence[Scene], *, columns: int = 3, cell: tuple[int, int] = (300, 240)
) -> None:
    """Write *scenes* row by row into one PNG, each fitted into its *cell* of pixels.

    Raises
    ------
    OutputError
        When the file cannot be written.
    """
    from PIL import Image, ImageDraw

    columns = min(columns, len(scenes))
    rows = ceil(len(scenes) / columns)
    size = (columns * cell[0] * _FINER, rows * cell[1] * _FINER)
    image = Image.new("RGB", size, _PAPER)
    draw = ImageDraw.Draw(image)
    for number, scene in enumerate(scenes):
        corner = np.array([number % columns * cell[0], number // columns * cell[1]]) * _FINER
        _paint(draw, scene, corner, np.array(cell) * _FINER)
    small = image.resize((columns * cell[0], rows * cell[1]), Image.Resampling.LANCZOS)
    try:
        small.quantize(_COLOURS, dither=Image.Dither.NONE).save(path, optimize=True)
    except OSError as error:
        raise OutputError(
            "The picture cannot be written", where=str(path), value=error.strerror or ""
        ) from None


def _paint(draw: object, scene: Scene, corner: Floats, cell: Floats) -> None:
    """Draw *scene* into the cell whose upper left pixel is *corner*."""
    from PIL import ImageFont

    low, high = bounds(scene.layers, scene.view)
    room = cell - np.array([2 * _MARGIN, 2 * _MARGIN + _TITLE]) * _FINER
    scale = float((room / np.maximum(high - low, 1e-9)).min())
    middle = corner + cell / 2.0 + [0.0, _TITLE * _FINER / 2.0]
    way = np.array([scale, -scale])
    for mark in in_order(scene.layers, scene.view):
        places = (mark.places - (low + high) / 2.0) * way + middle
        colour = tuple(round(255.0 * min(max(c, 0.0), 1.0)) for c in mark.colour.tolist())
        flat = list(map(tuple, places.tolist()))
        if mark.kind is Lines:
            width = max(1, round(mark.size * scene.pen * _FINER))
            draw.line(flat, fill=colour, width=width, joint="curve")  # type: ignore[attr-defined]
        elif mark.kind is Dots:
            x, y = flat[0]
            r = mark.size * scene.pen * _FINER
            draw.ellipse((x - r, y - r, x + r, y + r), fill=colour)  # type: ignore[attr-defined]
        else:
            draw.polygon(flat, fill=colour)  # type: ignore[attr-defined]
    font = ImageFont.load_default(size=13 * _FINER)
    place = (float(corner[0]) + _MARGIN * _FINER, float(corner[1]) + 8 * _FINER)
    draw.text(place, scene.title, fill=_INK, font=font)  # type: ignore[attr-defined]
