"""Pieces of built strips as solids of triangles, made without the CAD kernel.

A block of cells over the flat outline, with the slots' cells left out, is moved through the strip's
own map. The map is straight along the height, so only the length needs slices, and the thickness of
thick strips: on a twisted narrow face the triangles over a length a and a depth t are a t / 4 times
the rate of twist off.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from itertools import pairwise

import manifold3d
import numpy as np

from fabrication.cut import Edge
from fabrication.lamella import Lamella
from fabrication.parts import FlatPart
from gridshell.arrays import Floats, Indices, Mask

_STEP = 3.0
"""Length of a cell at most, mm."""

_DEEP = 5.0
"""Depth of a cell at most, mm: 0.004 mm off at 1 rad/m."""

_SLICES = 4
"""Cells beside a slot on either side, and in the slot."""

_BEYOND = 1.0
"""How much longer a tube's cavity is than the piece it is taken from, mm."""

_ROUND = 64
"""Straight sides of a drill."""

Window = tuple[float, float]
"""From and to, mm from the strip's cut end."""


@dataclass(frozen=True, eq=False)
class StripPiece:
    """A length of a built strip.

    Parameters
    ----------
    solid : bent, twisted, slotted and drilled, mm.
    nodes : whose slots it has.
    """

    solid: manifold3d.Manifold
    nodes: frozenset[str]


def strip_pieces(
    lamella: Lamella, part: FlatPart, windows: Sequence[Window]
) -> Iterator[StripPiece]:
    """The built strip within each window."""
    lattices = [_Lattice.of(part, window) for window in windows]
    if not lattices:
        return
    flat = np.concatenate([lattice.points for lattice in lattices])
    x, y, up = flat.T
    placed = lamella.place(x + lamella.start, y, up - part.width / 2.0)
    ends = np.cumsum([len(lattice.points) for lattice in lattices])[:-1]
    for lattice, points in zip(lattices, np.split(placed, ends), strict=True):
        solid = manifold3d.Manifold(
            manifold3d.Mesh64(
                vert_properties=np.ascontiguousarray(points),
                tri_verts=lattice.triangles.astype(np.uint64),
            )
        )
        if part.wall:
            solid = _hollowed(lamella, part, lattice, solid)
        drills = [
            _drill(lamella, part, hole.x, hole.y, hole.diameter)
            for hole in part.holes
            if lattice.low < hole.x < lattice.high
        ]
        if drills:
            solid = manifold3d.Manifold.batch_boolean([solid, *drills], manifold3d.OpType.Subtract)
        nodes = frozenset(s.node for s in part.slots if lattice.low < s.x < lattice.high)
        yield StripPiece(solid, nodes)


def _hollowed(
    lamella: Lamella, part: FlatPart, lattice: _Lattice, solid: manifold3d.Manifold
) -> manifold3d.Manifold:
    """A length of a tube: its cavity and the holes through its narrow walls taken away."""
    inside = replace(
        part, thickness=part.thickness - 2.0 * part.wall, width=part.width - 2.0 * part.wall
    )
    core = _Lattice.of(inside, (lattice.low - _BEYOND, lattice.high + _BEYOND))
    x, y, up = core.points.T
    placed = lamella.place(x + lamella.start, y, up - inside.width / 2.0)
    tools = [
        manifold3d.Manifold(
            manifold3d.Mesh64(
                vert_properties=np.ascontiguousarray(placed),
                tri_verts=core.triangles.astype(np.uint64),
            )
        )
    ]
    for drill in part.drills:
        if lattice.low < drill.x < lattice.high:
            frame = lamella.frames(np.array([drill.x + lamella.start]))
            motion = np.column_stack([frame.t[0], frame.b[0], frame.n[0], frame.points[0]])
            tool = manifold3d.Manifold.cylinder(
                2.0 * part.width, drill.diameter / 2.0, circular_segments=_ROUND, center=True
            )
            tools.append(tool.transform(motion))
    return manifold3d.Manifold.batch_boolean([solid, *tools], manifold3d.OpType.Subtract)


def _drill(
    lamella: Lamella, part: FlatPart, x: float, y: float, diameter: float
) -> manifold3d.Manifold:
    """A cylinder through the strip where its hole lies."""
    s = np.array([x + lamella.start])
    frame = lamella.frames(s)
    middle = lamella.place(s, np.zeros(1), np.array([y - part.width / 2.0]))[0]
    motion = np.column_stack([frame.n[0], frame.t[0], frame.b[0], middle])
    tool = manifold3d.Manifold.cylinder(
        3.0 * part.thickness, diameter / 2.0, circular_segments=_ROUND, center=True
    )
    return tool.transform(motion)


