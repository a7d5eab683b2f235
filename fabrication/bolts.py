"""Bolts along an axis: shank, head and nut as prisms, in whole lengths as they are sold.

Sizes follow the coarse metric series (ISO 4017, ISO 4032) in round figures: the head is 0.65, the
nut 0.9 diameters high, both 1.6 diameters across their flats, and a nut leaves 2 threads free.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from fabrication.outlines import Frame
from fabrication.shapes import Body, Prisms, Shape, circle
from gridshell.arrays import Floats

COLOUR = (0.45, 0.47, 0.50)
HEAD, NUT, FLATS, FREE = 0.65, 0.9, 1.6, 0.3
"""Heights of head and nut, distance across the flats, free thread: all in diameters."""

HOLE_PLAY = 1.0
"""Of a bolt in its hole, mm: M8 in 9."""

EDGE_DISTANCE = 1.2
"""From the middle of a hole to an edge, in diameters of the hole (EN 1993-1-8, Table 3.3)."""

_STEP = 5.0
"""Between lengths that are sold, mm."""


def bolt_length(grip: float, diameter: float) -> float:
    """Length under the head of the shortest bolt for a grip, mm."""
    needed = grip + (NUT + FREE) * diameter
    return float(_STEP * np.ceil(needed / _STEP - 1e-9))


def bolt_bodies(
    marks: Sequence[str],
    heads: Sequence[Frame],
    grips: Floats,
    lengths: Sequence[float],
    diameter: float,
    *,
    of: str = "",
) -> tuple[Prisms, Prisms]:
    """Bolts (shanks), and their heads and nuts.

    Parameters
    ----------
    marks : of the places, "N12".
    heads : frames in the plane the heads lie on; bolts run against their normals.
    grips : (n,) thickness that is held, mm.
    lengths : of the bolts under their heads, mm.
    of : what they hold, where there are others: "block ".
    """
    hexagon = _hexagon(FLATS * diameter)
    sizes = sorted(set(lengths))
    shanks = tuple(
        Shape(f"M{diameter:g}x{size:g}", circle(diameter / 2.0), -size, 0.0) for size in sizes
    )
    bolts = tuple(
        Body(f"{mark}-bolt", sizes.index(size), frame)
        for mark, size, frame in zip(marks, lengths, heads, strict=True)
    )
    head = Shape(f"M{diameter:g} head", hexagon, 0.0, HEAD * diameter)
    nut = Shape(f"M{diameter:g} nut", hexagon, -NUT * diameter, 0.0, (circle(diameter / 2.0),))
    ends = []
    for mark, frame, grip in zip(marks, heads, grips.tolist(), strict=True):
        below = Frame(frame.origin - grip * frame.normal, frame.x, frame.y)
        ends += [Body(f"{mark}-head", 0, frame), Body(f"{mark}-nut", 1, below)]
    return (
        Prisms(f"{of}bolts", COLOUR, shanks, bolts),
        Prisms(f"{of}heads and nuts", COLOUR, (head, nut) if ends else (), tuple(ends)),
    )


def _hexagon(flats: float) -> Floats:
    turn = np.pi / 6.0 + np.pi / 3.0 * np.arange(6)
    radius = flats / np.sqrt(3.0)
    return np.column_stack([radius * np.cos(turn), radius * np.sin(turn), np.zeros(6)])
