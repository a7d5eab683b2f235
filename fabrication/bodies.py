"""Bodies: solids as plain data, each a shape at a place. Equal parts share one shape.

A shape is an outline pushed straight along z. Where it lies is a frame: its x and y, and z across
both.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from fabrication.grouping import Group, Member, equal_groups
from fabrication.outlines import Frame
from fabrication.panel_structure import (
    COLOURS,
    SAME,
    PanelStructure,
    connector_span,
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
            frame = placed_like(outlines[first], outlines[member.index], member)
            bodies[member.index] = Body(
                marks[member.index], number, seen_in(frames[member.index], frame)
            )
    return Prisms(name, tuple(shapes), tuple(bodies[i] for i in range(len(marks))))


def with_bulges(outline: Floats) -> Floats:
    """(k, 3) rows x, y, bulge of an outline (k, 2) or (k, 3)."""
    if outline.shape[1] == 3:
        return outline
    return np.column_stack([outline, np.zeros(len(outline))])


Turn = tuple[complex, complex, bool]
"""z -> turn z + shift, and then mirrored at the x axis where the last is true."""


def placed_like(first: Floats, other: Floats, member: Member) -> Turn:
    """The motion that lays *first* over *other* (k, 2) as *member* says, by least squares."""
    k, corner = len(first), np.arange(len(first))
    way = (member.shift - corner) % k if member.mirrored else (corner + member.shift) % k
    a = first[:, 0] + 1j * first[:, 1]
    b = (other[:, 0] + 1j * other[:, 1])[way]
    b = np.conj(b) if member.mirrored else b
    turn = complex((np.conj(a - a.mean()) * (b - b.mean())).sum())
    turn /= abs(turn)
    return turn, complex(b.mean() - turn * a.mean()), member.mirrored


def seen_in(frame: Frame, motion: Turn) -> Frame:
    """The frame of the moved coordinates in space, when *motion* happens within *frame*."""
    turn, shift, mirrored = motion
    if mirrored:
        turn, shift = turn.conjugate(), shift.conjugate()
    side = -1j * turn if mirrored else 1j * turn

    def along(z: complex) -> Floats:
        return np.asarray(z.real * frame.x + z.imag * frame.y)

    return Frame(frame.origin + along(shift), along(turn), along(side))


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
    return prisms(
        "connectors",
        [c.mark for c in built.connectors],
        [c.section() for c in built.connectors],
        [c.frame for c in built.connectors],
        sections_alike(built.connectors, SAME),
        connector_span(built.system),
    )
