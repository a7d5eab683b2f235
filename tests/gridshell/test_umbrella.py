"""The recursion against the conditions themselves: lengths, planar stars, symmetry."""

from math import pi

import numpy as np
import pytest

import gridshell as gs

EVEN = gs.Umbrella(16, 1000.0, (400.0,) * 8)
UNEVEN = gs.Umbrella(11, 900.0, (520.0, 480.0, 500.0, 450.0, 470.0))
UMBRELLAS = {"even": EVEN, "uneven": UNEVEN, "large": gs.Umbrella(24, 3000.0, (900.0,) * 12)}


@pytest.fixture(params=UMBRELLAS)
def umbrella(request):
    return UMBRELLAS[request.param]


@pytest.mark.parametrize("opening", [0.02, 0.3, 0.7, 0.98])
def test_every_position_keeps_lengths_and_planar_stars(umbrella, opening):
    position = umbrella.position(opening)
    control = position.control()
    net = gs.diagonal_meshes(control)[0]
    a, b = net.vertices[net.edges.T]
    length = np.linalg.norm(a - b, axis=1)
    lower = np.minimum(a[:, 2], b[:, 2])
    ring = np.abs(lower[:, None] - position.heights[:-1]).argmin(axis=1)
    if opening < 0.9:  # the crown of an opened umbrella bends down
        np.testing.assert_allclose(length, np.array(umbrella.bays)[ring], rtol=1e-12)
    quality = gs.net_quality(control, planarity=gs.Planarity.FIRST_DIAGONAL_STARS)
    assert quality.star_planarity.max < 1e-12
    base = np.abs(net.vertices[:, 2]) < 1e-9
    np.testing.assert_allclose(np.linalg.norm(net.vertices[base, :2], axis=1), umbrella.radius)
    assert np.count_nonzero(base) == umbrella.ribs


def test_all_edges_keep_their_lengths_to_the_very_locks(umbrella):
    c, s = np.cos(pi / umbrella.ribs), np.sin(pi / umbrella.ribs)
    for position in (*umbrella.locks, *umbrella.positions(60)):
        r, z = position.radii, position.heights
        length = np.sqrt((r[1:] * c - r[:-1]) ** 2 + (r[1:] * s) ** 2 + np.diff(z) ** 2)
        np.testing.assert_allclose(length, umbrella.bays, rtol=1e-9)


def test_from_a_closed_cone_to_an_opened_funnel():
    """Angles fall towards the top of the closed one and rise towards that of the opened one."""
    closed, opened = EVEN.position(0.02), EVEN.position(0.9)
    assert (np.diff(closed.node_angles) < 0.0).all()
    assert (np.diff(opened.node_angles) > 0.0).all()
    assert closed.radii[-1] < 0.1 * EVEN.radius
    assert opened.radii[-1] > EVEN.radius
    assert opened.height < closed.height


def test_the_angles_are_those_of_the_net():
    position = EVEN.position(0.4)
    net = gs.diagonal_meshes(position.control())[0]
    for k, angle in enumerate(position.node_angles):
        v = int(np.argmin(np.abs(net.vertices[:, 2] - position.heights[k])))
        spokes = net.vertices[net.stars.spokes[v][net.stars.spokes[v] >= 0]] - net.vertices[v]
        above = spokes[np.argsort(-spokes[:, 2])[:2]]
        above /= np.linalg.norm(above, axis=1)[:, None]
        assert np.arccos(above[0] @ above[1]) == pytest.approx(angle, abs=1e-9)


def test_it_locks_where_a_ring_has_shrunk_to_nothing_and_where_a_bay_is_straight():
    closed, opened = EVEN.locks
    assert closed.radii[-1] < 1e-6
    assert np.degrees(opened.node_angles[-1]) == pytest.approx(180.0, abs=1e-3)
    beyond = np.array([closed.first - 1e-6, opened.first + 1e-6])
    assert not np.isfinite(EVEN.rings(beyond)[0]).all(axis=1).any()


def test_the_motion_grows_with_the_umbrella():
    large = gs.Umbrella(16, 2500.0, (1000.0,) * 8)
    for opening in (0.1, 0.8):
        np.testing.assert_allclose(
            large.position(opening).radii, 2.5 * EVEN.position(opening).radii, rtol=1e-9
        )


