"""Flat parts: what the machine cuts and engraves."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise

from fabrication.cut import Slot, area, outline
from fabrication.joints import Joint
from fabrication.structures import Structure
from fabrication.unroll import Development, unroll
from gridshell import SettingError
from gridshell.arrays import Floats


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
    outline : (k, 2) closed, counter-clockwise, strip coordinates, mm.
    slots : in order along the strip.
    labels : the own mark and the partner's mark at each slot.
    width, thickness : mm.
    development : where it came from.
    """

    mark: str
    outline: Floats
    slots: tuple[Slot, ...]
    labels: tuple[Label, ...]
    width: float
    thickness: float
    development: Development

    @property
    def length(self) -> float:
        """Developed length, mm."""
        return self.development.length

    @property
    def area(self) -> float:
        """Net area after cutting, mm2."""
        return area(self.outline)


def flat_parts(structure: Structure, joint: Joint) -> tuple[FlatPart, ...]:
    """One part per lamella, in the structure's order.

    Raises
    ------
    SettingError
        When slots run into each other or out of the strip.
    """
    cuts = joint.cuts(structure)
    width, thickness = structure.profile.width, structure.profile.thickness
    parts = []
    for lamella in structure.lamellas:
        slots = cuts[lamella.mark]
        _require_room(lamella.mark, slots, lamella.length)
        developed = unroll(lamella, width)
        parts.append(
            FlatPart(
                mark=lamella.mark,
                outline=outline(developed.length, width, slots),
                slots=slots,
                labels=_labels(lamella.mark, developed, slots, width),
                width=width,
                thickness=thickness,
                development=developed,
            )
        )
    return tuple(parts)


def _require_room(mark: str, slots: Sequence[Slot], length: float) -> None:
    """Refuse slots that run into each other or out of the strip: there is no part to cut."""
    walls = [0.0, *(w for s in slots for w in (s.x - s.width / 2, s.x + s.width / 2)), length]
    for i, (a, b) in enumerate(pairwise(walls)):
        if i % 2 == 0 and not a < b:
            beside = [s.node for s in slots[max(0, i // 2 - 1) : i // 2 + 1]]
            raise SettingError(
                "A slot runs into the next one or out of its strip",
                where=f"{mark}, {' and '.join(beside)}",
                value=f"{b - a:.2f} mm between them",
                limit="> 0",
                advice="fewer lamellas, a thinner strip, or a longer overhang",
            )


def _labels(
    mark: str, developed: Development, slots: Sequence[Slot], width: float
) -> tuple[Label, ...]:
    """Partner marks in the uncut half behind each slot; the own mark beside the first node."""
    height = min(width / 8.0, 10.0)
    labels = []
    for slot in slots:
        behind = 0.2 * width if slot.edge.value == "upper" else 0.8 * width
        labels.append(Label(slot.partner, slot.x, behind, height))
    first = developed.node_x[0]
    following = developed.node_x[1] if len(developed.node_x) > 1 else developed.length
    labels.insert(0, Label(mark, (first + following) / 2.0, width / 2.0, 1.5 * height))
    return tuple(labels)
