import numpy as np
import pytest

from gridshell.constraints import SphericalStar

STAR = SphericalStar(np.arange(5)[None])


def residual(points):
    x = np.ravel(points)
    return STAR.evaluate(x, STAR.lag(x)).residual[0, 0]


def cross(h0, h1, h2, h3):
    return np.array([[0, 0, 0], [1, 0, h0], [0, 1, h1], [-1, 0, h2], [0, -1, h3]], dtype=float)


def test_five_points_of_a_sphere_have_no_residual():
    directions = np.random.default_rng(4).normal(size=(5, 3))
    points = directions / np.linalg.norm(directions, axis=1, keepdims=True) * 3.0 + 7.0
    assert abs(residual(points)) < 1e-13


def test_a_planar_star_has_none():
    assert residual(cross(0, 0, 0, 0)) == 0.0


def test_equal_normal_curvatures_in_both_families_have_none():
    assert abs(residual(cross(0.2, 0.2, 0.2, 0.2))) < 1e-15


@pytest.mark.parametrize("h", [0.01, 0.05])
def test_opposite_curvatures_show_as_their_difference(h):
    """Heights h and -h of the two families: twice the mean difference, to second order."""
    assert abs(residual(cross(h, -h, h, -h))) == pytest.approx(4.0 * h, rel=0.02)


def test_it_grows_with_the_star_and_not_with_its_place():
    small, large = cross(0.1, -0.1, 0.1, 0.0), 5.0 * cross(0.1, -0.1, 0.1, 0.0) + 100.0
    assert residual(large) == pytest.approx(5.0 * residual(small), rel=1e-10)
