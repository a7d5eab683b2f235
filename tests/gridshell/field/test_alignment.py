"""Angles between edges and lines."""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np
import pytest

from gridshell.errors import InputError
from gridshell.field import FrameField, alignment, asymptotic_field, lines_at
from gridshell.surface import CurvedMesh, Enneper, TriangulatedSurface


def test_error_is_the_angle_to_the_line_of_the_family(plane: CurvedMesh) -> None:
    row = plane.mesh.face_frames[:, 0]
    first = 0.3 - np.arctan2(row[:, 1], row[:, 0])
    field = FrameField.of_lines(plane.mesh, first, first + 1.0)
    faces = np.arange(len(first))
    rng = np.random.default_rng(1)
    off = rng.uniform(-1.5, 1.5, len(first))
    family = rng.integers(1, 3, len(first))
    turn = np.where(family == 1, 0.3, 1.3) + off + math.pi * rng.integers(0, 2, len(first))
    edges = 7.0 * np.stack([np.cos(turn), np.sin(turn), 0.0 * turn], axis=1)
    error = alignment(field, faces, plane.mesh.centroids, edges, family)
    np.testing.assert_allclose(error, np.abs(off), atol=1e-12)


def test_a_turning_field_is_read_between_the_middles(plane: CurvedMesh) -> None:
    mesh = plane.mesh
    row = mesh.face_frames[:, 0]

    def world(p: np.ndarray) -> np.ndarray:
        return 0.4 + 2.0 * p[:, 0] - 1.5 * p[:, 1]

    first = world(mesh.centroids) - np.arctan2(row[:, 1], row[:, 0])
    field = FrameField.of_lines(mesh, first, first + 1.0)
    faces = np.arange(len(first))
    for corner in range(3):
        points = mesh.corners[:, corner]
        lines = lines_at(field, faces, points, np.ones(len(faces)))
        exact = np.stack([np.cos(world(points)), np.sin(world(points)), 0.0 * faces], axis=1)
        np.testing.assert_allclose(np.abs(np.einsum("fc,fc->f", lines, exact)), 1.0, atol=1e-12)


@pytest.mark.parametrize("family", [1, 2])
def test_edges_along_exact_lines_have_almost_no_error(
    on_grid: Callable[..., CurvedMesh], family: int
) -> None:
    surface = Enneper(1.0)
    curved = on_grid(surface, ((-0.7, 0.7), (-0.7, 0.7)), (50, 50))
    field = asymptotic_field(curved)
    rng = np.random.default_rng(3)
    u, v = rng.uniform(-0.6, 0.6, (2, 400))
    d = surface.derivatives(u, v)
    faces, _ = TriangulatedSurface(curved.mesh.vertices, curved.mesh.triangles).locate(d.x)
    edges = [d.xu + d.xv, d.xu - d.xv]
    errors = [np.degrees(alignment(field, faces, d.x, e, np.full(len(u), family))) for e in edges]
    right = min(errors, key=np.mean)
    assert right.mean() < 0.02
    assert right.max() < 0.2
    assert max(errors, key=np.mean).min() > 80.0


def test_arrays_that_do_not_belong_together_are_refused(plane: CurvedMesh) -> None:
    first = np.zeros(len(plane.mesh.triangles))
    field = FrameField.of_lines(plane.mesh, first, first + 1.0)
    faces, points = np.arange(4), plane.mesh.centroids[:4]
    with pytest.raises(InputError, match="one family per point"):
        alignment(field, faces, points, points, np.array([1, 2, 3, 1]))
    with pytest.raises(InputError, match="one direction per point"):
        alignment(field, faces, points, points[:3], np.ones(4))
