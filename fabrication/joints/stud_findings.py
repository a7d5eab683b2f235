"""What a person should know about studs on two levels: room, length, bolts, bending off the net."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import numpy as np

from fabrication.arrangement import Arrangement
from fabrication.bolts import EDGE_DISTANCE
from fabrication.finding import Finding, Severity
from fabrication.node import Node
from fabrication.structures import Structure
from gridshell.arrays import Floats

_SAMPLES_PER_BAY = 8


def stud_findings(
    design: Structure,
    made: Arrangement,
    nodes: Sequence[Node],
    *,
    need: Floats,
    room: Floats,
    level: float,
    length: float,
    hole: float,
    spacing: float,
    fit: float,
) -> Iterator[Finding]:
    """All of them; none where there is no node to put a stud in.

    Parameters
    ----------
    need, room : (n,) of every stud, mm; what the strips leave, before the play.
    level : of the strips' middles from the net, mm.
    length : of the studs, mm.
    hole : diameter of the bolts' holes, mm; 0 where there are none.
    spacing : of the two strips of an axis, mm.
    fit : between a stud and each strip, mm.
    """
    if not nodes:
        return
    yield Finding(
        "stud-assembly",
        Severity.INFO,
        "all nodes",
        float(len(nodes)),
        0.0,
        "studs",
        "The studs only fit once all strips of both levels are bent into place: build on a "
        "falsework, lower level first.",
    )
    yield from _room(nodes, need, room - 2.0 * fit, spacing)
    yield from _length(2.0 * level + design.profile.width, level, length)
    if hole and design.profile.width / 2.0 < EDGE_DISTANCE * hole:
        yield Finding(
            "bolt-edge",
            Severity.ERROR,
            "all nodes",
            design.profile.width / 2.0,
            EDGE_DISTANCE * hole,
            "mm",
            f"The holes of {hole:g} mm lie {design.profile.width / 2.0:g} mm from the edges of "
            f"the strips, {EDGE_DISTANCE * hole:.1f} mm are needed. Use a smaller bolt.",
        )
    yield _bend(design, made, level)


def _room(nodes: Sequence[Node], need: Floats, room: Floats, spacing: float) -> Iterator[Finding]:
    short = need - room
    worst = int(np.argmax(np.where(room <= 0.0, np.inf, short)))
    if short[worst] <= 0.0 < room[worst]:
        return
    node, wanted, left = nodes[worst].name, float(need[worst]), float(room[worst])
    told = f", which needs {wanted:.2f} mm" if wanted > 0.0 else ""
    yield Finding(
        "stud-room",
        Severity.ERROR,
        node,
        wanted,
        left,
        "mm",
        f"The strips leave {max(left, 0.0):.2f} mm for the stud at {node}{told}. Use a smaller "
        f"stud or a spacing of {np.ceil(spacing + max(wanted, 5.0) - left):g} mm.",
    )


def _length(both: float, level: float, length: float) -> Iterator[Finding]:
    if length > both + 1e-9:
        yield Finding(
            "stud-long",
            Severity.WARNING,
            "all nodes",
            length,
            both,
            "mm",
            f"The studs are {length:g} mm long and stand out of both levels, which are "
            f"{both:g} mm high together. Use {both:g} mm.",
        )
    elif length < 2.0 * level:
        yield Finding(
            "stud-short",
            Severity.ERROR,
            "all nodes",
            length,
            both,
            "mm",
            f"The studs are {length:g} mm long and hold less than half of either level, which "
            f"are {both:g} mm high together. Use {both:g} mm.",
        )


def _bend(design: Structure, made: Arrangement, level: float) -> Finding:
    """Bending about the strong axis, which the distance from the net costs."""
    profile = design.profile
    largest, where = 0.0, ""
    for strip in made.strips.lamellas:
        count = _SAMPLES_PER_BAY * max(len(strip.stations), 2)
        _, strong = strip.bending(np.linspace(strip.start, strip.end, count))
        if (most := float(np.abs(strong).max())) >= largest:
            largest, where = most, strip.mark
    stress = profile.material.modulus * largest * profile.width / 2.0
    limit = profile.material.strength
    advice = ""
    if stress > limit:
        nearer = level * limit / stress
        possible = nearer >= profile.width / 2.0
        advice = f" Use level = {np.floor(nearer):g} mm at most, or" if possible else " Use"
        advice += f" strips of {np.floor(profile.width * np.sqrt(limit / stress)):g} mm in width."
    return Finding(
        "level-bend",
        Severity.ERROR if stress > limit else Severity.INFO,
        where,
        stress,
        limit,
        "N/mm2",
        f"At {level:g} mm from the net, {where} bends about its strong axis to a radius of "
        f"{1.0 / max(largest, 1e-12) / 1e3:.1f} m: {stress:.1f} N/mm2, {limit:g} allowed.{advice}",
    )
