"""A drawing against the parts it should hold: how many, which, how large."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator, Sequence

import numpy as np
import shapely

from fabrication.export.lint_shapes import DrawnParts
from fabrication.finding import Finding, Severity
from fabrication.flattening import flattened
from fabrication.kerf import moved_out
from fabrication.nesting import SheetPart
from fabrication.shapes import with_bulges
from gridshell.arrays import Floats

_SHAPE = 0.02
"""How far lengths of a drawn part may differ, mm."""

_SCALES = {25.4: "mm were taken for inches", 1.0 / 25.4: "it was drawn in inches"}


def part_findings(
    drawn: DrawnParts, parts: Sequence[SheetPart], offset: float
) -> Iterator[Finding]:
    """Parts that are missing, too many, of another size, or drawn at another scale.

    Parameters
    ----------
    drawn : parts with marks are found by them; in a drawing without any, by their size.
    offset : how far outside its part a line is drawn, mm.

    Raises
    ------
    SettingError
        When the kerf leaves nothing of a part's cuts.
    """
    outer = [k for k in drawn.outer.tolist() if _is_part(drawn, k)]
    found = np.array([_sizes(drawn.shapes[k]) for k in outer]).reshape(-1, 2)
    marks = [drawn.contours[k].mark for k in outer]
    wanted = np.array([_sizes(_shape(part, offset)) for part in parts]).reshape(-1, 2)
    if any(marks):
        pairs = _by_mark(marks, parts)
        yield from _counted_by_mark(marks, parts)
    else:
        pairs = _by_size(found, wanted)
        if len(outer) != len(parts):
            yield _count("file", len(outer), len(parts))
    if not pairs:
        return
    i, j = np.array(pairs).T
    scale = np.median(found[i] / wanted[j])
    if abs(scale - 1.0) > 1e-3 and np.allclose(found[i] / wanted[j], scale, rtol=2e-3):
        yield _scaled(float(scale))
        return
    for k, m in pairs:
        yield from _compared(found[k], wanted[m], drawn.contours[outer[k]].name, parts[m].mark)


def _is_part(drawn: DrawnParts, k: int) -> bool:
    return bool(drawn.contours[k].diameter == 0.0)


def _shape(part: SheetPart, offset: float) -> shapely.Polygon:
    rows = moved_out(part.outline, offset)
    return shapely.Polygon(flattened(with_bulges(rows), closed=True))


def _sizes(shape: shapely.Geometry) -> Floats:
    """(2,) lengths that stay the same however a part is turned: around, and of its longest line."""
    hull = shapely.get_coordinates(shapely.convex_hull(shape))
    away = hull[:, None] - hull[None]
    return np.array([shapely.length(shape), np.sqrt((away**2).sum(axis=-1).max())])


def _by_mark(marks: Sequence[str], parts: Sequence[SheetPart]) -> list[tuple[int, int]]:
    at = {part.mark: m for m, part in enumerate(parts)}
    return [(k, at[mark]) for k, mark in enumerate(marks) if mark in at]


def _by_size(found: Floats, wanted: Floats) -> list[tuple[int, int]]:
    """The k-th largest with the k-th largest, where there are as many."""
    if len(found) != len(wanted):
        return []
    first, second = (np.lexsort((s[:, 1], s[:, 0])) for s in (found, wanted))
    return list(zip(first.tolist(), second.tolist(), strict=True))


def _counted_by_mark(marks: Sequence[str], parts: Sequence[SheetPart]) -> Iterator[Finding]:
    have, want = Counter(marks), Counter(part.mark for part in parts)
    for mark in sorted((want - have).keys()):
        missing = want[mark] - have[mark]
        message = f"{mark or 'A part'} is missing from the drawing."
        count = float(have[mark])
        yield Finding("part-missing", Severity.ERROR, mark, count, count + missing, "", message)
    for mark in sorted((have - want).keys()):
        if want[mark] == 0:
            name = mark or "A part without a mark"
            message = f"{name} is drawn but belongs to nothing here. Delete it."
            yield Finding("part-unknown", Severity.ERROR, mark, 1.0, 0.0, "", message)


def _count(where: str, found: int, wanted: int) -> Finding:
    message = f"{found} parts are drawn, {wanted} should be."
    return Finding("part-count", Severity.ERROR, where, float(found), float(wanted), "", message)


def _scaled(scale: float) -> Finding:
    near = min(_SCALES, key=lambda known: abs(scale / known - 1.0))
    why = f": {_SCALES[near]}" if abs(scale / near - 1.0) < 1e-3 else ""
    message = f"All parts are {scale:.4g} times as large as they should be{why}. Scale it."
    return Finding("scale", Severity.ERROR, "file", scale, 1.0, "", message)


def _compared(found: Floats, wanted: Floats, name: str, mark: str) -> Iterator[Finding]:
    off = float(np.abs(found - wanted).max())
    if off > _SHAPE + _arcs(wanted):
        message = (
            f"{name} is not {mark} as it was designed: {found[0]:.2f} mm around instead of "
            f"{wanted[0]:.2f} mm. Take the outline from the design again."
        )
        yield Finding("part-differs", Severity.ERROR, mark, off, _SHAPE, "mm", message)


def _arcs(wanted: Floats) -> float:
    """What lines instead of arcs can change of the way around, mm."""
    return 1e-5 * float(wanted[0])
