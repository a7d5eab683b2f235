"""Strips that pass through each other away from their slots.

Every strip's middle surface is cut into cells along its length, each of two triangles. Cells whose
bounding boxes overlap are tested edge against triangle (Moeller and Trumbore, Fast, minimum storage
ray-triangle intersection, 1997), both ways: two triangles that are not in one plane meet exactly
where an edge of one of them meets the other. What lies around a slot on both its strips is left to
``fitting``, which knows the slot itself.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from fabrication.cut import Slot
from fabrication.finding import Finding, Severity
from fabrication.lamella import Lamella
from fabrication.parts import FlatPart
from fabrication.structures import Structure
from gridshell.arrays import Floats, Indices, Mask, Points

_CELLS_PER_BAY = 8
_REACH = 2.0
_EDGES = np.array([[0, 1], [1, 2], [2, 3], [3, 0], [0, 2]])
_TRIANGLES = np.array([[0, 1, 2], [0, 2, 3]])
"""Corners of a cell: lower and upper edge at its start, upper and lower edge at its end."""


def slot_reach(slot: Slot, thickness: float) -> float:
    """Length on either side of a slot's walls that belongs to its node, mm."""
    return _REACH * (slot.width + thickness)


@dataclass(frozen=True, eq=False)
class _Cells:
    """Cells of all strips.

    Parameters
    ----------
    corners : (c, 4, 3) mm.
    strip : (c,) index of the lamella.
    place : (c,) number of the cell along its strip.
    x : (c, 2) where the cell begins and ends, mm from the strip's cut end.
    """

    corners: Floats
    strip: Indices
    place: Indices
    x: Floats


def collisions(structure: Structure, parts: Sequence[FlatPart]) -> tuple[Finding, ...]:
    """One finding for each pair of strips that pass through each other away from their slots.

    It is a warning beside a singular node, where strips are cut back for a connector, and an error
    elsewhere.
    """
    cells = _cells(structure, parts)
    first, second = _candidates(cells)
    hit, points = _meetings(cells.corners[first], cells.corners[second])
    first, second, points = first[hit], second[hit], points[hit]
    slotted = _at_a_shared_slot(cells, parts, first, second, points)
    pairs = np.stack([cells.strip[first], cells.strip[second]], axis=1)[~slotted]
    points = points[~slotted]
    beside = _singular_beside(structure, points)
    order = np.argsort(beside >= 0, kind="stable")
    distinct, at = np.unique(pairs[order], axis=0, return_index=True)
    return tuple(
        _finding(structure, a, b, points[i], int(beside[i]))
        for (a, b), i in zip(distinct.tolist(), order[at].tolist(), strict=True)
    )


def _singular_beside(structure: Structure, points: Points) -> Indices:
    """(n,) index of a node of more than two lamellas within a strip's width, -1 for none."""
    singular = [i for i, node in enumerate(structure.nodes) if node.singular]
    beside = np.full(len(points), -1)
    for i in singular:
        apart = np.linalg.norm(points - structure.nodes[i].position, axis=1)
        beside[apart <= structure.profile.width] = i
    return beside


def _finding(structure: Structure, i: int, j: int, point: Floats, singular: int) -> Finding:
    a, b = structure.lamellas[i].mark, structure.lamellas[j].mark
    x, y, z = (round(value) for value in point.tolist())
    met = f"{a} passes through {'itself' if a == b else b} at ({x}, {y}, {z}) mm"
    if singular >= 0:
        node = structure.nodes[singular].name
        message = f"{met}, beside {node}: cut both back there for the connector."
    else:
        message = (
            f"{met}, away from any slot they share. Use a smaller patch if the surface cuts "
            "through itself there, else a narrower strip."
        )
    severity = Severity.ERROR if singular < 0 else Severity.WARNING
    thickness = structure.profile.thickness
    return Finding("strips-cross", severity, f"{a} {b}", 0.0, thickness, "mm", message)


# ---- cells -------------------------------------------------------------------------------------


def _cells(structure: Structure, parts: Sequence[FlatPart]) -> _Cells:
    corners, counts, ends = [], [], []
    for lamella, part in zip(structure.lamellas, parts, strict=True):
        s = _stations(lamella)
        height = np.repeat([-part.width / 2.0, part.width / 2.0], len(s))
        low, high = lamella.place(np.r_[s, s], np.zeros(2 * len(s)), height).reshape(2, -1, 3)
        corners.append(np.stack([low[:-1], high[:-1], high[1:], low[1:]], axis=1))
        counts.append(len(s) - 1)
        ends.append(np.stack([s[:-1], s[1:]], axis=1) - lamella.start)
    return _Cells(
        np.concatenate(corners),
        np.repeat(np.arange(len(counts)), counts),
        np.concatenate([np.arange(count) for count in counts]),
        np.concatenate(ends),
    )


