import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

import gridshell as gs
from gridshell.mesh.panel_mesh import area_vectors

SQUARE = np.array([[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.0]])
UP = np.tile([0.0, 0.0, 2.0], (6, 1))


def quad_and_triangle():
    points = np.vstack([SQUARE, [[2.0, 0.5, 0.0], [9.0, 9.0, 9.0]]])
    return gs.panel_mesh(points, np.array([[0, 1, 2, 3], [1, 4, 2, -1]]), UP)


def test_vertices_that_no_panel_uses_are_left_out():
    mesh = quad_and_triangle()
    assert len(mesh.vertices) == 5
    np.testing.assert_array_equal(mesh.axes, np.tile([0.0, 0.0, 1.0], (5, 1)))


def test_the_shared_edge_knows_the_panel_left_and_right_of_it():
    mesh = quad_and_triangle()
    shared = mesh.edges.tolist().index([1, 2])
    assert mesh.edge_faces[shared].tolist() == [0, 1]
    assert np.count_nonzero(mesh.edge_faces < 0) == 5
    assert mesh.corners.tolist() == [4, 3]
    assert mesh.boundary.all()


def test_face_edges_are_the_sides_in_order():
    mesh = quad_and_triangle()
    for face, count in zip(range(2), mesh.corners, strict=True):
        ring = mesh.faces[face, :count]
        for side, (a, b) in enumerate(zip(ring, np.roll(ring, -1), strict=True)):
            edge = mesh.face_edges[face, side]
            assert set(mesh.edges[edge]) == {a, b}
            assert mesh.edge_faces[edge, int(a > b)] == face
    assert mesh.face_edges[1, 3] == -1


@given(st.integers(3, 9), st.floats(0.1, 100.0), st.integers(0, 4))
def test_the_area_vector_of_a_regular_polygon(corners, radius, padding):
    turn = 2.0 * np.pi * np.arange(corners) / corners
    points = radius * np.stack([np.cos(turn), np.sin(turn), np.full(corners, 0.7)], axis=1)
    polygon = np.r_[np.arange(corners), np.full(padding, -1)][None]
    expected = corners / 2.0 * radius**2 * np.sin(2.0 * np.pi / corners)
    np.testing.assert_allclose(area_vectors(points, polygon), [[0.0, 0.0, expected]], atol=1e-9)


def test_averaged_normals_weigh_panels_alike():
    roof = np.array([[0.0, 0, 0], [0, 1, 0], [5, 0, 0], [5, 1, 0], [0, 0, 9], [0, 1, 9]])
    mesh = gs.panel_mesh(roof, np.array([[0, 2, 3, 1], [0, 1, 5, 4]]), UP)
    ridge = gs.averaged_normals(mesh)[0]
    np.testing.assert_allclose(ridge, [np.sqrt(0.5), 0.0, np.sqrt(0.5)], atol=1e-12)


def test_no_panels_are_refused():
    with pytest.raises(gs.MeshError, match="too small"):
        gs.panel_mesh(SQUARE, np.empty((0, 4), dtype=int), UP[:4])


def test_overlapping_panels_are_refused_by_edge():
    faces = np.array([[0, 1, 2, 3], [0, 1, 3, -1]])
    with pytest.raises(gs.NonManifoldError, match="edge 0-1"):
        gs.panel_mesh(SQUARE, faces, UP[:4])


@pytest.mark.parametrize("axis", [[0.0, 0.0, 0.0], [np.nan, 0.0, 1.0]])
def test_a_node_without_an_axis_is_refused_by_number(axis):
    axes = UP[:4].copy()
    axes[2] = axis
    with pytest.raises(gs.MeshError, match="node 2"):
        gs.panel_mesh(SQUARE, np.array([[0, 1, 2, 3]]), axes)
