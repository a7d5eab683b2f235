"""Halved edges: the surface, its curvature and the field come along."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pytest

from gridshell.field import FrameField, asymptotic_field, singularities, split_links
from gridshell.field.refinement import rotated
from gridshell.surface import CurvedMesh, TriangleMesh


def test_new_vertices_lie_on_the_surface(monkey: Callable[[int], CurvedMesh]) -> None:
    curved = monkey(12)
    refined = split_links(curved, asymptotic_field(curved), np.arange(60))
    mesh, parents = refined.curved.mesh, refined.vertex_parents
    n = len(curved.mesh.vertices)
    assert len(mesh.vertices) == n + len(parents)
    np.testing.assert_array_equal(mesh.vertices[:n], curved.mesh.vertices)
    x, y, z = mesh.vertices[n:].T
    chord = curved.mesh.vertices[parents].mean(axis=1)
    lifted = np.abs(z - (x**3 - 3.0 * x * y * y)).max()
    flat = np.abs(chord[:, 2] - (chord[:, 0] ** 3 - 3.0 * chord[:, 0] * chord[:, 1] ** 2)).max()
    assert lifted < 0.05 * flat
    normals = np.stack([-3.0 * (x * x - y * y), 6.0 * x * y, 1.0 + 0.0 * x], axis=1)
    normals /= np.linalg.norm(normals, axis=1)[:, None]
    assert np.linalg.norm(refined.curved.normals[n:] - normals, axis=1).max() < 0.02
    bend = np.einsum("nij,nj->ni", refined.curved.shapes[n:], refined.curved.normals[n:])
    assert np.abs(bend).max() < 1e-12


def test_children_copy_directions_and_curvature(monkey: Callable[[int], CurvedMesh]) -> None:
    curved = monkey(12)
    field = asymptotic_field(curved)
    refined = split_links(curved, field, np.array([0, 40, 41, 90]))
    mesh, parents = refined.curved.mesh, refined.face_parents
    carried = rotated(
        field.first_directions[parents], curved.mesh.face_normals[parents], mesh.face_normals
    )
    cosine = np.einsum("fc,fc->f", carried, refined.field.first_directions)
    np.testing.assert_allclose(cosine, 1.0, atol=1e-6)
    np.testing.assert_allclose(refined.field.angle, field.angle[parents], atol=1e-12)
    # the normal curvature along the copied line is still zero
    a, b, c = refined.curved.face_shapes.T
    t = refined.field.first
    bend = a * np.cos(t) ** 2 + b * np.sin(2.0 * t) + c * np.sin(t) ** 2
    assert np.abs(bend).max() < 1e-12 * curved.largest_curvature
    whole = np.bincount(parents)[parents] == 1
    assert (refined.curved.face_shapes[whole] == curved.face_shapes[parents[whole]]).all()


@pytest.mark.parametrize("count", [1, 2, 5, 30])
def test_topology_and_area_stay(plane: CurvedMesh, count: int) -> None:
    rng = np.random.default_rng(count)
    vertices = rng.choice(len(plane.mesh.vertices), count, replace=False)
    first = np.zeros(len(plane.mesh.triangles))
    field = FrameField.of_lines(plane.mesh, first, first + 1.0)
    refined = split_links(plane, field, vertices)
    mesh = refined.curved.mesh
    assert mesh.euler_characteristic == plane.mesh.euler_characteristic
    assert mesh.areas.sum() == pytest.approx(1.0, abs=1e-12)
    assert mesh.areas.min() > 0.0
    assert (mesh.face_normals[:, 2] > 0.99).all()
    parts = np.bincount(refined.face_parents, mesh.areas)
    np.testing.assert_allclose(parts, plane.mesh.areas, atol=1e-12)


def test_all_edges_of_a_tetrahedron_are_halved() -> None:
    points = np.array([[1, 1, 1], [1, -1, -1], [-1, 1, -1], [-1, -1, 1]], dtype=float)
    mesh = TriangleMesh(points, np.array([[0, 1, 2], [0, 3, 1], [0, 2, 3], [1, 3, 2]]))
    curved = CurvedMesh(mesh, points / np.sqrt(3.0), np.zeros((4, 3, 3)), np.zeros((4, 3)))
    field = FrameField.of_lines(mesh, np.zeros(4), np.ones(4))
    refined = split_links(curved, field, np.arange(4))
    assert len(refined.curved.mesh.triangles) == 16
    assert len(refined.vertex_parents) == 6
    assert refined.curved.mesh.euler_characteristic == 2
    assert singularities(refined.field).indices.sum() == 2.0
