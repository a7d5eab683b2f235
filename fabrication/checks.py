"""Checks of a structure against its material and its own cuts. Loads and buckling are not checked.

* the material, bent and twisted into place: see ``strength`` and ``stress_checks``
* slots: material of at least one thickness between two slots and beside the cut ends,
  and behind each slot
* strips that pass through each other away from their slots: see ``collisions``
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from itertools import pairwise

from fabrication.collisions import collisions
from fabrication.finding import Finding, Severity
from fabrication.lamella import Lamella
from fabrication.parts import FlatPart
from fabrication.strength import BayStress, bay_stress
from fabrication.stress_checks import stress_findings
from fabrication.structures import Structure


def check(
    structure: Structure, parts: Sequence[FlatPart], stress: BayStress | None = None
) -> tuple[Finding, ...]:
    """All findings about lamellas and flat parts, in the structure's order, then about pairs.

    Parameters
    ----------
    stress : of all bays, where it is known already.
    """
    stress = bay_stress(structure, parts) if stress is None else stress
    found: list[Finding] = []
    material = stress_findings(structure, stress)
    for lamella, part, worn in zip(structure.lamellas, parts, material, strict=True):
        found += worn
        found += _slots(part)
        if lamella.closed:
            found.append(_seam(lamella))
    return (*found, *collisions(structure, parts))


def _slots(part: FlatPart) -> Iterator[Finding]:
    for a, b in pairwise(part.slots):
        web = (b.x - b.spread) - (a.x + a.spread)
        if web < part.thickness:
            yield Finding(
                "slot-spacing",
                Severity.ERROR,
                f"{part.mark} {a.node}-{b.node}",
                web,
                part.thickness,
                "mm",
                f"Only {web:.2f} mm are left between the slots for {a.partner} and {b.partner} in "
                f"{part.mark}. Use fewer lamellas or a thinner strip.",
            )
    for slot in sorted(part.slots, key=lambda s: -s.reach)[:1]:
        web = part.width - slot.reach
        if web < part.thickness:
            yield Finding(
                "slot-depth",
                Severity.ERROR,
                f"{part.mark} {slot.node}",
                web,
                part.thickness,
                "mm",
                f"The slots of {part.mark} leave {web:.2f} mm of its width, for {slot.partner} as "
                "elsewhere. Use a smaller depth clearance or a wider strip.",
            )
    for slot in dict.fromkeys(part.slots[:1] + part.slots[-1:]):
        web = min(slot.x, part.length - slot.x) - slot.spread
        if web < part.thickness:
            yield Finding(
                "slot-at-end",
                Severity.ERROR,
                f"{part.mark} {slot.node}",
                web,
                part.thickness,
                "mm",
                f"The slot for {slot.partner} leaves {web:.2f} mm at the end of {part.mark}. "
                "Use a longer overhang.",
            )


def _seam(lamella: Lamella) -> Finding:
    return Finding(
        "seam",
        Severity.INFO,
        lamella.mark,
        lamella.axis.length,
        lamella.length,
        "mm",
        f"{lamella.mark} is closed: its ends meet half-way between its last and its first node "
        "and need a splice there.",
    )
