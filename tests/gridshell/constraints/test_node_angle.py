import numpy as np
import pytest

from gridshell.constraints import NodeAngle

QUAD = np.array([[0, 1, 2, 3]])


def residual(points, angle, lag_lengths=False):
    x = np.asarray(points, dtype=float).ravel()
    constraint = NodeAngle(QUAD, np.array([angle]), lag_lengths)
    return float(constraint.evaluate(x, constraint.lag(x)).residual[0, 0])


def crossing(angle, first=1.0, second=1.0):
    """A quad whose diagonals cross at the origin under *angle*, counter-clockwise."""
    a = first * np.array([1.0, 0.0, 0.0])
    b = second * np.array([np.cos(angle), np.sin(angle), 0.0])
    return np.array([-a, -b, a, b])


@pytest.mark.parametrize("degrees", [30.0, 60.0, 75.0, 90.0, 120.0])
def test_it_vanishes_at_its_angle(degrees):
    angle = np.radians(degrees)
    assert abs(residual(crossing(angle), angle)) < 1e-15


def test_it_is_the_difference_of_cosines():
    found = residual(crossing(np.radians(60.0)), np.radians(90.0))
    assert found == pytest.approx(0.5, abs=1e-15)


def test_an_angle_and_its_supplement_are_told_apart():
    assert abs(residual(crossing(np.radians(60.0)), np.radians(120.0))) > 0.9


def test_it_does_not_depend_on_the_lengths_or_the_distance_of_the_diagonals():
    angle = np.radians(60.0)
    points = crossing(angle, 3.0, 0.2)
    points[[1, 3], 2] += 5.0
    assert abs(residual(points, angle)) < 1e-15


def test_with_lagged_lengths_the_value_is_the_same_at_the_point_of_the_lag():
    points = np.random.default_rng(0).normal(size=(4, 3))
    assert residual(points, 1.0, True) == pytest.approx(residual(points, 1.0), abs=1e-15)


def test_lagged_lengths_stay_those_of_the_lag():
    constraint = NodeAngle(QUAD, np.array([np.pi / 2.0]), lag_lengths=True)
    x = crossing(np.radians(60.0)).ravel()
    lag = constraint.lag(x)
    assert constraint.evaluate(2.0 * x, lag).residual[0, 0] == pytest.approx(4.0 * 0.5)


def test_nothing_is_lagged_by_default():
    assert NodeAngle(QUAD, np.array([1.0])).lag(np.zeros(12)) is None


def test_a_collapsed_diagonal_gives_finite_numbers():
    points = crossing(1.0)
    points[2] = points[0]
    constraint = NodeAngle(QUAD, np.array([1.0]))
    found = constraint.evaluate(points.ravel(), None)
    assert np.isfinite(found.residual).all()
    assert np.isfinite(found.values).all()
