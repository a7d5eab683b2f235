from math import radians

import numpy as np
import pytest

import gridshell as gs

POINTS = np.array([[0.0, 0.0, 0.0], [3.0, 4.0, 0.0], [0.0, 0.0, 10.0], [0.0, 0.0, 100.0]])
RIGHT, SHARP = radians(90.0), radians(60.0)


def degrees(field, points=POINTS):
    return np.degrees(field(points))


def test_a_radial_field_is_linear_between_its_radii():
    field = gs.RadialAngle((0.0, 0.0, 0.0), (0.0, 10.0), (RIGHT, SHARP))
    np.testing.assert_allclose(degrees(field), [90.0, 75.0, 60.0, 60.0])


def test_a_field_along_a_direction_is_linear_between_its_stations():
    field = gs.AngleAlong((0.0, 0.0, 5.0), (0.0, 20.0, 100.0), (RIGHT, SHARP, RIGHT))
    np.testing.assert_allclose(degrees(field), [90.0, 90.0, 75.0, 90.0])


def test_samples_are_met_and_joined_linearly_on_a_line():
    places = np.array([[0.0, 0.0, 0.0], [0.0, 0.0, 20.0], [0.0, 0.0, 100.0]])
    field = gs.SampledAngle(places, np.radians([90.0, 60.0, 80.0]))
    np.testing.assert_allclose(degrees(field, places), [90.0, 60.0, 80.0], rtol=1e-9)
    np.testing.assert_allclose(degrees(field, [[0.0, 0.0, 10.0]] @ np.eye(3)), [75.0], rtol=1e-9)


def test_samples_never_overshoot():
    rng = np.random.default_rng(3)
    field = gs.SampledAngle(rng.normal(size=(30, 3)), rng.uniform(1.0, 1.5, 30))
    found = field(4.0 * rng.normal(size=(500, 3)))
    assert found.min() >= field.angles.min()
    assert found.max() <= field.angles.max()


def test_one_sample_holds_everywhere():
    field = gs.SampledAngle(np.zeros((1, 3)), np.array([1.1]))
    np.testing.assert_allclose(field(POINTS), 1.1)


def test_a_formula_knows_the_place_and_the_distance_from_its_centre():
    field = gs.FormulaAngle("90 - x - 2 * y + z / 10 - r", centre=(0.0, 0.0, 10.0))
    x, y, z = POINTS[:3].T
    r = np.linalg.norm(POINTS[:3] - [0.0, 0.0, 10.0], axis=1)
    np.testing.assert_allclose(degrees(field, POINTS[:3]), 90 - x - 2 * y + z / 10 - r)


def test_a_formula_that_leaves_the_range_names_the_place_and_a_way_out():
    field = gs.FormulaAngle("90 + z")
    with pytest.raises(gs.SettingError, match="range of node angles") as info:
        field(POINTS)
    assert info.value.where == "formula at (0, 0, 100) mm"
    assert info.value.value == "190 degrees"
    assert degrees(gs.FormulaAngle(info.value.advice)).max() == pytest.approx(150.0)


@pytest.mark.parametrize("formula", ["0/0 * x", "log(-1 - r)", "180", "0"])
def test_a_formula_without_a_usable_value_is_refused(formula):
    with pytest.raises(gs.SettingError, match="range of node angles"):
        gs.FormulaAngle(formula)(POINTS)


@pytest.mark.parametrize(
    ("make", "key"),
    [
        (lambda: gs.RadialAngle((0, 0, 0), (10.0, 0.0), (1.0, 1.2)), "radii"),
        (lambda: gs.RadialAngle((0, 0, 0), (0.0, 10.0), (1.0, 3.2)), "angles"),
        (lambda: gs.AngleAlong((0, 0, 0), (0.0,), (1.0,)), "direction"),
        (lambda: gs.AngleAlong((0, 0, 1), (0.0, 0.0), (1.0, 1.1)), "stations"),
        (lambda: gs.AngleAlong((0, 0, 1), (0.0, 1.0), (1.0,)), "angles"),
        (lambda: gs.AngleAlong((0, 0, 1), (0.0, np.nan), (1.0, 1.0)), "stations"),
        (lambda: gs.SampledAngle(np.zeros((0, 3)), np.zeros(0)), "samples"),
        (lambda: gs.SampledAngle(np.zeros((1, 3)), np.array([0.0])), "samples"),
        (lambda: gs.SampledAngle(np.zeros((2, 3)), np.array([1.0, 1.1])), "samples"),
    ],
)
def test_fields_that_cannot_be_are_refused(make, key):
    with pytest.raises(gs.SettingError) as info:
        make()
    assert info.value.where == key


FIELDS = {
    "radial": gs.RadialAngle((0, 0, 0), (0.0, 4000.0), (radians(70.0), RIGHT)),
    "along": gs.AngleAlong((0.0, 0.0, 1.0), (-2000.0, 2000.0), (SHARP, RIGHT)),
    "samples": gs.SampledAngle(
        np.array([[3000.0, 0, 0], [0, 3000.0, 0], [-3000.0, -3000.0, 0]]),
        np.radians([80.0, 70.0, 95.0]),
    ),
    "formula": gs.FormulaAngle("80 + 8 * sin(x / 2000) - 5 * (y / 3000) ** 2"),
    "any function": lambda p: 1.3 + 0.1 * np.tanh(p[:, 2] / 1000.0),
}


@pytest.mark.parametrize("name", FIELDS)
def test_every_field_is_met_around_a_singularity(name):
    """Fig. 13: form-finding with a free boundary; the angle is that of where the net ends."""
    control = gs.control_patch(gs.Enneper(4000.0), gs.SingularPatch(6, 6, 0.8, cut=1))
    field = FIELDS[name]
    found = gs.optimize(control, gs.a_net(angle=field), anchor=gs.Free()).require()
    wanted = field(found.control.vertices[control.quads].mean(axis=1))
    assert np.degrees(np.abs(gs.node_angles(found.control) - wanted)).max() < 1e-5
    assert found.quality.star_planarity.max < 1e-8


def test_the_net_of_a_field_moves_and_grows_with_it():
    """Invariance under a rigid motion and scale of surface and field together."""
    control = gs.control_patch(gs.Enneper(4000.0), gs.SingularPatch(6, 4, 0.7))
    field = gs.RadialAngle((0, 0, 0), (0.0, 4000.0), (RIGHT, SHARP))
    first = gs.optimize(control, gs.a_net(angle=field), anchor=gs.Free()).require().control
    turn, scale, shift = np.linalg.qr(np.array([[1, 2, 3], [0, 1, 4], [5, 6, 0.0]]))[0], 0.25, 700.0
    turn = turn * np.sign(np.linalg.det(turn))
    moved = control.moved(scale * control.vertices @ turn.T + shift)
    centre = (shift, shift, shift)
    there = gs.RadialAngle(centre, (0.0, scale * 4000.0), (RIGHT, SHARP))
    second = gs.optimize(moved, gs.a_net(angle=there), anchor=gs.Free()).require().control
    expected = scale * first.vertices @ turn.T + shift
    assert np.abs(second.vertices - expected).max() < 1e-5 * second.mesh.mean_edge
