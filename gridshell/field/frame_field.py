"""FrameField: one pair of labelled lines per triangle, and how pairs meet across edges.

A direction is a line (it has no sign), but the two are told apart: family 1 and family 2 run over
the whole surface. With the second line measured less than half a turn after the first, a pair can
meet its neighbour in two ways only, as it is or turned by pi. So every singularity has an index
that is a multiple of 1/2, and a quad mesh along the lines only has even valences there.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import NamedTuple

import numpy as np

from gridshell.arrays import Floats, Indices, Mask, Points, Vectors, frozen
from gridshell.errors import SurfaceError
from gridshell.surface.triangle_mesh import TriangleMesh, place

_HALF = 1e-6
"""An index may differ from a multiple of 1/2 by this much; more is a degenerate triangle."""


@dataclass(frozen=True, eq=False)
class FrameField:
    """Two tangent lines per triangle, labelled consistently over the surface.

    Parameters
    ----------
    mesh : the triangles.
    first, second : (f,) angles of the lines d1 and d2 against row 0 of ``mesh.face_frames``,
        counter-clockwise, rad; ``first < second < first + pi``.
    infeasible : (f,) whether the pair is a substitute, because the surface has none as asked for.

    Raises
    ------
    SurfaceError
        When the arrays do not belong to the mesh, or a second line does not lie within half a turn
        after the first.
    """

    mesh: TriangleMesh
    first: Floats
    second: Floats
    infeasible: Mask

    def __post_init__(self) -> None:
        f = len(self.mesh.triangles)
        for key, kind in (("first", np.float64), ("second", np.float64), ("infeasible", np.bool_)):
            object.__setattr__(self, key, frozen(getattr(self, key), kind))
            if getattr(self, key).shape != (f,):
                raise SurfaceError(
                    "The directions do not belong to the mesh",
                    where=key,
                    value=f"shape {getattr(self, key).shape}",
                    limit=f"({f},)",
                )
        bad = np.flatnonzero(~((self.angle > 0.0) & (self.angle < np.pi)))
        if len(bad):
            raise SurfaceError(
                "The two directions of a triangle coincide, or are not numbers",
                where=f"triangle {bad[0]} {place(self.mesh.centroids[bad[0]])}",
                value=f"{np.degrees(self.angle[bad[0]]):.6g} degrees from the first to the second",
                limit="more than 0 and less than 180 degrees",
                advice="give two directions that cross everywhere",
            )

    @classmethod
    def of_lines(
        cls, mesh: TriangleMesh, first: Floats, second: Floats, infeasible: Mask | None = None
    ) -> FrameField:
        """Take angles (f,) of lines, rad, up to multiples of pi; raises as the class does."""
        none = np.zeros(len(mesh.triangles), dtype=bool)
        opening = np.mod(np.asarray(second) - first, np.pi)
        return cls(mesh, first, first + opening, none if infeasible is None else infeasible)

    @property
    def angle(self) -> Floats:
        """(f,) angle from the first to the second direction, rad, in (0, pi)."""
        return np.asarray(self.second - self.first)

    @property
    def bisector(self) -> Floats:
        """(f,) angle of the line midway from the first to the second, rad."""
        return np.asarray((self.first + self.second) / 2.0)

    @cached_property
    def first_directions(self) -> Vectors:
        """(f, 3) unit vectors along the lines of family 1."""
        return directions(self.mesh, self.first)

    @cached_property
    def second_directions(self) -> Vectors:
        """(f, 3) unit vectors along the lines of family 2."""
        return directions(self.mesh, self.second)


class Matching(NamedTuple):
    """How the pair of each half-edge's triangle meets the pair across it."""

    sign: Indices
    """(3f,) +1 where the pairs match as they are, -1 turned by pi; +1 on the boundary."""
    rotation: Floats
    """(3f,) mean rotation of the matched pair from the triangle to the next one, rad, within
    pi/2; 0 on the boundary."""


