"""Clusters of singular points become one vertex; poles and crowds are refused."""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np
import pytest

from gridshell.arrays import Floats
from gridshell.errors import PoleSingularityError, TooManySingularitiesError
from gridshell.field import (
    FrameField,
    asymptotic_field,
    cleaned,
    matching,
    merge_singularities,
    principal_field,
    singularities,
)
from gridshell.surface import CurvedMesh

Rings = Callable[[int], CurvedMesh]
Disk = Callable[..., CurvedMesh]


def in_plane(curved: CurvedMesh, world: Floats, opening: float = 1.2) -> FrameField:
    """A field in a plane from world angles (f,) of its first lines."""
    row = curved.mesh.face_frames[:, 0]
    first = world - np.arctan2(row[:, 1], row[:, 0])
    return FrameField.of_lines(curved.mesh, first, first + opening)


def test_two_points_of_valence_six_become_one_of_valence_eight(quartic: CurvedMesh) -> None:
    field = asymptotic_field(quartic)
    before = singularities(field)
    assert before.indices.tolist() == [-0.5, -0.5]
    after = singularities(merge_singularities(field, 0.15))
    assert after.vertices.tolist() == [0]
    assert after.valence.tolist() == [8]


def test_points_further_apart_than_two_edges_stay(quartic: CurvedMesh) -> None:
    field = asymptotic_field(quartic)
    before, after = singularities(field), singularities(merge_singularities(field, 0.04))
    assert after.vertices.tolist() == before.vertices.tolist()


def test_opposite_points_vanish(plane: CurvedMesh) -> None:
    x, y, _ = plane.mesh.centroids.T
    world = (np.arctan2(y - 0.53, x - 0.42) - np.arctan2(y - 0.52, x - 0.6)) / 2.0
    field = in_plane(plane, world)
    assert sorted(singularities(field).indices) == [-0.5, 0.5]
    merged = merge_singularities(field, 0.12)
    assert len(singularities(merged).vertices) == 0
    far = np.linalg.norm(plane.mesh.centroids - [0.5, 0.53, 0.0], axis=1) > 0.4
    assert far.any()
    assert (merged.first[far] == field.first[far]).all()
    inner = np.abs(matching(merged).rotation)
    middle = np.linalg.norm(plane.mesh.centroids - [0.51, 0.525, 0.0], axis=1) < 0.1
    assert inner.max() < 0.4
    assert inner.reshape(-1, 3)[middle].max() < 0.1


def test_disc_takes_the_directions_of_its_rim(monkey: Rings) -> None:
    curved = monkey(30)
    noisy = asymptotic_field(curved)
    near = np.linalg.norm(curved.mesh.centroids, axis=1) < 0.04
    twist = np.where(near, 0.3, 0.0)
    spoilt = FrameField.of_lines(curved.mesh, noisy.first + twist, noisy.second + twist)
    merged = merge_singularities(spoilt, 0.15)
    # the saddle is symmetric: the rim's directions are exact at every radius, up to its steepness
    for one, two in ((merged.first, noisy.first), (merged.second, noisy.second)):
        off = np.abs(np.sin(one - two))[near]
        assert off.max() < 0.02 < 0.2 < math.sin(0.3)


def test_a_singular_vertex_has_twice_the_triangles_and_its_index(monkey: Rings) -> None:
    curved = monkey(12)
    refined = cleaned(curved, asymptotic_field(curved), 0.2)
    found = singularities(refined.field)
    assert found.vertices.tolist() == [0]
    assert found.indices.tolist() == [-0.5]
    assert refined.curved.mesh.valence[0] == 2 * curved.mesh.valence[0] == 12
    assert refined.field.mesh is refined.curved.mesh


def test_a_field_without_singular_points_is_left_alone(on_grid: Callable[..., CurvedMesh]) -> None:
    from gridshell.surface import Enneper

    curved = on_grid(Enneper(1.0), ((-0.6, 0.6), (-0.6, 0.6)))
    field = asymptotic_field(curved)
    refined = cleaned(curved, field, 0.1)
    assert (refined.field.first == field.first).all()
    assert (refined.curved.mesh.triangles == curved.mesh.triangles).all()
    assert (refined.curved.face_shapes == curved.face_shapes).all()


