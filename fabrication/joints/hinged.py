"""Hinged joints of hollow sections: the joint of the Asymptotic Umbrella (Fig. 18).

Both families run through on two levels, and at every node one pin along the node axis goes through
both tubes, with a spacer between them. The pin lets the tubes turn against each other and holds
nothing else: the node angle is free, and the net moves as far as tubes of one family have room
beside each other.

Lengths mm, angles radians.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np

from fabrication.arrangement import Arrangement, Lane, arranged
from fabrication.bolts import EDGE_DISTANCE, FLATS, bolt_bodies, bolt_length
from fabrication.cut import Cuts, Drill
from fabrication.finding import Finding, Severity
from fabrication.jointed import BillLine, Feature, Fixture, Jointed
from fabrication.joints.joint import Joint
from fabrication.node import Node, rows_by_lamella
from fabrication.outlines import Frame
from fabrication.shapes import Body, Prisms, Shape, circle
from fabrication.stock import HollowProfile, require_distance, require_positive
from fabrication.structures import Structure
from gridshell import SettingError
from gridshell.arrays import Floats, unit

_SPACER = (0.70, 0.72, 0.74)
_RIM = 1.3
"""Outer radius of a spacer, in diameters of the pin."""

_TRIES = 9
"""Places along and across a seat where the tube's face is compared with the plane of the head."""


