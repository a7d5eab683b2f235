import numpy as np
import pytest

from gridshell.constraints import AngleBounds

QUAD = np.array([[0, 1, 2, 3]])


def rhombus(angle):
    """Corners whose diagonals have length 2 and meet at *angle*."""
    c, s = np.cos(angle), np.sin(angle)
    return np.array([[-1.0, 0, 0], [-c, -s, 0], [1.0, 0, 0], [c, s, 0]]).ravel()


@pytest.mark.parametrize("degrees", [61.0, 75.0, 89.0])
def test_between_the_bounds_nothing_pulls(degrees):
    bounds = AngleBounds(QUAD, np.radians([60.0]), np.radians([90.0]))
    found = bounds.evaluate(rhombus(np.radians(degrees)), None)
    assert np.abs(found.residual).max() == 0.0
    assert np.abs(found.values).max() == 0.0


@pytest.mark.parametrize(("degrees", "nearest"), [(40.0, 60.0), (100.0, 90.0)])
def test_outside_the_nearer_bound_is_the_target(degrees, nearest):
    bounds = AngleBounds(QUAD, np.radians([60.0]), np.radians([90.0]))
    found = bounds.evaluate(rhombus(np.radians(degrees)), None)
    expected = np.cos(np.radians(degrees)) - np.cos(np.radians(nearest))
    assert found.residual[0, 0] == pytest.approx(expected)
    assert np.abs(found.values).max() > 0.1
