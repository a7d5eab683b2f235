"""Drawings of flat pieces to look at: panels, plates, stars and shapes of connectors, as SVG."""

from __future__ import annotations

from collections.abc import Sequence
from math import degrees

import numpy as np
from markupsafe import escape

from fabrication.flattening import corners
from fabrication.shapes import Shape, with_bulges
from fabrication.sheet_parts import SheetPiece
from fabrication.strip_drawing import svg_path
from fabrication.words import fixed
from gridshell.arrays import Floats

_ROOM, _EDGE = (440.0, 320.0), 34.0
"""Px: what the piece fills at most, and what is left around it."""

_SMALLEST = 7.0
"""Px: letters are not drawn smaller."""

_LINE = 'fill="{fill}" fill-rule="evenodd" stroke="#1c232d" stroke-width="1"'


def piece_svg(piece: SheetPiece) -> str:
    """A piece as it lies on its sheet, to scale, with its marks and its size in mm."""
    scale = _scale(piece.length, piece.width)
    rings = [with_bulges(piece.outline)]
    rings += [np.array([[x - d / 2.0, y, 1.0], [x + d / 2.0, y, 1.0]]) for x, y, d in piece.circles]
    marks = "".join(
        f'<text transform="translate({_EDGE + scale * label.x:.1f} '
        f"{_EDGE + scale * (piece.width - label.y):.1f}) rotate({-degrees(label.angle):.1f})"
        f'" text-anchor="middle" dominant-baseline="middle" '
        f'font-size="{max(_SMALLEST, 1.4 * scale * label.height):.1f}">{escape(label.text)}</text>'
        for label in piece.labels
    )
    return _framed(piece.mark, rings, (piece.length, piece.width), piece.thickness, marks)


def shape_svg(shape: Shape) -> str:
    """A connector's shape from above, to scale, with its size in mm."""
    rings = [np.array(with_bulges(r)) for r in (shape.outline, *shape.openings)]
    reach = corners(rings[0], np.pi / 16.0)
    low, high = reach.min(axis=0), reach.max(axis=0)
    for ring in rings:
        ring[:, :2] -= low
    length, width = (high - low).tolist()
    return _framed(shape.mark, rings, (length, width), shape.high - shape.low, "")


def _scale(length: float, width: float) -> float:
    """Px per mm."""
    return min(_ROOM[0] / max(length, 1e-6), _ROOM[1] / max(width, 1e-6))


def _framed(
    mark: str, rings: Sequence[Floats], size: tuple[float, float], thickness: float, marks: str
) -> str:
    length, width = size
    scale = _scale(length, width)
    path = " ".join(
        svg_path(np.column_stack([scale * ring[:, :2] + [_EDGE, 0.0], ring[:, 2]]), scale * width)
        for ring in rings
    )
    across, up = scale * length + 2.0 * _EDGE, scale * width + 2.0 * _EDGE
    told = f"{fixed(length, 1)} × {fixed(width, 1)} × {fixed(thickness, 1)} mm"
    return (
        f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {across:.0f} {up:.0f}" '
        f'role="img" aria-label="Flat piece {escape(mark)}" '
        f'font-family="system-ui, sans-serif" fill="#1c232d">'
        f'<path transform="translate(0 {_EDGE:g})" d="{path}" {_LINE.format(fill="#e6ebf0")}/>'
        f'{marks}<text x="{across / 2:.1f}" y="{up - 10:.1f}" text-anchor="middle" '
        f'font-size="13">{told}</text></svg>'
    )
