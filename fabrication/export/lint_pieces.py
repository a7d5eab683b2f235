"""Straight pieces of all contours at once: which lie on each other, cross, or come too near.

Contours run with the material on their left, so that two pieces that run against each other have
either material or a cut between them.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np
import shapely

from fabrication.export.lint_contours import JOINED, Contour
from fabrication.finding import Finding, Severity
from gridshell.arrays import Floats, Indices, Mask

_SAME = 0.02
"""Overlaps shorter than this are rounding, mm."""

_AGAINST = -0.7
"""Cosine between pieces that face each other."""


@dataclass(frozen=True, eq=False)
class Pieces:
    """All straight pieces of contours, n.

    Parameters
    ----------
    a, b : (n, 2) their ends, mm.
    owner : (n,) number of the contour.
    order : (n,) number in its contour.
    last : (n,) number of the last piece of its contour, -1 where that is open.
    """

    a: Floats
    b: Floats
    owner: Indices
    order: Indices
    last: Indices

    @cached_property
    def tree(self) -> shapely.STRtree:
        """A tree of the pieces."""
        return shapely.STRtree(self.lines)

    @cached_property
    def lines(self) -> np.ndarray:
        """(n,) shapely lines."""
        return np.asarray(shapely.linestrings(np.stack([self.a, self.b], axis=1)))


def pieces_of(contours: Sequence[Contour]) -> Pieces:
    """All pieces in the contours' order."""
    counts = np.array([len(c.points) - 1 for c in contours], dtype=np.int64)
    closed = np.array([c.closed for c in contours], dtype=bool)
    rows = [np.concatenate([c.points[:-1], c.points[1:]], axis=1) for c in contours]
    ends = np.concatenate(rows) if rows else np.zeros((0, 4))
    owner = np.repeat(np.arange(len(counts)), counts)
    order = np.arange(len(owner)) - np.repeat(np.cumsum(counts) - counts, counts)
    last = np.where(closed, counts - 1, -1)[owner] if len(owner) else owner
    return Pieces(ends[:, :2], ends[:, 2:], owner, order, last)


def touching(pieces: Pieces) -> tuple[Indices, Indices]:
    """Pairs i < j of pieces whose boxes meet."""
    box = np.sort(np.stack([pieces.a, pieces.b]), axis=0)
    boxes = shapely.box(*(box[0] - JOINED).T, *(box[1] + JOINED).T)
    i, j = shapely.STRtree(boxes).query(boxes)
    return i[i < j], j[i < j]


@dataclass(frozen=True, eq=False)
class _Pairs:
    """Pairs of pieces and how they lie to each other."""

    i: Indices
    j: Indices
    overlap: Floats
    longer: Floats
    shorter: Floats
    collinear: Mask
    crossing: Mask


def _pairs(pieces: Pieces) -> _Pairs:
    i, j = touching(pieces)
    a, b, c, d = pieces.a[i], pieces.b[i], pieces.a[j], pieces.b[j]
    u, v = b - a, d - c
    lu, lv = np.hypot(*u.T), np.hypot(*v.T)
    away_c, away_d = _cross(u, c - a) / lu, _cross(u, d - a) / lu
    away_a, away_b = _cross(v, a - c) / lv, _cross(v, b - c) / lv
    collinear = np.maximum(np.abs(away_c), np.abs(away_d)) <= JOINED
    collinear &= np.maximum(np.abs(away_a), np.abs(away_b)) <= JOINED
    along = np.stack([_dot(u, c - a), _dot(u, d - a)]) / lu
    overlap = np.minimum(along.max(axis=0), lu) - np.maximum(along.min(axis=0), 0.0)
    through = (away_c * away_d < 0.0) & (away_a * away_b < 0.0)
    touch = _lies_on(away_c, along[0], lu) | _lies_on(away_d, along[1], lu)
    touch |= _lies_on(away_a, _dot(v, a - c) / lv, lv) | _lies_on(away_b, _dot(v, b - c) / lv, lv)
    step = pieces.order[j] - pieces.order[i]
    neighbours = (pieces.owner[i] == pieces.owner[j]) & ((step == 1) | (step == pieces.last[i]))
    crossing = (through | touch) & ~collinear & ~neighbours
    return _Pairs(i, j, overlap, np.maximum(lu, lv), np.minimum(lu, lv), collinear, crossing)


def _lies_on(away: Floats, along: Floats, length: Floats) -> Mask:
    return np.asarray(
        (np.abs(away) <= JOINED) & (along >= -JOINED) & (along <= length + JOINED), dtype=bool
    )


def _cross(u: Floats, v: Floats) -> Floats:
    return np.asarray(u[:, 0] * v[:, 1] - u[:, 1] * v[:, 0])


