"""Bodies: solids as plain data, each a shape at a place. Equal parts share one shape.

A shape is an outline pushed straight along z. Where it lies is a frame: its x and y, and z across
both.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from fabrication.grouping import Group, equal_groups, instance_frame
from fabrication.outlines import Frame
from fabrication.panel_structure import (
    COLOURS,
    SAME,
    PanelStructure,
    sections_alike,
)
from gridshell.arrays import Floats


@dataclass(frozen=True, eq=False)
class Shape:
    """A prism in its own coordinates.

    Parameters
    ----------
    mark : of the first body that has it.
    outline : (k, 3) rows x, y, bulge, counter-clockwise, mm; the bulge, tan(sweep / 4), belongs to
        the piece from its corner to the next.
    low, high : where it begins and ends along z, mm.
    """

    mark: str
    outline: Floats
    low: float
    high: float


@dataclass(frozen=True, eq=False)
class Body:
    """One solid: *shape* counts in the list of shapes."""

    mark: str
    shape: int
    frame: Frame


@dataclass(frozen=True, eq=False)
class Kind:
    """All bodies of a kind: what they are called, their colour (sRGB, 0 to 1), what they are."""

    name: str
    colour: tuple[float, float, float]
    bodies: tuple[Body, ...]


@dataclass(frozen=True, eq=False)
class Bodies:
    """A whole assembly."""

    shapes: tuple[Shape, ...]
    kinds: tuple[Kind, ...]


def structure_bodies(built: PanelStructure) -> Bodies:
    """Panels, plates and connectors of *built*; equal ones within ``SAME`` share their shape."""
    return joined(_panels(built), _plates(built), _connectors(built))


def joined(*sets: Prisms) -> Bodies:
    """One assembly of several kinds; empty ones are left out."""
    shapes: list[Shape] = []
    kinds = []
    for prisms in sets:
        if prisms.bodies:
            first = len(shapes)
            shapes += prisms.shapes
            moved = (Body(b.mark, b.shape + first, b.frame) for b in prisms.bodies)
            kinds.append(Kind(prisms.name, COLOURS[prisms.name], tuple(moved)))
    return Bodies(tuple(shapes), tuple(kinds))


@dataclass(frozen=True, eq=False)
class Prisms:
    """The shapes and bodies of one kind."""

    name: str
    shapes: tuple[Shape, ...]
    bodies: tuple[Body, ...]


def prisms(
    name: str,
    marks: Sequence[str],
    outlines: Sequence[Floats],
    frames: Sequence[Frame],
    groups: Sequence[Group],
    span: tuple[float, float],
) -> Prisms:
    """One body per outline, in their order, each group with the shape of its first member.

    Parameters
    ----------
    outlines : (k, 2), or (k, 3) with bulges, each in its own frame.
    groups : a member may be turned over where *span* is even about nought.
    span : lower and upper end across the frames, mm.
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
    return Prisms(name, tuple(shapes), tuple(bodies[i] for i in range(len(marks))))


def with_bulges(outline: Floats) -> Floats:
    """(k, 3) rows x, y, bulge of an outline (k, 2) or (k, 3)."""
    if outline.shape[1] == 3:
        return outline
    return np.column_stack([outline, np.zeros(len(outline))])


def _panels(built: PanelStructure) -> Prisms:
    outlines = [p.outline for p in built.panels]
    return prisms(
        "panels",
        [p.mark for p in built.panels],
        outlines,
        [p.frame for p in built.panels],
        equal_groups(outlines, SAME, prefix="G"),
        (0.0, built.system.panels.thickness),
    )


def _plates(built: PanelStructure) -> Prisms:
    half = 0.0 if built.system.plates is None else built.system.plates.thickness / 2.0
    outlines = [p.outline for p in built.plates]
    return prisms(
        "plates",
        [p.mark for p in built.plates],
        outlines,
        [p.frame for p in built.plates],
        equal_groups(outlines, SAME, prefix="H", mirror=True),
        (-half, half),
    )


def _connectors(built: PanelStructure) -> Prisms:
    pieces = built.pieces
    return prisms(
        "connectors",
        [piece.mark for piece in pieces],
        [piece.connector.section() for piece in pieces],
        [piece.frame for piece in pieces],
        sections_alike(pieces, SAME),
        (0.0, pieces[0].height if pieces else 0.0),
    )
