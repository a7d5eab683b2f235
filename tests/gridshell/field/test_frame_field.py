"""Pairs of lines on triangles: transport, matching and turns around vertices."""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from gridshell.arrays import Floats
from gridshell.errors import SurfaceError
from gridshell.field import (
    FrameField,
    asymptotic_field,
    matching,
    principal_field,
    singularities,
    transport,
)
from gridshell.surface import CurvedMesh, Torus, TriangleMesh

Grid = Callable[..., CurvedMesh]


def turning(plane: CurvedMesh, centre: Floats, index: float, start: float = 0.2) -> FrameField:
    """A flat field that turns *index* times around *centre*."""
    mesh = plane.mesh
    x, y = (mesh.centroids[:, :2] - centre).T
    world = start + index * np.arctan2(y, x)
    row = mesh.face_frames[:, 0]
    first = world - np.arctan2(row[:, 1], row[:, 0])
    return FrameField.of_lines(mesh, first, first + 1.1)


def test_transport_unfolds_two_triangles(on_ellipsoid: Callable[..., CurvedMesh]) -> None:
    mesh = on_ellipsoid((3.0, 2.0, 1.5), 2).mesh
    turn = transport(mesh)
    along = mesh.vertices[mesh.target] - mesh.vertices[mesh.origin]
    face = np.arange(len(mesh.twin)) // 3

    def angle(faces: np.ndarray) -> Floats:
        local = np.einsum("hic,hc->hi", mesh.face_frames[faces, :2], along)
        return np.asarray(np.arctan2(local[:, 1], local[:, 0]))

    # the common edge keeps its direction
    off = angle(face) + turn - angle(mesh.twin // 3)
    np.testing.assert_allclose(np.cos(off), 1.0, atol=1e-12)
    np.testing.assert_allclose(np.cos(turn + turn[mesh.twin]), 1.0, atol=1e-12)


def test_transport_on_the_boundary_is_zero(plane: CurvedMesh) -> None:
    assert (transport(plane.mesh)[plane.mesh.twin < 0] == 0.0).all()


@pytest.mark.parametrize("index", [-1.0, -0.5, 0.0, 0.5, 1.0])
def test_a_field_that_turns_is_singular_with_that_index(plane: CurvedMesh, index: float) -> None:
    # a vertex amid eight triangles: the pair turns 45 degrees at most between two of them
    mesh = plane.mesh
    candidates = np.flatnonzero((mesh.valence == 8) & ~mesh.on_boundary)
    middle = np.linalg.norm(mesh.vertices[candidates] - [0.5, 0.5, 0.0], axis=1)
    vertex = candidates[np.argmin(middle)]
    found = singularities(turning(plane, mesh.vertices[vertex, :2], index))
    assert found.vertices.tolist() == ([vertex] if index else [])
    assert found.indices.tolist() == ([index] if index else [])
    assert found.valence.tolist() == ([round(4 - 4 * index)] if index else [])


@given(seed=st.integers(0, 1000))
def test_labels_up_to_half_turns_do_not_matter(plane: CurvedMesh, seed: int) -> None:
    field = turning(plane, np.array([0.4, 0.6]), -0.5)
    turns = np.random.default_rng(seed).integers(-3, 4, (2, len(field.first))) * math.pi
    other = FrameField.of_lines(plane.mesh, field.first + turns[0], field.second + turns[1])
    one, two = singularities(field), singularities(other)
    assert one.vertices.tolist() == two.vertices.tolist()
    np.testing.assert_allclose(matching(other).rotation, matching(field).rotation, atol=1e-12)
    np.testing.assert_allclose(other.angle, field.angle, atol=1e-12)


def test_matching_of_a_halfedge_and_its_twin_are_opposite(monkey: Callable) -> None:
    field = asymptotic_field(monkey(8))
    inner = np.flatnonzero(field.mesh.twin >= 0)
    sign, rotation = matching(field)
    twin = field.mesh.twin[inner]
    assert (sign[inner] == sign[twin]).all()
    np.testing.assert_allclose(rotation[inner], -rotation[twin], atol=1e-12)
    assert set(sign.tolist()) == {1, -1}


def test_matched_pairs_are_close_in_space(monkey: Callable) -> None:
    field = asymptotic_field(monkey(30))
    mesh = field.mesh
    inner = np.flatnonzero(mesh.twin >= 0)
    away = np.linalg.norm(mesh.centroids[inner // 3][:, :2], axis=1)
    inner = inner[away > 0.3]
    here, there = inner // 3, mesh.twin[inner] // 3
    sign = matching(field).sign[inner]
    for lines in (field.first_directions, field.second_directions):
        cosine = np.einsum("hc,hc->h", lines[here], lines[there]) * sign
        assert cosine.min() > 0.9


def test_torus_has_no_singularities(on_grid: Grid) -> None:
    def formula(u: Floats, v: Floats):
        from gridshell.surface import Derivatives

        cu, su, cv, sv, o = np.cos(u), np.sin(u), np.cos(v), np.sin(v), np.zeros_like(u)
        r = 3.0 + cv
        rows = [
            (r * cu, r * su, sv),
            (-r * su, r * cu, o),
            (-sv * cu, -sv * su, cv),
            (-r * cu, -r * su, o),
            (sv * su, -sv * cu, o),
            (-cv * cu, -cv * su, -sv),
        ]
        return Derivatives(*(np.stack(row, axis=-1) for row in rows))

    box = ((0.0, 2.0 * math.pi), (0.0, 2.0 * math.pi))
    curved = on_grid(formula, box, (40, 20), (True, True))
    assert curved.mesh.euler_characteristic == 0
    field = principal_field(curved)
    assert len(singularities(field).vertices) == 0
    assert len(np.flatnonzero(curved.mesh.twin < 0)) == 0


def test_inner_torus_ring_has_no_singularities(on_grid: Grid) -> None:
    torus = Torus(3000.0, 800.0)
    low, high = torus.domain[1]
    box = ((0.0, torus.period_u), (0.9 * low, 0.9 * high))
    field = asymptotic_field(on_grid(torus, box, (60, 20), (True, False)))
    assert len(singularities(field).vertices) == 0


def test_indices_of_a_closed_surface_add_up_to_its_euler_characteristic(
    on_ellipsoid: Callable[..., CurvedMesh],
) -> None:
    curved = on_ellipsoid((3.0, 2.0, 1.5), 3)
    rng = np.random.default_rng(5)
    first = rng.uniform(0.0, math.pi, len(curved.mesh.triangles))
    noise = FrameField.of_lines(curved.mesh, first, first + 1.0)
    assert singularities(noise).indices.sum() == curved.mesh.euler_characteristic == 2
    assert len(singularities(noise).indices) > 20


def test_coinciding_lines_are_refused(plane: CurvedMesh) -> None:
    first = np.zeros(len(plane.mesh.triangles))
    second = first + 1.0
    second[7] = math.pi
    with pytest.raises(SurfaceError, match="triangle 7"):
        FrameField.of_lines(plane.mesh, first, second)
    with pytest.raises(SurfaceError, match="shape"):
        FrameField.of_lines(plane.mesh, first[1:], second[1:], np.zeros(3, dtype=bool))


def test_lines_that_are_not_numbers_are_refused(plane: CurvedMesh) -> None:
    first = np.full(len(plane.mesh.triangles), np.nan)
    with pytest.raises(SurfaceError, match="not numbers"):
        FrameField.of_lines(plane.mesh, first, first)


@pytest.mark.filterwarnings("ignore::RuntimeWarning")
def test_triangles_whose_size_overflows_are_named(plane: CurvedMesh) -> None:
    mesh = TriangleMesh(plane.mesh.vertices * 1e200, plane.mesh.triangles)
    first = np.zeros(len(mesh.triangles))
    with pytest.raises(SurfaceError, match="degenerate"):
        singularities(FrameField.of_lines(mesh, first, first + 1.0))
