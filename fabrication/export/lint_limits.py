"""What of a drawing a process cannot cut: small holes, thin webs, narrow slots, edges too near."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
import shapely

from fabrication.export.lint_pieces import facing, pieces_of
from fabrication.export.lint_shapes import DrawnParts
from fabrication.finding import Finding, Severity
from fabrication.shop import Process
from gridshell.arrays import Floats, Indices

_ROUNDING = 0.03
"""Of arcs that are checked as lines, both sides, mm."""

_WALLS = 0.5
"""Length of walls over their distance from which on they are a slot and not an arc's two sides."""


def limit_findings(parts: DrawnParts, process: Process) -> Iterator[Finding]:
    """One finding per part and limit, with the worst place."""
    if not len(parts.shapes):
        return
    grown = 2.0 * process.offset
    yield from _holes(parts, process)
    yield from _beside(parts, process, grown)
    yield from _edges(parts, process.min_edge + grown)


def _beside(parts: DrawnParts, process: Process, grown: float) -> Iterator[Finding]:
    """Webs between cuts that are no round holes, and slots in one outline."""
    reach = max(process.min_web + grown, process.min_slot)
    angular = np.flatnonzero(parts.diameters == 0.0)
    if reach <= 0.0 or not len(angular):
        return
    near = facing(pieces_of([parts.contours[k] for k in angular.tolist()]), reach)
    first, second = angular[near.first], angular[near.second]
    web = (parts.part[first] == parts.part[second]) & near.material
    slot = (first == second) & ~near.material & (near.length > _WALLS * near.distance)
    for mask, code, limit in (
        (web, "thin-web", process.min_web + grown),
        (slot, "narrow-slot", process.min_slot - grown),
    ):
        small = mask & (near.distance < limit - _ROUNDING)
        of = parts.part[first[small]]
        yield from _one_per_part(parts, of, near.distance[small], near.at[small], code, limit)


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


def _edges(parts: DrawnParts, limit: float) -> Iterator[Finding]:
    """Round holes too near to any other cut of their part."""
    holes = np.flatnonzero((parts.diameters > 0.0) & (parts.depth % 2 == 1))
    if not len(holes) or limit <= 0.0:
        return
    middle = shapely.centroid(parts.shapes[holes])
    radius = parts.diameters[holes] / 2.0
    angular = np.flatnonzero(parts.diameters == 0.0)
    pieces = pieces_of([parts.contours[k] for k in angular.tolist()])
    i, j = pieces.tree.query(middle, predicate="dwithin", distance=radius + limit)
    own = parts.part[angular[pieces.owner[j]]] == parts.part[holes[i]]
    i, j = i[own], j[own]
    to_cut = shapely.distance(middle[i], pieces.lines[j]) - radius[i]
    widest = radius + float(radius.max()) + limit
    k, m = shapely.STRtree(middle).query(middle, predicate="dwithin", distance=widest)
    pair = (k != m) & (parts.part[holes[k]] == parts.part[holes[m]])
    k, m = k[pair], m[pair]
    to_hole = shapely.distance(middle[k], middle[m]) - radius[k] - radius[m]
    hole, web = np.concatenate([i, k]), np.concatenate([to_cut, to_hole])
    small = web < limit - _ROUNDING
    at = shapely.get_coordinates(middle)[hole[small]]
    of = parts.part[holes[hole[small]]]
    yield from _one_per_part(parts, of, web[small], at, "near-edge", limit)