@dataclass(frozen=True, eq=False)
class _Lattice:
    """Cells over a window of a flat strip.

    Parameters
    ----------
    points : (n, 3) corners of the cells: x, y through the thickness, height from the lower edge.
    triangles : (m, 3) the closed surface of the cells that are there, turned outwards.
    low, high : the window, mm.
    """

    points: Floats
    triangles: Indices
    low: float
    high: float

    @classmethod
    def of(cls, part: FlatPart, window: Window) -> _Lattice:
        """Columns end at slot walls and are 3 mm long at most; rows end at slot floors."""
        low, high = window
        slots = [s for s in part.slots if low < s.x < high]
        walls = [w for s in slots for w in (s.x - s.width / 2.0, s.x + s.width / 2.0)]
        stops = np.unique(np.clip(np.r_[low, walls, high], low, high))
        x = np.concatenate(
            [np.linspace(a, b, _cells(b - a, thin=True) + 1)[:-1] for a, b in pairwise(stops)]
            + [[high]]
        )
        floors = [part.width - s.depth if s.edge is Edge.UPPER else s.depth for s in slots]
        z = np.unique(np.r_[0.0, floors, part.width])
        column, row = (x[:-1] + x[1:]) / 2.0, (z[:-1] + z[1:]) / 2.0
        present = np.ones((len(column), len(row)), dtype=bool)
        for slot, floor in zip(slots, floors, strict=True):
            inside = np.abs(column - slot.x) < slot.width / 2.0
            open_rows = row > floor if slot.edge is Edge.UPPER else row < floor
            present &= ~(inside[:, None] & open_rows)
        deep = int(np.ceil(part.thickness / _DEEP))
        through = part.thickness * (np.arange(deep + 1) / deep - 0.5)
        grid = np.stack(np.meshgrid(x, through, z, indexing="ij"), axis=-1)
        _bevel(grid, part)
        return cls(grid.reshape(-1, 3), _surface(present, deep), low, high)


def _cells(length: float, *, thin: bool) -> int:
    least = _SLICES if thin and length < _SLICES * _STEP else 1
    return max(least, int(np.ceil(length / _STEP)))


def _bevel(grid: Floats, part: FlatPart) -> None:
    """Move the columns near a bevelled end so that its near and far face end where they do."""
    for run, end in zip(part.bevels, (0.0, part.length), strict=True):
        if run == 0.0 or not np.isclose(grid[:, 0, 0, 0], end).any():
            continue
        x = grid[..., 0]
        share = np.linspace(0.0, 1.0, x.shape[1])[:, None]  # from the far face to the near one
        shorter = share * max(0.0, -run) + (1.0 - share) * max(0.0, run)
        near = np.clip(1.0 - np.abs(x - end) / (4.0 * abs(run)), 0.0, 1.0)
        x += np.where(end == 0.0, 1.0, -1.0) * shorter * near


def _surface(present: Mask, deep: int) -> Indices:
    """Closed surface of the cells of a lattice *deep* cells thick, turned outwards."""
    columns, rows = present.shape
    count = (columns + 1, deep + 1, rows + 1)
    number = np.arange(np.prod(count)).reshape(count)
    cell = np.pad(np.repeat(present[:, None, :], deep, axis=1), 1)
    inside = cell[1:-1, 1:-1, 1:-1]
    quads = []
    for axis in range(3):
        for side in (0, 1):
            beside = np.roll(cell, 1 - 2 * side, axis=axis)[1:-1, 1:-1, 1:-1]
            corner = np.argwhere(inside & ~beside)
            corner[:, axis] += side
            b, c = (axis + 1) % 3, (axis + 2) % 3
            ring = [(0, 0), (1, 0), (1, 1), (0, 1)] if side else [(0, 0), (0, 1), (1, 1), (1, 0)]
            found = []
            for at_b, at_c in ring:
                point = corner.copy()
                point[:, b] += at_b
                point[:, c] += at_c
                found.append(number[tuple(point.T)])
            quads.append(np.stack(found, axis=1))
    faces = np.concatenate(quads)
    return np.concatenate([faces[:, [0, 1, 2]], faces[:, [0, 2, 3]]])