def _stations(lamella: Lamella) -> Floats:
    """Ends of the cells: the cut ends, the nodes between them, and equal steps in each bay."""
    inside = (lamella.stations > lamella.start) & (lamella.stations < lamella.end)
    bays = np.r_[lamella.start, lamella.stations[inside], lamella.end]
    steps = np.arange(_CELLS_PER_BAY * (len(bays) - 1) + 1) / _CELLS_PER_BAY
    return np.asarray(np.interp(steps, np.arange(len(bays)), bays))


def _candidates(cells: _Cells) -> tuple[Indices, Indices]:
    """Pairs of cells with overlapping boxes; neighbours along a strip share an edge and are none.

    The pair's first cell belongs to the strip that comes first.
    """
    from scipy.spatial import cKDTree

    low, high = cells.corners.min(axis=1), cells.corners.max(axis=1)
    reach = float(np.linalg.norm(high - low, axis=1).max())
    pairs = cKDTree((low + high) / 2.0).query_pairs(reach, output_type="ndarray")
    first, second = np.sort(pairs, axis=1).T
    overlap = ((low[first] <= high[second]) & (low[second] <= high[first])).all(axis=1)
    first, second = first[overlap], second[overlap]
    own = cells.strip[first] == cells.strip[second]
    beside = own & (np.abs(cells.place[first] - cells.place[second]) <= 1)
    order = np.lexsort((second[~beside], first[~beside]))
    return first[~beside][order], second[~beside][order]


# ---- where cells meet --------------------------------------------------------------------------


def _meetings(a: Floats, b: Floats) -> tuple[Mask, Points]:
    """(n,) whether cells *a* and *b* (n, 4, 3) meet, and (n, 3) one point where they do."""
    hit, point = np.zeros(len(a), dtype=bool), np.zeros((len(a), 3))
    for edges_of, triangles_of in ((a, b), (b, a)):
        for edge in _EDGES:
            for triangle in _TRIANGLES:
                start, end = edges_of[:, edge[0]], edges_of[:, edge[1]]
                crosses, where = _pierces(start, end, triangles_of[:, triangle])
                point[crosses & ~hit] = where[crosses & ~hit]
                hit |= crosses
    return hit, point


def _pierces(start: Points, end: Points, triangle: Floats) -> tuple[Mask, Points]:
    """Whether segments (n, 3) pierce triangles (n, 3, 3), and where their lines meet the planes."""
    along, origin = end - start, triangle[:, 0]
    side, other = triangle[:, 1] - origin, triangle[:, 2] - origin
    across = np.cross(along, other)
    volume = np.einsum("nc,nc->n", side, across)
    inverse = np.divide(1.0, volume, out=np.zeros_like(volume), where=volume != 0.0)
    offset = start - origin
    u = np.einsum("nc,nc->n", offset, across) * inverse
    turned = np.cross(offset, side)
    v = np.einsum("nc,nc->n", along, turned) * inverse
    share = np.einsum("nc,nc->n", other, turned) * inverse
    inside = (u >= 0.0) & (v >= 0.0) & (u + v <= 1.0) & (share >= 0.0) & (share <= 1.0)
    return inside & (inverse != 0.0), start + share[:, None] * along


# ---- slots -------------------------------------------------------------------------------------


def _at_a_shared_slot(
    cells: _Cells, parts: Sequence[FlatPart], first: Indices, second: Indices, points: Points
) -> Mask:
    """(n,) whether a meeting lies within the reach of one node's slots on both strips."""
    (node_a, gap_a), (node_b, gap_b) = (
        _nearest_slot(cells, parts, cell, points) for cell in (first, second)
    )
    return np.asarray((node_a == node_b) & (gap_a <= 0.0) & (gap_b <= 0.0))


def _nearest_slot(
    cells: _Cells, parts: Sequence[FlatPart], cell: Indices, points: Points
) -> tuple[Indices, Floats]:
    """(n,) number of the node of the nearest slot (-1 for none), and how far out of its reach."""
    names = {
        name: i for i, name in enumerate(dict.fromkeys(s.node for p in parts for s in p.slots))
    }
    x = _along(cells.corners[cell], cells.x[cell], points)
    node, gap = np.full(len(cell), -1), np.full(len(cell), np.inf)
    for strip in np.unique(cells.strip[cell]):
        slots, here = parts[strip].slots, cells.strip[cell] == strip
        if slots:
            centre = np.array([slot.x for slot in slots])
            reach = [slot.width / 2.0 + slot_reach(slot, parts[strip].thickness) for slot in slots]
            nearest = np.abs(x[here, None] - centre).argmin(axis=1)
            node[here] = np.array([names[slot.node] for slot in slots])[nearest]
            gap[here] = np.abs(x[here] - centre[nearest]) - np.array(reach)[nearest]
    return node, gap


def _along(corners: Floats, x: Floats, points: Points) -> Floats:
    """(n,) positions along their strips of *points* (n, 3) in cells, mm."""
    start, end = corners[:, :2].mean(axis=1), corners[:, 2:].mean(axis=1)
    run = end - start
    share = np.einsum("nc,nc->n", points - start, run) / np.einsum("nc,nc->n", run, run)
    return np.asarray(x[:, 0] + np.clip(share, 0.0, 1.0) * (x[:, 1] - x[:, 0]))
