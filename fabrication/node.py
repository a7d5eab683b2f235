"""A node: where lamellas cross, with the axis both strips share."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from gridshell.arrays import Floats, Indices, Vectors


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


def node_angles(first: Vectors, second: Vectors, axes: Vectors) -> Floats:
    """(n,) turn from the line of family 1 to that of family 2, counter-clockwise (eq. 4), radians.

    Parameters
    ----------
    first, second : (n, 3) unit tangents of the two lamellas.
    axes : (n, 3) unit node axes, about which the turn is counted; it lies in [0, pi).
    """
    across = np.einsum("nc,nc->n", np.cross(first, second), axes)
    return np.asarray(np.arctan2(across, np.einsum("nc,nc->n", first, second)) % np.pi)


def rows_by_lamella(nodes: Sequence[Node]) -> dict[int, tuple[Indices, Floats]]:
    """By lamella the numbers of the *nodes* it passes, and its stations there, mm."""
    found: dict[int, list[tuple[int, float]]] = {}
    for row, node in enumerate(nodes):
        for crossing in node.crossings:
            found.setdefault(crossing.lamella, []).append((row, crossing.station))
    return {
        lamella: (np.array([row for row, _ in own]), np.array([s for _, s in own]))
        for lamella, own in found.items()
    }
