"""Do the strips go together? The volume two neighbouring strips would share at their nodes.

Around a node both strips are taken with their drawn slots, as thin solids bent and twisted into
place, and intersected. The pieces are meshed independently of the CAD solids: each is extruded
from its flat outline, refined, and moved through the strip's own map.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import manifold3d
import numpy as np

from fabrication.lamella import Lamella
from fabrication.parts import FlatPart
from fabrication.structures import Structure
from gridshell.arrays import Floats

_REACH = 2.0
"""Half length of the piece around a node, in slot widths plus thicknesses."""


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
    slots = {(part.mark, slot.node): slot for part in parts for slot in part.slots}
    worst, largest, tried = "", 0.0, 0
    for node in structure.nodes:
        if not node.regular:
            continue
        pieces = []
        for crossing in node.crossings:
            lamella, part = structure.lamellas[crossing.lamella], parts[crossing.lamella]
            slot = slots[part.mark, node.name]
            reach = _REACH * (slot.width + part.thickness)
            pieces.append(strip_piece(lamella, part, slot.x - reach, slot.x + reach))
        clash = (pieces[0] ^ pieces[1]).volume()
        tried += 1
        if clash > largest:
            worst, largest = node.name, clash
    return Fit(largest, worst, tried)


def strip_piece(
    lamella: Lamella, part: FlatPart, start: float, end: float
) -> manifold3d.Manifold:
    """The piece of a built strip between *start* and *end* (x on the flat strip, mm)."""
    window = manifold3d.CrossSection.square((end - start, part.width)).translate((start, 0.0))
    flat = window ^ manifold3d.CrossSection([part.outline.tolist()])
    block = manifold3d.Manifold.extrude(flat, part.thickness)
    block = block.refine_to_length(part.width / 40.0)

    def bend(points: Floats) -> Floats:
        x, up, through = np.asarray(points, dtype=np.float64).T
        # along, up, through is right-handed and t, n, -b as well
        return lamella.place(x + lamella.start, part.thickness / 2.0 - through, up - part.width / 2.0)

    return block.warp_batch(bend)
