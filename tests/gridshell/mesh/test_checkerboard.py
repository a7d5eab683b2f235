import numpy as np
import pytest

import gridshell as gs


@pytest.fixture(params=["crumpled grid", "monkey saddle", "torus"])
def control(request, grid, monkey_saddle, torus):
    mesh = {"crumpled grid": grid(4, 5), "monkey saddle": monkey_saddle, "torus": torus(4, 6)}
    chosen = mesh[request.param]
    noise = np.random.default_rng(7).normal(scale=0.2, size=chosen.vertices.shape)
    return gs.as_control_mesh(chosen.moved(chosen.vertices + noise))


def edge_vectors(corners):
    return np.roll(corners, -1, axis=-2) - corners


def test_vertices_are_the_midpoints_of_the_edges_in_their_order(control):
    ends = control.vertices[control.mesh.edges]
    np.testing.assert_array_equal(gs.checkerboard(control).vertices, ends.mean(axis=1))


def test_every_quad_gives_one_black_face(control):
    pattern = gs.checkerboard(control)
    np.testing.assert_allclose(
        pattern.vertices[pattern.black].mean(axis=1),
        control.vertices[control.quads].mean(axis=1),
        atol=1e-14,
    )


def test_black_faces_are_parallelograms(control):
    pattern = gs.checkerboard(control)
    a, b, c, d = pattern.vertices[pattern.black].swapaxes(0, 1)
    np.testing.assert_allclose(a - b + c - d, 0.0, atol=1e-14)


def test_edges_of_black_faces_are_half_the_diagonals(control):
    pattern = gs.checkerboard(control)
    corners = control.vertices[control.quads]
    half = (corners[:, [2, 3]] - corners[:, [0, 1]]) / 2.0
    edges = edge_vectors(pattern.vertices[pattern.black])
    np.testing.assert_allclose(edges[:, [0, 1]], half, atol=1e-14)


def test_there_is_one_white_face_around_every_inner_vertex(control):
    inner = ~control.mesh.on_boundary
    assert len(gs.checkerboard(control).white) == np.count_nonzero(inner)


def test_white_faces_are_half_a_face_of_either_net(control):
    pattern = gs.checkerboard(control)
    faces = {}
    for colour, net in enumerate(gs.diagonal_meshes(control)):
        centres = np.flatnonzero((control.colour == 1 - colour) & ~control.mesh.on_boundary)
        for centre, ring in zip(centres, net.faces, strict=True):
            faces[centre] = net.vertices[ring[ring >= 0]]
    inner = np.flatnonzero(~control.mesh.on_boundary)
    for centre, ring in zip(inner, pattern.white, strict=True):
        white = edge_vectors(pattern.vertices[ring[ring >= 0]])
        np.testing.assert_allclose(white, edge_vectors(faces[centre]) / 2.0, atol=1e-14)


def test_white_faces_of_small_valence_are_padded(monkey_saddle):
    white = gs.checkerboard(gs.as_control_mesh(monkey_saddle)).white
    assert np.unique((white >= 0).sum(axis=1), return_counts=True)[1].tolist() == [72, 1]
    assert white.shape[1] == 6


def test_black_and_white_faces_cover_a_flat_grid_but_for_the_rim(grid):
    pattern = gs.checkerboard(gs.as_control_mesh(grid(3, 3)))

    def area(faces):
        edges = edge_vectors(pattern.vertices[faces])
        return np.linalg.norm(np.cross(edges[:, 0], edges[:, 1]), axis=1).sum()

    assert area(pattern.black) == pytest.approx(9 * 0.5)
    assert area(pattern.white) == pytest.approx(4 * 0.5)
