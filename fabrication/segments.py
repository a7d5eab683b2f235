"""Equal segments around a vertical axis: a canopy that is solved once and built several times.

Everything about one segment stays as it is; the others are copies, each turned by a full turn over
their number. A segment is put together hanging upside down, where gravity pulls it into its shape
(Fig. 17).
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from fabrication.outlines import Frame
from fabrication.structures import Structure
from gridshell import SettingError
from gridshell.arrays import Floats, Points


@dataclass(frozen=True)
class Segments:
    """Copies of a net.

    Parameters
    ----------
    count : how many there are, the first among them.
    centre : where the axis stands, mm.
    seam : what strips of two segments shall be apart at least, mm.

    Raises
    ------
    SettingError
        For fewer than two, or a seam that is negative.
    """

    count: int
    centre: tuple[float, float] = (0.0, 0.0)
    seam: float = 0.0

    def __post_init__(self) -> None:
        if self.count < 2:
            raise SettingError(
                "A canopy of segments has two or more",
                where="segments.count",
                value=f"{self.count}",
                limit="at least 2",
            )
        if not (np.isfinite(self.seam) and self.seam >= 0.0):
            raise SettingError(
                "A distance cannot be negative", where="segments.seam", value=f"{self.seam:g} mm"
            )

    @property
    def poses(self) -> tuple[Frame, ...]:
        """Where the coordinates of every copy lie, the first one at their own place."""
        return tuple(self._pose(k) for k in range(self.count))

    def _pose(self, number: int) -> Frame:
        turn = self.turn(number)
        centre = np.array([*self.centre, 0.0])
        return Frame(centre - turn @ centre, turn[:, 0], turn[:, 1])

    def turn(self, number: int) -> Floats:
        """(3, 3) rotation of copy *number*; quarters and halves exactly."""
        angle = 2.0 * np.pi * number / self.count
        c, s = np.cos(angle), np.sin(angle)
        c, s = (float(np.round(v)) if abs(v - np.round(v)) < 1e-12 else float(v) for v in (c, s))
        return np.array([[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]])

    def placed(self, points: Points, number: int) -> Points:
        """*points* (n, 3) of the first segment as those of copy *number*, mm."""
        centre = np.array([*self.centre, 0.0])
        return np.asarray((points - centre) @ self.turn(number).T + centre)


def hanging(design: Structure) -> Points:
    """(n, 3) the nodes of a segment turned upside down, its lowest one at height 0, mm.

    It is turned about a level axis along its longer side, which keeps left and right as they are.
    """
    points = np.array([node.position for node in design.nodes]).reshape(-1, 3)
    flat = points[:, :2] - points[:, :2].mean(axis=0)
    _, axes = np.linalg.eigh(flat.T @ flat)
    x, y = axes[:, 1].tolist()
    turned = points.copy()
    mirror = np.array([[2.0 * x * x - 1.0, 2.0 * x * y], [2.0 * x * y, 2.0 * y * y - 1.0]])
    turned[:, :2] = flat @ mirror.T
    turned[:, 2] = -points[:, 2]
    turned[:, 2] -= turned[:, 2].min()
    return turned
