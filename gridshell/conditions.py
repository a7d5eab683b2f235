"""Conditions a designer adds to a recipe: lengths, bounds of the angle, planes of symmetry."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Protocol

import numpy as np

from gridshell.angles import face_crossings
from gridshell.arrays import Floats, Indices, frozen, unit
from gridshell.constraints import (
    AngleBounds,
    EdgeLength,
    EqualDiagonals,
    Symmetry,
    planar_faces,
)
from gridshell.errors import SettingError
from gridshell.mesh import edge_stars, position
from gridshell.pose import Pose
from gridshell.solve import Term, Weight


class Condition(Protocol):
    """Anything that becomes one more term of the problem."""

    def term(self, pose: Pose) -> Term:
        """The term in the solver's units."""


@dataclass(frozen=True, eq=False)
class EdgeLengths:
    """Pairs of vertices at given distances.

    Parameters
    ----------
    edges : (m, 2) vertex indices; any two vertices, not only those of an edge.
    lengths : (m,) mm.

    Raises
    ------
    SettingError
        When the two do not belong together, or a length is not positive.
    """

    edges: Indices
    lengths: Floats
    weight: Weight = field(default=Weight(1.0))

    def __post_init__(self) -> None:
        object.__setattr__(self, "edges", frozen(self.edges, np.int64).reshape(-1, 2))
        object.__setattr__(self, "lengths", frozen(self.lengths))
        if self.lengths.shape != (len(self.edges),):
            raise SettingError(
                "Each pair of vertices needs a length",
                where="lengths",
                value=f"shape {self.lengths.shape}",
                limit=f"({len(self.edges)},)",
            )
        bad = np.flatnonzero(~(self.lengths > 0.0))
        if len(bad):
            raise SettingError(
                "A length must be positive",
                where=f"lengths {bad[0]}",
                value=f"{self.lengths[bad[0]]:g} mm",
            )

    def term(self, pose: Pose) -> Term:
        """Differences of length at unit mean edge."""
        _check_indices("edges", self.edges, len(pose.net.vertices))
        return Term(
            "edge length", self.weight, EdgeLength(self.edges, self.lengths / pose.scale), goal=True
        )


@dataclass(frozen=True)
class AngleBetween:
    """The diagonals of every control quad meet within bounds, and are else free.

    Parameters
    ----------
    lowest, highest : node angles, radians.

    Raises
    ------
    SettingError
        For an angle outside (0, 180) degrees, or bounds that leave nothing between them.
    """

    lowest: float
    highest: float
    weight: Weight = field(default=Weight(1.0))

    def __post_init__(self) -> None:
        if not 0.0 < self.lowest < self.highest < np.pi:
            low, high = np.degrees([self.lowest, self.highest])
            raise SettingError(
                "The bounds of the node angle leave nothing between them",
                where="angle_between",
                value=f"{low:g} and {high:g} degrees",
                limit="two angles between 0 and 180 degrees, the smaller first",
                advice="60 and 90 degrees",
            )

    def term(self, pose: Pose) -> Term:
        """How far cosines are out of bounds."""
        quads = face_crossings(pose.net)
        low, high = np.full(len(quads), self.lowest), np.full(len(quads), self.highest)
        return Term("angle bounds", self.weight, AngleBounds(quads, low, high), goal=True)


@dataclass(frozen=True)
class NearRhombi:
    """The black parallelograms are as near to rhombi (eq. 5) as the net's goals let them be.

    A net of planar stars with an angle of its own everywhere has no freedom left for exact rhombi:
    by the Codazzi equations equal lengths along both families go with few fields of angles. As a
    guide the condition shares what freedom there is with fairness.
    """

    weight: Weight = field(default=Weight(1e-2, 0.3))

    def term(self, pose: Pose) -> Term:
        """Differences of diagonals, as a guide."""
        return Term("near rhombi", self.weight, EqualDiagonals(pose.control.quads))


@dataclass(frozen=True)
class FlatRim:
    """The neighbours of every vertex lie in a plane where its ring is open, too.

    At a ragged rim a vertex may have three quads and four neighbours that bound no white face. Its
    node axis is the normal of their plane; unless they have one, support plates there are not flat.
    """

    weight: Weight = field(default=Weight(1.0))

    def term(self, pose: Pose) -> Term:
        """Any four neighbours in a row; there may be none."""
        stars = edge_stars(pose.control.mesh)
        rows = [np.empty((0, 4), dtype=np.int64)]
        for count in range(4, int(stars.count.max(initial=0)) + 1):
            ring = stars.spokes[~stars.closed & (stars.count == count), :count]
            rows += [ring[:, i : i + 4] for i in range(count - 3)]
        return Term("flat rim", self.weight, planar_faces(np.concatenate(rows)), goal=True)


@dataclass(frozen=True, eq=False)
class MirrorPlane:
    """The net is symmetric about a plane, as its start is.

    Parameters
    ----------
    origin : (3,) a point of the plane, mm.
    normal : (3,) of any length but zero.
    tolerance : how far the start may be from its mirror image, over its mean edge; each vertex
        must find its partner within it.

    Raises
    ------
    SettingError
        For a normal of length zero; from ``term`` when a vertex finds no partner.
    """

    origin: Floats
    normal: Floats
    tolerance: float = 0.2
    weight: Weight = field(default=Weight(1.0))

    def __post_init__(self) -> None:
        object.__setattr__(self, "origin", frozen(self.origin))
        if not np.linalg.norm(self.normal) > 0.0:
            raise SettingError("The normal of a plane needs a direction", where="normal")
        object.__setattr__(self, "normal", frozen(unit(np.asarray(self.normal, dtype=np.float64))))

    def term(self, pose: Pose) -> Term:
        """Offsets from the mirror image at unit mean edge."""
        origin = pose.inside(self.origin[None])[0]
        return Term(
            "symmetry",
            self.weight,
            Symmetry(self._partners(pose, origin), origin, self.normal),
            goal=True,
        )

    def _partners(self, pose: Pose, origin: Floats) -> Indices:
        from scipy.spatial import cKDTree

        used = np.flatnonzero(pose.net.mesh.valence > 0)
        x = pose.control.vertices[used]
        image = x - 2.0 * np.outer((x - origin) @ self.normal, self.normal)
        distance, partner = cKDTree(x).query(image)
        mutual = partner[partner] == np.arange(len(x))
        lost = np.flatnonzero((distance > self.tolerance) | ~mutual)
        if len(lost):
            v = int(used[lost[0]])
            raise SettingError(
                "A vertex has no mirror image",
                where=f"vertex {v} {position(pose.net.vertices[v])}",
                value=f"{distance[lost[0]] * pose.scale:.4g} mm to the nearest vertex",
                limit=f"{self.tolerance * pose.scale:.4g} mm",
                advice="a plane of symmetry of the mesh, or a larger tolerance",
            )
        once = np.arange(len(x)) <= partner
        return np.asarray(np.stack([used, used[partner]], axis=1)[once])


def _check_indices(key: str, indices: Indices, count: int) -> None:
    bad = indices[(indices < 0) | (indices >= count)]
    if len(bad):
        raise SettingError(
            "A vertex does not exist", where=key, value=str(bad[0]), limit=f"0 .. {count - 1}"
        )
