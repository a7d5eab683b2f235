"""Double lamellas with double slots (Fig. 15d): the joint of the Munich gridshell.

Every axis carries two strips, side by side. Where two axes cross, four pairs of strips are slotted
into each other around a void, in which one bolt runs along the node axis. Star washers lie on the
edges of the strips above and below: crosses whose arms point along the bisectors of the node angle,
each over one of the four crossings, so that one bolt holds them all.

The two strips of an axis are not equal: each follows its own curve, and their lengths differ by
the distance between them times the turn of the axis within the surface.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace

import numpy as np

from fabrication.arrangement import LEFT, RIGHT, Arrangement, Lane, arranged
from fabrication.bolts import EDGE_DISTANCE, HOLE_PLAY, bolt_bodies, bolt_length
from fabrication.finding import Finding, Severity
from fabrication.jointed import BillLine, Jointed
from fabrication.joints.half_lap import HalfLap, half_lap, slot_findings
from fabrication.joints.joint import Joint
from fabrication.joints.node_frames import bisector_frames, node_tangents
from fabrication.node import Node, rows_by_lamella
from fabrication.outlines import Frame
from fabrication.shapes import Body, Prisms, Shape, circle
from fabrication.stock import Material, require_distance, require_positive
from fabrication.structures import Structure
from gridshell import SettingError
from gridshell.arrays import Floats

_WASHER_COLOUR = (0.75, 0.77, 0.80)
_MISS = 0.05
"""Distance between two strips' curves at a crossing above which it is told, mm."""

_ALIKE = np.radians(0.5)
"""Node angles are rounded to steps of this for the washers: their arms need not be exact."""


@dataclass(frozen=True)
class StarWasher:
    """A cross of two arms.

    Parameters
    ----------
    thickness : mm.
    arm : width of its arms, mm.
    beyond : how far an arm reaches over the middle of the crossing it covers, mm.
    material : what it is cut from.
    """

    thickness: float
    arm: float
    beyond: float
    material: Material

    def __post_init__(self) -> None:
        for key in ("thickness", "arm", "beyond"):
            require_positive(key, getattr(self, key))

    def outline(self, angle: float, half: float, hole: float) -> tuple[Floats, Floats]:
        """Outline and hole for strips *half* mm beside axes that cross at *angle*.

        The frame's x lies along the bisector of the angle between the axes.
        """
        x = half / np.sin(angle / 2.0) + self.beyond
        y = half / np.cos(angle / 2.0) + self.beyond
        b = self.arm / 2.0
        corners = [
            *((x, -b), (x, b), (b, b), (b, y), (-b, y), (-b, b)),
            *((-x, b), (-x, -b), (-b, -b), (-b, -y), (b, -y), (b, -b)),
        ]
        return np.column_stack([corners, np.zeros(len(corners))]), circle(hole / 2.0)


