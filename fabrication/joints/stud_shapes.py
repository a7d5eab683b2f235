"""Studs of nodes on two levels: their sizes, shapes and lines of the bill."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np

from fabrication.jointed import BillLine
from fabrication.node import Node
from fabrication.outlines import Frame
from fabrication.shapes import Body, Prisms, Shape
from fabrication.stock import Material, require_distance, require_positive
from gridshell.arrays import Floats

_COLOUR = (0.72, 0.56, 0.36)
_ANGLE_STEP = np.radians(0.5)
"""Angles of studs are rounded to steps of this, so that many are alike."""


@dataclass(frozen=True)
class Stud:
    """The stud of a node.

    Parameters
    ----------
    material : what it is cut from.
    size : distance between opposite sides, mm; as much as the strips leave unless said otherwise.
    length : along the node axis, mm; over both levels unless said otherwise.
    wall : of a pipe, mm; 0 for a solid stud.
    fit : between the stud and each strip, mm.
    step : sizes are rounded down to steps of this, and angles to half degrees, so that many studs
        are alike, mm; 0 makes every stud to measure.

    Raises
    ------
    SettingError
        For a size that is not positive.
    """

    material: Material
    size: float | None = None
    length: float | None = None
    wall: float = 0.0
    fit: float = 0.2
    step: float = 0.1

    def __post_init__(self) -> None:
        for key in ("size", "length"):
            if getattr(self, key) is not None:
                require_positive(f"stud.{key}", getattr(self, key))
        for key in ("wall", "fit", "step"):
            require_distance(f"stud.{key}", getattr(self, key))


def stud_sizes(stud: Stud, rooms: Floats, nodes: Sequence[Node]) -> tuple[Floats, Floats]:
    """(n,) distance between opposite sides of each stud, mm, and its angle."""
    angle = np.array([node.angle for node in nodes], dtype=float)
    if stud.size is not None:
        sizes = np.full(len(nodes), stud.size)
    else:
        sizes = rooms.min(axis=1, initial=np.inf) - 2.0 * stud.fit
    if stud.step == 0.0:
        return sizes, angle
    turned = np.round(angle / _ANGLE_STEP) * _ANGLE_STEP
    if stud.size is None:
        sizes = sizes / (1.0 + _leaning(angle, turned))
        sizes = np.floor(sizes / stud.step + 1e-9) * stud.step
    return sizes, turned


def stud_need(stud: Stud, nodes: Sequence[Node]) -> Floats:
    """(n,) room that each stud needs at least, mm: that of its own size where it has one."""
    if stud.size is None:
        return np.full(len(nodes), 2.0 * stud.wall)
    angle = np.array([node.angle for node in nodes], dtype=float)
    if stud.step == 0.0:
        return np.full(len(nodes), stud.size)
    turned = np.round(angle / _ANGLE_STEP) * _ANGLE_STEP
    return np.asarray(stud.size * (1.0 + _leaning(angle, turned)))


def stud_prisms(
    stud: Stud,
    nodes: Sequence[Node],
    frames: Sequence[Frame],
    sizes: Floats,
    angles: Floats,
    length: float,
) -> Prisms:
    """A stud at every node that leaves room for one; equal ones share a shape.

    Parameters
    ----------
    frames : at the nodes, x along the bisector of the node angle.
    sizes, angles : (n,) distance between opposite sides, mm, and angle, radians.
    length : along the node axes, half of it on either side of the net, mm.
    """
    shapes: dict[tuple[float, float], int] = {}
    made: list[Shape] = []
    bodies = []
    for node, frame, size, angle in zip(nodes, frames, sizes, angles, strict=True):
        if not size > 2.0 * stud.wall:
            continue
        key = round(float(size), 6), round(float(angle), 9)
        if key not in shapes:
            shapes[key] = len(made)
            hollow = stud.wall > 0.0
            inside = (rhombus(size - 2.0 * stud.wall, angle),) if hollow else ()
            outline = rhombus(float(size), float(angle))
            made.append(Shape(f"S{len(made) + 1}", outline, -length / 2.0, length / 2.0, inside))
        bodies.append(Body(f"{node.name}-stud", shapes[key], frame))
    return Prisms("studs", _COLOUR, tuple(made), tuple(bodies), stud.material)


def stud_lines(stud: Stud, studs: Prisms, *, length: float, hole: float) -> Iterator[BillLine]:
    """A line of the bill per shape; *length* of the studs and *hole* of their bolts, mm, or 0."""
    used = Counter(body.shape for body in studs.bodies)
    kind = f"pipe, wall {stud.wall:g} mm" if stud.wall else "solid"
    drilled = f"; drilled {hole:g} mm at both levels" if hole else ""
    for number, shape in enumerate(studs.shapes):
        (x, _), (_, y) = np.abs(shape.outline[[0, 1], :2])
        size, angle = 2.0 * x * y / np.hypot(x, y), 2.0 * np.degrees(np.arctan2(y, x))
        yield BillLine(
            "stud",
            f"{shape.mark}: {size:.1f} mm between sides, {angle:.1f} degrees, {length:g} long",
            used[number],
            material=stud.material.name,
            mass=shape.volume * stud.material.density * 1e-9,
            note=f"{kind}{drilled}",
        )


def rhombus(size: float, angle: float) -> Floats:
    """(4, 3) outline with opposite sides *size* mm apart; x lies along the bisector of *angle*."""
    x, y = size / (2.0 * np.sin(angle / 2.0)), size / (2.0 * np.cos(angle / 2.0))
    return np.array([[x, 0.0, 0.0], [0.0, y, 0.0], [-x, 0.0, 0.0], [0.0, -y, 0.0]])


def _leaning(angle: Floats, turned: Floats) -> Floats:
    """Share of its size that a stud of the angle *turned* needs more between strips at *angle*."""
    return np.asarray(np.abs(turned - angle) * (1.0 + np.abs(np.cos(angle))) / np.sin(angle))