def test_a_pole_is_refused_with_its_place(on_disk: Disk) -> None:
    def paraboloid(x: Floats, y: Floats) -> tuple[Floats, ...]:
        o = np.zeros_like(x)
        return (x * x + y * y) / 2.0, x, y, o + 1.0, o, o + 1.0

    curved = on_disk(paraboloid, 20)
    with pytest.raises(PoleSingularityError, match=r"vertex 0 .*index \+1 .*hole of about 0\.15"):
        cleaned(curved, principal_field(curved), 0.1)


def test_two_umbilics_too_close_are_a_pole(on_ellipsoid: Callable[..., CurvedMesh]) -> None:
    curved = on_ellipsoid((2.0, 1.9, 1.2), 4, 0.1)
    field = principal_field(curved)
    assert singularities(field).indices.tolist() == [0.5, 0.5]
    with pytest.raises(PoleSingularityError, match="2 singular points"):
        cleaned(curved, field, 1.0)
    assert singularities(cleaned(curved, field, 0.1).field).indices.tolist() == [0.5, 0.5]


def test_noise_is_refused(plane: CurvedMesh) -> None:
    x, y, _ = plane.mesh.centroids.T
    signs = np.where((np.arange(25) // 5 + np.arange(25) % 5) % 2, 0.5, -0.5)
    centres = [(0.1 + 0.2 * i, 0.1 + 0.2 * j) for i in range(5) for j in range(5)]
    world = sum(
        s * np.arctan2(y - v - 0.003, x - u - 0.004)
        for s, (u, v) in zip(signs, centres, strict=True)
    )
    field = in_plane(plane, np.asarray(world))
    assert len(singularities(field).vertices) == 25
    with pytest.raises(TooManySingularitiesError, match=r"25 singular points in about 1\d\d quads"):
        cleaned(plane, field, 0.09)


@pytest.mark.parametrize("index", [-1.0, -0.5, 0.5])
def test_a_point_next_to_the_boundary_keeps_its_index(plane: CurvedMesh, index: float) -> None:
    mesh = plane.mesh
    x, y, _ = mesh.centroids.T
    rows = np.flatnonzero(~mesh.on_boundary & (mesh.valence == 8))
    vertex = rows[np.argmin(np.linalg.norm(mesh.vertices[rows] - [0.5, 0.07, 0.0], axis=1))]
    u, v, _ = mesh.vertices[vertex]
    field = in_plane(plane, index * np.arctan2(y - v, x - u))
    assert singularities(field).vertices.tolist() == [vertex]
    merged = merge_singularities(field, 0.3)
    assert (merged.first != field.first).any()
    assert singularities(merged).indices.tolist() == [index]
    # the field is the same at every radius, so the rim says it all, over its gap as well
    np.testing.assert_allclose(np.sin(merged.first - field.first), 0.0, atol=0.01)
    np.testing.assert_allclose(merged.angle, 1.2, atol=1e-12)


def test_a_closed_surface_may_have_the_singular_points_it_needs(
    on_ellipsoid: Callable[..., CurvedMesh],
) -> None:
    curved = on_ellipsoid((2.0, math.sqrt(2.5), 1.0), 4)
    # 4 points in 70 quads are more than 5 %
    spacing = math.sqrt(float(curved.mesh.areas.sum()) / 70.0)
    refined = cleaned(curved, principal_field(curved), spacing)
    assert singularities(refined.field).indices.tolist() == [0.5] * 4


def test_a_disc_does_not_reach_the_next_singular_point(plane: CurvedMesh) -> None:
    x, y, _ = plane.mesh.centroids.T
    centres = ((0.44, 0.5), (0.565, 0.5))
    world = -sum(np.arctan2(y - v - 0.003, x - u - 0.004) for u, v in centres) / 2.0
    field = in_plane(plane, np.asarray(world))
    before = singularities(field)
    assert before.indices.tolist() == [-0.5, -0.5]
    # two edges of the triangles are more than the way to the other point
    after = singularities(merge_singularities(field, 0.05))
    assert after.vertices.tolist() == before.vertices.tolist()
    assert after.indices.tolist() == before.indices.tolist()


def test_cleaning_is_the_same_every_time(quartic: CurvedMesh) -> None:
    field = asymptotic_field(quartic)
    one, two = (merge_singularities(field, 0.15) for _ in range(2))
    assert one.first.tobytes() == two.first.tobytes()
