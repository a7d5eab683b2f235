"""Meshes of parts to look at: columns along a strip, and prisms with their openings.

Fine enough for the eye; finer ones go to other programs, exact ones into the STEP file.
"""

from __future__ import annotations

import numpy as np
from manifold3d import triangulate

from fabrication.cut import Edge, Floor, Slot
from fabrication.flattening import corners
from fabrication.parts import FlatPart
from fabrication.shapes import Shape
from gridshell.arrays import Floats, Indices, Points

_STEP = np.pi / 4.0
"""Largest turn of an arc between two of its points."""


def columns(part: FlatPart, per_bay: int) -> tuple[Floats, Floats, Floats]:
    """(c + 1,) ends of the columns along the strip, (c,) lower and (c,) upper bounds, mm."""
    first, last = abs(part.bevels[0]) / 2.0, part.length - abs(part.bevels[1]) / 2.0
    bays = np.unique(np.clip(np.r_[first, part.development.node_x, last], first, last))
    steps = np.arange(per_bay * (len(bays) - 1) + 1) / per_bay
    samples = np.interp(steps, np.arange(len(bays)), bays)
    centres = np.array([slot.x for slot in part.slots])
    half = np.array([slot.width for slot in part.slots]) / 2.0
    x = np.unique(np.clip(np.r_[centres - half, centres + half, samples], first, last))
    x = x[np.r_[True, np.diff(x) > 1e-6]]
    middle = (x[:-1] + x[1:]) / 2.0
    notch = []
    for edge in (Edge.LOWER, Edge.UPPER):
        slots = [(slot.x, slot.width, _depth(slot)) for slot in part.slots if slot.edge is edge]
        centre, width, depth = np.array(slots).reshape(-1, 3).T
        inside = np.abs(middle[:, None] - centre) < width / 2.0
        notch.append(np.where(inside, depth, 0.0).max(axis=1, initial=0.0))
    return x, notch[0], np.maximum(notch[0], part.width - notch[1])


def _depth(slot: Slot) -> float:
    """Depth of the rectangle that stands for a slot: a half circle is pi / 4 of its square."""
    rounded = np.pi / 8.0 * slot.width if slot.floor is Floor.ROUND else 0.0
    return float(slot.depth + rounded)


def shape_mesh(shape: Shape, *, fine: bool = False) -> tuple[Points, Indices]:
    """Points (n, 3), mm, and triangles (m, 3), facing outwards, of a shape with its openings.

    Parameters
    ----------
    fine : arcs within 0.01 mm, for other programs.
    """
    step = None if fine else _STEP
    rings = [corners(shape.outline, step), *(corners(o, step)[::-1] for o in shape.openings)]
    flat = np.concatenate(rings)
    caps = np.asarray(triangulate(rings), dtype=np.int64).reshape(-1, 3)
    count = len(flat)
    levels = (np.full(count, shape.low), np.full(count, shape.high))
    points = np.concatenate([np.column_stack([flat, level]) for level in levels])
    first = np.cumsum([0, *(len(ring) for ring in rings[:-1])])
    here = np.arange(count)
    after = np.concatenate(
        [at + np.roll(np.arange(len(ring)), -1) for at, ring in zip(first, rings, strict=True)]
    )
    walls = [
        np.stack([here, after, after + count], axis=1),
        np.stack([here, after + count, here + count], axis=1),
    ]
    return points, np.concatenate([caps[:, ::-1], caps + count, *walls])
