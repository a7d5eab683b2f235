import numpy as np
import pytest

from gridshell.errors import NoisyInputError, PoorTriangulationError, SettingError
from gridshell.mesh import grid_quads
from gridshell.surface import TriangleMesh, aspects, curved_by_jets, working_mesh
from gridshell.surface.working_mesh import halved, thinned


def noisy(mesh, share):
    shake = np.random.default_rng(0).normal(size=mesh.vertices.shape)
    return TriangleMesh(mesh.vertices + share * mesh.mean_edge * shake, mesh.triangles)


def away(surface, mesh):
    """Distance of the vertices from the exact surface, over the mean edge."""
    feet = surface.closest(mesh.vertices).points
    return np.linalg.norm(feet - mesh.vertices, axis=1) / mesh.mean_edge


def curvature_error(surface, curved):
    """Error of the principal curvatures at the vertices over the largest, sign by the normal."""
    truth = surface.closest(curved.mesh.vertices)
    assert (np.einsum("nc,nc->n", truth.normals, curved.normals) > 0.9).all()
    values = np.linalg.eigvalsh(curved.shapes)
    k1, k2 = truth.curvature.T
    product = (
        values[:, 0] * values[:, 2] + values[:, 0] * values[:, 1] + values[:, 1] * values[:, 2]
    )
    size = np.abs(truth.curvature).max()
    mean = np.abs(values.sum(axis=1) - (k1 + k2)) / size
    return np.maximum(mean, np.abs(product - k1 * k2) / size**2)


def test_a_mesh_of_the_right_fineness_keeps_its_triangles(exact):
    mesh = exact("enneper", 30).mesh
    found = working_mesh(mesh, quads=100)
    assert found.curved.mesh is mesh
    np.testing.assert_array_equal(found.curved.shapes, curved_by_jets(mesh).shapes)


@pytest.mark.parametrize("name", ["enneper", "catenoid", "hypar", "torus"])
def test_a_coarse_mesh_is_halved_and_lifted(exact, name):
    case = exact(name, 20)
    found = working_mesh(case.mesh, quads=500)
    mesh = found.curved.mesh
    assert len(mesh.triangles) == 4 * len(case.mesh.triangles)
    assert len(found.residual) == len(mesh.vertices)
    assert mesh.euler_characteristic == case.mesh.euler_characteristic
    middles = (case.mesh.vertices[case.mesh.origin] + case.mesh.vertices[case.mesh.target]) / 2.0
    flat = np.linalg.norm(case.surface.closest(middles).points - middles, axis=1).mean()
    inner = ~mesh.on_boundary
    assert away(case.surface, mesh)[inner].mean() < flat / mesh.mean_edge / 10.0
    assert np.percentile(curvature_error(case.surface, found.curved), 95) < 0.05


def test_halving_twice_is_what_many_quads_need(exact):
    case = exact("torus", 10)
    found = working_mesh(case.mesh, quads=500)
    assert len(found.curved.mesh.triangles) == 16 * len(case.mesh.triangles)
    assert found.curved.mesh.areas.min() > 0.0


@pytest.mark.parametrize("name", ["enneper", "catenoid", "hypar", "torus"])
def test_a_fine_mesh_is_thinned_and_keeps_its_curvature(exact, name):
    case = exact(name, 80)
    found = working_mesh(case.mesh, quads=30)
    mesh = found.curved.mesh
    assert len(mesh.triangles) == pytest.approx(3600, rel=0.02)
    assert mesh.euler_characteristic == 1
    assert away(case.surface, mesh).max() < 1e-4
    assert np.percentile(curvature_error(case.surface, found.curved), 95) < 0.01
    assert np.percentile(aspects(mesh), 99) < 8.0


def test_the_boundary_and_its_corners_stay(exact):
    case = exact("hypar", 60)
    thin = working_mesh(case.mesh, quads=20).curved.mesh
    length = thin.edge_lengths[thin.twin < 0].sum()
    assert length == pytest.approx(case.mesh.edge_lengths[case.mesh.twin < 0].sum(), rel=5e-4)
    corners = case.mesh.vertices[case.mesh.valence <= 2]
    corners = corners[np.argsort(np.abs(corners[:, 0]) + np.abs(corners[:, 1]))[-4:]]
    gap = np.linalg.norm(thin.vertices[:, None] - corners, axis=2).min(axis=0)
    assert gap.max() < 1e-3 * thin.mean_edge
    assert thin.areas.sum() == pytest.approx(case.mesh.areas.sum(), rel=2e-3)


def test_a_closed_surface_and_a_tube_keep_their_topology():
    import trimesh

    for solid, euler in (
        (trimesh.creation.icosphere(5, 500.0), 2),
        (trimesh.creation.torus(900.0, 300.0, 120, 60), 0),
    ):
        mesh = TriangleMesh(solid.vertices, solid.faces)
        found = working_mesh(mesh, quads=25).curved.mesh
        assert len(found.triangles) < len(mesh.triangles) / 2
        assert found.euler_characteristic == euler
        assert not found.on_boundary.any()


def test_a_fine_noisy_mesh_is_thinned_and_smoothed(exact):
    case = exact("enneper", 80)
    found = working_mesh(noisy(case.mesh, 0.03), quads=50)
    assert found.noise == pytest.approx(0.03, rel=0.15)
    assert away(case.surface, found.curved.mesh).mean() < 0.005
    assert curvature_error(case.surface, found.curved).mean() < 0.06


@pytest.mark.parametrize("quads", [20, 2000])
def test_noise_beyond_use_is_refused_on_either_way(exact, quads):
    with pytest.raises(NoisyInputError):
        working_mesh(noisy(exact("enneper", 40).mesh, 0.8), quads=quads)


def test_the_same_bytes_on_a_second_run(exact):
    mesh = exact("enneper", 60).mesh
    first, second = (working_mesh(mesh, quads=20).curved for _ in range(2))
    assert first.mesh.vertices.tobytes() == second.mesh.vertices.tobytes()
    assert first.mesh.triangles.tobytes() == second.mesh.triangles.tobytes()
    assert first.shapes.tobytes() == second.shapes.tobytes()


def test_slivers_are_refused_with_their_share():
    i, j = (a.ravel() for a in np.mgrid[0:21, 0:21].astype(float))
    quads = grid_quads(20, 20)
    triangles = np.concatenate([quads[:, [0, 1, 2]], quads[:, [0, 2, 3]]])
    mesh = TriangleMesh(np.stack([200.0 * i, 10.0 * j, 0.1 * i * j], axis=1), triangles)
    with pytest.raises(PoorTriangulationError, match="100 % of the area"):
        working_mesh(mesh, quads=50)


def test_no_quads_are_refused(exact):
    with pytest.raises(SettingError, match="quads"):
        working_mesh(exact("hypar", 8).mesh, quads=0)


def test_thinning_to_more_than_there_is_gives_nothing(exact):
    assert thinned(exact("hypar", 8).mesh, triangles=1000) is None


def test_halving_interpolates_the_curvature(exact):
    case = exact("catenoid", 25)
    fine = halved(curved_by_jets(case.mesh))
    error = curvature_error(case.surface, fine)
    assert np.median(error) < 0.01
    np.testing.assert_allclose(np.einsum("nij,nj->ni", fine.shapes, fine.normals), 0.0, atol=1e-8)
