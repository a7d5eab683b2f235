"""Parts of a drawing: which contour lies in which, the raw sheet, marks and where they stand."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np
import shapely

from fabrication.export.dxf_content import Track
from fabrication.export.lint_contours import Contour, polygon
from fabrication.export.lint_pieces import Pieces
from fabrication.finding import Finding, Severity
from gridshell.arrays import Indices, Mask

_TOUCH = 1e-3
"""How far a part may lie over the edge of its sheet: rounding, mm."""

_ALIKE = 0.02
"""Parts of one mark whose ways around agree so well are equal ones, mm."""

_ROUND = 0.995
"""4 pi area / perimeter squared above which a contour is a circle."""


@dataclass(frozen=True, eq=False)
class DrawnParts:
    """Contours that enclose something, and how they lie in each other.

    Parameters
    ----------
    contours, shapes : (n,) of either.
    depth : (n,) in how many others each lies; even: a part, odd: an opening.
    part : (n,) the part each belongs to: itself, or the innermost that holds it.
    """

    contours: tuple[Contour, ...]
    shapes: np.ndarray
    depth: Indices
    part: Indices

    @property
    def outer(self) -> Indices:
        """Numbers of the parts."""
        return np.flatnonzero(self.depth % 2 == 0)

    @cached_property
    def diameters(self) -> np.ndarray:
        """(n,) of contours that are round, 0 for others, mm."""
        area, around = shapely.area(self.shapes), shapely.length(self.shapes)
        rounded = 4.0 * np.pi * area > _ROUND * around**2
        known = np.array([contour.diameter for contour in self.contours])
        return np.where(known > 0.0, known, np.where(rounded, 2.0 * np.sqrt(area / np.pi), 0.0))


def drawn_parts(contours: Sequence[Contour]) -> DrawnParts:
    """Sort contours into parts and their openings; material lies left of every contour then."""
    both = [(contour, polygon(contour)) for contour in contours]
    kept = [(contour, shape) for contour, shape in both if shape is not None]
    shapes = np.array([shape for _, shape in kept], dtype=object)
    count = len(shapes)
    depth, part = np.zeros(count, dtype=np.int64), np.arange(count)
    if count:
        inner, outer = shapely.STRtree(shapes).query(shapes, predicate="within")
        area = shapely.area(shapes)
        inner, outer = inner[area[inner] < area[outer]], outer[area[inner] < area[outer]]
        depth = np.bincount(inner, minlength=count)
        for i, o in zip(inner.tolist(), outer.tolist(), strict=True):
            if depth[i] % 2 and depth[o] == depth[i] - 1:
                part[i] = o
    turned = tuple(
        _turned(contour, inside=bool(level % 2))
        for (contour, _), level in zip(kept, depth, strict=True)
    )
    return DrawnParts(turned, shapes, depth, part)


def _turned(contour: Contour, *, inside: bool) -> Contour:
    """A part counter-clockwise, an opening clockwise."""
    x, y = (contour.points - contour.points[0]).T
    left = float(np.dot(x[:-1], y[1:]) - np.dot(y[:-1], x[1:])) > 0.0
    points = contour.points if left != inside else contour.points[::-1]
    return Contour(contour.name, points, contour.closed, contour.mark, contour.diameter)


def place_findings(
    parts: DrawnParts, sheets: Sequence[Track], drilled: set[str]
) -> Iterator[Finding]:
    """Parts beyond the raw sheet, and holes that lie in no part.

    Parameters
    ----------
    drilled : names of contours on a layer of holes.
    """
    room = [shapely.Polygon(track.points) for track in sheets if len(track.points) > 3]
    if room and len(parts.shapes):
        sheet = shapely.union_all([s if s.is_valid else s.convex_hull for s in room])
        held = shapely.covers(sheet.buffer(_TOUCH), parts.shapes)
        for k in np.flatnonzero(~held & (parts.depth == 0) & (parts.diameters == 0.0)).tolist():
            corners = shapely.points(parts.contours[k].points)
            over = float(shapely.distance(corners, sheet).max())
            name = parts.contours[k].name
            message = f"{name} lies up to {over:.1f} mm outside the sheet. Move it in."
            yield Finding("outside-sheet", Severity.ERROR, name, over, 0.0, "mm", message)
    for k in parts.outer.tolist():
        contour = parts.contours[k]
        alone = parts.diameters[k] > 0.0 and len(parts.outer) > 1
        if alone and (contour.mark or contour.name.split(" (")[0] in drilled):
            message = f"The hole {contour.name} lies in no part. Move or delete it."
            yield Finding("stray-hole", Severity.ERROR, contour.name, 0.0, 0.0, "mm", message)
        elif alone and _is_small(parts, k):
            message = f"The circle {contour.name} lies in no part: a part, or a hole gone astray?"
            yield Finding("stray-hole", Severity.WARNING, contour.name, 0.0, 0.0, "mm", message)


def _is_small(parts: DrawnParts, k: int) -> bool:
    """Whether a contour is much smaller than the parts around it."""
    others = shapely.area(parts.shapes[parts.outer])
    return bool(shapely.area(parts.shapes[k]) < 0.1 * np.median(others))


def mark_findings(
    parts: DrawnParts,
    pieces: Pieces,
    marks: Sequence[Track],
    doubles: Sequence[tuple[Track, Track]],
) -> Iterator[Finding]:
    """Strokes to engrave that cross a cut, lie in no part, or are drawn twice; parts without."""
    for _, double in doubles:
        message = f"{double.name} is engraved twice. Delete one."
        yield Finding("duplicate-mark", Severity.WARNING, double.name, 2.0, 1.0, "", message)
    yield from _same_mark(parts)
    if not len(parts.shapes):
        return
    if not marks:
        message = "No part carries a mark to engrave: nobody can tell them apart."
        yield Finding("missing-mark", Severity.WARNING, "file", 0.0, 1.0, "", message)
        return
    strokes = np.array([_line(track) for track in marks], dtype=object)
    on_cut = _hits(pieces.tree, strokes, "intersects")
    outer = parts.outer
    inside, holder = shapely.STRtree(parts.shapes[outer]).query(strokes, predicate="intersects")
    in_part = np.isin(np.arange(len(strokes)), inside)
    for number, track in enumerate(marks):
        if on_cut[number]:
            message = f"The mark {track.name} crosses a cut. Move it or make it smaller."
            yield Finding("mark-on-cut", Severity.WARNING, track.name, 1.0, 0.0, "", message)
        elif not in_part[number]:
            message = f"The mark {track.name} lies in no part. Move or delete it."
            yield Finding("mark-outside", Severity.WARNING, track.name, 1.0, 0.0, "", message)
    marked = set(outer[holder].tolist())
    for k in outer.tolist():
        if k not in marked and not parts.diameters[k]:
            message = f"{parts.contours[k].name} carries no mark to engrave."
            name = parts.contours[k].name
            yield Finding("missing-mark", Severity.WARNING, name, 0.0, 1.0, "", message)


def _line(track: Track) -> shapely.Geometry:
    if len(track.points) < 2:
        return shapely.Point(track.points[0])
    return shapely.LineString(track.points)


def _hits(tree: shapely.STRtree, lines: np.ndarray, predicate: str) -> Mask:
    found, _ = tree.query(lines, predicate=predicate)
    return np.asarray(np.isin(np.arange(len(lines)), found), dtype=bool)


def _same_mark(parts: DrawnParts) -> Iterator[Finding]:
    """Parts that say they are the same one and are not equal."""
    by: dict[str, list[int]] = defaultdict(list)
    for k in parts.outer.tolist():
        if parts.contours[k].mark and not parts.contours[k].diameter:
            by[parts.contours[k].mark].append(k)
    for mark, several in by.items():
        around = shapely.length(parts.shapes[several])
        if len(several) > 1 and float(np.ptp(around)) > _ALIKE:
            message = f"{len(several)} parts are called {mark}. Delete all but one, or rename them."
            count = float(len(several))
            yield Finding("duplicate-part", Severity.ERROR, mark, count, 1.0, "", message)
