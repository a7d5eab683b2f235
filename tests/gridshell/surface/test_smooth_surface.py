import numpy as np
import pytest

import gridshell as gs
from gridshell.surface import CurvedMesh, SmoothSurface, Surface, curved_by_jets, lift
from gridshell.surface.smooth_surface import flat_points


def apart(a, b):
    return np.linalg.norm(a - b, axis=1)


def samples(mesh, count=400):
    rng = np.random.default_rng(0)
    return rng.integers(0, len(mesh.triangles), count), rng.dirichlet([1.0, 1.0, 1.0], count)


@pytest.mark.parametrize("name", ["enneper", "catenoid", "helicoid", "hypar", "scherk", "torus"])
def test_lifted_points_are_far_closer_to_the_surface_than_the_triangles(exact, name):
    case = exact(name)
    curved = curved_by_jets(case.mesh)
    where = samples(case.mesh)
    flat, lifted = flat_points(curved, *where), lift(curved, *where)
    away_flat = apart(flat, case.surface.closest(flat).points)
    away = apart(lifted, case.surface.closest(lifted).points)
    assert away.mean() < away_flat.mean() / 40.0
    assert away.max() < away_flat.max() / 10.0


@pytest.mark.parametrize("name", ["enneper", "catenoid", "hypar", "torus"])
@pytest.mark.parametrize("distance", [-30.0, 0.0, 30.0])
def test_feet_normals_and_curvature_are_those_of_the_exact_surface(exact, name, distance):
    case = exact(name)
    smooth = SmoothSurface(curved_by_jets(case.mesh))
    points = case.mesh.centroids[::7]
    truth = case.surface.closest(points)
    points = truth.points + distance * truth.normals
    found, truth = smooth.closest(points), case.surface.closest(points)
    flat = smooth.flat.closest(points)
    edge = case.mesh.mean_edge
    assert apart(found.points, truth.points).mean() < apart(flat.points, truth.points).mean() / 10.0
    assert apart(found.points, truth.points).max() < 2e-3 * edge
    assert apart(found.normals, truth.normals).max() < 2e-3
    limit = 0.02 * np.abs(truth.curvature).max()
    np.testing.assert_allclose(found.curvature, truth.curvature, atol=limit)


def test_it_can_stand_wherever_a_surface_is_asked_for(exact):
    smooth = SmoothSurface(curved_by_jets(exact("hypar", 8).mesh))
    assert isinstance(smooth, Surface)
    assert smooth.closest(np.zeros((0, 3))).points.shape == (0, 3)
    with pytest.raises(gs.InputError):
        smooth.closest(np.full((1, 3), np.nan))


def test_feet_lie_on_the_surface_and_are_their_own_feet(exact):
    case = exact("enneper", 30)
    smooth = SmoothSurface(curved_by_jets(case.mesh))
    points = lift(smooth.curved, *samples(case.mesh))
    again = smooth.closest(points).points
    assert apart(points, again).max() < 1e-4 * case.mesh.mean_edge


def test_no_point_of_the_surface_is_closer_than_the_foot(exact):
    """Against a dense sampling of the blend itself, points beyond the boundary among them."""
    case = exact("torus", 8)
    smooth = SmoothSurface(curved_by_jets(case.mesh))
    rng = np.random.default_rng(2)
    points = case.mesh.vertices[rng.integers(0, len(case.mesh.vertices), 40)]
    points = points + rng.normal(size=(40, 3)) * 80.0
    found = apart(points, smooth.closest(points).points)
    i, j = (a.ravel() for a in np.mgrid[0:25, 0:25])
    keep = i + j <= 24
    weights = np.stack([i, j, 24 - i - j], axis=1)[keep] / 24.0
    faces = np.repeat(np.arange(len(case.mesh.triangles)), len(weights))
    dense = lift(smooth.curved, faces, np.tile(weights, (len(case.mesh.triangles), 1)))
    nearest = np.array([apart(dense, p).min() for p in points])
    assert (found <= nearest + 0.01 * case.mesh.mean_edge).all()


def test_there_is_no_gap_between_neighbouring_triangles(exact):
    case = exact("enneper", 12)
    curved = curved_by_jets(case.mesh)
    inner = np.flatnonzero(case.mesh.twin >= 0)
    here, there = np.zeros((len(inner), 3)), np.zeros((len(inner), 3))
    rows, twin = np.arange(len(inner)), case.mesh.twin[inner]
    here[rows, inner % 3], here[rows, (inner + 1) % 3] = 0.3, 0.7
    there[rows, (twin + 1) % 3], there[rows, twin % 3] = 0.3, 0.7
    np.testing.assert_allclose(
        lift(curved, inner // 3, here), lift(curved, twin // 3, there), atol=1e-9
    )


def test_a_flat_mesh_lifts_to_itself(exact):
    mesh = exact("hypar", 8).mesh
    flat = gs.surface.TriangleMesh(mesh.vertices * [1.0, 1.0, 0.0], mesh.triangles)
    curved = CurvedMesh.of_vertices(flat, flat.vertex_normals, np.zeros((len(flat.vertices), 3, 3)))
    where = samples(flat)
    np.testing.assert_allclose(lift(curved, *where), flat_points(curved, *where), atol=1e-9)


@pytest.mark.parametrize(("scale", "away"), [(1e-3, 0.0), (1.0, 1e6), (1e3, 0.0)])
def test_the_unit_and_the_origin_do_not_matter(exact, scale, away):
    case = exact("enneper", 15)
    moved = gs.surface.TriangleMesh(scale * case.mesh.vertices + away, case.mesh.triangles)
    points = case.mesh.centroids[::5] + 20.0
    first = SmoothSurface(curved_by_jets(case.mesh)).closest(points)
    second = SmoothSurface(curved_by_jets(moved)).closest(scale * points + away)
    expected = scale * first.points + away
    np.testing.assert_allclose(second.points, expected, rtol=0.0, atol=scale * 1e-3)
