import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

import gridshell as gs
from gridshell.errors import NoisyInputError
from gridshell.surface import TriangleMesh, curved_by_jets, estimated_curvature

NAMES = ["enneper", "catenoid", "helicoid", "hypar", "scherk", "torus"]


def noisy(mesh, share, seed=0):
    shake = np.random.default_rng(seed).normal(size=mesh.vertices.shape)
    return TriangleMesh(mesh.vertices + share * mesh.mean_edge * shake, mesh.triangles)


@pytest.mark.parametrize("name", NAMES)
def test_directions_and_curvatures_of_exact_surfaces_are_found(exact, direction_error, name):
    case = exact(name)
    curved = curved_by_jets(case.mesh)
    error = direction_error(curved.shapes, case.shapes)
    assert np.median(error) < 0.05
    assert np.percentile(error, 95) < 0.5
    assert np.percentile(error[case.mesh.on_boundary], 95) < 1.2
    size = np.linalg.norm(case.shapes, axis=(1, 2))
    off = np.linalg.norm(curved.shapes - case.shapes, axis=(1, 2))
    assert np.median(off / size) < 0.005
    assert np.percentile(np.linalg.norm(curved.normals - case.normals, axis=1), 95) < 1e-3


def test_the_error_falls_with_the_square_of_the_edge(exact):
    def off(n):
        case = exact("enneper", n)
        inner = ~case.mesh.on_boundary
        return np.median(np.abs(curved_by_jets(case.mesh).shapes - case.shapes)[inner])

    assert off(60) < off(20) / 6.0


def test_a_sphere_with_outward_normals_bends_away_from_them():
    import trimesh

    ball = trimesh.creation.icosphere(4, 250.0)
    curved = curved_by_jets(TriangleMesh(ball.vertices, ball.faces))
    values = np.linalg.eigvalsh(curved.shapes)
    np.testing.assert_allclose(values[:, :2], -1.0 / 250.0, rtol=8e-3)
    np.testing.assert_allclose(values[:, 2], 0.0, atol=1e-15)
    np.testing.assert_allclose(curved.normals, ball.vertices / 250.0, atol=1e-3)


def test_a_cubic_is_reproduced_exactly_even_at_the_corners():
    """Over a lattice in the plane, with slopes that make the metric matter."""
    i, j = (a.ravel() / 8.0 for a in np.mgrid[0:9, 0:9].astype(float))
    z = 0.1 * i + 0.2 * j + 0.3 * i * i - 0.2 * i * j + 0.1 * i**3 - 0.2 * i * j * j
    from gridshell.mesh import grid_quads

    quads = grid_quads(8, 8)
    triangles = np.concatenate([quads[:, [0, 1, 2]], quads[:, [0, 2, 3]]])
    mesh = TriangleMesh(np.stack([i, j, z], axis=1), triangles)
    up = mesh.face_normals[:, 2].mean()
    from gridshell.surface.jet_fit import fit_jets
    from gridshell.surface.neighbourhoods import vertex_rings

    around = vertex_rings(mesh, rings=2, least=16, at_edge=16)
    flat = np.tile([0.0, 0.0, np.sign(up)], (81, 1))
    jets = fit_jets(mesh.vertices, mesh.vertices, flat, around, passes=1)
    zx = 0.1 + 0.6 * i - 0.2 * j + 0.3 * i * i - 0.2 * j * j
    zy = 0.2 - 0.2 * i - 0.4 * i * j
    normal = np.stack([-zx, -zy, np.ones(81)], axis=1) / np.sqrt(1 + zx**2 + zy**2)[:, None]
    np.testing.assert_allclose(jets.normals, np.sign(up) * normal, atol=1e-7)
    second = np.stack([0.6 + 0.6 * i, -0.2 - 0.4 * j, -0.4 * i], axis=1)
    tangents = np.stack(
        [np.stack([np.ones(81), 0 * i, zx], 1), np.stack([0 * i, np.ones(81), zy], 1)], axis=1
    )
    found = tangents @ jets.shapes @ tangents.transpose(0, 2, 1)
    width = np.sign(up) / np.sqrt(1 + zx**2 + zy**2)
    np.testing.assert_allclose(found[:, 0, 0], second[:, 0] * width, atol=1e-6)
    np.testing.assert_allclose(found[:, 0, 1], second[:, 1] * width, atol=1e-6)
    np.testing.assert_allclose(found[:, 1, 1], second[:, 2] * width, atol=1e-6)
    assert jets.residuals.max() < 1e-5


