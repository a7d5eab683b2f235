"""What is unknown follows its neighbours."""

from __future__ import annotations

import numpy as np

from gridshell.field import FrameField
from gridshell.field.extension import extended, filled, line_values
from gridshell.surface import CurvedMesh


def constant(plane: CurvedMesh, world: float, opening: float) -> FrameField:
    row = plane.mesh.face_frames[:, 0]
    first = world - np.arctan2(row[:, 1], row[:, 0])
    return FrameField.of_lines(plane.mesh, first, first + opening)


def test_a_constant_field_is_restored_exactly(plane: CurvedMesh) -> None:
    field = constant(plane, 0.4, 1.1)
    unknown = np.linalg.norm(plane.mesh.centroids - [0.5, 0.5, 0.0], axis=1) < 0.3
    spoilt = FrameField.of_lines(
        plane.mesh, np.where(unknown, 0.0, field.first), np.where(unknown, 2.9, field.second)
    )
    restored = filled(spoilt, unknown)
    np.testing.assert_allclose(np.sin(restored.first - field.first), 0.0, atol=1e-9)
    np.testing.assert_allclose(restored.angle, 1.1, atol=1e-9)
    assert (restored.first[~unknown] == spoilt.first[~unknown]).all()


def test_without_anything_known_the_field_stays(plane: CurvedMesh) -> None:
    field = constant(plane, 0.4, 1.1)
    assert filled(field, np.ones(len(field.first), dtype=bool)) is field
    assert filled(field, np.zeros(len(field.first), dtype=bool)) is field


def test_a_strong_pull_keeps_the_data_and_a_weak_one_lets_it_go(plane: CurvedMesh) -> None:
    mesh = plane.mesh
    rng = np.random.default_rng(0)
    values = line_values(rng.uniform(0.0, 3.0, len(mesh.triangles)))
    free = np.zeros(len(values), dtype=bool)
    strong = extended(mesh, values, np.full(len(values), 1e12), known=free)
    np.testing.assert_allclose(strong, values, atol=1e-6)
    weak = extended(mesh, values, np.full(len(values), 1e-6), known=free, turns=0)
    mean = (mesh.areas @ values) / mesh.areas.sum()
    np.testing.assert_allclose(weak, mean, atol=1e-3)
