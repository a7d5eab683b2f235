"""Two levels connected by studs (Fig. 15c, Fig. 14): the joint of the timber prototype.

The two families of lamellas lie on separate levels, so that every profile runs through. Each axis
carries two profiles side by side. At every node a stud stands along the node axis, in the void
between the profiles of both levels: its sides are parallel to both, a square at 90 degrees, so that
it fixes the node angle on both levels and carries bending and torsion from one to the other. It
only fits once all profiles are bent. Shear blocks then join the two profiles of an axis.

Off the net a straight strip must bend about its strong axis: at a distance d from an asymptotic
curve with rate of twist w its curvature is w^2 d / (1 + w^2 d^2).
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np

from fabrication.arrangement import LEFT, RIGHT, Arrangement, Lane, arranged
from fabrication.bolts import HOLE_PLAY, bolt_bodies, bolt_length
from fabrication.cut import Cuts, Hole
from fabrication.jointed import BillLine, Feature, Fixture, Jointed
from fabrication.joints.joint import Joint
from fabrication.joints.node_frames import bisector_frames, node_tangents
from fabrication.joints.stud_findings import stud_findings
from fabrication.node import Node, rows_by_lamella
from fabrication.outlines import Frame
from fabrication.rooms import room_beside
from fabrication.shapes import Body, Prisms, Shape
from fabrication.shear_blocks import Blocks, ShearBlock, made_grip, shear_blocks
from fabrication.stock import Material, require_distance, require_positive
from fabrication.structures import Structure
from gridshell import SettingError
from gridshell.arrays import Floats, Indices

_COLOUR = (0.72, 0.56, 0.36)
_ANGLE_STEP = np.radians(0.5)


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


@dataclass(frozen=True)
class StudJoint(Joint):
    """Double profiles on two levels, studs at the nodes, blocks between them.

    Parameters
    ----------
    spacing : between the middles of the two strips of an axis, mm.
    level : distance of the middle of either level from the net, mm; half the strips' width and
        a millimetre unless said otherwise.
    stud : at every node.
    bolt : diameter of the bolts through both strips and the stud, one per level, mm; 0 for none.
    blocks : between the nodes; none unless said otherwise.

    Raises
    ------
    SettingError
        For a size that is not positive.
    """

    spacing: float
    stud: Stud
    level: float | None = None
    bolt: float = 0.0
    blocks: ShearBlock | None = None

    def __post_init__(self) -> None:
        require_positive("spacing", self.spacing)
        require_distance("bolt", self.bolt)
        if self.level is not None:
            require_positive("level", self.level)

    def build(self, design: Structure) -> Jointed:
        """Two strips per axis on its level, studs, bolts and blocks.

        Raises
        ------
        SettingError
            When the two strips of an axis or the two levels lie in each other.
        """
        level = self._level(design)
        half = self.spacing / 2.0
        made = arranged(
            design,
            {
                1: (Lane(LEFT, half, level), Lane(RIGHT, -half, level)),
                2: (Lane(LEFT, half, -level), Lane(RIGHT, -half, -level)),
            },
            crossing=False,
        )
        nodes = [node for node in design.nodes if node.regular]
        tangents = node_tangents(design, nodes)
        rooms = self._rooms(design, made, nodes, tangents)
        sizes, angles = self._sizes(rooms, nodes)
        length = (
            2.0 * level + design.profile.width if self.stud.length is None else (self.stud.length)
        )
        studs = self._studs(nodes, bisector_frames(nodes, tangents), sizes, angles, length)
        holes, fixtures = self._holes(design, made, nodes, tangents)
        bolts, bolt_bill = self._bolts(design, made, nodes, tangents, level)
        blocks = self._blocks(design, made, sizes, nodes)
        need = self._need(nodes)
        found = stud_findings(
            design,
            made,
            nodes,
            need=need,
            room=rooms.min(axis=1, initial=np.inf),
            level=level,
            length=length,
            hole=self.bolt + HOLE_PLAY if self.bolt else 0.0,
            spacing=self.spacing,
            fit=self.stud.fit,
        )
        cuts = {
            mark: Cuts(holes=tuple(sorted([*own, *blocks.holes[mark]], key=lambda h: h.x)))
            for mark, own in holes.items()
        }
        return Jointed(
            design=design,
            strips=made.strips,
            carriers=made.carriers,
            cuts=cuts,
            fixtures=(*fixtures, *blocks.fixtures),
            connectors=(studs, *bolts, *blocks.connectors),
            bill=(*self._bill(studs, length), *bolt_bill, *blocks.bill),
            findings=(*found, *blocks.findings),
        )

    def _level(self, design: Structure) -> float:
        profile = design.profile
        if not self.spacing > profile.thickness:
            raise SettingError(
                "The two strips of an axis lie in each other",
                where="spacing",
                value=f"{self.spacing:g} mm",
                limit=f"more than the thickness, {profile.thickness:g} mm",
                advice=f"{10.0 * profile.thickness:g} mm",
            )
        level = profile.width / 2.0 + 1.0 if self.level is None else self.level
        if level < profile.width / 2.0:
            raise SettingError(
                "The two levels lie in each other",
                where="level",
                value=f"{level:g} mm from the net",
                limit=f"at least half the width, {profile.width / 2.0:g} mm",
                advice=f"{profile.width / 2.0 + 1.0:g} mm",
            )
        return level

    # ---- studs ---------------------------------------------------------------------------------

    def _rooms(
        self, design: Structure, made: Arrangement, nodes: Sequence[Node], tangents: Floats
    ) -> Floats:
        """(n, 2) width between the inner faces of the two strips of each family, mm."""
        profile = design.profile
        angle = np.array([node.angle for node in nodes], dtype=float)
        widest = self.spacing - profile.thickness
        reach = widest / 2.0 * (1.0 + np.abs(np.cos(angle))) / np.sin(angle)
        position = np.array([node.position for node in nodes]).reshape(-1, 3)
        axis = np.array([node.axis for node in nodes]).reshape(-1, 3)
        rooms = np.full((len(nodes), 2), np.inf)
        for index, rows, stations in _passing(design, made):
            strip, lane = made.strips.lamellas[index], made.lanes[index]
            side = np.sign(lane.across)
            across = side * np.cross(axis[rows], tangents[rows, strip.family - 1])
            found = room_beside(
                strip,
                stations,
                position[rows] + lane.along * axis[rows],
                across,
                reach=reach[rows],
                width=profile.width,
                thickness=profile.thickness,
            )
            column = rooms[:, strip.family - 1]
            column[rows] = np.minimum(column[rows], 2.0 * found)
        return rooms

    def _sizes(self, rooms: Floats, nodes: Sequence[Node]) -> tuple[Floats, Floats]:
        """(n,) distance between opposite sides of each stud, mm, and its angle."""
        angle = np.array([node.angle for node in nodes], dtype=float)
        if self.stud.size is not None:
            sizes = np.full(len(nodes), self.stud.size)
        else:
            sizes = rooms.min(axis=1, initial=np.inf) - 2.0 * self.stud.fit
        if self.stud.step == 0.0:
            return sizes, angle
        turned = np.round(angle / _ANGLE_STEP) * _ANGLE_STEP
        if self.stud.size is None:
            sizes = sizes / (1.0 + _leaning(angle, turned))
            sizes = np.floor(sizes / self.stud.step + 1e-9) * self.stud.step
        return sizes, turned

    def _need(self, nodes: Sequence[Node]) -> Floats:
        """(n,) room that each stud needs at least, mm: that of its own size where it has one."""
        if self.stud.size is None:
            return np.full(len(nodes), 2.0 * self.stud.wall)
        angle = np.array([node.angle for node in nodes], dtype=float)
        if self.stud.step == 0.0:
            return np.full(len(nodes), self.stud.size)
        turned = np.round(angle / _ANGLE_STEP) * _ANGLE_STEP
        return np.asarray(self.stud.size * (1.0 + _leaning(angle, turned)))

    def _studs(
        self,
        nodes: Sequence[Node],
        frames: Sequence[Frame],
        sizes: Floats,
        angles: Floats,
        length: float,
    ) -> Prisms:
        shapes: dict[tuple[float, float], int] = {}
        made: list[Shape] = []
        bodies = []
        for node, frame, size, angle in zip(nodes, frames, sizes, angles, strict=True):
            if not size > 2.0 * self.stud.wall:
                continue
            key = round(float(size), 6), round(float(angle), 9)
            if key not in shapes:
                shapes[key] = len(made)
                hollow = self.stud.wall > 0.0
                inside = (rhombus(size - 2.0 * self.stud.wall, angle),) if hollow else ()
                outline = rhombus(float(size), float(angle))
                made.append(
                    Shape(f"S{len(made) + 1}", outline, -length / 2.0, length / 2.0, inside)
                )
            bodies.append(Body(f"{node.name}-stud", shapes[key], frame))
        material = self.stud.material.name
        return Prisms("studs", _COLOUR, tuple(made), tuple(bodies), material)

    # ---- bolts ---------------------------------------------------------------------------------

    def _holes(
        self, design: Structure, made: Arrangement, nodes: Sequence[Node], tangents: Floats
    ) -> tuple[dict[str, list[Hole]], list[Fixture]]:
        """Holes of the bolts at the nodes, and where they must lie."""
        holes: dict[str, list[Hole]] = {strip.mark: [] for strip in made.strips.lamellas}
        fixtures: list[Fixture] = []
        if self.bolt == 0.0:
            return holes, fixtures
        y = design.profile.width / 2.0
        for index, rows, stations in _passing(design, made):
            strip, lane = made.strips.lamellas[index], made.lanes[index]
            for row, station in zip(rows.tolist(), stations.tolist(), strict=True):
                node, x = nodes[row], station - strip.start
                across = np.cross(node.axis, tangents[row, strip.family - 1])
                position = node.position + lane.along * node.axis + lane.across * across
                diameter, purpose = self.bolt + HOLE_PLAY, f"bolt M{self.bolt:g}"
                holes[strip.mark].append(Hole(x, y, diameter, node.name, purpose))
                fixtures.append(Fixture(strip.mark, node.name, Feature.HOLE, x, y, position))
        return holes, fixtures

    def _bolts(
        self,
        design: Structure,
        made: Arrangement,
        nodes: Sequence[Node],
        tangents: Floats,
        level: float,
    ) -> tuple[tuple[Prisms, ...], tuple[BillLine, ...]]:
        if self.bolt == 0.0 or not nodes:
            return (), ()
        grip = made_grip(made, design.profile.thickness)
        marks, heads = [], []
        for row, node in enumerate(nodes):
            for family, way in ((0, 1.0), (1, -1.0)):
                along = tangents[row, family]
                across = np.cross(node.axis, along)
                place = node.position + way * level * node.axis + grip / 2.0 * across
                heads.append(Frame(place, node.axis, along))
                marks.append(f"{node.name}-{'AB'[family]}")
        length = bolt_length(grip, self.bolt)
        count = len(marks)
        bolts = bolt_bodies(marks, heads, np.full(count, grip), [length] * count, self.bolt)
        return bolts, (
            BillLine("bolt", f"M{self.bolt:g} x {length:g}", count, note="through strips and stud"),
            BillLine("nut", f"M{self.bolt:g}", count),
        )

    def _blocks(
        self, design: Structure, made: Arrangement, sizes: Floats, nodes: Sequence[Node]
    ) -> Blocks:
        if self.blocks is None:
            return Blocks((), {s.mark: [] for s in made.strips.lamellas}, (), (), ())
        angle = np.array([node.angle for node in nodes], dtype=float)
        reach = sizes / 2.0 * (1.0 + np.abs(np.cos(angle))) / np.sin(angle)
        return shear_blocks(self.blocks, design, made, keep=float(reach.max(initial=0.0)))

    # ---- bill ---------------------------------------------------------------------------------

    def _bill(self, studs: Prisms, length: float) -> Iterator[BillLine]:
        used = Counter(body.shape for body in studs.bodies)
        kind = f"pipe, wall {self.stud.wall:g} mm" if self.stud.wall else "solid"
        drilled = f"; drilled {self.bolt + HOLE_PLAY:g} mm at both levels" if self.bolt else ""
        for number, shape in enumerate(studs.shapes):
            (x, _), (_, y) = np.abs(shape.outline[[0, 1], :2])
            size, angle = 2.0 * x * y / np.hypot(x, y), 2.0 * np.degrees(np.arctan2(y, x))
            yield BillLine(
                "stud",
                f"{shape.mark}: {size:.1f} mm between sides, {angle:.1f} degrees, {length:g} long",
                used[number],
                material=self.stud.material.name,
                mass=shape.volume * self.stud.material.density * 1e-9,
                note=f"{kind}{drilled}",
            )


def rhombus(size: float, angle: float) -> Floats:
    """(4, 3) outline with opposite sides *size* mm apart; x lies along the bisector of *angle*."""
    x, y = size / (2.0 * np.sin(angle / 2.0)), size / (2.0 * np.cos(angle / 2.0))
    return np.array([[x, 0.0, 0.0], [0.0, y, 0.0], [-x, 0.0, 0.0], [0.0, -y, 0.0]])


def _leaning(angle: Floats, turned: Floats) -> Floats:
    """Share of its size that a stud of the angle *turned* needs more between strips at *angle*."""
    return np.asarray(np.abs(turned - angle) * (1.0 + np.abs(np.cos(angle))) / np.sin(angle))


def _passing(design: Structure, made: Arrangement) -> Iterator[tuple[int, Indices, Floats]]:
    """Every strip with the numbers of the regular nodes it passes, and its stations there."""
    both = zip(made.strips.nodes, design.nodes, strict=True)
    kept = [node for node, before in both if before.regular]
    for index, (rows, stations) in sorted(rows_by_lamella(kept).items()):
        yield index, rows, stations
