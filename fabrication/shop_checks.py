"""What a shop's process cannot cut of flat parts; spacing at one thickness is in ``checks``."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from itertools import pairwise

import numpy as np
import shapely

from fabrication.cut import Edge, Floor, Slot
from fabrication.finding import Finding, Severity
from fabrication.flattening import flattened
from fabrication.nesting import SheetPart
from fabrication.parts import FlatPart
from fabrication.shapes import with_bulges
from fabrication.shop import Process

_ROUNDING = 1e-6


def shop_findings(parts: Sequence[SheetPart], process: Process) -> tuple[Finding, ...]:
    """All findings, part by part; for each kind the worst place of a part.

    Parameters
    ----------
    parts : strips are looked at with their slots and bevels, others by their holes and sizes.
    """
    found: list[Finding] = []
    for part in parts:
        if isinstance(part, FlatPart):
            found += _slots(part, process)
            found += _webs(part, process)
            found += _bevels(part, process)
        found += _holes(part, process)
        found += _bed(part, process)
    return tuple(found)


def _slots(part: FlatPart, process: Process) -> Iterator[Finding]:
    """Slots that the tool does not fit into, and floors it does not cut."""
    for slot in sorted(part.slots, key=lambda s: s.width)[:1]:
        if slot.width < process.min_slot - _ROUNDING:
            more = process.min_slot - slot.width
            yield _found(
                "shop-slot",
                f"{part.mark} {slot.node}",
                slot.width,
                process.min_slot,
                f"The slot for {slot.partner} in {part.mark} is {slot.width:.2f} mm wide; the "
                f"{process.name} needs {process.min_slot:g} mm. Use {more:.2f} mm more clearance, "
                "a thicker strip or a smaller tool.",
            )
    radius = process.relief.radius
    if process.relief.floor is not Floor.DOGBONE:
        return
    for slot in [s for s in part.slots if _inner_radius(s) < radius - _ROUNDING][:1]:
        yield _found(
            "shop-relief",
            f"{part.mark} {slot.node}",
            _inner_radius(slot),
            radius,
            f"The {process.name} leaves corners of {radius:g} mm radius in the slots of "
            f"{part.mark}, which have {_inner_radius(slot):g} mm. Use dogbones of {radius:g} mm.",
            Severity.WARNING,
        )
    meeting = [
        s for s in part.slots if s.relief.floor is Floor.DOGBONE and s.floor is not Floor.DOGBONE
    ]
    for slot in meeting[:1]:
        least = 2.0 * float(np.sqrt(2.0)) * slot.relief.radius
        yield _found(
            "shop-reliefs-meet",
            f"{part.mark} {slot.node}",
            slot.width,
            least,
            f"Two dogbones of {slot.relief.radius:g} mm meet in the slot for {slot.partner} in "
            f"{part.mark}, which gets a round floor. Use a tool of "
            f"{2.0 * slot.width / (2.0 * np.sqrt(2.0)):.2f} mm or less.",
            Severity.INFO,
        )


def _inner_radius(slot: Slot) -> float:
    """Of the corners inside a slot, mm."""
    radii = {
        Floor.SQUARE: 0.0,
        Floor.ROUND: slot.width / 2.0,
        Floor.DOGBONE: slot.relief.radius,
    }
    return radii[slot.floor]


def _webs(part: FlatPart, process: Process) -> Iterator[Finding]:
    """Between slots of one edge, where the shop wants more than one thickness."""
    webs = [
        ((b.x - b.spread) - (a.x + a.spread), a, b)
        for edge in Edge
        for a, b in pairwise([s for s in part.slots if s.edge is edge])
    ]
    for web, a, b in sorted(webs, key=lambda row: row[0])[:1]:
        if part.thickness <= web < process.min_web - _ROUNDING:
            yield _found(
                "shop-web",
                f"{part.mark} {a.node}-{b.node}",
                web,
                process.min_web,
                f"{web:.2f} mm are left between the slots for {a.partner} and {b.partner} in "
                f"{part.mark}; the {process.name} needs {process.min_web:g} mm. Use fewer "
                "lamellas.",
            )


def _bevels(part: FlatPart, process: Process) -> Iterator[Finding]:
    bevel = max(abs(b) for b in part.bevels)
    if bevel > _ROUNDING and not process.bevels:
        angle = float(np.degrees(np.arctan2(bevel, part.thickness)))
        yield Finding(
            "shop-bevel",
            Severity.INFO,
            part.mark,
            angle,
            0.0,
            "deg",
            f"An end of {part.mark} is {angle:.1f} degrees off square, which the {process.name} "
            f"does not cut: grind {bevel:.2f} mm away after cutting.",
        )


def _holes(part: SheetPart, process: Process) -> Iterator[Finding]:
    """Holes that are too small, or too near to another cut."""
    if not len(part.circles):
        return
    x, y, diameter = part.circles.T
    k = int(diameter.argmin())
    if diameter[k] < process.min_hole - _ROUNDING:
        yield _found(
            "shop-hole",
            part.mark,
            float(diameter[k]),
            process.min_hole,
            f"A hole in {part.mark} is {diameter[k]:g} mm wide; the {process.name} cuts "
            f"{process.min_hole:g} mm. Use {process.min_hole:g} mm, or drill it.",
        )
    middle = shapely.points(x, y)
    ring = shapely.LinearRing(flattened(with_bulges(part.outline), closed=True))
    beside = [shapely.distance(middle, ring) - diameter / 2.0]
    i, j = np.triu_indices(len(x), 1)
    between = np.hypot(x[i] - x[j], y[i] - y[j]) - (diameter[i] + diameter[j]) / 2.0
    web = float(np.concatenate([*beside, between]).min())
    if web < process.min_edge - _ROUNDING:
        yield _found(
            "shop-edge",
            part.mark,
            web,
            process.min_edge,
            f"{web:.2f} mm are left beside a hole in {part.mark}; the {process.name} needs "
            f"{process.min_edge:g} mm. Move it by {process.min_edge - web:.2f} mm or make it "
            "smaller.",
        )


def _bed(part: SheetPart, process: Process) -> Iterator[Finding]:
    if process.bed is None:
        return
    for size, room in zip(
        sorted((part.length, part.width), reverse=True),
        sorted(process.bed, reverse=True),
        strict=True,
    ):
        if size > room + _ROUNDING:
            yield _found(
                "shop-bed",
                part.mark,
                size,
                room,
                f"{part.mark} is {size:.1f} mm long or wide, the {process.name} takes {room:g} mm. "
                "Divide it, or ask for a larger machine.",
            )
            return


def _found(
    code: str,
    where: str,
    value: float,
    limit: float,
    message: str,
    severity: Severity = Severity.ERROR,
) -> Finding:
    return Finding(code, severity, where, value, limit, "mm", message)
