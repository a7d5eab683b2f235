"""What of a drawing a process cannot cut: small holes, thin webs, narrow slots, edges too near."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
import shapely

from fabrication.export.lint_pieces import Facing, Pieces, facing, pieces_of
from fabrication.export.lint_shapes import DrawnParts
from fabrication.finding import Finding, Severity
from fabrication.shop import Process
from gridshell.arrays import Mask, Floats, Indices

_ROUNDING = 0.03
"""Of arcs that are checked as lines, both sides, mm."""


def limit_findings(parts: DrawnParts, process: Process) -> Iterator[Finding]:
    """One finding per part and limit, with the worst place."""
    if not len(parts.shapes):
        return
    grown = 2.0 * process.offset
    yield from _holes(parts, process)
    pieces = pieces_of(parts.contours)
    reach = max(process.min_web + grown, process.min_slot, process.min_edge + grown)
    if reach <= 0.0:
        return
    near = facing(pieces, reach)
    same = parts.part[near.first] == parts.part[near.second]
    round_ = parts.diameters > 0.0
    hole = round_ & (parts.depth % 2 == 1)
    of_hole = hole[near.first] | hole[near.second]
    web, slot = same & near.material & ~of_hole, same & ~near.material
    slot &= near.first == near.second
    slot &= ~round_[near.first]
    yield from _worst(parts, near, web, "thin-web", process.min_web + grown)
    yield from _worst(parts, near, slot, "narrow-slot", process.min_slot - grown)
    yield from _edges(parts, pieces, hole, process.min_edge + grown)


def _holes(parts: DrawnParts, process: Process) -> Iterator[Finding]:
    limit = process.min_hole - 2.0 * process.offset
    for k in np.flatnonzero((parts.depth % 2 == 1) & (parts.diameters > 0.0)).tolist():
        diameter = float(parts.diameters[k])
        if diameter < limit - _ROUNDING:
            name = parts.contours[parts.part[k]].name
            message = (
                f"A hole of {name} is {diameter:.2f} mm wide, the {process.name} cuts "
                f"{limit:g} mm. Use {limit:g} mm, or drill it."
            )
            yield Finding("small-hole", Severity.ERROR, name, diameter, limit, "mm", message)


_ADVICE = {
    "thin-web": "mm of material are left between two cuts of",
    "narrow-slot": "mm wide is a slot of",
    "near-edge": "mm of material are left beside a hole of",
}


def _worst(
    parts: DrawnParts, near: Facing, mask: Mask, code: str, limit: float
) -> Iterator[Finding]:
    mask = mask & (near.distance < limit - _ROUNDING)
    of = parts.part[near.first[mask]]
    yield from _one_per_part(parts, of, near.distance[mask], near.at[mask], code, limit)


def _one_per_part(
    parts: DrawnParts, of: Indices, distance: Floats, at: Floats, code: str, limit: float
) -> Iterator[Finding]:
    order = np.lexsort((distance, of))
    _, first = np.unique(of[order], return_index=True)
    for k in order[first].tolist():
        name, (x, y) = parts.contours[of[k]].name, at[k].tolist()
        message = (
            f"Only {distance[k]:.2f} {_ADVICE[code]} {name} near ({x:.1f}, {y:.1f}). "
            f"Use {limit:g} mm or more."
        )
        value = float(distance[k])
        yield Finding(code, Severity.ERROR, name, value, limit, "mm", message)


def _edges(parts: DrawnParts, pieces: Pieces, hole: Mask, limit: float) -> Iterator[Finding]:
    """Round holes too near to any other cut of their part."""
    holes = np.flatnonzero(hole)
    if not len(holes) or limit <= 0.0:
        return
    middle = shapely.centroid(parts.shapes[holes])
    radius = parts.diameters[holes] / 2.0
    lines = pieces.geometries
    i, j = shapely.STRtree(lines).query(middle, predicate="dwithin", distance=radius + limit)
    other = pieces.owner[j] != holes[i]
    other &= parts.part[pieces.owner[j]] == parts.part[holes[i]]
    i, j = i[other], j[other]
    web = shapely.distance(middle[i], lines[j]) - radius[i]
    small = web < limit - _ROUNDING
    at = shapely.get_coordinates(middle)[i[small]]
    of = parts.part[holes[i[small]]]
    yield from _one_per_part(parts, of, web[small], at, "near-edge", limit)
