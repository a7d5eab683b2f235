import numpy as np
import pytest

import gridshell as gs
from gridshell.mesh import grid_quads


def sampled(surface, u, v, n):
    """Triangles over an n x n grid of parameters."""
    uu, vv = np.meshgrid(np.linspace(*u, n + 1), np.linspace(*v, n + 1), indexing="ij")
    points = surface.point(uu.ravel(), vv.ravel())
    return gs.TriangulatedSurface.of_quads(points, grid_quads(n, n))


def brute_force(surface, point, samples=60):
    """Distance to a dense sampling of every triangle."""
    i, j = np.meshgrid(np.arange(samples + 1), np.arange(samples + 1), indexing="ij")
    inside = i + j <= samples
    b, c = i[inside] / samples, j[inside] / samples
    corners = surface.vertices[surface.triangles]
    all_points = np.einsum("kw,fwc->fkc", np.stack([1.0 - b - c, b, c], axis=1), corners)
    return np.linalg.norm(all_points - point, axis=2).min()


def test_feet_are_as_close_as_a_dense_sampling_says():
    rng = np.random.default_rng(3)
    vertices = rng.normal(size=(30, 3))
    triangles = np.array([rng.choice(30, 3, replace=False) for _ in range(25)])
    surface = gs.TriangulatedSurface(vertices, triangles)
    points = 2.0 * rng.normal(size=(40, 3))
    found = np.linalg.norm(surface.closest(points).points - points, axis=1)
    expected = np.array([brute_force(surface, p) for p in points])
    assert (found <= expected + 1e-12).all()
    np.testing.assert_allclose(found, expected, atol=0.03)


def test_a_large_triangle_beside_many_small_ones_is_not_overlooked():
    """Its centroid is far away, its edge is near."""
    small = np.stack(np.meshgrid(np.arange(40.0), np.arange(3.0), [-3.0]), axis=-1).reshape(-1, 3)
    large = np.array([[-500.0, -2.0, 0.0], [500.0, -2.0, 0.0], [0.0, -900.0, 0.0]])
    from scipy.spatial import Delaunay

    faces = np.vstack([Delaunay(small[:, :2]).simplices, [[120, 121, 122]]])
    surface = gs.TriangulatedSurface(np.vstack([small, large]), faces)
    foot = surface.closest(np.array([[20.0, 0.0, 0.0]]))
    np.testing.assert_allclose(foot.points, [[20.0, -2.0, 0.0]], atol=1e-9)


@pytest.mark.parametrize("n", [16, 32])
def test_feet_on_a_sampled_torus_approach_the_exact_ones(n):
    exact = gs.Torus(3000.0, 1000.0)
    surface = sampled(exact, (0.0, 1.5), (-0.7, 0.7), n)
    points = 1.02 * exact.point(np.array([0.4, 0.8, 1.1]), np.array([0.1, -0.2, 0.3]))
    apart = np.linalg.norm(surface.closest(points).points - exact.closest(points).points, axis=1)
    assert apart.max() < 12000.0 / n**2


def test_normals_and_curvature_follow_the_surface_with_its_signs():
    exact = gs.Torus(3000.0, 1000.0)
    surface = sampled(exact, (0.0, 1.5), (-0.7, 0.7), 40)
    points = exact.point(np.array([0.4, 0.8, 1.1]), np.array([0.1, -0.2, 0.3]))
    found, truth = surface.closest(points), exact.closest(points)
    sign = np.sign(np.einsum("nc,nc->n", found.normals, truth.normals))
    assert len(set(sign)) == 1
    cosine = np.abs(np.einsum("nc,nc->n", found.normals, truth.normals))
    assert cosine.min() > 0.9995
    expected = np.sort(sign[0] * truth.curvature, axis=1)
    np.testing.assert_allclose(found.curvature, expected, rtol=0.08)


def test_a_hyperbolic_surface_has_curvatures_of_both_signs():
    surface = sampled(gs.Enneper(1000.0), (-0.5, 0.5), (-0.5, 0.5), 30)
    kappa = surface.closest(surface.vertices[::17]).curvature
    assert (kappa[:, 0] < 0.0).all()
    assert (kappa[:, 1] > 0.0).all()


def test_an_optimiser_keeps_to_a_surface_of_triangles(enneper):
    surface = sampled(gs.Enneper(4000.0), (-1.0, 1.0), (-1.0, 1.0), 60)
    found = gs.optimize(enneper(10), gs.a_net(), anchor=gs.Free(), reference=surface)
    assert found.converged
    assert found.quality.surface_distance_mm.mean < 10.0


def test_a_triangle_without_area_is_named():
    vertices = np.array([[0.0, 0, 0], [1, 0, 0], [0, 1, 0], [2, 0, 0]])
    with pytest.raises(gs.SurfaceError, match="no area") as info:
        gs.TriangulatedSurface(vertices, [[0, 1, 2], [0, 1, 3]])
    assert info.value.where == "triangle 1"


@pytest.mark.parametrize("triangles", [np.empty((0, 3)), [[0, 1]], [[0, 1, 9]], [[-1, 0, 1]]])
def test_triangles_must_lie_over_the_vertices(triangles):
    with pytest.raises(gs.SurfaceError, match="needs triangles"):
        gs.TriangulatedSurface(np.eye(3), triangles)


def test_no_points_have_no_feet():
    surface = sampled(gs.Hypar(1000.0), (-0.3, 0.3), (-0.3, 0.3), 4)
    assert surface.closest(np.empty((0, 3))).points.shape == (0, 3)
