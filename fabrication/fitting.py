"""Do the strips go together? The volume two crossing strips share at their nodes.

Strips that meet anywhere else are found by ``collisions``.

Around a node both strips are taken with their drawn slots, as thin solids bent and twisted into
place, and intersected. The pieces are meshed independently of the CAD solids: a small block of
cells over the flat outline, two rows high with the slot's cells left out, is moved through the
strip's own map. The map is straight along the height, so only the length needs slices.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cache

import manifold3d
import numpy as np

from fabrication.collisions import slot_reach
from fabrication.cut import Edge, Slot
from fabrication.lamella import Lamella
from fabrication.parts import FlatPart
from fabrication.structures import Structure
from gridshell.arrays import Floats, Indices

_SLICES = 4
"""Cells beside the slot on either side, and in the slot."""


@dataclass(frozen=True)
class Fit:
    """Clash volumes over all slotted nodes.

    Parameters
    ----------
    max_mm3 : largest volume shared at one node, mm3.
    worst : its node.
    nodes : how many were tried.
    """

    max_mm3: float
    worst: str
    nodes: int


def fit(structure: Structure, parts: Sequence[FlatPart]) -> Fit:
    """Intersect the two strips at every slotted node."""
    pieces: dict[str, list[manifold3d.Manifold]] = {}
    for lamella, part in zip(structure.lamellas, parts, strict=True):
        solids = slot_pieces(lamella, part)
        for slot, piece in zip(part.slots, solids, strict=True):
            pieces.setdefault(slot.node, []).append(piece)
    clashes = {node: (pair[0] ^ pair[1]).volume() for node, pair in pieces.items()}
    worst = max(clashes, key=lambda node: clashes[node], default="")
    largest = clashes.get(worst, 0.0)
    return Fit(largest, worst if largest > 0.0 else "", len(clashes))


def slot_pieces(lamella: Lamella, part: FlatPart) -> list[manifold3d.Manifold]:
    """The built strip around each of its slots, one solid per slot."""
    if not part.slots:
        return []
    flat = np.array([_lattice(slot, part) for slot in part.slots])
    x, y, up = np.moveaxis(flat, -1, 0).reshape(3, -1)
    placed = lamella.place(x + lamella.start, y, up - part.width / 2.0).reshape(flat.shape)
    return [
        manifold3d.Manifold(
            manifold3d.Mesh64(
                vert_properties=np.ascontiguousarray(points),
                tri_verts=_triangles(slot.edge).astype(np.uint64),
            )
        )
        for slot, points in zip(part.slots, placed, strict=True)
    ]


def _lattice(slot: Slot, part: FlatPart) -> Floats:
    """Corners of the cells around a slot as (x, y through the thickness, height), (k, 3)."""
    reach = slot_reach(slot, part.thickness)
    half, steps = slot.width / 2.0, np.arange(_SLICES) / _SLICES
    x = (
        slot.x
        + np.r_[
            -half - reach * (1.0 - steps),
            -half + slot.width * steps,
            half + reach * steps,
            half + reach,
        ]
    )
    floor = part.width - slot.depth if slot.edge is Edge.UPPER else slot.depth
    height = np.array([0.0, floor, part.width])
    through = np.array([-part.thickness / 2.0, part.thickness / 2.0])
    return np.stack(np.meshgrid(x, through, height, indexing="ij"), axis=-1).reshape(-1, 3)


@cache
def _triangles(edge: Edge) -> Indices:
    """Closed surface of the cells of a piece, turned outwards in (x, y, height)."""
    columns = 3 * _SLICES
    present = np.ones((columns + 2, 3, 4), dtype=bool)
    present[0] = present[-1] = False
    present[:, [0, -1]] = present[:, :, [0, -1]] = False
    row = 2 if edge is Edge.UPPER else 1
    present[1 + _SLICES : 1 + 2 * _SLICES, 1, row] = False
    number = np.arange((columns + 1) * 2 * 3).reshape(columns + 1, 2, 3)
    faces = []
    for i, j, k in np.argwhere(present).tolist():
        corner = np.array([i - 1, j - 1, k - 1])
        for axis in range(3):
            for side in (0, 1):
                beside = np.array([i, j, k])
                beside[axis] += 2 * side - 1
                if not present[tuple(beside)]:
                    faces.append(_face(number, corner, axis, side))
    quads = np.array(faces)
    return np.concatenate([quads[:, [0, 1, 2]], quads[:, [0, 2, 3]]])


def _face(number: Indices, corner: Indices, axis: int, side: int) -> list[int]:
    """Corner numbers of one side of a cell, counter-clockwise seen from outside."""
    b, c = (axis + 1) % 3, (axis + 2) % 3
    ring = [(0, 0), (1, 0), (1, 1), (0, 1)] if side else [(0, 0), (0, 1), (1, 1), (1, 0)]
    found = []
    for at_b, at_c in ring:
        point = corner.copy()
        point[axis] += side
        point[b] += at_b
        point[c] += at_c
        found.append(int(number[tuple(point)]))
    return found
