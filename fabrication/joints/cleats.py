"""Angle cleats: bent plates in the corners between a strip that runs through and a piece's end.

A cleat is an L outline at the angle of its corner, pushed along the node axis. Strips twist and
bend slightly along its legs, so that it keeps a play from both. Its angle is rounded down to steps,
so that many are alike: the leg along the piece then leans away from it, never into it.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from fabrication.finding import Finding, Severity
from fabrication.jointed import BillLine
from fabrication.joints.piece_ends import Ends
from fabrication.outlines import Frame
from fabrication.shapes import Body, Prisms, Shape
from fabrication.stock import Material, require_distance, require_positive
from fabrication.structures import Structure
from gridshell.arrays import Floats, unit

_COLOUR = (0.62, 0.64, 0.68)
_ALIKE = np.radians(0.5)


@dataclass(frozen=True)
class Cleat:
    """An angle on each side of a piece's end.

    Parameters
    ----------
    leg : length of both legs, outside, mm.
    thickness : of the plate, mm.
    height : along the node axis, mm.
    material : what it is bent from.
    play : between its legs and the strips at the node axis, mm.

    Raises
    ------
    SettingError
        For a size that is not positive.
    """

    leg: float
    thickness: float
    height: float
    material: Material
    play: float = 0.5

    def __post_init__(self) -> None:
        for key in ("leg", "thickness", "height"):
            require_positive(key, getattr(self, key))
        require_distance("play", self.play)

    def outline(self, angle: float) -> Floats:
        """(6, 3) outline; its corner at (0, 0), the first leg along x, the other at *angle*."""
        leg, t, c, s = self.leg, self.thickness, np.cos(angle), np.sin(angle)
        return np.array(
            [
                [0.0, 0.0, 0.0],
                [leg, 0.0, 0.0],
                [leg, t, 0.0],
                [t * (1.0 + c) / s, t, 0.0],
                [leg * c + t * s, leg * s - t * c, 0.0],
                [leg * c, leg * s, 0.0],
            ]
        )

    def fits(self, angle: float) -> bool:
        """Whether the legs are longer than the plate is thick at the inside of the corner."""
        return bool(self.leg > self.thickness / np.tan(angle / 2.0))


def cleats(cleat: Cleat, design: Structure, ends: Ends, marks: list[str]) -> Prisms:
    """Two cleats at each of *ends*, where they fit; equal ones share a shape.

    Parameters
    ----------
    marks : of the pieces, by span.
    """
    shapes: dict[int, int] = {}
    made: list[Shape] = []
    bodies: list[Body] = []
    off = design.profile.thickness / 2.0 + cleat.play
    for row, node in enumerate(ends.node.tolist()):
        axis, (along, through) = design.nodes[node].axis, ends.tangents[row]
        for name, leg in (("a", through), ("b", -through)):
            angle = float(np.arccos(np.clip(along @ leg, -1.0, 1.0)))
            key = int(np.floor(angle / _ALIKE + 1e-9))
            if not cleat.fits(key * _ALIKE):
                continue
            if key not in shapes:
                shapes[key] = len(made)
                span = cleat.height / 2.0
                made.append(Shape(f"L{len(made) + 1}", cleat.outline(key * _ALIKE), -span, span))
            side = np.cross(axis, leg)
            origin = design.nodes[node].position + off * (along + leg) / np.sin(angle)
            frame = Frame(origin, leg, unit(side * np.sign(side @ along)))
            mark = f"{marks[int(ends.span[row])]}-{design.nodes[node].name}{name}"
            bodies.append(Body(mark, shapes[key], frame))
    return Prisms("angle cleats", _COLOUR, tuple(made), tuple(bodies), cleat.material)


def cleat_lines(cleat: Cleat, made: Prisms) -> Iterator[BillLine]:
    """One line of the bill per shape."""
    used = Counter(body.shape for body in made.bodies)
    for number, shape in enumerate(made.shapes):
        across = shape.outline[5, :2]
        angle = np.degrees(np.arctan2(across[1], across[0]))
        yield BillLine(
            "angle cleat",
            f"{shape.mark}: {cleat.leg:g} x {cleat.leg:g} x {cleat.thickness:g}, "
            f"{cleat.height:g} mm high, bent to {angle:.1f} degrees",
            used[number],
            material=cleat.material.name,
            mass=shape.volume * cleat.material.density * 1e-9,
            note="in the corners between through strips and pieces",
        )


def cleat_findings(cleat: Cleat, design: Structure, ends: Ends) -> Iterator[Finding]:
    """Corners a cleat does not fit into, and strips that bend or twist by more than its play."""
    for row, node in enumerate(ends.node.tolist()):
        name = design.nodes[node].name
        sharp = float(min(abs(ends.angle[row]), np.pi - abs(ends.angle[row])))
        shortest = cleat.thickness / np.tan(np.floor(sharp / _ALIKE) * _ALIKE / 2.0 + 1e-12)
        if not cleat.leg > shortest:
            yield Finding(
                "cleat-sharp",
                Severity.ERROR,
                name,
                cleat.leg,
                float(shortest),
                "mm",
                f"The corner of {np.degrees(sharp):.1f} degrees at {name} is too sharp for a cleat "
                f"of {cleat.leg:g} mm, which is left out. Use legs of {np.ceil(shortest + 1):g} mm "
                "or a thinner plate.",
            )
    for node in dict.fromkeys(ends.node.tolist()):
        yield from _play(cleat, design, node)


def _play(cleat: Cleat, design: Structure, number: int) -> Iterator[Finding]:
    node, needed = design.nodes[number], 0.0
    reach = cleat.leg + (design.profile.thickness + 2.0 * cleat.play) / np.sin(node.angle or 1.0)
    for crossing in node.crossings:
        lamella, at = design.lamellas[crossing.lamella], np.array([crossing.station])
        turn = abs(float(lamella.twist(at)[0])) * cleat.height / 2.0
        bend = abs(float(lamella.bending(at)[0][0])) / 2.0
        needed = max(needed, reach * turn + reach**2 * bend)
    if needed > cleat.play:
        yield Finding(
            "cleat-play",
            Severity.WARNING,
            node.name,
            cleat.play,
            needed,
            "mm",
            f"The strips at {node.name} bend and twist by {needed:.3f} mm along a cleat, whose "
            f"play is {cleat.play:g} mm. Use a play of {np.ceil(needed * 10.0) / 10.0:g} mm, or "
            "shorter legs or less height.",
        )
