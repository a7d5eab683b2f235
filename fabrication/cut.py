"""Cuts exist once, in strip coordinates; the flat part and the solid are their two images.

Strip coordinates: x from the strip's cut end along the developed axis, y across from the lower
edge (0) to the upper edge (width). The upper edge is the one the surface normal points to.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from enum import Enum

import numpy as np

from gridshell.arrays import Floats, frozen


class Edge(Enum):
    """The edge of the strip a slot opens to."""

    LOWER = "lower"
    UPPER = "upper"


@dataclass(frozen=True)
class Slot:
    """A notch with parallel walls.

    Parameters
    ----------
    x : centre line, mm from the strip's cut end.
    width, depth : mm.
    edge : where it opens.
    node : name of the node.
    partner : mark of the lamella that goes in.
    """

    x: float
    width: float
    depth: float
    edge: Edge
    node: str
    partner: str


def outline(length: float, width: float, slots: Sequence[Slot]) -> Floats:
    """The closed outline of a strip with its slots.

    Returns
    -------
    (k, 2) corners counter-clockwise from (0, 0), first corner not repeated; every edge is
    horizontal or vertical.
    """
    lower = sorted((s for s in slots if s.edge is Edge.LOWER), key=lambda s: s.x)
    upper = sorted((s for s in slots if s.edge is Edge.UPPER), key=lambda s: -s.x)
    corners = [[0.0, 0.0]]
    for s in lower:
        left, right = s.x - s.width / 2.0, s.x + s.width / 2.0
        corners += [[left, 0.0], [left, s.depth], [right, s.depth], [right, 0.0]]
    corners += [[length, 0.0], [length, width]]
    for s in upper:
        left, right, floor = s.x - s.width / 2.0, s.x + s.width / 2.0, width - s.depth
        corners += [[right, width], [right, floor], [left, floor], [left, width]]
    corners.append([0.0, width])
    return frozen(corners)


def area(corners: Floats) -> float:
    """Signed area of a polygon (k, 2), positive counter-clockwise, mm2."""
    x, y = corners.T
    return float(np.dot(x, np.roll(y, -1)) - np.dot(y, np.roll(x, -1))) / 2.0
