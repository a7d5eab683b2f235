"""Which two families of lines the quad mesh shall follow: frozen wishes that make a field."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Protocol

from gridshell.arrays import Vectors
from gridshell.field import (
    FrameField,
    Guide,
    Hand,
    Infeasible,
    asymptotic_field,
    conjugate_field,
    directions_field,
    principal_field,
)
from gridshell.surface import CurvedMesh


class Directions(Protocol):
    """Makes the frame field of a surface."""

    def field(self, curved: CurvedMesh) -> FrameField:
        """The pair of directions on every triangle; raises where the surface has none."""


@dataclass(frozen=True)
class Asymptotic:
    """The two directions without normal curvature: K < 0 is needed."""

    def field(self, curved: CurvedMesh) -> FrameField:
        """See :func:`gridshell.field.asymptotic_field`."""
        return asymptotic_field(curved)


@dataclass(frozen=True)
class Principal:
    """The directions of least and greatest normal curvature.

    Parameters
    ----------
    guides : lines the field follows where the surface leaves it free.
    """

    guides: tuple[Guide, ...] = ()

    def field(self, curved: CurvedMesh) -> FrameField:
        """See :func:`gridshell.field.principal_field`."""
        return principal_field(curved, guides=self.guides)


@dataclass(frozen=True)
class Conjugate:
    """Conjugate directions at a constant angle (eqs. 1-3).

    Parameters
    ----------
    angle : from family 1 to family 2, radians.
    hand : which of the two mirror-symmetric pairs.
    where_infeasible : what to do where K > 0 leaves no such pair.
    guides : lines the field follows where the surface leaves it free.
    """

    angle: float
    hand: Hand = Hand.RIGHT
    where_infeasible: Infeasible = Infeasible.WIDEN
    guides: tuple[Guide, ...] = ()

    def field(self, curved: CurvedMesh) -> FrameField:
        """See :func:`gridshell.field.conjugate_field`."""
        return conjugate_field(
            curved,
            self.angle,
            hand=self.hand,
            where_infeasible=self.where_infeasible,
            guides=self.guides,
        )


@dataclass(frozen=True, eq=False)
class Given:
    """Two vector fields (f, 3) over the triangles, from elsewhere."""

    first: Vectors
    second: Vectors

    def field(self, curved: CurvedMesh) -> FrameField:
        """See :func:`gridshell.field.directions_field`."""
        return directions_field(curved.mesh, self.first, self.second)
