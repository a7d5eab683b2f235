"""Flat parts: what the machine cuts and engraves."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from itertools import pairwise

import numpy as np

from fabrication.cut import (
    SQUARE,
    Cuts,
    Drill,
    Edge,
    Hole,
    Relief,
    Slot,
    area,
    face_outlines,
    outline,
)
from fabrication.jointed import Jointed
from fabrication.joints import Joint
from fabrication.stock import hollow_area, wall_of
from fabrication.strip_picture import strip_svg
from fabrication.structures import Structure
from fabrication.unroll import Development, unroll
from gridshell import SettingError
from gridshell.arrays import Floats
from gridshell.picture import card, limits

LETTER = 0.9
"""Width of a letter over its height."""


@dataclass(frozen=True)
class Label:
    """A text engraved on a part, centred on (x, y) in the part's coordinates, mm.

    *angle* turns it counter-clockwise, radians.
    """

    text: str
    x: float
    y: float
    height: float
    angle: float = 0.0


@dataclass(frozen=True, eq=False)
class FlatPart:
    """A straight strip ready for cutting.

    Parameters
    ----------
    mark : the lamella's.
    outline : (k, 2), or (k, 3) with bulges where slots have rounded floors: closed,
        counter-clockwise, strip coordinates, mm.
    slots : in order along the strip.
    labels : the own mark and the partner's mark at each slot.
    width, thickness : mm.
    development : where it came from.
    holes : in order along the strip.
    bevels : how much longer the near face is than the far one at either end, see ``Cuts``, mm.
    wall : of a hollow section, mm; 0 for a solid strip.
    drills : through the narrow walls of a hollow section, in order along it.
    quantity : how many equal ones are built.
    """

    mark: str
    outline: Floats
    slots: tuple[Slot, ...]
    labels: tuple[Label, ...]
    width: float
    thickness: float
    development: Development
    holes: tuple[Hole, ...] = ()
    bevels: tuple[float, float] = (0.0, 0.0)
    wall: float = 0.0
    drills: tuple[Drill, ...] = ()
    quantity: int = 1

    @property
    def length(self) -> float:
        """Developed length, mm."""
        return self.development.length

    @property
    def area(self) -> float:
        """Net area after cutting, without bevels, mm2."""
        return area(self.outline) - sum(hole.area for hole in self.holes)

    @property
    def circles(self) -> Floats:
        """(m, 3) rows x, y, diameter of the holes, mm."""
        return np.array([[h.x, h.y, h.diameter] for h in self.holes]).reshape(-1, 3)

    @property
    def faces(self) -> tuple[Floats, Floats]:
        """Outlines of the near (+b) and of the far face; the outline itself at square ends."""
        return face_outlines(self.outline, self.bevels)

    @property
    def volume(self) -> float:
        """Of the finished strip, mm3."""
        if self.wall:
            drilled = 2.0 * self.wall * sum(drill.area for drill in self.drills)
            return self.length * hollow_area(self.width, self.thickness, self.wall) - drilled
        bevelled = sum(abs(run) for run in self.bevels) * self.width / 2.0
        return (self.area - bevelled) * self.thickness

    def _repr_html_(self) -> str:
        """For notebooks: the flat pattern; families are told apart by the mark."""
        return card(
            f"Strip {self.mark}",
            _figures(self),
            picture=strip_svg(self, 2 if self.mark.startswith("B") else 1),
            width=1100,
        )


def flat_parts(structure: Structure, joint: Joint) -> tuple[FlatPart, ...]:
    """One part per strip that *joint* makes on *structure*; see :func:`parts_of`."""
    return parts_of(joint.build(structure))


def parts_of(jointed: Jointed, relief: Relief = SQUARE, *, copies: int = 1) -> tuple[FlatPart, ...]:
    """One part per strip, in their order.

    Parameters
    ----------
    relief : of the floors of all slots.
    copies : how often every strip is built.

    Raises
    ------
    SettingError
        When slots run into each other or out of the strip, or a tube is slotted.
    """
    profile = jointed.strips.profile
    wall = wall_of(profile)
    width, thickness = profile.width, profile.thickness
    parts = []
    passing = uncut_nodes(jointed)
    for lamella in jointed.strips.lamellas:
        cuts = jointed.cuts[lamella.mark]
        slots = tuple(replace(slot, relief=relief) for slot in cuts.slots)
        _require_room(lamella.mark, slots, lamella.length)
        _require_whole(lamella.mark, cuts, wall)
        developed = unroll(lamella, width)
        parts.append(
            FlatPart(
                mark=lamella.mark,
                outline=outline(developed.length, width, slots),
                slots=slots,
                labels=_labels(lamella.mark, developed.length, cuts, passing[lamella.mark], width),
                width=width,
                thickness=thickness,
                development=developed,
                holes=cuts.holes,
                bevels=cuts.bevels,
                wall=wall,
                drills=cuts.drills,
                quantity=copies,
            )
        )
    return tuple(parts)


def uncut_nodes(jointed: Jointed) -> dict[str, list[tuple[float, str, str]]]:
    """By strip: x of every node where nothing is cut, what meets it there, and the node's name."""
    strips = jointed.strips.lamellas
    taken = {
        mark: np.array([*(s.x for s in cuts.slots), *(h.x for h in cuts.holes)])
        for mark, cuts in jointed.cuts.items()
    }
    found: dict[str, list[tuple[float, str, str]]] = {strip.mark: [] for strip in strips}
    for node in jointed.strips.nodes:
        for crossing in node.crossings:
            strip = strips[crossing.lamella]
            x = crossing.station - strip.start
            others = [strips[c.lamella].mark for c in node.crossings if c is not crossing]
            free = np.abs(taken[strip.mark] - x).min(initial=np.inf) > 1.0
            if free and others and 0.0 < x < strip.length:
                found[strip.mark].append((x, " ".join(others), node.name))
    return found