@pytest.mark.parametrize("opening", [-0.1, 1.01, np.nan])
def test_a_position_beyond_a_lock_names_the_nearest_that_works(opening):
    with pytest.raises(gs.SettingError, match="locks before") as info:
        EVEN.position(opening)
    assert info.value.limit == "0 (closed) to 1 (opened)"
    if np.isfinite(opening):
        assert EVEN.position(float(info.value.advice)).opening in (0.0, pytest.approx(1.0))


def test_a_cable_sets_the_position():
    cable = gs.Cable(2, 8)
    for opening in (0.2, 0.6):
        position = EVEN.position(opening)
        r, z = position.radii, position.heights
        length = float(np.hypot(r[8] - r[2], z[8] - z[2]))
        assert EVEN.at_cable(cable, length).opening == pytest.approx(opening, abs=1e-9)


@pytest.mark.parametrize(("length", "nearest"), [(100.0, 1.0), (9000.0, 0.0)])
def test_a_cable_that_no_position_has_names_the_nearest_length(length, nearest):
    cable = gs.Cable(2, 8)
    with pytest.raises(gs.SettingError, match="locks before the cable") as info:
        EVEN.at_cable(cable, length)
    number, unit = info.value.advice.split()
    found = EVEN.at_cable(cable, float(number) * (1.0 + 1e-6 * (1 if nearest == 1.0 else -1)))
    assert unit == "mm"
    assert found.opening == pytest.approx(nearest, abs=1e-3)


def test_a_cable_from_the_base_has_a_dead_point_where_it_is_longest():
    umbrella = gs.Umbrella(12, 1000.0, (550.0,) * 6)
    cable = gs.Cable(4, 6)
    at = umbrella.dead_point(cable)
    if at is not None:
        around = [umbrella.position(o) for o in (max(at - 0.01, 0.0), at, at + 0.01)]
        found = [float(cable.lengths(p.radii[None], p.heights[None])[0]) for p in around]
        assert found[1] == max(found)


@pytest.mark.parametrize(
    ("rings", "advice"), [((2, 5), "rings 2 and 6"), ((4, 2), "rings 4 and 6")]
)
def test_a_cable_joins_nodes_above_each_other(rings, advice):
    with pytest.raises(gs.SettingError, match="above each other") as info:
        gs.Cable(*rings)
    assert info.value.advice == advice


def test_a_cable_ends_on_the_umbrella():
    with pytest.raises(gs.SettingError, match="ends above") as info:
        EVEN.dead_point(gs.Cable(0, 10))
    assert info.value.advice == "ring 8"


@pytest.mark.parametrize(
    ("ribs", "radius", "bays", "key"),
    [
        (2, 1000.0, (500.0,) * 3, "ribs"),
        (12, 0.0, (500.0,) * 3, "radius"),
        (12, 1000.0, (500.0,), "bays"),
        (12, 1000.0, (500.0, -1.0), "bays"),
        (12, 1000.0, (250.0, 500.0), "bays"),
    ],
)
def test_umbrellas_that_cannot_be_are_refused(ribs, radius, bays, key):
    with pytest.raises(gs.SettingError) as info:
        gs.Umbrella(ribs, radius, bays)
    assert info.value.where == key


def test_one_without_any_position_is_refused():
    with pytest.raises(gs.SettingError, match="No position") as info:
        _ = gs.Umbrella(12, 1000.0, (300.0, 40.0, 2000.0, 30.0, 500.0, 2000.0)).locks
    assert "fewer bays" in info.value.advice


def test_angles_of_all_positions_are_those_of_each():
    umbrella = gs.Umbrella(10, 1200.0, (700.0, 650.0, 700.0, 600.0))
    positions = umbrella.positions(5)
    every = umbrella.node_angles(np.array([p.radii for p in positions]))
    assert every == pytest.approx(np.array([p.node_angles for p in positions]))


def test_the_length_of_a_cable_is_the_distance_of_its_nodes():
    position = gs.Umbrella(10, 1200.0, (700.0, 650.0, 700.0, 600.0)).position(0.4)
    cable = gs.Cable(0, 4)
    across, up = position.radii[4] - position.radii[0], position.heights[4] - position.heights[0]
    assert cable.length(position) == pytest.approx(np.hypot(across, up))
