"""SmoothSurface: the curved surface a triangle mesh stands for, as a surface to stay close to.

Every vertex carries a quadric, x + n (d . S d / 2 - n . d) for the offset d from it; a point of a
triangle is lifted onto the mean of its corners' three, weighted by its barycentric coordinates.
Along an edge only the quadrics of its two ends count, so the surface has no gaps.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from gridshell.arrays import Floats, Indices, Points, Vectors, unit
from gridshell.surface.curved_mesh import CurvedMesh
from gridshell.surface.jet_fit import tangent_frames
from gridshell.surface.surface import Foot, checked_points
from gridshell.surface.triangulated import TriangulatedSurface

_STEPS = 3
"""Corrections of a foot; each leaves a share of about edge times curvature of its error."""

_STRONGEST = 0.5
"""Distance times curvature counts at most this much: beyond lies the centre of curvature."""


@dataclass(frozen=True, eq=False)
class SmoothSurface:
    """The blended vertex quadrics of a curved mesh.

    Parameters
    ----------
    curved : the mesh with normals and shape operators at its vertices.

    Raises
    ------
    SurfaceError
        When a triangle has no area.
    """

    curved: CurvedMesh

    def __post_init__(self) -> None:
        _ = self.flat

    @cached_property
    def flat(self) -> TriangulatedSurface:
        """The triangles themselves."""
        return TriangulatedSurface(self.curved.mesh.vertices, self.curved.mesh.triangles)

    def closest(self, points: Points) -> Foot:
        """Find the feet of *points* (n, 3), mm: those on the triangles, lifted and corrected.

        Raises
        ------
        InputError
            When *points* is not (n, 3) or not finite.
        """
        points = checked_points(points)
        faces, weights = self.flat.locate(points)
        below = flat_points(self.curved, faces, weights)
        for _ in range(_STEPS):
            feet, normals, shapes = blend(self.curved, faces, weights)
            below = below + _correction(points - feet, normals, shapes)
            faces, weights = self._next_to(faces, below)
            below = flat_points(self.curved, faces, weights)
        feet, normals, shapes = blend(self.curved, faces, weights)
        return Foot(feet, normals, _principal(normals, shapes))

    def _next_to(self, faces: Indices, points: Points) -> tuple[Indices, Floats]:
        """Nearest triangle (n,) among those that touch *faces* (n,), and the weights in it.

        Most points stay above the triangle they were in; only the others look around.
        """
        own, _ = self.flat.nearest_in(points, faces[:, None])
        faces, weights = faces.copy(), own[:, 0]
        left = np.flatnonzero(weights.min(axis=1) <= 0.0)
        spokes = self.curved.mesh.fans[self.curved.mesh.triangles[faces[left]]]
        spokes = spokes.reshape(len(left), 3 * spokes.shape[2])
        near = np.where(spokes < 0, faces[left, None], spokes // 3)
        share, distance = self.flat.nearest_in(points[left], near)
        rows, pick = np.arange(len(left)), np.argmin(distance, axis=1)
        faces[left], weights[left] = near[rows, pick], share[rows, pick]
        return faces, weights


def flat_points(curved: CurvedMesh, faces: Indices, barycentric: Floats) -> Points:
    """Points (n, 3), mm, on the flat triangles *faces* (n,) with weights *barycentric* (n, 3)."""
    corners = curved.mesh.vertices[curved.mesh.triangles[faces]]
    return np.asarray(np.einsum("nk,nkc->nc", barycentric, corners))


def lift(curved: CurvedMesh, faces: Indices, barycentric: Floats) -> Points:
    """Points (n, 3), mm, of the curved surface over points of its triangles.

    Parameters
    ----------
    faces : (n,) triangles.
    barycentric : (n, 3) weights of their corners, each row with the sum 1.
    """
    return blend(curved, faces, barycentric)[0]


def blend(curved: CurvedMesh, faces: Indices, weights: Floats) -> tuple[Points, Vectors, Floats]:
    """Lifted points (n, 3), mm, unit normals (n, 3), shape operators (n, 3, 3), 1/mm, there."""
    corners = curved.mesh.triangles[faces]
    flat = flat_points(curved, faces, weights)
    offset = flat[:, None] - curved.mesh.vertices[corners]
    normals, shapes = curved.normals[corners], curved.shapes[corners]
    turned = np.einsum("nkij,nkj->nki", shapes, offset)
    bulge = 0.5 * np.einsum("nki,nki->nk", offset, turned)
    height = bulge - np.einsum("nki,nki->nk", offset, normals)
    lifted = flat + np.einsum("nk,nkc->nc", weights * height, normals)
    return (
        lifted,
        unit(np.einsum("nk,nkc->nc", weights, normals - turned)),
        np.einsum("nk,nkij->nij", weights, shapes),
    )


def _correction(offset: Floats, normals: Vectors, shapes: Floats) -> Floats:
    """Steps (n, 3) along the surface that bring feet below points at *offset* (n, 3) from them.

    A step s turns the normal by -S s, so the foot is right when (1 - distance S) s = tangential
    part of the offset; near a centre of curvature the step is kept bounded.
    """
    distance = np.einsum("nc,nc->n", offset, normals)
    tangential = offset - distance[:, None] * normals
    size = np.linalg.norm(shapes, axis=(1, 2)) * np.abs(distance)
    distance = distance * np.minimum(1.0, _STRONGEST / np.maximum(size, _STRONGEST))
    system = np.eye(3) - distance[:, None, None] * shapes
    step = np.linalg.solve(system, tangential[..., None])[..., 0]
    return np.asarray(step - np.einsum("nc,nc->n", step, normals)[:, None] * normals)


def _principal(normals: Vectors, shapes: Floats) -> Floats:
    """Principal curvatures (n, 2), smaller first, of operators made tangential to *normals*."""
    tangents = tangent_frames(normals)[:, :2]
    local = tangents @ shapes @ tangents.transpose(0, 2, 1)
    return np.asarray(np.linalg.eigvalsh(local))
