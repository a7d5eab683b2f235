import numpy as np
import pytest

import gridshell as gs


@pytest.fixture(scope="module")
def start():
    return gs.control_patch(gs.Enneper(4000.0), gs.SingularPatch(6, 6, 0.8))


@pytest.fixture(scope="module")
def corners(start):
    """The outer corners of the six sectors: the boundary vertices of a single quad."""
    return start.vertices[start.mesh.valence == 1]


def test_a_net_stands_on_its_supports(start, corners):
    places = corners * [1.1, 1.1, 1.0] + [0.0, 0.0, 150.0]
    control, held = gs.stand_on(start, places)
    assert sorted(held.vertices) == np.flatnonzero(start.mesh.valence == 1).tolist()
    np.testing.assert_allclose(control.vertices[list(held.vertices)], places, atol=1e-9)


def test_the_form_is_found_from_supports_and_angles_alone(start, corners):
    places = corners[::2] * [1.05, 1.05, 0.9]
    control, held = gs.stand_on(start, places)
    field = gs.RadialAngle((0, 0, 0), (0.0, 4000.0), np.radians((70.0, 90.0)))
    found = gs.optimize(control, gs.a_net(angle=field), anchor=held).require()
    np.testing.assert_allclose(found.control.vertices[list(held.vertices)], places, atol=1e-9)
    assert found.quality.angle_error_deg.max < 1e-5
    assert found.quality.star_planarity.max < 1e-8


def test_supports_in_place_move_nothing(start, corners):
    control, _ = gs.stand_on(start, corners)
    assert np.abs(control.vertices - start.vertices).max() < 1e-6


def test_a_lift_of_all_supports_lifts_the_net(start, corners):
    lift = np.array([0.0, 0.0, 300.0])
    control, _ = gs.stand_on(start, corners + lift)
    assert np.abs(control.vertices - start.vertices - lift).max() < 0.1


@pytest.mark.parametrize(
    ("places", "what", "where"),
    [
        (lambda c: c[:1], "two supports or more", "supports"),
        (lambda c: np.repeat(c, 50, axis=0), "two supports or more", "supports"),
        (lambda c: c * [1.0, 1.0, 1.0] + [0.0, 9e4, 0.0], "far from the boundary", "supports"),
        (lambda c: c[[0, 1, 1]], "one place", "supports"),
    ],
)
def test_supports_that_cannot_be_are_refused(start, corners, places, what, where):
    with pytest.raises(gs.SettingError, match=what) as info:
        gs.stand_on(start, places(corners))
    assert info.value.where.startswith(where)
