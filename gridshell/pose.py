"""A net as the solver sees it: mean edge 1, centroid at the origin, and what holds it."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from gridshell.anchors import Anchor, Hold
from gridshell.arrays import Floats, Points
from gridshell.mesh import ControlMesh
from gridshell.surface import Foot, Surface


@dataclass(frozen=True, eq=False)
class Pose:
    """The start of a solve.

    Parameters
    ----------
    net : in mm, as it came.
    centre : (3,) of its vertices in use, mm.
    scale : its mean edge, mm.
    hold : what the anchor asks for, in the solver's units.
    reference : surface to stay close to, in the solver's units.
    moved : (n, 3) where the solve begins when not at the net itself, mm.
    """

    net: ControlMesh
    centre: Floats
    scale: float
    hold: Hold
    reference: Surface | None = None
    moved: Points | None = None

    @cached_property
    def control(self) -> ControlMesh:
        """The net in the solver's units."""
        return self.net.moved(self.inside(self.net.vertices))

    @property
    def start(self) -> Floats:
        """(3 n,) where the solve begins, in the solver's units."""
        moved = self.net.vertices if self.moved is None else self.moved
        return np.asarray(self.inside(moved).ravel())

    def inside(self, points: Points) -> Points:
        """Positions (n, 3) from mm to the solver's units."""
        return (points - self.centre) / self.scale

    def outside(self, points: Points) -> Points:
        """Positions (n, 3) from the solver's units to mm."""
        return points * self.scale + self.centre


def pose(
    net: ControlMesh,
    anchor: Anchor,
    reference: Surface | None = None,
    *,
    start: Points | None = None,
) -> Pose:
    """Scale *net* to mean edge 1 around its centroid and ask the anchor what it holds.

    Parameters
    ----------
    start : (n, 3) where the solve begins, mm; None begins at the net.

    Raises
    ------
    SettingError
        When the anchor names a vertex that does not exist.
    """
    used = net.mesh.valence > 0
    centre, scale = net.vertices[used].mean(axis=0), net.mesh.mean_edge
    x = (net.vertices - centre) / scale
    hold = anchor.hold(net.moved(x), x)
    surface = None if reference is None else _Scaled(reference, centre, scale)
    return Pose(net, centre, scale, hold, surface, start)


@dataclass(frozen=True, eq=False)
class _Scaled:
    """A surface seen in the solver's units."""

    surface: Surface
    centre: Points
    scale: float

    def closest(self, points: Points) -> Foot:
        foot = self.surface.closest(points * self.scale + self.centre)
        return Foot(
            (foot.points - self.centre) / self.scale, foot.normals, foot.curvature * self.scale
        )
