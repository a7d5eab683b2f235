import numpy as np
import pytest

import gridshell as gs
from gridshell.curvature import vertex_normals
from gridshell.mesh import grid_quads


def square(cells=16):
    """Parameters of a grid over |u|, |v| <= 0.6."""
    line = np.linspace(-0.6, 0.6, cells + 1)
    u, v = np.meshgrid(line, line, indexing="ij")
    return u.ravel(), v.ravel()


def meshed(surface, cells=16):
    return gs.QuadMesh(surface.point(*square(cells)), grid_quads(cells, cells))


def largest_error(surface, cells=16):
    """Relative to the exact curvature."""
    vertices, found = gs.principal_curvatures(meshed(surface, cells))
    exact = surface.principal_curvatures(*square(cells))[vertices]
    return np.abs(found / exact - 1.0).max()


SURFACES = {
    "sphere": gs.Sphere(1000.0),
    "catenoid": gs.Catenoid(700.0),
    "hyperbolic paraboloid": gs.Hypar(2000.0),
    "hyperboloid": gs.Hyperboloid(900.0, 1600.0),
    "helicoid": gs.Helicoid(5000.0),
}


@pytest.mark.parametrize("name", SURFACES)
def test_principal_curvatures_are_within_one_percent(name):
    assert largest_error(SURFACES[name]) < 0.01


@pytest.mark.parametrize("name", SURFACES)
def test_half_the_edge_length_gives_a_third_of_the_error_or_less(name):
    surface = SURFACES[name]
    assert largest_error(surface, 32) < largest_error(surface, 16) / 3.0


def test_curvature_is_negative_where_the_surface_bends_away_from_its_normal():
    _, outward = gs.principal_curvatures(meshed(gs.Sphere(1000.0)))
    assert (outward < 0.0).all()


def test_turning_the_mesh_over_swaps_the_signs():
    mesh = meshed(gs.Catenoid(700.0))
    over = gs.QuadMesh(mesh.vertices, mesh.quads[:, ::-1])
    _, front = gs.principal_curvatures(mesh)
    _, back = gs.principal_curvatures(over)
    np.testing.assert_allclose(back, -front[:, ::-1], rtol=1e-6)


def test_the_smaller_curvature_comes_first(monkey_saddle):
    _, found = gs.principal_curvatures(monkey_saddle)
    assert (found[:, 0] <= found[:, 1]).all()


def test_curvatures_scale_with_one_over_length():
    mesh = meshed(gs.Enneper(1300.0))
    _, small = gs.principal_curvatures(mesh)
    _, large = gs.principal_curvatures(mesh.moved(1000.0 * mesh.vertices + 1e6))
    np.testing.assert_allclose(1000.0 * large, small, rtol=1e-6)


@pytest.mark.parametrize(("cubic", "tolerance"), [(0.0, 1e-8), (0.02, 1e-4)])
def test_a_polynomial_of_degree_three_is_fitted_at_its_level_point(grid, cubic, tolerance):
    """Exactly where the first guess of the normal is exact, after two passes otherwise."""
    mesh = grid(4, 4, lambda x, y: 0.03 * (x - 2) ** 2 - 0.01 * (y - 2) ** 2 + cubic * (x - 2) ** 3)
    vertices, found = gs.principal_curvatures(mesh)
    (row,) = np.flatnonzero(vertices == 12)
    np.testing.assert_allclose(found[row], [-0.02, 0.06], rtol=tolerance)


def test_a_flat_mesh_has_no_curvature(grid):
    _, found = gs.principal_curvatures(grid(5, 5))
    assert np.abs(found).max() < 1e-14


def test_only_inner_vertices_with_fourteen_neighbours_are_estimated(grid):
    """In 2 x 5 quads the two rings of an inner vertex hold 3 x 5 vertices but near the ends."""
    vertices, found = gs.principal_curvatures(grid(2, 5))
    assert vertices.tolist() == [1 * 6 + 2, 1 * 6 + 3]
    assert found.shape == (2, 2)


def test_thirteen_neighbours_are_too_few(grid):
    """Without its first quad, one of both vertices has lost a corner of its two rings."""
    mesh = grid(2, 5)
    vertices, _ = gs.principal_curvatures(gs.QuadMesh(mesh.vertices, mesh.quads[1:]))
    assert vertices.tolist() == [1 * 6 + 3]


@pytest.mark.parametrize(("rows", "columns"), [(1, 1), (2, 2), (1, 9)])
def test_a_mesh_too_small_for_any_estimate_gives_none(grid, rows, columns):
    vertices, found = gs.principal_curvatures(grid(rows, columns))
    assert (vertices.shape, found.shape) == ((0,), (0, 2))


