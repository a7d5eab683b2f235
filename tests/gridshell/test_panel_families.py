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


@pytest.mark.parametrize("lamellas", [14, 28])
def test_a_net_of_constant_angle_needs_about_the_square_root_of_its_panels(lamellas):
    """An A-net at 60 degrees has the ratio -1/3 everywhere (Fig. 9); no surface is needed."""
    patch = gs.AsymptoticPatch((-1.2, 0.8), (-0.6, 1.2), (lamellas, lamellas))
    start = gs.control_patch(gs.Enneper(4000.0), patch)
    control = gs.optimize(start, gs.a_net(angle=np.pi / 3.0), anchor=gs.Free()).require().control
    mesh = gs.skin(control, gs.Skin.D1)
    kappa, radius = gs.panel_curvatures_from_mesh(mesh, control)
    families = gs.cluster_panels(kappa, radius, gs.own_variation(mesh, kappa, radius))
    root = np.sqrt(len(mesh.faces))
    assert 0.3 * root < len(families.moulds) < 1.5 * root


def catenoid(cells=24):
    surface = gs.Catenoid(4000.0)
    patch = gs.BisectingPatch(v=(-0.6, 0.6), cells=cells, u=(0.0, 1.5))
    return surface, gs.control_patch(surface, patch)


@pytest.mark.parametrize("which", [gs.Skin.D1, gs.Skin.D2])
def test_curvatures_from_the_mesh_are_those_of_the_surface(which):
    surface, control = catenoid()
    mesh = gs.skin(control, which)
    exact, radius = gs.panel_curvatures(mesh, surface)
    kappa, same = gs.panel_curvatures_from_mesh(mesh, control)
    np.testing.assert_array_equal(radius, same)
    rim = mesh.boundary[mesh.faces].any(axis=1)
    np.testing.assert_allclose(kappa[~rim], exact[~rim], rtol=0.01)
    np.testing.assert_allclose(kappa, exact, rtol=0.1)
    for face in range(0, len(mesh.faces), 37):
        away = mesh.corner_points(face) - mesh.corner_points(face).mean(axis=0)
        assert radius[face] == pytest.approx(np.linalg.norm(away, axis=1).max())


def test_the_own_variation_is_half_a_step_to_the_neighbours():
    points = np.array([[x, y, 0.0] for x in (0.0, 6.0, 12.0) for y in (0.0, 8.0)])
    quads = np.array([[0, 2, 3, 1], [2, 4, 5, 3]])
    mesh = gs.panel_mesh(points, quads, np.tile([0.0, 0.0, 1.0], (6, 1)))
    kappa = np.array([[0.01, 0.02], [0.05, 0.01]])
    radius = np.array([5.0, 5.0])
    # sorted pairs (0.01, 0.02) and (0.01, 0.05)
    assert gs.own_variation(mesh, kappa, radius) == pytest.approx(0.03 / 2.0 * 25.0 / 2.0)
    alone = gs.panel_mesh(points, quads[:1], np.tile([0.0, 0.0, 1.0], (6, 1)))
    assert gs.own_variation(alone, kappa[:1], radius[:1]) == 0.0


def test_a_mesh_too_small_for_curvature_is_refused(grid):
    control = gs.as_control_mesh(grid(2, 2))
    mesh = gs.skin(control, gs.Skin.PATTERN)
    with pytest.raises(gs.SettingError, match="too small"):
        gs.panel_curvatures_from_mesh(mesh, control)
