import numpy as np

import gridshell as gs
from gridshell.constraints import stars_across_normals, white_quads_across_normals


def residual(constraint, vertices, normals):
    x = np.concatenate([np.ravel(vertices), np.ravel(normals)])
    return constraint.evaluate(x, None).residual


def up(mesh):
    return np.tile([0.0, 0.0, 1.0], (len(mesh.vertices), 1))


def test_a_flat_mesh_has_no_residual_with_its_own_normal(grid):
    mesh = grid(4, 5)
    for constraint in (
        stars_across_normals(gs.diagonal_stars(mesh), len(mesh.vertices)),
        white_quads_across_normals(gs.edge_stars(mesh), len(mesh.vertices)),
    ):
        assert len(constraint.points) == 12
        assert np.abs(residual(constraint, mesh.vertices, up(mesh))).max() == 0.0


def test_rows_of_a_star_are_the_heights_of_its_spokes(grid):
    mesh = grid(2, 2)
    vertices = mesh.vertices.copy()
    stars = gs.diagonal_stars(mesh)
    vertices[stars.spokes[4, :4], 2] = [0.1, 0.2, -0.3, 0.4]
    found = residual(stars_across_normals(stars, 9), vertices, up(mesh))
    np.testing.assert_allclose(found, [[0.1, 0.2, -0.3, 0.4]], atol=1e-15)


def test_rows_of_a_white_quad_are_the_rises_of_its_edges(grid):
    mesh = grid(2, 2)
    vertices = mesh.vertices.copy()
    stars = gs.edge_stars(mesh)
    vertices[stars.spokes[4, :4], 2] = [0.1, 0.2, -0.3, 0.4]
    found = residual(white_quads_across_normals(stars, 9), vertices, up(mesh))
    np.testing.assert_allclose(found, [[-0.1, 0.5, -0.7, 0.3]], atol=1e-15)


def test_each_star_refers_to_the_normal_of_its_own_centre(grid):
    mesh = grid(4, 4)
    points = stars_across_normals(gs.diagonal_stars(mesh), 25).points
    np.testing.assert_array_equal(points[:, -1] - points[:, 0], 25)