def test_an_unused_vertex_is_not_estimated(grid):
    mesh = grid(4, 4)
    widened = gs.QuadMesh(np.vstack([mesh.vertices, [9.0, 9.0, 9.0]]), mesh.quads)
    assert gs.principal_curvatures(widened)[0].tolist() == gs.principal_curvatures(mesh)[0].tolist()


def test_vertex_normals_of_a_flat_mesh_point_up(grid):
    np.testing.assert_array_equal(vertex_normals(grid(3, 3)), [[0.0, 0.0, 1.0]] * 16)


def test_vertex_normals_of_a_sphere_point_outwards():
    sphere = gs.Sphere(1000.0)
    mesh = meshed(sphere)
    cosine = np.einsum("nc,nc->n", vertex_normals(mesh), mesh.vertices / 1000.0)
    assert cosine[~mesh.on_boundary].min() > np.cos(np.radians(0.1))


def test_vertex_normals_have_unit_length_but_for_unused_vertices(monkey_saddle):
    widened = gs.QuadMesh(np.vstack([monkey_saddle.vertices, [0.0] * 3]), monkey_saddle.quads)
    length = np.linalg.norm(vertex_normals(widened), axis=1)
    np.testing.assert_allclose(length[:-1], 1.0, rtol=1e-15)
    assert length[-1] == 0.0


# ---- negative curvature ---------------------------------------------------------------------


@pytest.mark.parametrize("name", [name for name in SURFACES if name != "sphere"])
def test_saddle_shaped_surfaces_are_hyperbolic(name):
    gs.require_hyperbolic(meshed(SURFACES[name]))


def bowl(grid):
    """Curved most at vertex 60, the middle of 10 x 10 quads."""
    return grid(10, 10, lambda x, y: 2.0 * np.sqrt(36.0 + (x - 5.0) ** 2 + (y - 5.0) ** 2))


def test_a_bowl_is_refused_by_its_most_curved_vertex_and_the_position(grid):
    with pytest.raises(gs.NotHyperbolicError) as info:
        gs.require_hyperbolic(bowl(grid))
    assert info.value.where == "vertex 60 (5, 5, 12) mm"
    assert "100% of the vertices" in info.value.value


def test_the_refusal_names_the_curvature(grid):
    """At the middle both curvatures are 1 / 3."""
    with pytest.raises(gs.NotHyperbolicError) as info:
        gs.require_hyperbolic(bowl(grid))
    assert float(info.value.value.split()[0]) == pytest.approx(1.0 / 9.0, rel=0.05)


def test_a_flat_mesh_and_a_cylinder_are_refused(grid):
    for height in (None, lambda x, y: np.sqrt(100.0 - (x - 4.0) ** 2)):
        with pytest.raises(gs.NotHyperbolicError, match="negative Gaussian curvature"):
            gs.require_hyperbolic(grid(8, 8, height))


@pytest.mark.parametrize("scale", [1e-3, 1e3])
def test_the_judgement_does_not_depend_on_the_unit(grid, scale):
    saddle = grid(8, 8, lambda x, y: 0.05 * (x - 4.0) * (y - 4.0))
    gs.require_hyperbolic(saddle.moved(scale * saddle.vertices))
    with pytest.raises(gs.NotHyperbolicError):
        gs.require_hyperbolic(bowl(grid).moved(scale * bowl(grid).vertices))


def bumped(grid, bumps):
    """A saddle of 22 x 22 quads, 441 inner vertices, with small domes on some of them."""

    def height(x, y):
        domes = [np.exp(-((x - a) ** 2 + (y - b) ** 2)) for a, b in bumps]
        return 0.01 * (x - 11.0) * (y - 11.0) + 0.05 * np.sum(domes, axis=0)

    return grid(22, 22, height)


def test_a_bump_among_hundreds_of_vertices_is_tolerated(grid):
    mesh = bumped(grid, [(11, 11)])
    _, found = gs.principal_curvatures(mesh)
    assert (found.prod(axis=1) > 0.0).any()
    gs.require_hyperbolic(mesh)


def test_many_bumps_are_not(grid):
    bumps = [(a, b) for a in (4, 11, 18) for b in (4, 11, 18)]
    with pytest.raises(gs.NotHyperbolicError):
        gs.require_hyperbolic(bumped(grid, bumps))


def test_a_mesh_too_small_to_tell_is_not_refused(grid):
    gs.require_hyperbolic(grid(2, 2))
