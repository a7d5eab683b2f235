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
from fabrication.joints.stud_shapes import (
    Stud,
    stud_lines,
    stud_need,
    stud_prisms,
    stud_sizes,
)
from fabrication.node import Node, rows_by_lamella
from fabrication.outlines import Frame
from fabrication.rooms import room_beside
from fabrication.shapes import Prisms
from fabrication.shear_blocks import Blocks, ShearBlock, made_grip, shear_blocks
from fabrication.stock import require_distance, require_positive
from fabrication.structures import Structure
from gridshell import SettingError
from gridshell.arrays import Floats, Indices


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
        sizes, angles = stud_sizes(self.stud, rooms, nodes)
        length = (
            2.0 * level + design.profile.width if self.stud.length is None else (self.stud.length)
        )
        studs = stud_prisms(
            self.stud, nodes, bisector_frames(nodes, tangents), sizes, angles, length
        )
        holes, fixtures = self._holes(design, made, nodes, tangents)
        bolts, bolt_bill = self._bolts(design, made, nodes, tangents, level)
        blocks = self._blocks(design, made, sizes, nodes)
        need = stud_need(self.stud, nodes)
        hole = self.bolt + HOLE_PLAY if self.bolt else 0.0
        found = stud_findings(
            design,
            made,
            nodes,
            need=need,
            room=rooms.min(axis=1, initial=np.inf),
            level=level,
            length=length,
            hole=hole,
            spacing=self.spacing,
            fit=self.stud.fit,
        )
        cuts = {
            mark: Cuts(holes=tuple(sorted([*own, *blocks.holes[mark]], key=lambda h: h.x)))
            for mark, own in holes.items()
        }
        lines = stud_lines(self.stud, studs, length=length, hole=hole)
        return Jointed(
            design=design,
            strips=made.strips,
            carriers=made.carriers,
            cuts=cuts,
            fixtures=(*fixtures, *blocks.fixtures),
            connectors=(studs, *bolts, *blocks.connectors),
            bill=(*lines, *bolt_bill, *blocks.bill),
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


def _passing(design: Structure, made: Arrangement) -> Iterator[tuple[int, Indices, Floats]]:
    """Every strip with the numbers of the regular nodes it passes, and its stations there."""
    both = zip(made.strips.nodes, design.nodes, strict=True)
    kept = [node for node, before in both if before.regular]
    for index, (rows, stations) in sorted(rows_by_lamella(kept).items()):
        yield index, rows, stations
