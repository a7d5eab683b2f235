"""Do the segments of a canopy keep apart? The distance of strips across every seam.

All seams are alike: the first segment is tried against the copies up to half a turn away. Strips
are compared as their middle surfaces, from the nearest samples on; half the thickness of either is
taken off.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from fabrication.finding import Finding, Severity
from fabrication.lamella import Lamella
from fabrication.segments import Segments
from fabrication.structures import Structure
from gridshell import SettingError
from gridshell.arrays import Floats, Indices, Points

_STEP = 20.0
"""Between samples along a strip, mm."""

_ACROSS = 5
_TRIED = 12
"""Pairs of strips, the closest first, between which the least distance is sought."""

_MOST = 60
"""Copies of a canopy that are tried downwards for advice."""


@dataclass(frozen=True)
class Seam:
    """The closest approach of two segments.

    Parameters
    ----------
    distance : between the strips' faces, mm; negative where they are in each other.
    first, second : marks of the two strips.
    place : (3,) between them, mm.
    """

    distance: float
    first: str
    second: str
    place: tuple[float, float, float]


def seam_of(segments: Segments, strips: Structure) -> Seam:
    """The closest approach of the first segment to any other."""
    samples = _samples(strips)
    return min(
        (_between(segments, number, strips, samples) for number in _neighbours(segments)),
        key=lambda seam: seam.distance,
    )


def require_apart(segments: Segments, strips: Structure) -> Seam:
    """The closest approach; refuses segments that run into each other.

    Raises
    ------
    SettingError
        Naming the strips, the place, and the largest number of segments that has room.
    """
    seam = seam_of(segments, strips)
    if seam.distance > 0.0:
        return seam
    fitting = next(
        (
            count
            for count in range(min(segments.count, _MOST) - 1, 1, -1)
            if seam_of(Segments(count, segments.centre), strips).distance > 0.0
        ),
        None,
    )
    raise SettingError(
        "The segments reach into each other",
        where=f"{seam.first} and {seam.second} of the next segment at "
        f"({', '.join(f'{c:.0f}' for c in seam.place)}) mm",
        value=f"{segments.count} segments",
        limit="a net within its own share of a full turn",
        advice="a net further from the axis" if fitting is None else f"count = {fitting}",
    )


def seam_findings(segments: Segments, seam: Seam) -> list[Finding]:
    """A warning where strips are closer across a seam than they shall be."""
    if seam.distance >= segments.seam:
        return []
    outwards = (segments.seam - seam.distance) / (2.0 * np.sin(np.pi / segments.count))
    return [
        Finding(
            "segment-seam",
            Severity.WARNING,
            f"{seam.first} {seam.second}",
            seam.distance,
            segments.seam,
            "mm",
            f"{seam.first} is {seam.distance:.1f} mm from {seam.second} of the next segment, "
            f"{segments.seam:g} asked for: move the net {outwards:.1f} mm away from the axis, or "
            "choose a narrower seam.",
        )
    ]


# ---- distances ---------------------------------------------------------------------------------


@dataclass(frozen=True, eq=False)
class _Samples:
    """Points of the middle surfaces of all strips, with strip, station and height."""

    points: Points
    strip: Indices
    station: Floats
    height: Floats


def _neighbours(segments: Segments) -> range:
    return range(1, segments.count // 2 + 1)


def _samples(strips: Structure) -> _Samples:
    points, owner, stations, heights = [], [], [], []
    levels = strips.profile.width * np.linspace(-0.5, 0.5, _ACROSS)
    for index, strip in enumerate(strips.lamellas):
        s = np.linspace(strip.start, strip.end, max(2, round(strip.length / _STEP) + 1))
        s, z = (a.ravel() for a in np.meshgrid(s, levels, indexing="ij"))
        points.append(strip.place(s, np.zeros_like(s), z))
        owner.append(np.full(len(s), index))
        stations.append(s)
        heights.append(z)
    return _Samples(*(np.concatenate(rows) for rows in (points, owner, stations, heights)))


def _between(segments: Segments, number: int, strips: Structure, samples: _Samples) -> Seam:
    """The closest approach to copy *number*."""
    from scipy.spatial import cKDTree

    there = segments.placed(samples.points, number)
    distance, nearest = cKDTree(there).query(samples.points)
    order = np.argsort(distance)
    tried: dict[tuple[int, int], tuple[int, int]] = {}
    for i in order.tolist():
        pair = int(samples.strip[i]), int(samples.strip[nearest[i]])
        tried.setdefault(pair, (i, int(nearest[i])))
        if len(tried) == _TRIED:
            break
    found = []
    for (a, b), (i, j) in tried.items():
        apart, place = _closest(
            strips.lamellas[a],
            strips.lamellas[b],
            (segments, number),
            np.array([samples.station[i], samples.height[i]]),
            np.array([samples.station[j], samples.height[j]]),
            strips.profile.width,
        )
        found.append((apart, strips.lamellas[a].mark, strips.lamellas[b].mark, place))
    apart, first, second, place = min(found, key=lambda one: one[0])
    x, y, z = place.tolist()
    return Seam(apart - strips.profile.thickness, first, second, (x, y, z))


def _closest(
    one: Lamella,
    other: Lamella,
    copy: tuple[Segments, int],
    here: Floats,
    there: Floats,
    width: float,
) -> tuple[float, Floats]:
    """Distance of two middle surfaces near places (station, height), and half-way between, mm."""
    from scipy.optimize import minimize

    segments, number = copy
    scale = np.array([_STEP, width, _STEP, width])

    def points(x: Floats) -> tuple[Floats, Floats]:
        s, z, t, w = (np.array([v]) for v in x * scale)
        first = one.place(s, np.zeros(1), z)
        second = segments.placed(other.place(t, np.zeros(1), w), number)
        return first[0], second[0]

    def apart(x: Floats) -> float:
        a, b = points(x)
        return float((a - b) @ (a - b))

    half = width / 2.0
    bounds = [(one.start, one.end), (-half, half), (other.start, other.end), (-half, half)]
    limits = [(a / k, b / k) for (a, b), k in zip(bounds, scale.tolist(), strict=True)]
    begin = np.r_[here, there] / scale
    found = minimize(apart, begin, bounds=limits, method="L-BFGS-B", options={"ftol": 1e-14})
    a, b = points(found.x if found.fun <= apart(begin) else begin)
    return float(np.linalg.norm(a - b)), np.asarray((a + b) / 2.0)


def largest_difference(
    segments: Segments, read: Sequence[tuple[Floats, Floats]], points: Points
) -> float:
    """How far copies that were read back are from the exact ones, mm.

    Parameters
    ----------
    read : motion of every copy as the file has it: x -> turn x + shift.
    points : (n, 3) of the first segment.
    """
    worst = 0.0
    for number, (turn, shift) in enumerate(read):
        off = points @ turn.T + shift - segments.placed(points, number)
        worst = max(worst, float(np.abs(off).max()))
    return worst