@dataclass(frozen=True)
class DoubleSlotJoint(Joint):
    """Two strips per axis, four slots per node and strip pair, one bolt.

    Parameters
    ----------
    spacing : between the middles of the two strips, mm.
    bolt : its diameter, mm.
    washer : above and below.
    clearance, depth_clearance : of the slots, see ``SlotJoint``, mm.

    Raises
    ------
    SettingError
        For a size that is not positive, or strips that would lie in each other.
    """

    spacing: float
    bolt: float
    washer: StarWasher
    clearance: float = 0.3
    depth_clearance: float = 0.5

    def __post_init__(self) -> None:
        for key in ("spacing", "bolt"):
            require_positive(key, getattr(self, key))
        for key in ("clearance", "depth_clearance"):
            require_distance(key, getattr(self, key))

    def build(self, design: Structure) -> Jointed:
        """Two strips per axis with their slots, bolts and washers.

        Raises
        ------
        SettingError
            When the slots would cut the strips through, or the strips touch each other.
        """
        if not self.spacing > design.profile.thickness:
            raise SettingError(
                "The two strips of an axis lie in each other",
                where="spacing",
                value=f"{self.spacing:g} mm",
                limit=f"more than the thickness, {design.profile.thickness:g} mm",
                advice=f"{design.profile.thickness + self.bolt + 2.0:g} mm leaves room for the "
                "bolt",
            )
        half = self.spacing / 2.0
        lanes = (Lane(LEFT, half), Lane(RIGHT, -half))
        made = arranged(design, {1: lanes, 2: lanes})
        cuts, fixtures = half_lap(made.strips, HalfLap(self.clearance, self.depth_clearance))
        regular = [node for node in design.nodes if node.regular]
        frames, low, high = self._seats(design, made, regular)
        washers = self._washers(regular, frames, low, high)
        lengths = [
            bolt_length(float(grip), self.bolt) for grip in high - low + 2.0 * self.washer.thickness
        ]
        heads = [
            replace(frame, origin=frame.origin + (top + self.washer.thickness) * frame.normal)
            for frame, top in zip(frames, high, strict=True)
        ]
        grips = high - low + 2.0 * self.washer.thickness
        bolts = bolt_bodies([node.name for node in regular], heads, grips, lengths, self.bolt)
        return Jointed(
            design=design,
            strips=made.strips,
            carriers=made.carriers,
            cuts=cuts,
            fixtures=fixtures,
            connectors=(washers, *bolts),
            bill=(*self._bill(washers), *_bolt_lines(lengths, self.bolt)),
            findings=(
                *slot_findings(design),
                *self._findings(design, regular),
                *_miss_finding(made),
            ),
        )

    # ---- washers and bolts ---------------------------------------------------------------------

    def _seats(
        self, design: Structure, made: Arrangement, nodes: Sequence[Node]
    ) -> tuple[list[Frame], Floats, Floats]:
        """Frames at *nodes*, and how low and how high the strips reach under a washer, mm."""
        names = {node.name: k for k, node in enumerate(nodes)}
        pairs = [node for node in made.strips.nodes if node.regular]
        owner = np.array([names[node.name.rstrip(LEFT + RIGHT)] for node in pairs], dtype=int)
        origin = np.array([node.position for node in nodes]).reshape(-1, 3)
        axis = np.array([node.axis for node in nodes]).reshape(-1, 3)
        low, high = np.full(len(nodes), np.inf), np.full(len(nodes), -np.inf)
        profile = design.profile
        for index, (pair, station) in rows_by_lamella(pairs).items():
            strip = made.strips.lamellas[index]
            rows = np.repeat(owner[pair], 6)
            s = np.repeat(station[:, None] + self.washer.arm * np.array([-1.0, 0.0, 1.0]), 2, 1)
            y = np.tile([-profile.thickness / 2.0, profile.thickness / 2.0], 3 * len(pair))
            for way, most in ((1.0, high), (-1.0, low)):
                z = np.full(s.size, way * profile.width / 2.0)
                points = strip.place(s.ravel(), y, z)
                level = np.einsum("nc,nc->n", points - origin[rows], axis[rows])
                (np.maximum if way > 0.0 else np.minimum).at(most, rows, level)
        return bisector_frames(nodes, node_tangents(design, nodes)), low, high

    def _washers(
        self, nodes: Sequence[Node], frames: Sequence[Frame], low: Floats, high: Floats
    ) -> Prisms:
        shapes: dict[int, int] = {}
        made: list[Shape] = []
        bodies = []
        washer, hole = self.washer, self.bolt + HOLE_PLAY
        for node, frame, bottom, top in zip(nodes, frames, low, high, strict=True):
            key = round(float(node.angle or 0.0) / _ALIKE)
            if key not in shapes:
                shapes[key] = len(made)
                outline, opening = washer.outline(key * _ALIKE, self.spacing / 2.0, hole)
                made.append(Shape(f"W{len(made) + 1}", outline, 0.0, washer.thickness, (opening,)))
            for where, level in (("top", top), ("bottom", bottom - washer.thickness)):
                placed = replace(frame, origin=frame.origin + level * frame.normal)
                bodies.append(Body(f"{node.name}-{where}", shapes[key], placed))
        return Prisms(
            "star washers",
            _WASHER_COLOUR,
            tuple(made),
            tuple(bodies),
            washer.material,
            from_sheet=True,
        )

    def _bill(self, washers: Prisms) -> Iterator[BillLine]:
        used = Counter(body.shape for body in washers.bodies)
        for number, shape in enumerate(washers.shapes):
            span = np.ptp(shape.outline[:, :2], axis=0)
            yield BillLine(
                "star washer",
                f"{shape.mark}: {span[0]:.1f} x {span[1]:.1f} x {self.washer.thickness:g} mm",
                used[number],
                material=self.washer.material.name,
                mass=shape.volume * self.washer.material.density * 1e-9,
                note=f"hole {self.bolt + HOLE_PLAY:g} mm; one above, one below every node",
            )

    # ---- findings ------------------------------------------------------------------------------

    def _findings(self, design: Structure, nodes: Sequence[Node]) -> Iterator[Finding]:
        void, hole = self.spacing - design.profile.thickness, self.bolt + HOLE_PLAY
        if hole > void:
            yield Finding(
                "bolt-void",
                Severity.ERROR,
                "all nodes",
                hole,
                void,
                "mm",
                f"A bolt of {self.bolt:g} mm and {HOLE_PLAY:g} mm of play need {hole:g} mm; the "
                f"void between the strips is {void:g} mm wide. Use a bolt of at most "
                f"{max(void - HOLE_PLAY, 0.0):g} mm or a spacing of "
                f"{hole + design.profile.thickness:g} mm.",
            )
        if self.washer.arm > void:
            yield Finding(
                "washer-void",
                Severity.ERROR,
                "all nodes",
                self.washer.arm,
                void,
                "mm",
                f"The arms of the star washers are {self.washer.arm:g} mm wide, the void between "
                f"the strips {void:g} mm: the washer closes it. Use arms of at most {void:g} mm.",
            )
        distance, needed = self.washer.arm / np.sqrt(2.0), EDGE_DISTANCE * hole
        if distance < needed:
            yield Finding(
                "washer-edge",
                Severity.ERROR,
                "all nodes",
                float(distance),
                needed,
                "mm",
                f"The hole of {hole:g} mm lies {distance:.1f} mm from the edge of its washer, "
                f"{needed:.1f} mm are needed. Use arms of {np.ceil(needed * np.sqrt(2.0)):g} mm.",
            )
        yield from self._reach(design, nodes)

    def _reach(self, design: Structure, nodes: Sequence[Node]) -> Iterator[Finding]:
        """Arms that end before they cover the whole crossing."""
        for node in nodes:
            half = min(node.angle or 0.0, np.pi - (node.angle or 0.0)) / 2.0
            needed = design.profile.thickness / (2.0 * np.sin(half))
            if self.washer.beyond < needed:
                yield Finding(
                    "washer-reach",
                    Severity.WARNING,
                    node.name,
                    self.washer.beyond,
                    float(needed),
                    "mm",
                    f"The arms of the star washer at {node.name} end {self.washer.beyond:g} mm "
                    f"beyond the crossings, which reach {needed:.1f} mm. Use beyond = "
                    f"{np.ceil(needed):g}.",
                )


def _miss_finding(made: Arrangement) -> Iterator[Finding]:
    """Strips that pass each other at different heights, where their curves are not asymptotic."""
    worst = int(np.argmax(made.miss)) if len(made.miss) else 0
    miss = float(made.miss[worst]) if len(made.miss) else 0.0
    if miss > _MISS:
        node = [node for node in made.strips.nodes if node.regular][worst].name
        yield Finding(
            "crossing-miss",
            Severity.WARNING,
            node,
            miss,
            _MISS,
            "mm",
            f"The two strips at {node} pass each other {miss:.2f} mm apart: their axes are not "
            "asymptotic there. Make the net exact, use more lamellas, or a smaller spacing.",
        )


def _bolt_lines(lengths: Sequence[float], diameter: float) -> Iterator[BillLine]:
    for length, count in sorted(Counter(lengths).items()):
        yield BillLine("bolt", f"M{diameter:g} x {length:g}", count, note="along the node axis")
    if lengths:
        yield BillLine("nut", f"M{diameter:g}", len(lengths))
