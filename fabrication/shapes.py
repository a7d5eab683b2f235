"""Shapes: solids as plain data, each a shape at a place. Equal parts share one shape.

A shape is an outline pushed straight along z. Where it lies is a frame: its x and y, and z across
both.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from fabrication.grouping import Group, instance_frame
from fabrication.materials import Material
from fabrication.outlines import Frame, outline_area
from gridshell.arrays import Floats

Colour = tuple[float, float, float]
"""sRGB, 0 to 1."""


@dataclass(frozen=True, eq=False)
class Shape:
    """A prism in its own coordinates.

    Parameters
    ----------
    mark : of the first body that has it.
    outline : (k, 3) rows x, y, bulge, counter-clockwise, mm; the bulge, tan(sweep / 4), belongs to
        the piece from its corner to the next.
    low, high : where it begins and ends along z, mm.
    openings : outlines of what is left out, rows as those of the outline, counter-clockwise, too.
    """

    mark: str
    outline: Floats
    low: float
    high: float
    openings: tuple[Floats, ...] = ()

    @property
    def volume(self) -> float:
        """Mm3."""
        inside = outline_area(self.outline) - sum(outline_area(o) for o in self.openings)
        return inside * (self.high - self.low)


def circle(radius: float, x: float = 0.0, y: float = 0.0) -> Floats:
    """(2, 3) outline of a circle around (x, y): two half circles."""
    return np.array([[x - radius, y, 1.0], [x + radius, y, 1.0]])


@dataclass(frozen=True, eq=False)
class Body:
    """One solid: *shape* counts in the list of shapes."""

    mark: str
    shape: int
    frame: Frame


@dataclass(frozen=True, eq=False)
class Kind:
    """All bodies of a kind: what they are called, their colour, what they are, and of what.

    Parameters
    ----------
    material : None where it is told elsewhere.
    """

    name: str
    colour: Colour
    bodies: tuple[Body, ...]
    material: Material | None = None


@dataclass(frozen=True, eq=False)
class Bodies:
    """A whole assembly."""

    shapes: tuple[Shape, ...]
    kinds: tuple[Kind, ...]


@dataclass(frozen=True, eq=False)
class Prisms:
    """The shapes and bodies of one kind.

    Parameters
    ----------
    material : what they are made of; None where it is told elsewhere.
    from_sheet : whether the shapes are cut from sheet as thick as they are high.
    """

    name: str
    colour: Colour
    shapes: tuple[Shape, ...]
    bodies: tuple[Body, ...]
    material: Material | None = None
    from_sheet: bool = False


def joined(*sets: Prisms) -> Bodies:
    """One assembly of several kinds; empty ones are left out."""
    shapes: list[Shape] = []
    kinds = []
    for prisms in sets:
        if prisms.bodies:
            first = len(shapes)
            shapes += prisms.shapes
            moved = (Body(b.mark, b.shape + first, b.frame) for b in prisms.bodies)
            kinds.append(Kind(prisms.name, prisms.colour, tuple(moved), prisms.material))
    return Bodies(tuple(shapes), tuple(kinds))


def prisms(
    name: str,
    colour: Colour,
    marks: Sequence[str],
    outlines: Sequence[Floats],
    frames: Sequence[Frame],
    groups: Sequence[Group],
    span: tuple[float, float],
    material: Material | None = None,
) -> Prisms:
    """One body per outline, in their order, each group with the shape of its first member.

    Parameters
    ----------
    outlines : (k, 2), or (k, 3) with bulges, each in its own frame.
    groups : a member may be turned over where *span* is even about nought.
    span : lower and upper end across the frames, mm.
    material : what they are made of.
    """
    shapes = []
    bodies: dict[int, Body] = {}
    for number, group in enumerate(groups):
        first = group.members[0].index
        shapes.append(Shape(marks[first], with_bulges(outlines[first]), *span))
        for member in group.members:
            here, outline = frames[member.index], outlines[member.index]
            there = instance_frame(outlines[first][:, :2], outline[:, :2], here, member)
            bodies[member.index] = Body(marks[member.index], number, there)
    placed = tuple(bodies[i] for i in range(len(marks)))
    return Prisms(name, colour, tuple(shapes), placed, material)


def with_bulges(outline: Floats) -> Floats:
    """(k, 3) rows x, y, bulge of an outline (k, 2) or (k, 3)."""
    if outline.shape[1] == 3:
        return outline
    return np.column_stack([outline, np.zeros(len(outline))])
