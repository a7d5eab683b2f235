import numpy as np
import pytest

import gridshell as gs
from gridshell.constraints import planar_faces, planar_white_faces


def residual(constraint, vertices):
    return constraint.evaluate(np.ravel(vertices), None).residual


def test_a_translation_surface_has_planar_faces(grid):
    mesh = grid(5, 4, lambda x, y: 0.2 * x**2 - 0.1 * y**3)
    assert np.abs(residual(planar_faces(mesh.quads), mesh.vertices)).max() < 1e-13


def test_a_lifted_corner_gives_the_distance_of_the_diagonals():
    """Corners of a unit square, one lifted by h: the diagonals pass each other at h / sqrt(...)."""
    h = 0.3
    x = np.array([[0, 0, 0], [1, 0, 0], [1, 1, h], [0, 1, 0]])
    normal = np.cross(x[2] - x[0], x[3] - x[1])
    expected = (x[1] - x[0]) @ normal / np.linalg.norm(normal)
    found = residual(planar_faces(np.array([[0, 1, 2, 3]])), x)
    np.testing.assert_allclose(found, [[expected]], rtol=1e-14)
    assert abs(expected) > 0.1


def test_white_faces_are_those_of_both_diagonal_meshes(grid):
    control = gs.as_control_mesh(grid(4, 5))
    rings = planar_white_faces(gs.edge_stars(control.mesh)).points
    faces = [
        {int(v) for v in net.control_vertices[face[face >= 0]]}
        for net in gs.diagonal_meshes(control)
        for face in net.faces
    ]
    assert len(rings) == 12
    assert {frozenset(r) for r in rings.tolist()} == {frozenset(f) for f in faces}


def test_a_white_face_of_six_corners_gives_a_row_for_any_four_in_a_row(sectors):
    mesh = sectors(6, 2)
    constraint = planar_white_faces(gs.edge_stars(mesh))
    ring = gs.edge_stars(mesh).spokes[0].tolist()
    around = [p for p in constraint.points.tolist() if set(p) <= set(ring)]
    assert around == [np.roll(ring, -k)[:4].tolist() for k in range(6)]


@pytest.mark.parametrize("lifted", range(6))
def test_each_of_its_corners_shows_when_it_is_lifted(sectors, lifted):
    mesh = sectors(6, 1)
    vertices = mesh.vertices.copy()
    assert np.abs(residual(planar_white_faces(gs.edge_stars(mesh)), vertices)).max() < 1e-14
    vertices[gs.edge_stars(mesh).spokes[0][lifted], 2] = 0.2
    assert np.abs(residual(planar_white_faces(gs.edge_stars(mesh)), vertices)).max() > 0.05


def test_a_mesh_without_interior_vertices_has_no_white_face(grid):
    assert len(planar_white_faces(gs.edge_stars(grid(1, 5))).points) == 0
