"""A node: where lamellas cross, with the axis both strips share."""

from __future__ import annotations

from dataclasses import dataclass

from gridshell.arrays import Floats


@dataclass(frozen=True, eq=False)
class Crossing:
    """One lamella at a node.

    Parameters
    ----------
    lamella : index into the structure's lamellas.
    station : where the node lies on that lamella's axis, mm.
    """

    lamella: int
    station: float


@dataclass(frozen=True, eq=False)
class Node:
    """A vertex of the net as a place where parts meet.

    Parameters
    ----------
    name : "N1", "N2", ...: the net's vertex number plus one, the same at every export.
    position : (3,) mm.
    axis : (3,) unit; perpendicular to both lamellas, so that both strips stand along it.
    angle : turn from the lamella of family 1 to that of family 2, counter-clockwise about the
        axis (eq. 4), in (0, pi); None where only one passes.
    crossings : the lamellas here, family 1 first.
    star_tilt : angle between the axis and the normal of the node's vertex star, radians.
    """

    name: str
    position: Floats
    axis: Floats
    angle: float | None
    crossings: tuple[Crossing, ...]
    star_tilt: float

    @property
    def regular(self) -> bool:
        """Whether exactly one lamella of each family crosses here."""
        return self.angle is not None and len(self.crossings) == 2

    @property
    def singular(self) -> bool:
        """Whether more than two lamellas end here, so that no two of them cross."""
        return self.angle is None and len(self.crossings) > 2
