"""Drawings of cutting sheets to look at: parts, holes and marks where the DXF files have them."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from math import degrees

import numpy as np
from markupsafe import Markup, escape

from fabrication.nesting import NestedSheet, Placement
from fabrication.shapes import with_bulges
from fabrication.strip_drawing import svg_path
from fabrication.words import fixed, plural

_MARGIN = 0.004
"""White around a sheet, over its length."""

_THIN = 'vector-effect="non-scaling-stroke"'


@dataclass(frozen=True)
class SheetDrawing:
    """A sheet, its drawing, and what stands below it."""

    file: str
    words: str
    svg: Markup


def sheet_drawings(sheets: Sequence[NestedSheet], files: Sequence[str]) -> list[SheetDrawing]:
    """One drawing for every sheet, to scale; *files* are their names without the ending."""
    return [
        SheetDrawing(f"{file}.dxf", _words(sheet), Markup(sheet_svg(sheet)))
        for sheet, file in zip(sheets, files, strict=True)
    ]


def sheet_svg(nested: NestedSheet) -> str:
    """A sheet with its parts, lengths in mm, as it lies in its DXF file."""
    length, width = nested.sheet.length, nested.sheet.width
    margin = _MARGIN * length
    frame = f"{-margin:.1f} {-margin:.1f} {length + 2 * margin:.1f} {width + 2 * margin:.1f}"
    parts = " ".join(_path(placement, width) for placement in nested.placements)
    marks = "".join(text for p in nested.placements for text in _marks(p, width))
    return (
        f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="{frame}" role="img" '
        f'aria-label="Sheet {nested.number}" font-family="system-ui, sans-serif">'
        f'<rect width="{length:.1f}" height="{width:.1f}" fill="#fff" stroke="#8a94a1" {_THIN}/>'
        f'<path d="{parts}" fill="#e6ebf0" fill-rule="evenodd" stroke="#1c232d" '
        f'stroke-width=".7" {_THIN}/>'
        f'<g fill="#24508c" text-anchor="middle" dominant-baseline="central">{marks}</g></svg>'
    )


def _path(placement: Placement, width: float) -> str:
    """Outline and holes of a part."""
    part, place = placement.part, [placement.x, placement.y, 0.0]
    rings = [with_bulges(part.outline)]
    rings += [np.array([[x - d / 2.0, y, 1.0], [x + d / 2.0, y, 1.0]]) for x, y, d in part.circles]
    return " ".join(svg_path(ring + place, width) for ring in rings)


def _marks(placement: Placement, width: float) -> Iterator[str]:
    for label in placement.part.labels:
        x, y = label.x + placement.x, width - label.y - placement.y
        turned = f" rotate({-degrees(label.angle):.1f})" if label.angle else ""
        yield (
            f'<text transform="translate({x:.1f} {y:.1f}){turned}" '
            f'font-size="{1.3 * label.height:.1f}">{escape(label.text)}</text>'
        )


def _words(nested: NestedSheet) -> str:
    size = f"{nested.sheet.length:g} × {nested.sheet.width:g} mm"
    return f"{size}, {plural(len(nested.placements), 'part')}, {fixed(100 * nested.used, 0)} % used"
