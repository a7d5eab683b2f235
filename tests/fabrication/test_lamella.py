from math import pi

import numpy as np
import pytest

import fabrication as fab
import gridshell as gs
from fabrication.lamella import axis_curve, piece_of

R = 4000.0
CATENOID = gs.Catenoid(R)


@pytest.fixture(scope="module")
def fine(profile):
    """A strip of catenoid with many nodes along p and few along q, and the other way round."""
    patches = (
        gs.AsymptoticPatch(p=(-0.8, 0.8), q=(-0.2, 0.2), lamellas=(4, 15)),
        gs.AsymptoticPatch(p=(-0.2, 0.2), q=(-0.8, 0.8), lamellas=(15, 4)),
    )
    nets = [gs.diagonal_meshes(gs.control_patch(CATENOID, patch))[0] for patch in patches]
    lamellas = [one for net in nets for one in fab.structure(net, profile).lamellas]
    long = [one for one in lamellas if len(one.nodes) == 15]
    return {family: [one for one in long if one.family == family] for family in (1, 2)}


def helix(count, *, turns=0.5):
    u = 2.0 * pi * turns * np.linspace(0.0, 1.0, count)
    return np.stack([1000.0 * np.cos(u), 1000.0 * np.sin(u), 300.0 * u], axis=1)


def rotation(seed):
    q = np.linalg.qr(np.random.default_rng(seed).normal(size=(3, 3)))[0]
    return q * np.sign(np.linalg.det(q))


def over(lamella, count=400):
    return np.linspace(lamella.start, lamella.end, count)


# ---- the axis -------------------------------------------------------------------------------


def test_stations_are_the_arc_lengths_of_a_helix():
    points = helix(17)
    axis = axis_curve(points, closed=False)
    exact = np.hypot(1000.0, 300.0) * pi * np.linspace(0.0, 1.0, 17)
    np.testing.assert_allclose(axis.stations, exact, atol=5e-3)


def test_the_axis_passes_through_its_points():
    points = helix(9)
    axis = axis_curve(points, closed=False, reach=50.0)
    np.testing.assert_allclose(axis.spline(axis.stations), points, atol=1e-9)


@pytest.mark.parametrize("seed", [1, 2])
def test_stations_do_not_depend_on_where_the_curve_lies(seed):
    points = helix(9)
    moved = points @ rotation(seed).T + np.array([1e5, -2e4, 3e3])
    expected = axis_curve(points, closed=False).stations
    np.testing.assert_allclose(axis_curve(moved, closed=False).stations, expected, atol=1e-7)


@pytest.mark.parametrize("factor", [1e-3, 7.0])
def test_stations_grow_with_the_curve(factor):
    points = helix(9)
    scaled = axis_curve(factor * points, closed=False).stations
    np.testing.assert_allclose(
        scaled, factor * axis_curve(points, closed=False).stations, rtol=1e-12
    )


def test_stations_count_from_the_other_end_when_the_points_are_reversed():
    points = helix(9)
    there = axis_curve(points, closed=False).stations
    back = axis_curve(points[::-1], closed=False).stations
    np.testing.assert_allclose(back, (there[-1] - there)[::-1], atol=1e-7)


def test_the_parameter_is_arc_length_everywhere():
    q = 0.3
    points = CATENOID.asymptotic_point(q + np.linspace(-1.6, 1.6, 25), np.full(25, q))
    axis = axis_curve(points, closed=False, reach=50.0)
    s = np.linspace(-50.0, axis.length + 50.0, 3001)
    np.testing.assert_allclose(np.linalg.norm(axis.spline(s, 1), axis=1), 1.0, atol=1e-6)


def test_the_parameter_of_a_closed_axis_is_arc_length_everywhere():
    axis = axis_curve(circle(32), closed=True)
    s = np.linspace(0.0, axis.length, 3001)
    np.testing.assert_allclose(np.linalg.norm(axis.spline(s, 1), axis=1), 1.0, atol=1e-6)


def circle(count):
    u = 2.0 * pi * np.arange(count) / count
    return 1000.0 * np.stack([np.cos(u), np.sin(u), np.zeros(count)], axis=1)


def test_a_closed_axis_is_as_long_as_its_circle():
    axis = axis_curve(circle(32), closed=True)
    assert axis.length == pytest.approx(2000.0 * pi, abs=0.02)
    np.testing.assert_allclose(np.diff(axis.stations), axis.length / 32, atol=1e-6)


def test_a_closed_axis_repeats_itself_after_one_turn():
    axis = axis_curve(circle(32), closed=True)
    s = np.linspace(0.0, axis.length, 50)
    for derivative in (0, 1, 2):
        np.testing.assert_allclose(
            axis.spline(s, derivative), axis.spline(s + axis.length, derivative), atol=1e-9
        )


def test_an_axis_through_two_points_is_straight_beyond_them_too():
    axis = axis_curve(np.array([[0.0, 0.0, 0.0], [300.0, 400.0, 0.0]]), closed=False, reach=50.0)
    np.testing.assert_allclose(axis.stations, [0.0, 500.0], atol=1e-9)
    beyond = axis.spline(np.array([-50.0, 250.0, 550.0]))
    np.testing.assert_allclose(beyond, [[-30, -40, 0], [150, 200, 0], [330, 440, 0]], atol=1e-9)


