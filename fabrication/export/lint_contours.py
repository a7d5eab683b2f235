"""From single lines of a drawing to contours: ends that meet are joined, doubles are told."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np
import shapely
from scipy.spatial import KDTree

from fabrication.export.dxf_content import Track
from fabrication.finding import Finding, Severity
from gridshell.arrays import Floats, Indices

JOINED = 0.002
"""Ends nearer than this are one point, mm: the digits that programs write."""

GAP = 0.5
"""Ends nearer than this were meant to meet, mm."""

TINY = 0.05
"""Lines shorter than this are left-overs, mm; machines stop at them."""


@dataclass(frozen=True, eq=False)
class Contour:
    """Lines that follow each other.

    Parameters
    ----------
    name : of its first line, with its mark where it has one.
    points : (k, 2), the first repeated at the end where it is closed, mm.
    closed : whether it is.
    mark : of the part; empty where the file does not say.
    diameter : of a circle, mm; 0 for all others.
    """

    name: str
    points: Floats
    closed: bool
    mark: str = ""
    diameter: float = 0.0


def short_findings(track: Track) -> Iterator[Finding]:
    """Pieces without length and tiny pieces of a line; arcs are not looked at."""
    length = np.hypot(*np.diff(track.points, axis=0).T)
    if not len(length) or not (length > 0.0).any():
        yield _short("zero-length", track.name, 0.0, "has no length. Delete it.")
    elif (length <= 1e-9).any():
        yield _short("zero-length", track.name, 0.0, "has a piece without length. Delete it.")
    elif float(length.sum()) < TINY:
        advice = f"is only {length.sum():.3g} mm long. Delete it."
        yield _short("tiny-line", track.name, float(length.sum()), advice)
    elif track.diameter == 0.0 and (length < TINY).any() and _is_angular(track.points):
        least = float(length.min())
        yield _short("tiny-line", track.name, least, f"has a piece of {least:.3g} mm. Delete it.")


def _is_angular(points: Floats) -> bool:
    """Whether a piece is tiny beside both its neighbours, and no part of an arc."""
    length = np.hypot(*np.diff(points, axis=0).T)
    around = np.minimum(np.roll(length, 1), np.roll(length, -1))
    return bool(((length < TINY) & (length < 0.2 * around)).any())


def _short(code: str, name: str, value: float, what: str) -> Finding:
    return Finding(code, Severity.WARNING, name, value, TINY, "mm", f"{name} {what}")


def cleaned(track: Track) -> Track | None:
    """The line without pieces that have no length; None where nothing is left of it."""
    keep = np.r_[True, np.hypot(*np.diff(track.points, axis=0).T) > 1e-9]
    points = track.points[keep]
    if len(points) < 2:
        return None
    closed = track.closed or (
        len(points) > 3 and float(np.hypot(*(points[0] - points[-1]))) <= JOINED
    )
    if closed:
        end = float(np.hypot(*(points[0] - points[-1])))
        points = points.copy() if end <= JOINED else np.concatenate([points, points[:1]])
        points[-1] = points[0]
    return Track(track.name, track.layer, points, closed, track.mark, track.diameter)


def without_doubles(tracks: Sequence[Track]) -> tuple[tuple[Track, ...], list[tuple[Track, Track]]]:
    """The lines that are drawn once, and pairs (kept, double) of the same points either way."""
    seen: dict[bytes, Track] = {}
    kept, doubles = [], []
    for track in tracks:
        points = np.round(track.points[:-1] if track.closed else track.points, 2) + 0.0
        key = points[np.lexsort(points.T)].tobytes()
        if key in seen:
            doubles.append((seen[key], track))
        else:
            seen[key] = track
            kept.append(track)
    return tuple(kept), doubles


def contours(tracks: Sequence[Track]) -> tuple[Contour, ...]:
    """Lines joined where exactly two of their ends meet."""
    done = [_contour([track.points], [track], track.closed) for track in tracks if track.closed]
    loose = [track for track in tracks if not track.closed]
    if not loose:
        return tuple(done)
    point = _shared_ends(loose)
    at: dict[int, list[tuple[int, int]]] = defaultdict(list)
    for number, ends in enumerate(point.tolist()):
        for side, end in enumerate(ends):
            at[end].append((number, side))
    used: set[int] = set()
    starts = [entry for entries in at.values() if len(entries) != 2 for entry in entries]
    rings = ((number, 0) for number in range(len(loose)))
    done.extend(
        _walk(first, loose, point, at, used) for first in (*starts, *rings) if first[0] not in used
    )
    return tuple(done)


def _shared_ends(loose: Sequence[Track]) -> Indices:
    """(n, 2) number of the point each line begins and ends at."""
    ends = np.concatenate([track.points[[0, -1]] for track in loose])
    number = np.arange(len(ends))
    for a, b in sorted(KDTree(ends).query_pairs(JOINED)):
        number[b] = min(number[a], number[b])
    return number.reshape(-1, 2)


def _walk(
    first: tuple[int, int],
    loose: Sequence[Track],
    point: Indices,
    at: dict[int, list[tuple[int, int]]],
    used: set[int],
) -> Contour:
    """Follow lines from the end *first* until they branch, end, or come back."""
    (number, side), pieces, chain = first, [], []
    begin = int(point[number, side])
    while True:
        used.add(number)
        track = loose[number]
        chain.append(track)
        pieces.append(track.points if side == 0 else track.points[::-1])
        end = int(point[number, 1 - side])
        onward = [entry for entry in at[end] if entry[0] not in used]
        if end == begin or len(at[end]) != 2 or not onward:
            closed = end == begin and len(np.concatenate(pieces)) > 3
            return _contour(pieces, chain, closed)
        number, side = onward[0]


def _contour(pieces: Sequence[Floats], chain: Sequence[Track], closed: bool) -> Contour:
    points = np.concatenate([pieces[0], *(piece[1:] for piece in pieces[1:])])
    if closed:
        points = np.concatenate([points[:-1], points[:1]])
    mark = next((track.mark for track in chain if track.mark), "")
    first = chain[0]
    name = f"{first.name} ({mark})" if mark else first.name
    return Contour(name, points, closed, mark, first.diameter if len(chain) == 1 else 0.0)


def open_findings(found: Sequence[Contour]) -> Iterator[Finding]:
    """Contours that do not close: by a gap one can hardly see, or for good."""
    loose = [contour for contour in found if not contour.closed]
    if not loose:
        return
    ends = np.concatenate([contour.points[[0, -1]] for contour in loose])
    tree = KDTree(ends)
    near, _ = tree.query(ends, k=min(2, len(ends)))
    near = near[:, -1].reshape(-1, 2).max(axis=1)
    for contour, gap in zip(loose, near.tolist(), strict=True):
        x, y = contour.points[0].tolist()
        where = f"{contour.name} at ({x:.1f}, {y:.1f})"
        if JOINED < gap <= GAP:
            message = (
                f"The ends of {where} miss each other by {gap:.3g} mm. Join them, "
                f"with a tolerance of {GAP:g} mm."
            )
            yield Finding("micro-gap", Severity.ERROR, contour.name, gap, JOINED, "mm", message)
        else:
            gap = float(np.hypot(*(contour.points[0] - contour.points[-1])))
            message = f"{where} is open: {gap:.1f} mm lie between its ends. Close it."
            yield Finding("open-path", Severity.ERROR, contour.name, gap, JOINED, "mm", message)


def polygon(contour: Contour) -> shapely.Polygon | None:
    """What a contour encloses, mended where it crosses itself; open ones are closed straight."""
    if len(contour.points) < 3:
        return None
    ring = shapely.Polygon(contour.points)
    shape = ring if ring.is_valid else shapely.make_valid(ring, method="structure")
    return shape if shape.area > 0.0 else None