@dataclass(frozen=True)
class HingedJoint(Joint):
    """Two levels of tubes, a pin in every node.

    Parameters
    ----------
    pin : diameter of the pins, mm.
    gap : between the tubes of a node, mm; the spacer fills it but for what the tubes twist.
    play : of a pin in its holes, mm.

    Raises
    ------
    SettingError
        For a size that is not positive.
    """

    pin: float
    gap: float = 4.0
    play: float = 0.3

    def __post_init__(self) -> None:
        require_positive("pin", self.pin)
        require_positive("gap", self.gap)
        require_distance("play", self.play)

    @property
    def hole(self) -> float:
        """Diameter of the holes, mm."""
        return self.pin + self.play

    def build(self, design: Structure) -> Jointed:
        """One tube per axis on its level, drilled through its narrow walls at every node.

        Raises
        ------
        SettingError
            For strips that are no hollow sections, or a pin that does not go between their walls.
        """
        profile = self._section(design)
        level = (profile.width + self.gap) / 2.0
        lanes = {1: (Lane(along=level),), 2: (Lane(along=-level),)}
        made = arranged(design, lanes, crossing=False)
        nodes = [node for node in design.nodes if node.regular]
        drills, fixtures = self._drills(design, made)
        seat = self._seat(made, profile)
        pins, bill = self._pins(nodes, level, profile, seat)
        return Jointed(
            design=design,
            strips=made.strips,
            carriers=made.carriers,
            cuts={mark: Cuts(drills=tuple(own)) for mark, own in drills.items()},
            fixtures=tuple(fixtures),
            connectors=pins,
            bill=bill,
            findings=tuple(self._findings(design, made, drills, profile, seat)),
        )

    def folded(self, design: Structure) -> float:
        """The smallest node angle: tubes of one family then touch, radians.

        Neighbours on one level are the bay times the sine of the angle apart, and must keep the
        larger of their own thickness and their heads.
        """
        room = max(design.profile.thickness, 2.0 * FLATS / np.sqrt(3.0) * self.pin)
        shortest = min(
            float(np.diff(strip.stations).min())
            for strip in design.lamellas
            if len(strip.stations) > 1
        )
        return float(np.arcsin(min(1.0, room / shortest)))

    def _section(self, design: Structure) -> HollowProfile:
        profile = design.profile
        if not isinstance(profile, HollowProfile):
            raise SettingError(
                "Hinges need hollow sections: a pin along the node axis goes through their walls",
                where="profile.wall",
                value=f"a solid strip of {profile.size} mm",
                advice="wall = 2.0, and a thickness of four times the pin",
            )
        inside = profile.thickness - 2.0 * profile.wall
        if not self.hole < inside:
            raise SettingError(
                "The pin does not go between the walls of the section",
                where="pin",
                value=f"{self.pin:g} mm, {self.hole:g} with its play",
                limit=f"below {inside:g} mm between the walls",
                advice=f"{max(np.floor(0.6 * inside), 1.0):g} mm",
            )
        return profile

    # ---- tubes ---------------------------------------------------------------------------------

    def _drills(
        self, design: Structure, made: Arrangement
    ) -> tuple[dict[str, list[Drill]], list[Fixture]]:
        """By mark in order along the tube, and where on the pins they must lie."""
        drills: dict[str, list[Drill]] = {strip.mark: [] for strip in made.strips.lamellas}
        fixtures: list[Fixture] = []
        both = zip(made.strips.nodes, design.nodes, strict=True)
        kept = [node for node, before in both if before.regular]
        for index, (rows, stations) in sorted(rows_by_lamella(kept).items()):
            strip, lane = made.strips.lamellas[index], made.lanes[index]
            for row, station in zip(rows.tolist(), stations.tolist(), strict=True):
                node, x = kept[row], station - strip.start
                position = node.position + lane.along * node.axis
                drills[strip.mark].append(Drill(x, self.hole, node.name, f"pin M{self.pin:g}"))
                y = design.profile.width / 2.0
                fixtures.append(
                    Fixture(strip.mark, node.name, Feature.DRILL, x, y, position, node.axis)
                )
        for own in drills.values():
            own.sort(key=lambda drill: drill.x)
        return drills, fixtures

    def _seat(self, made: Arrangement, profile: HollowProfile) -> float:
        """How far a narrow face leaves the plane of a head or a spacer, at any node, mm."""
        reach = max(FLATS / np.sqrt(3.0), _RIM) * self.pin
        worst = 0.0
        share = np.linspace(-1.0, 1.0, _TRIES)
        ds, y = (a.ravel() for a in np.meshgrid(reach * share, profile.thickness / 2.0 * share))
        for strip in made.strips.lamellas:
            s = strip.stations
            frames = strip.frames(s)
            for half in (-profile.width / 2.0, profile.width / 2.0):
                at, across = np.repeat(s, len(ds)) + np.tile(ds, len(s)), np.tile(y, len(s))
                places = strip.place(at, across, np.full(len(at), half)).reshape(len(s), -1, 3)
                plane = frames.points + half * frames.n
                off = np.einsum("nkc,nc->nk", places - plane[:, None], frames.n)
                worst = max(worst, float(np.abs(off).max()))
        return worst

    # ---- pins ----------------------------------------------------------------------------------

    def _pins(
        self, nodes: Sequence[Node], level: float, profile: HollowProfile, seat: float
    ) -> tuple[tuple[Prisms, ...], tuple[BillLine, ...]]:
        if not nodes:
            return (), ()
        grip = 2.0 * level + profile.width + 2.0 * seat
        length = bolt_length(grip, self.pin)
        frames = [_frame(node, grip / 2.0) for node in nodes]
        names = [node.name for node in nodes]
        count = len(nodes)
        bolts = bolt_bodies(names, frames, np.full(count, grip), [length] * count, self.pin)
        high = self.gap - 2.0 * seat
        ring = Shape(
            f"spacer {high:.3g}",
            circle(_RIM * self.pin),
            -high / 2.0,
            high / 2.0,
            (circle(self.hole / 2.0),),
        )
        spacers = tuple(
            Body(f"{node.name}-spacer", 0, _frame(node, 0.0)) for node in nodes if high > 0.0
        )
        kinds = (*bolts, Prisms("spacers", _SPACER, (ring,), spacers)) if spacers else bolts
        size = f"{2.0 * _RIM * self.pin:g} x {self.hole:g} x {high:.2f} mm"
        return kinds, (
            BillLine("pin", f"M{self.pin:g} x {length:g}", count, note="turns in both tubes"),
            BillLine("nut", f"M{self.pin:g}, self-locking", count, note="not tightened"),
            BillLine("spacer", size, len(spacers), note="between the tubes of a node"),
        )

    # ---- findings ------------------------------------------------------------------------------

    def _findings(
        self,
        design: Structure,
        made: Arrangement,
        drills: dict[str, list[Drill]],
        profile: HollowProfile,
        seat: float,
    ) -> Iterator[Finding]:
        limit = EDGE_DISTANCE * self.hole
        for strip in made.strips.lamellas:
            own = drills[strip.mark]
            for drill in dict.fromkeys(own[:1] + own[-1:]):
                room = min(drill.x, strip.length - drill.x)
                if room < limit:
                    yield Finding(
                        "hinge-at-end",
                        Severity.ERROR,
                        f"{strip.mark} {drill.node}",
                        room,
                        limit,
                        "mm",
                        f"The pin of {drill.node} stands {room:.1f} mm from the end of "
                        f"{strip.mark}, {limit:.1f} needed. Use a longer overhang.",
                    )
        if not self.gap > 2.0 * seat + 0.1:
            yield Finding(
                "hinge-gap",
                Severity.ERROR,
                "joint",
                self.gap,
                2.0 * seat + 0.1,
                "mm",
                f"The tubes twist by {seat:.2f} mm within their seats: a gap of {self.gap:g} mm "
                "leaves no room for a spacer. Use a larger gap, or a thinner pin.",
            )
        angles = [node.angle for node in design.nodes if node.angle is not None]
        sharp = min((min(angle, np.pi - angle) for angle in angles), default=np.pi)
        fold = self.folded(design)
        if sharp < fold:
            yield Finding(
                "hinge-fold",
                Severity.ERROR,
                "nodes",
                float(np.degrees(sharp)),
                float(np.degrees(fold)),
                "degrees",
                f"Tubes of one level touch below {np.degrees(fold):.1f} degrees; the net has "
                f"{np.degrees(sharp):.1f}. Use longer bays or a thinner section.",
            )


def _frame(node: Node, along: float) -> Frame:
    """A plane across the node axis, *along* mm from the node."""
    other = np.eye(3)[int(np.argmin(np.abs(node.axis)))]
    x: Floats = unit(np.cross(other, node.axis)[None])[0]
    return Frame(node.position + along * node.axis, x, np.cross(node.axis, x))