# ---- frames ---------------------------------------------------------------------------------


@pytest.mark.parametrize("name", ["catenoid", "enneper", "hypar", "tube", "saddle"])
def test_frames_are_orthonormal_and_right_handed(name, request):
    for lamella in request.getfixturevalue(name).structure.lamellas:
        f = lamella.frames(over(lamella, 40))
        frames = np.stack([f.t, f.b, f.n], axis=1)
        np.testing.assert_allclose(frames @ frames.transpose(0, 2, 1), [np.eye(3)] * 40, atol=1e-12)
        np.testing.assert_allclose(np.linalg.det(frames), 1.0, atol=1e-12)


def test_the_strip_stands_on_the_surface(fine):
    lamella = fine[1][1]
    s = over(lamella)
    f = lamella.frames(s)
    normals = CATENOID.closest(f.points).normals
    assert np.abs(np.einsum("nc,nc->n", f.n, normals)).min() > np.cos(np.radians(0.2))


def test_placing_measures_along_the_frame(enneper):
    lamella = enneper.structure.lamellas[0]
    s = np.array([100.0, 700.0])
    f = lamella.frames(s)
    placed = lamella.place(s, np.array([3.0, -2.0]), np.array([40.0, -50.0]))
    expected = f.points + np.array([[3.0], [-2.0]]) * f.b + np.array([[40.0], [-50.0]]) * f.n
    np.testing.assert_allclose(placed, expected, atol=1e-12)


@pytest.mark.parametrize("family", [1, 2])
def test_twist_squared_is_the_negative_gaussian_curvature(fine, family):
    for lamella in fine[family]:
        s = np.linspace(0.0, lamella.axis.length, 200)
        gauss = CATENOID.closest(lamella.axis.spline(s)).curvature.prod(axis=1)
        np.testing.assert_allclose(lamella.twist(s) ** 2, -gauss, rtol=0.02)


def test_the_two_families_twist_in_opposite_senses(fine):
    senses = [
        {float(np.sign(rate)) for one in fine[family] for rate in one.twist(one.stations)}
        for family in (1, 2)
    ]
    assert sorted(senses, key=min) == [{-1.0}, {1.0}]


def test_an_asymptotic_lamella_bends_about_its_weak_axis_only(fine):
    for lamella in fine[1] + fine[2]:
        weak, strong = lamella.bending(np.linspace(0.0, lamella.axis.length, 200))
        assert np.abs(weak).max() > 1e-5
        assert np.abs(strong).max() < 2e-2 * np.abs(weak).max()


def test_bending_and_axis_curvature_agree(enneper):
    lamella = enneper.structure.lamellas[1]
    s = np.linspace(0.0, lamella.axis.length, 50)
    curvature = np.linalg.norm(lamella.axis.spline(s, 2), axis=1)
    np.testing.assert_allclose(np.hypot(*lamella.bending(s)), curvature, rtol=1e-4, atol=1e-9)


def test_a_straight_lamella_does_not_bend(hypar):
    for lamella in hypar.structure.lamellas:
        weak, strong = lamella.bending(over(lamella))
        assert np.abs(np.r_[weak, strong]).max() < 1e-10


def test_a_hoop_bends_with_the_curvature_of_its_circle(tube):
    hoop = next(one for one in tube.structure.lamellas if one.closed)
    radius = np.linalg.norm(hoop.axis.spline(hoop.stations)[:, :2], axis=1).mean()
    curvature = np.hypot(*hoop.bending(over(hoop)))
    np.testing.assert_allclose(curvature, 1.0 / radius, rtol=2e-2)


# ---- pieces ---------------------------------------------------------------------------------


def test_a_piece_lies_where_its_length_of_the_lamella_lies(enneper):
    lamella = enneper.structure.lamellas[0]
    first, last = lamella.stations[1:3]
    piece = piece_of(lamella, "A1.1", (1, 2), first + 5.0, last - 7.0)
    assert (piece.mark, piece.family) == ("A1.1", lamella.family)
    assert piece.length == pytest.approx(last - first - 12.0)
    np.testing.assert_array_equal(piece.nodes, lamella.nodes[1:3])
    np.testing.assert_allclose(piece.stations, [0.0, last - first])
    s, y, z = np.linspace(0.0, 300.0, 7), np.full(7, 1.2), np.full(7, -40.0)
    np.testing.assert_allclose(piece.place(s, y, z), lamella.place(s + first, y, z), atol=1e-9)


def test_a_piece_of_a_hoop_may_go_on_over_its_first_node(tube):
    lamella = next(one for one in tube.structure.lamellas if one.closed)
    count, around = len(lamella.nodes), lamella.axis.length
    start = float(lamella.stations[-1])
    piece = piece_of(lamella, "A1.9", (count - 1, count + 1), start, around + lamella.stations[1])
    assert not piece.closed
    np.testing.assert_array_equal(piece.nodes, lamella.nodes[[-1, 0, 1]])
    bays = np.diff(np.r_[start, around, around + lamella.stations[1]])
    np.testing.assert_allclose(np.diff(piece.stations), bays)
    positions = [tube.structure.nodes[i].position for i in piece.nodes.tolist()]
    zero = np.zeros(3)
    np.testing.assert_allclose(piece.place(piece.stations, zero, zero), positions, atol=1e-6)
