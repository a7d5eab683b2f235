import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

import gridshell as gs

CURVATURES = arrays(
    np.float64, st.tuples(st.integers(1, 40), st.just(2)), elements=st.floats(-1e-3, 1e-3)
)


def panels_of(surface, reach, n):
    """Middle curvatures, radii, and by how much a panel's corners depart from its own quadric."""
    u, v = np.meshgrid(
        np.linspace(-reach, reach, n + 1), np.linspace(-reach, reach, n + 1) * 0.9 + 0.05
    )
    shape = u.shape
    points = surface.point(u.ravel(), v.ravel()).reshape(*shape, 3)
    kappa = np.sort(np.stack(surface.curvatures(u.ravel(), v.ravel()), axis=-1), axis=1)
    corners = [kappa.reshape(*shape, 2)[i : n + i, j : n + j] for i in (0, 1) for j in (0, 1)]
    places = [points[i : n + i, j : n + j] for i in (0, 1) for j in (0, 1)]
    middle, place = np.mean(corners, axis=0), np.mean(places, axis=0)
    radius = np.max([np.linalg.norm(p - place, axis=-1) for p in places], axis=0)
    own = np.max([np.abs(k - middle).max(axis=-1) for k in corners], axis=0) * radius**2 / 2.0
    return middle.reshape(-1, 2), radius.ravel(), float(np.median(own))


@pytest.mark.parametrize("n", [10, 20, 40, 80])
def test_a_constant_ratio_needs_about_the_square_root_of_the_panels(n):
    kappa, radius, own = panels_of(gs.Scherk(scale=4000.0), 1.2, n)
    families = gs.cluster_panels(kappa, radius, own)
    assert 0.35 * n <= len(families.moulds) <= n
    assert families.deviation.max() <= own * (1.0 + 1e-9)


def test_without_a_relation_the_moulds_fill_an_area():
    step = 1e-5
    first, second = np.meshgrid(np.arange(12), 100 + np.arange(9), indexing="ij")
    kappa = step * np.stack([first.ravel(), second.ravel()], axis=1)
    radius = 500.0
    # one mould reaches one step to either side: three by three panels
    families = gs.cluster_panels(kappa, radius, step * radius**2 / 2.0 * (1.0 + 1e-9))
    assert len(families.moulds) == 4 * 3
    assert families.panels_per_mould == 9.0


def test_panels_on_a_sphere_need_one_mould():
    kappa = np.full((50, 2), 1.0 / 7000.0)
    families = gs.cluster_panels(kappa, np.linspace(100.0, 900.0, 50), 1e-3)
    assert families.moulds.tolist() == [[1.0 / 7000.0] * 2]


def test_the_deviation_is_that_of_the_quadrics_over_the_panel():
    kappa = np.array([[1e-4, 3e-4], [1.5e-4, 2e-4]])
    radius = np.array([400.0, 600.0])
    families = gs.cluster_panels(kappa, radius, 20.0)
    assert len(families.moulds) == 1
    turn = np.linspace(0.0, 2.0 * np.pi, 721)
    for panel in range(2):
        x, y = radius[panel] * np.cos(turn), radius[panel] * np.sin(turn)
        change = kappa[panel] - families.moulds[0]
        away = np.abs(change[0] * x**2 + change[1] * y**2) / 2.0
        assert families.deviation[panel] == pytest.approx(away.max(), rel=1e-9)


@given(CURVATURES, st.floats(1e-3, 10.0))
def test_every_panel_is_within_the_tolerance_of_its_mould(kappa, tolerance):
    families = gs.cluster_panels(kappa, 800.0, tolerance)
    assert families.deviation.max() <= tolerance * (1.0 + 1e-9)
    assert sorted(set(families.mould_of.tolist())) == list(range(len(families.moulds)))


@given(CURVATURES, st.floats(1e-3, 10.0))
def test_the_order_of_the_curvatures_does_not_matter(kappa, tolerance):
    one = gs.cluster_panels(kappa, 800.0, tolerance)
    other = gs.cluster_panels(kappa[:, ::-1], 800.0, tolerance)
    np.testing.assert_array_equal(one.mould_of, other.mould_of)


def test_a_mould_is_not_shared_by_panels_too_far_apart():
    kappa = np.array([[0.0, 0.0], [0.0, 5e-5]])
    assert len(gs.cluster_panels(kappa, 200.0, 0.49).moulds) == 2
    assert len(gs.cluster_panels(kappa, 200.0, 0.51).moulds) == 1


@pytest.mark.parametrize(
    ("kappa", "radius", "tolerance", "word"),
    [
        (np.zeros((0, 2)), 1.0, 1.0, "two curvatures"),
        (np.zeros((3, 3)), 1.0, 1.0, "two curvatures"),
        (np.array([[np.nan, 0.0]]), 1.0, 1.0, "curvatures"),
        (np.zeros((2, 2)), np.array([1.0, 0.0]), 1.0, "radius"),
        (np.zeros((2, 2)), 1.0, -1.0, "tolerance"),
        (np.zeros((2, 2)), 1.0, np.inf, "tolerance"),
    ],
)
def test_bad_input_is_refused_by_name(kappa, radius, tolerance, word):
    with pytest.raises(gs.SettingError, match=word):
        gs.cluster_panels(kappa, radius, tolerance)


def test_curvatures_of_panels_from_their_mesh_alone():
    surface = gs.Catenoid(4000.0)
    patch = gs.BisectingPatch(v=(-0.6, 0.6), cells=24, u=(0.0, 1.5))
    mesh = gs.control_patch(surface, patch).mesh
    faces, kappa, radius = gs.panel_curvatures(mesh)
    assert len(faces) > 0.8 * len(mesh.quads)
    middle = mesh.vertices[mesh.quads[faces]].mean(axis=1)
    exact = np.sort(surface.closest(middle).curvature, axis=1)
    # at the rim only the inner corners count, and the panel is taken for its inner side
    rim = mesh.on_boundary[mesh.quads[faces]].any(axis=1)
    np.testing.assert_allclose(kappa[~rim], exact[~rim], rtol=0.01)
    np.testing.assert_allclose(kappa[rim], exact[rim], rtol=0.05)
    points = mesh.vertices[mesh.quads[faces]]
    reach = np.linalg.norm(points - middle[:, None], axis=2).max(axis=1)
    np.testing.assert_allclose(radius, reach)