@settings(max_examples=10)
@given(
    seed=st.integers(0, 1000),
    scale=st.sampled_from([1e-3, 1.0, 1e3]),
    offset=st.sampled_from([0.0, 1e6]),
)
def test_moving_turning_and_scaling_moves_turns_and_scales(exact, seed, scale, offset):
    case = exact("enneper", 12)
    turn = Rotation.random(random_state=seed).as_matrix()
    moved = TriangleMesh(scale * case.mesh.vertices @ turn.T + scale * offset, case.mesh.triangles)
    first, second = curved_by_jets(case.mesh), curved_by_jets(moved)
    # the normal equations of a fit keep half of the digits: 1.5e-8
    tolerance = 1.5e-8 if offset == 0.0 else 1e-5
    np.testing.assert_allclose(second.normals, first.normals @ turn.T, atol=tolerance)
    expected = turn @ first.shapes @ turn.T / scale
    size = np.abs(expected).max()
    np.testing.assert_allclose(second.shapes / size, expected / size, atol=10.0 * tolerance)


def test_the_other_side_of_a_surface_bends_the_other_way(exact):
    case = exact("torus", 15)
    turned = TriangleMesh(case.mesh.vertices, case.mesh.triangles[:, ::-1])
    first, second = curved_by_jets(case.mesh), curved_by_jets(turned)
    np.testing.assert_allclose(second.shapes, -first.shapes, atol=1e-9 * np.abs(first.shapes).max())


def test_the_same_bytes_on_a_second_run(exact):
    mesh = noisy(exact("enneper", 20).mesh, 0.03)
    first, second = (estimated_curvature(mesh, quad_edge=400.0).curved for _ in range(2))
    assert first.shapes.tobytes() == second.shapes.tobytes()
    assert first.mesh.vertices.tobytes() == second.mesh.vertices.tobytes()


@pytest.mark.parametrize("name", NAMES)
@pytest.mark.parametrize("n", [8, 50])
def test_a_clean_mesh_is_not_called_noisy_however_coarse(exact, name, n):
    case = exact(name, n)
    found = estimated_curvature(case.mesh)
    assert not found.noisy
    assert found.rings == 2
    assert found.curved.mesh is case.mesh
    assert found.residual.max() < 0.3


@pytest.mark.parametrize(("share", "mean", "p95"), [(0.01, 0.35, 1.2), (0.03, 0.6, 2.2)])
@pytest.mark.parametrize("name", ["enneper", "catenoid", "hypar", "torus"])
def test_noise_is_measured_and_averaged_away(exact, direction_error, name, share, mean, p95):
    case = exact(name)
    found = estimated_curvature(noisy(case.mesh, share), quad_edge=6.0 * case.mesh.mean_edge)
    assert found.noise == pytest.approx(share, rel=0.15)
    error = direction_error(found.curved.shapes, case.shapes)
    assert error.mean() < mean
    assert np.percentile(error, 95) < p95


def test_ten_percent_noise_still_gives_directions(exact, direction_error):
    case = exact("enneper")
    found = estimated_curvature(noisy(case.mesh, 0.1), quad_edge=10.0 * case.mesh.mean_edge)
    error = direction_error(found.curved.shapes, case.shapes)
    assert error.mean() < 1.5
    assert np.percentile(error, 95) < 3.9


def test_vertices_of_a_noisy_mesh_are_placed_on_the_surface(exact):
    case = exact("enneper")
    rough = noisy(case.mesh, 0.03)

    def away(vertices):
        return np.linalg.norm(case.surface.closest(vertices).points - vertices, axis=1).mean()

    assert away(estimated_curvature(rough).curved.mesh.vertices) < away(rough.vertices) / 4.0


def test_noise_beyond_use_is_refused(exact):
    with pytest.raises(NoisyInputError, match="% of the mean edge"):
        estimated_curvature(noisy(exact("enneper", 30).mesh, 0.8))


@pytest.mark.parametrize("edge", [0.0, -1.0, float("nan"), float("inf")])
def test_an_edge_that_is_no_length_is_refused(exact, edge):
    with pytest.raises(gs.SettingError, match="quad_edge"):
        estimated_curvature(exact("hypar", 8).mesh, quad_edge=edge)


def test_the_smallest_meshes_do_not_fail():
    """A tetrahedron's four points do not determine a cubic; the answer is at least finite."""
    vertices = np.array([[0.0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]])
    mesh = TriangleMesh(vertices, [[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]])
    curved = curved_by_jets(mesh)
    assert np.isfinite(curved.shapes).all()
    np.testing.assert_allclose(np.linalg.norm(curved.normals, axis=1), 1.0)