class Singularities(NamedTuple):
    """Interior vertices around which the pair turns."""

    vertices: Indices
    """(k,) ascending."""
    indices: Floats
    """(k,) multiples of 1/2: turns of the pair in one turn around the vertex."""

    @property
    def valence(self) -> Indices:
        """(k,) edges of the quad mesh that meet there: 4 - 4 times the index, 0 for a pole."""
        return np.rint(4.0 - 4.0 * self.indices).astype(np.int64)

    def positions(self, mesh: TriangleMesh) -> Points:
        """(k, 3) where they are, mm."""
        return np.asarray(mesh.vertices[self.vertices])


def directions(mesh: TriangleMesh, angles: Floats) -> Vectors:
    """(f, 3) unit vectors at *angles* (f,), rad, in the frames of the triangles."""
    frames = mesh.face_frames
    return np.asarray(
        np.cos(angles)[:, None] * frames[:, 0] + np.sin(angles)[:, None] * frames[:, 1]
    )


def transport(mesh: TriangleMesh) -> Floats:
    """(3f,) what turns an angle in a half-edge's frame into the angle in its twin's, rad.

    The two triangles are unfolded around their common edge (Levi-Civita connection); the value is
    within pi, and 0 on the boundary.
    """
    corners = mesh.flat_corners
    along = np.roll(corners, -1, axis=1) - corners
    own = np.arctan2(along[..., 1], along[..., 0]).ravel()
    return np.where(mesh.twin < 0, 0.0, wrapped(own[mesh.twin] + np.pi - own))


def wrapped(angles: Floats, period: float = 2.0 * np.pi) -> Floats:
    """*angles* brought into half a *period* around 0, rad."""
    return np.asarray(angles - period * np.rint(angles / period))


def matching(field: FrameField) -> Matching:
    """Match every pair with its neighbours: the way that turns the bisector less.

    The sign is that of cos d1 + cos d2 over the transported differences of both lines, which is
    the sign of the cosine of their mean.
    """
    mesh = field.mesh
    face = np.arange(len(mesh.twin)) // 3
    other = np.where(mesh.twin < 0, face, mesh.twin // 3)
    turn = field.bisector[other] - field.bisector[face] - transport(mesh)
    half_turns = np.rint(turn / np.pi)
    sign = 1 - 2 * np.mod(half_turns, 2.0).astype(np.int64)
    return Matching(sign, np.asarray(turn - np.pi * half_turns))


def singularities(field: FrameField) -> Singularities:
    """Find the interior vertices around which the pair turns.

    Raises
    ------
    SurfaceError
        When an index is not a multiple of 1/2, which needs a degenerate triangle.
    """
    mesh = field.mesh
    n = len(mesh.vertices)
    corners = mesh.flat_corners
    ahead = np.roll(corners, -1, axis=1) - corners
    behind = np.roll(corners, 1, axis=1) - corners
    cross = ahead[..., 0] * behind[..., 1] - ahead[..., 1] * behind[..., 0]
    corner_angles = np.arctan2(cross, np.einsum("fki,fki->fk", ahead, behind)).ravel()
    # counter-clockwise around a vertex every triangle is left through the half-edge that ends there
    rotation = np.bincount(mesh.target, matching(field).rotation, n)
    defect = 2.0 * np.pi - np.bincount(mesh.origin, corner_angles, n)
    index = np.where(mesh.on_boundary, 0.0, (rotation + defect) / (2.0 * np.pi))
    exact = np.rint(2.0 * index) / 2.0
    bad = np.flatnonzero(~(np.abs(index - exact) < _HALF))
    if len(bad):
        raise SurfaceError(
            "The turns of the field around a vertex cannot be counted",
            where=f"vertex {bad[0]} {place(mesh.vertices[bad[0]])}",
            value=f"index {index[bad[0]]:.6g}",
            limit=f"a multiple of 1/2 to {_HALF:g}",
            advice="remesh the triangles there: one of them is degenerate",
        )
    vertices = np.flatnonzero(exact)
    return Singularities(vertices, exact[vertices])