def _require_room(mark: str, slots: Sequence[Slot], length: float) -> None:
    """Refuse slots that run into each other or out of the strip: there is no part to cut."""
    walls = [0.0, *(w for s in slots for w in (s.x - s.spread, s.x + s.spread)), length]
    for i, (a, b) in enumerate(pairwise(walls)):
        if i % 2 == 0 and not a < b:
            beside = [s.node for s in slots[max(0, i // 2 - 1) : i // 2 + 1]]
            raise SettingError(
                "A slot runs into the next one or out of its strip",
                where=f"{mark}, {' and '.join(beside)}",
                value=f"{b - a:.2f} mm between them",
                limit="> 0",
                advice="fewer lamellas, a thinner strip, a longer overhang; lengths are in mm",
            )


def _require_whole(mark: str, cuts: Cuts, wall: float) -> None:
    """Refuse what cannot be cut: slots and side holes of tubes, drills through solid strips."""
    across = [*cuts.slots, *cuts.holes] if wall else list(cuts.drills)
    if across or (wall and cuts.bevels != (0.0, 0.0)):
        raise SettingError(
            "This joint does not go with the section of the strips",
            where=mark,
            value="a hollow section" if wall else "a solid strip",
            limit="hinges for hollow sections, all other joints for solid strips",
            advice="kind = 'hinged' with a wall, or no wall",
        )


def _figures(part: FlatPart) -> list[tuple[str, str]]:
    """What a person wants to know of a strip, as text; empty where there is none."""
    widths = np.array([slot.width for slot in part.slots])
    cuts = (("slot", len(part.slots)), ("hole", len(part.holes)), ("drilling", len(part.drills)))
    bevels = " and ".join(f"{run:.2f}" for run in part.bevels)
    wall = f", wall {part.wall:g}" if part.wall else ""
    return [
        ("Length", f"{part.length:.1f} mm"),
        ("Section", f"{part.width:g} x {part.thickness:g} mm{wall}"),
        *((f"{name.capitalize()}s", f"{count}" if count else "") for name, count in cuts),
        ("Slot width", limits(widths, "mm")),
        ("Near face longer by", f"{bevels} mm" if any(part.bevels) else ""),
        ("Volume", f"{part.volume / 1e3:.1f} cm3"),
        ("Built", f"{part.quantity} times" if part.quantity > 1 else ""),
    ]


def _labels(
    mark: str,
    length: float,
    cuts: Cuts,
    passing: Sequence[tuple[float, str, str]],
    width: float,
) -> tuple[Label, ...]:
    """The own mark in the first free place, what meets the strip, and where it is drilled."""
    beside = tuple(_passing_labels(passing, width))
    return (
        _own_label(mark, length, cuts, beside, width),
        *_slot_labels(cuts.slots, width),
        *beside,
        *_drill_ticks(cuts.drills, width),
    )


def _slot_labels(slots: Sequence[Slot], width: float) -> Iterator[Label]:
    """Partner marks in the uncut half behind each slot."""
    largest = min(width / 8.0, 10.0)
    for k, slot in enumerate(slots):
        beside = [abs(slot.x - s.x) for s in (*slots[max(k - 1, 0) : k], *slots[k + 1 : k + 2])]
        room = 0.9 * min(beside, default=np.inf) / (LETTER * len(slot.partner))
        behind = 0.2 * width if slot.edge is Edge.UPPER else 0.8 * width
        yield Label(slot.partner, slot.x, behind, min(largest, room))


def _passing_labels(passing: Sequence[tuple[float, str, str]], width: float) -> Iterator[Label]:
    """What is fixed to the side of a strip, across it where its middle must come."""
    height = min(width / 8.0, 10.0)
    for x, others, _ in passing:
        small = min(height, 0.4 * width / (LETTER * len(others)))
        yield Label(others, x, width / 2.0, small, np.pi / 2.0)


def _drill_ticks(drills: Sequence[Drill], width: float) -> Iterator[Label]:
    """A short line at either edge where the middle of a drill comes."""
    height = min(width / 8.0, 5.0)
    for drill in drills:
        for y in (height, width - height):
            yield Label("|", drill.x, y, height)


def _own_label(
    mark: str, length: float, cuts: Cuts, beside: Sequence[Label], width: float
) -> Label:
    """The strip's own mark half-way up, between the first two cuts or marks it fits between."""
    taken = [(s.x - s.spread, s.x + s.spread) for s in cuts.slots]
    taken += [(h.x - h.diameter / 2.0, h.x + h.diameter / 2.0) for h in cuts.holes]
    taken += [(one.x - one.height, one.x + one.height) for one in beside]
    walls = [(0.0, 0.0), *sorted(taken), (length, length)]
    height = 1.5 * min(width / 8.0, 10.0)
    needed = 2.0 * (len(mark) + 1.0) * LETTER * height
    free, reached = [], 0.0
    for low, high in walls:
        free.append((reached, low))
        reached = max(reached, high)
    between = free[1:-1] or free
    fitting = [gap for gap in between if gap[1] - gap[0] >= needed]
    low, high = fitting[0] if fitting else max(between, key=lambda gap: gap[1] - gap[0])
    return Label(
        mark, (low + high) / 2.0, width / 2.0, height * min(1.0, 2.0 * (high - low) / needed)
    )
