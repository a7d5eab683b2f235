"""What is cut of one material, as files for machines take it: equal parts told once."""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass

from fabrication.flattening import corners
from fabrication.grouping import equal_groups
from fabrication.nesting import NestedSheet, SheetPart
from fabrication.parts import FlatPart
from fabrication.stock import Material

_SAME = 3
"""Digits behind the point, mm, to which equal parts agree."""

_TURNED = 0.01
"""Between corners of plates that are equal once they are turned, mm."""


@dataclass(frozen=True, eq=False)
class CutSet:
    """Flat parts of one material.

    Parameters
    ----------
    kind : what they are: "strips", "star-washers", "splices", "panels", ...
    parts : as often as they are built.
    """

    kind: str
    material: Material
    parts: tuple[SheetPart, ...]


@dataclass(frozen=True, eq=False)
class Counted:
    """A distinct part.

    Parameters
    ----------
    part : the first of its kind.
    mark : what is engraved on it, its name in files.
    quantity : how many are built.
    marks : of all of them, in order.
    alike : whether all carry the same texts.
    """

    part: SheetPart
    mark: str
    quantity: int
    marks: tuple[str, ...]
    alike: bool


def cut_set(kind: str, material: Material, sheets: Sequence[NestedSheet]) -> CutSet:
    """All parts that lie on *sheets*."""
    parts = tuple(p.part for sheet in sheets for p in sheet.placements)
    return CutSet(kind, material, parts)


def counted(cut: CutSet) -> tuple[Counted, ...]:
    """The distinct parts of a set: strips by their marks, all others by their shape.

    Every strip has its own place, and its partners' marks on it; of a washer or a splice plate any
    goes to any place.
    """
    groups: dict[tuple[object, ...], list[SheetPart]] = {}
    for part, turned in zip(cut.parts, _turned_alike(cut.parts), strict=True):
        groups.setdefault(_key(part, turned), []).append(part)
    return tuple(_counted(group) for group in groups.values())


def _turned_alike(parts: Sequence[SheetPart]) -> list[str]:
    """A name for every part: the same for plates without holes that are equal once turned."""
    names = [""] * len(parts)
    plain = [k for k, p in enumerate(parts) if not isinstance(p, FlatPart) and not len(p.circles)]
    outlines = [corners(parts[k].outline) for k in plain]
    for group in equal_groups(outlines, _TURNED, prefix="T"):
        for member in group.members:
            names[plain[member.index]] = group.name
    return names


def _key(part: SheetPart, turned: str) -> tuple[object, ...]:
    if isinstance(part, FlatPart):
        return (part.mark,)
    thickness = round(part.thickness, _SAME)
    if turned:
        return (thickness, turned)
    lines = (part.outline.round(_SAME) + 0.0, part.circles.round(_SAME) + 0.0)
    return (thickness, *(line.tobytes() for line in lines))


def _counted(group: Sequence[SheetPart]) -> Counted:
    first = group[0]
    texts = Counter(tuple(label.text for label in part.labels) for part in group)
    return Counted(
        part=first,
        mark=first.labels[0].text if first.labels else first.mark,
        quantity=len(group),
        marks=tuple(dict.fromkeys(part.mark for part in group)),
        alike=len(texts) == 1,
    )