def _dot(u: Floats, v: Floats) -> Floats:
    return np.asarray(u[:, 0] * v[:, 0] + u[:, 1] * v[:, 1])


def crossing_findings(contours: Sequence[Contour], pieces: Pieces) -> Iterator[Finding]:
    """Lines drawn twice, in part or whole, and contours that cross or touch."""
    pairs = _pairs(pieces)
    over = pairs.collinear & (pairs.overlap > _SAME)
    whole = over & (pairs.overlap > 0.98 * pairs.longer)
    owners = np.stack([pieces.owner[pairs.i], pieces.owner[pairs.j]], axis=1)
    doubled = {tuple(pair) for pair in owners[over].tolist()}
    for mask, code in ((whole, "duplicate-line"), (over & ~whole, "overlapping-lines")):
        for (first, second), length in _sums(owners[mask], pairs.overlap[mask]).items():
            yield _doubled(code, contours[first], contours[second], length, first == second)
    for first, second in _sums(owners[pairs.crossing], pairs.overlap[pairs.crossing]):
        if (first, second) in doubled:
            continue
        here = pairs.crossing & (owners == (first, second)).all(axis=1)
        at = pieces.a[pairs.j[here][0]]
        yield _crossed(contours[first], contours[second], at, int(here.sum()), first == second)


def _sums(owners: Indices, values: Floats) -> dict[tuple[int, int], float]:
    sums: dict[tuple[int, int], float] = {}
    for (first, second), value in zip(owners.tolist(), values.tolist(), strict=True):
        sums[first, second] = sums.get((first, second), 0.0) + value
    return sums


def _doubled(code: str, a: Contour, b: Contour, length: float, same: bool) -> Finding:
    how = "twice" if code == "duplicate-line" else "partly over another line"
    where = a.name if same else f"{a.name} and {b.name}"
    return Finding(
        code,
        Severity.ERROR,
        a.name,
        length,
        0.0,
        "mm",
        f"{length:.2f} mm of {where} are drawn {how}: they would be cut twice. Delete one.",
    )


def _crossed(a: Contour, b: Contour, at: Floats, count: int, same: bool) -> Finding:
    x, y = at.tolist()
    place = f"near ({x:.1f}, {y:.1f})"
    if same:
        message = f"{a.name} crosses or touches itself {place}. Draw it without loops."
        return Finding("self-crossing", Severity.ERROR, a.name, float(count), 0.0, "", message)
    message = f"{a.name} and {b.name} cross or touch {place}. Move the parts apart."
    return Finding("crossing-cuts", Severity.ERROR, a.name, float(count), 0.0, "", message)


@dataclass(frozen=True, eq=False)
class Facing:
    """Pairs of pieces that run against each other, m.

    Parameters
    ----------
    first, second : (m,) numbers of their contours.
    distance : (m,) between them, mm.
    length : (m,) along which they lie beside each other, mm.
    material : (m,) whether there is material between them, or a cut.
    at : (m, 2) a point of the first piece, mm.
    """

    first: Indices
    second: Indices
    distance: Floats
    length: Floats
    material: Mask
    at: Floats


def facing(pieces: Pieces, reach: float) -> Facing:
    """All pairs of pieces nearer than *reach* that run against each other side by side."""
    i, j = pieces.tree.query(pieces.lines, predicate="dwithin", distance=reach)
    i, j = i[i != j], j[i != j]
    u, v = pieces.b[i] - pieces.a[i], pieces.b[j] - pieces.a[j]
    lu, lv = np.hypot(*u.T), np.hypot(*v.T)
    against = _dot(u, v) < _AGAINST * lu * lv
    i, j, u, lu = i[against], j[against], u[against], lu[against]
    u = u / lu[:, None]
    c, d = pieces.a[j] - pieces.a[i], pieces.b[j] - pieces.a[i]
    along_c, along_d = _dot(u, c), _dot(u, d)
    low = np.maximum(np.minimum(along_c, along_d), 0.0)
    high = np.minimum(np.maximum(along_c, along_d), lu)
    span = np.where(along_d == along_c, 1.0, along_d - along_c)
    away_c, away_d = _cross(u, c), _cross(u, d)
    ends = [away_c + (away_d - away_c) * (s - along_c) / span for s in (low, high)]
    away = np.where(np.abs(ends[0]) < np.abs(ends[1]), ends[0], ends[1])
    beside = (high > low) & (np.abs(away) > JOINED) & (np.abs(away) < reach)
    i, j, away = i[beside], j[beside], away[beside]
    length = (high - low)[beside]
    return Facing(pieces.owner[i], pieces.owner[j], np.abs(away), length, away > 0.0, pieces.a[i])
