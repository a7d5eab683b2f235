import numpy as np
import pytest

import gridshell as gs
from gridshell.constraints import Proximity

SPHERE = gs.Sphere(2.0)


def evaluated(points, at=None):
    """At *points*, with the feet found from *at*."""
    x = np.asarray(points, dtype=float).ravel()
    constraint = Proximity(np.arange(x.size // 3), SPHERE)
    return constraint.evaluate(x, constraint.lag(x if at is None else np.ravel(at)))


def test_it_vanishes_on_the_surface():
    points = SPHERE.point([0.3, 1.0], [-0.2, 0.7])
    np.testing.assert_allclose(evaluated(points).residual, 0.0, atol=1e-14)


@pytest.mark.parametrize("radius", [1.5, 2.5])
def test_off_the_surface_it_is_the_signed_distance(radius):
    points = radius / 2.0 * SPHERE.point([0.3, 1.0], [-0.2, 0.7])
    np.testing.assert_allclose(evaluated(points).residual, radius - 2.0, atol=1e-14)


def test_moving_in_the_tangent_plane_costs_nothing_while_the_feet_are_held():
    foot = np.array([[2.0, 0.0, 0.0]])
    found = evaluated(foot + np.array([0.0, 0.3, -0.4]), at=foot)
    np.testing.assert_allclose(found.residual, 0.0, atol=1e-14)


def test_the_derivative_is_the_normal_of_the_foot():
    found = evaluated([[0.0, 5.0, 0.0]])
    np.testing.assert_allclose(found.values, [[[0.0, 1.0, 0.0]]], atol=1e-14)


def test_only_the_named_vertices_are_seen():
    x = np.array([[9.0, 9.0, 9.0], [3.0, 0.0, 0.0]]).ravel()
    constraint = Proximity(np.array([1]), SPHERE)
    assert constraint.pattern().columns.tolist() == [[3, 4, 5]]
    np.testing.assert_allclose(constraint.evaluate(x, constraint.lag(x)).residual, [[1.0]])
