"""Cuts exist once, in strip coordinates; the flat part and the solid are their two images.

Strip coordinates: x from the strip's cut end along the developed axis, y across from the lower
edge (0) to the upper edge (width). The upper edge is the one the surface normal points to.

An outline is a closed polygon (k, 2), counter-clockwise, its first corner not repeated; or (k, 3)
where some of its pieces are arcs: the third column is then the bulge, tan(sweep / 4), of the piece
from a corner to the next, negative where the arc turns clockwise.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from enum import Enum

import numpy as np

from fabrication.outlines import outline_area
from gridshell import SettingError
from gridshell.arrays import Floats, frozen


class Edge(Enum):
    """The edge of the strip a slot opens to."""

    LOWER = "lower"
    UPPER = "upper"


class Floor(Enum):
    """How a slot ends inside the strip."""

    SQUARE = "square"
    ROUND = "round"
    DOGBONE = "dogbone"


@dataclass(frozen=True)
class Relief:
    """The shape of slot floors.

    Parameters
    ----------
    floor : SQUARE; ROUND, half a circle as wide as the slot beyond its depth; or DOGBONE, half a
        circle over each corner, which lets a round tool reach it. A slot too narrow for two of
        them gets a round floor.
    radius : of a dogbone, the tool's at least, mm.

    Raises
    ------
    SettingError
        For a dogbone without a radius.
    """

    floor: Floor = Floor.SQUARE
    radius: float = 0.0

    def __post_init__(self) -> None:
        if self.floor is Floor.DOGBONE and not (np.isfinite(self.radius) and self.radius > 0.0):
            raise SettingError(
                "A dogbone needs the radius of the tool",
                where="relief.radius",
                value=f"{self.radius:g} mm",
                limit="> 0",
                advice="half the cutter's diameter",
            )


SQUARE = Relief()
"""Floors of slots as a laser cuts them."""


@dataclass(frozen=True)
class Slot:
    """A notch with parallel walls.

    Parameters
    ----------
    x : centre line, mm from the strip's cut end.
    width, depth : of the parallel walls, mm.
    edge : where it opens.
    node : name of the node.
    partner : mark of the strip that goes in.
    relief : what is cut away beyond the walls.
    """

    x: float
    width: float
    depth: float
    edge: Edge
    node: str
    partner: str
    relief: Relief = SQUARE

    @property
    def floor(self) -> Floor:
        """What the floor really is: dogbones need room for two half circles."""
        if self.relief.floor is Floor.DOGBONE and not self.width > 2.0 * self._bone:
            return Floor.ROUND
        return self.relief.floor

    @property
    def reach(self) -> float:
        """Depth with the relief, mm."""
        if self.floor is Floor.ROUND:
            return self.depth + self.width / 2.0
        return self.depth + self._overcut

    @property
    def spread(self) -> float:
        """Half of the width with the relief, mm."""
        return self.width / 2.0 + self._overcut

    @property
    def _bone(self) -> float:
        """Where a dogbone leaves the walls and the floor, from the corner, mm."""
        return float(np.sqrt(2.0)) * self.relief.radius

    @property
    def _overcut(self) -> float:
        """How far a dogbone goes beyond walls and floor, mm."""
        if self.floor is not Floor.DOGBONE:
            return 0.0
        return self.relief.radius * (1.0 - float(np.sqrt(0.5)))

    def notch(self) -> list[tuple[float, float, float]]:
        """Corners from the left mouth to the right one: x from the centre, depth, bulge."""
        half, depth, bone = self.width / 2.0, self.depth, self._bone
        floors: dict[Floor, list[tuple[float, float, float]]] = {
            Floor.SQUARE: [(-half, depth, 0.0), (half, depth, 0.0)],
            Floor.ROUND: [(-half, depth, -1.0), (half, depth, 0.0)],
            Floor.DOGBONE: [
                (-half, depth - bone, -1.0),
                (bone - half, depth, 0.0),
                (half - bone, depth, -1.0),
                (half, depth - bone, 0.0),
            ],
        }
        return [(-half, 0.0, 0.0), *floors[self.floor], (half, 0.0, 0.0)]


@dataclass(frozen=True)
class Hole:
    """A round hole.

    Parameters
    ----------
    x, y : centre in strip coordinates, mm.
    diameter : mm.
    node : name of the node, or of the place between two.
    purpose : what goes through, for lists and drawings: "bolt M8".
    """

    x: float
    y: float
    diameter: float
    node: str
    purpose: str

    @property
    def area(self) -> float:
        """Mm2."""
        return float(np.pi) * self.diameter**2 / 4.0


@dataclass(frozen=True)
class Drill:
    """A round hole through both narrow walls of a hollow section, from its upper edge down.

    Parameters
    ----------
    x : of its axis, half-way through the thickness, mm from the cut end.
    diameter : mm.
    node : name of the node.
    purpose : what goes through, for lists and drawings: "pin M6".
    """

    x: float
    diameter: float
    node: str
    purpose: str

    @property
    def area(self) -> float:
        """Mm2."""
        return float(np.pi) * self.diameter**2 / 4.0


@dataclass(frozen=True)
class Cuts:
    """All cuts of one strip.

    Parameters
    ----------
    slots, holes, drills : in order along the strip.
    bevels : at its start and at its end, how much longer the near face (+b) is than the far one,
        mm along the strip; negative where it is shorter. The outline is the longer of both.
    """

    slots: tuple[Slot, ...] = ()
    holes: tuple[Hole, ...] = ()
    bevels: tuple[float, float] = (0.0, 0.0)
    drills: tuple[Drill, ...] = ()


def outline(length: float, width: float, slots: Sequence[Slot]) -> Floats:
    """The closed outline of a strip with its slots.

    Returns
    -------
    (k, 2) corners counter-clockwise from (0, 0), first corner not repeated; (k, 3) with bulges
    where a slot has a rounded floor. Straight edges are horizontal or vertical.
    """
    lower = sorted((s for s in slots if s.edge is Edge.LOWER), key=lambda s: s.x)
    upper = sorted((s for s in slots if s.edge is Edge.UPPER), key=lambda s: -s.x)
    corners = [(0.0, 0.0, 0.0)]
    for s in lower:
        corners += [(s.x + dx, dy, bulge) for dx, dy, bulge in s.notch()]
    corners += [(length, 0.0, 0.0), (length, width, 0.0)]
    for s in upper:
        corners += [(s.x - dx, width - dy, bulge) for dx, dy, bulge in s.notch()]
    corners.append((0.0, width, 0.0))
    rows = np.array(corners)
    return frozen(rows if rows[:, 2].any() else rows[:, :2])


def face_outlines(contour: Floats, bevels: tuple[float, float]) -> tuple[Floats, Floats]:
    """Outlines of the near (+b) and the far face of a strip whose ends are cut at an angle.

    Parameters
    ----------
    contour : outline of the strip, as long as the longer face at either end.
    bevels : see :class:`Cuts`.
    """
    faces = []
    first, last = float(contour[:, 0].min()), float(contour[:, 0].max())
    at_start, at_end = contour[:, 0] == first, contour[:, 0] == last
    for side in (1.0, -1.0):
        face = np.array(contour)
        face[at_start, 0] += max(0.0, -side * bevels[0])
        face[at_end, 0] -= max(0.0, -side * bevels[1])
        faces.append(frozen(face))
    return faces[0], faces[1]


def area(corners: Floats) -> float:
    """Signed area of an outline (k, 2), or (k, 3) with bulges, positive counter-clockwise, mm2."""
    return outline_area(corners)
