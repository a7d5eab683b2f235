"""A built strip or tube as a closed triangle mesh, on the very sides that its solid has.

Slots with their rounded floors, holes and bevelled ends are those of the flat part; arcs
become short lines within 0.01 mm, bends within 0.02 mm.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components
from scipy.spatial import cKDTree

from fabrication.export.interchange.sheeting import divided, lines_across, rim_of, sheeted
from fabrication.flattening import corners
from fabrication.lamella import Lamella
from fabrication.parts import FlatPart
from fabrication.shapes import circle
from fabrication.sides import Side, strip_sides
from fabrication.tube_sides import Box, tube_sides
from gridshell.arrays import Floats, Indices, Points

_PER_BAY = (2, 4, 8, 16, 32, 64)
"""Columns in a bay: the first that is fine enough."""

_SAGITTA = 0.02
"""Between a bent edge and its chords, mm."""

_ALIKE = 1e-6
"""Points of a tube's faces that are nearer than this are one, mm."""


def strip_mesh(strip: Lamella, part: FlatPart) -> tuple[Points, Indices]:
    """(n, 3) points, mm, and (m, 3) triangles, closed and facing outwards."""
    return _hollow(strip, part) if part.wall else _solid(strip, part)


def _solid(strip: Lamella, part: FlatPart) -> tuple[Points, Indices]:
    near, far = (corners(face) for face in part.faces)
    holes = [corners(circle(d / 2.0, x, y)) for x, y, d in part.circles.tolist()]
    ends = (max(f[:, 0].min() for f in (near, far)), min(f[:, 0].max() for f in (near, far)))
    sides = strip_sides(strip, part)
    lines = lines_across([near, far, *holes], _columns(sides[0], part, ends))
    flat, triangles = sheeted([near, *holes], lines)
    beyond = _moved(flat, near, far)
    count = len(flat)
    points = [side.points(*own.T) for side, own in zip(sides, (flat, beyond), strict=True)]
    rim = rim_of(triangles)
    faces = [triangles[:, ::-1], triangles + count, _walls(rim, rim + count)]
    return np.concatenate(points), np.concatenate(faces)


def _moved(flat: Floats, near: Floats, far: Floats) -> Floats:
    """*flat* on the far side: the corners at a bevelled end lie elsewhere along it."""
    beyond = np.array(flat)
    for end in (np.min, np.max):
        x = end(near[:, 0])
        beyond[flat[:, 0] == x, 0] = end(far[:, 0])
    return beyond


def _columns(side: Side, part: FlatPart, ends: tuple[float, float]) -> Floats:
    """Places between *ends* where the strip is split: every bay as often as its bend asks for."""
    bays = np.unique(np.clip(np.r_[ends[0], part.development.node_x, ends[1]], *ends))
    for per_bay in _PER_BAY:
        steps = np.arange(per_bay * (len(bays) - 1) + 1) / per_bay
        x = np.interp(steps, np.arange(len(bays)), bays)
        if _sagitta(side, x) <= _SAGITTA:
            break
    return np.asarray(x[1:-1])


def _sagitta(side: Side, x: Floats) -> float:
    """Largest distance of either edge from its chords between *x*, mm."""
    middle = (x[1:] + x[:-1]) / 2.0
    off = 0.0
    for v in (0.0, side.width):
        on_it, between = (
            side.points(x, np.full(len(x), v)),
            side.points(middle, np.full(len(middle), v)),
        )
        chords = (on_it[1:] + on_it[:-1]) / 2.0
        off = max(off, float(np.linalg.norm(between - chords, axis=1).max()))
    return off


def _walls(here: Indices, there: Indices) -> Indices:
    """Two triangles for every edge (k, 2) and its image, facing to the right of the edges."""
    (a, b), (c, d) = here.T, there.T
    return np.concatenate([np.stack([a, b, d], axis=1), np.stack([a, d, c], axis=1)])


# ---- tubes -------------------------------------------------------------------------------------

_OUTWARD = {"near": False, "far": True, "top": False, "bottom": True}
"""Whether a face's natural normal, along x across, points away from the axis."""


def _hollow(strip: Lamella, part: FlatPart) -> tuple[Points, Indices]:
    """Outer and inner faces, the two ends, and the walls of the drillings."""
    boxes = tube_sides(strip, part)
    circles = [corners(circle(d.diameter / 2.0, d.x)) for d in part.drills]
    lines = _columns(boxes[0].near, part, (0.0, part.length))
    lines = lines_across(circles, lines) if circles else lines
    holes = [divided(ring, lines) for ring in circles]
    pieces = [_end(boxes, x, last=x > 0.0) for x in (0.0, part.length)]
    for name, outward in _OUTWARD.items():
        drilled = holes if name in ("top", "bottom") else []
        for k, box in enumerate(boxes):
            side: Side = getattr(box, name)
            rectangle = np.array([[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]])
            middle = np.array([0.0, side.width / 2.0])
            rings = [rectangle * [part.length, side.width], *(ring + middle for ring in drilled)]
            flat, triangles = sheeted(rings, lines)
            turned = triangles if outward == (k == 0) else triangles[:, ::-1]
            pieces.append((side.points(*flat.T), turned))
        pieces += [_bore(boxes, name, ring) for ring in drilled]
    return _welded(pieces)


def _end(boxes: tuple[Box, Box], x: float, *, last: bool) -> tuple[Points, Indices]:
    """The wall's cut at one end: four quads between the outer and the inner corners."""
    rows = []
    for box in boxes:
        near, far = (
            side.points(np.full(2, x), np.array([0.0, side.width])) for side in (box.near, box.far)
        )
        rows.append(np.stack([near[0], near[1], far[1], far[0]]))
    here = np.arange(4)
    ring = np.stack([here, np.roll(here, -1)], axis=1)
    walls = _walls(ring, ring + 4)
    return np.concatenate(rows), walls if last else walls[:, ::-1]


def _bore(boxes: tuple[Box, Box], name: str, ring: Floats) -> tuple[Points, Indices]:
    """The wall of a drilling, from the outer to the inner face."""
    sides: list[Side] = [getattr(box, name) for box in boxes]
    points = [side.points(ring[:, 0], ring[:, 1] + side.width / 2.0) for side in sides]
    here = np.arange(len(ring))
    edges = np.stack([here, np.roll(here, -1)], axis=1)
    walls = _walls(edges, edges + len(ring))
    return np.concatenate(points), walls if name == "bottom" else walls[:, ::-1]


def _welded(pieces: Sequence[tuple[Points, Indices]]) -> tuple[Points, Indices]:
    """One mesh, equal points as one."""
    points = np.concatenate([own for own, _ in pieces])
    first = np.cumsum([0, *(len(own) for own, _ in pieces[:-1])])
    triangles = np.concatenate([own + n for (_, own), n in zip(pieces, first, strict=True)])
    a, b = cKDTree(points).query_pairs(_ALIKE, output_type="ndarray").T
    alike = coo_array((np.ones(len(a)), (a, b)), shape=(len(points),) * 2)
    _, number = connected_components(alike, directed=False)
    _, kept = np.unique(number, return_index=True)
    return points[kept], number[triangles]
