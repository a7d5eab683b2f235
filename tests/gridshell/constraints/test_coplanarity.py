import numpy as np
import pytest

from gridshell.constraints import Coplanarity

P, A, B, C = np.eye(4)
THROUGH_A = {"p": B - A, "q": C - A, "w": (P - A)[None]}
"""Point 0 against the plane of points 1, 2, 3."""


def distance(points, **coefficients):
    constraint = Coplanarity(np.array([[0, 1, 2, 3]]), **(coefficients or THROUGH_A))
    return constraint.evaluate(np.asarray(points, dtype=float).ravel(), None)


def planar_points(rng):
    """Four points in a random plane, far from the origin."""
    frame = rng.normal(size=(2, 3))
    return 50.0 + rng.normal(size=(4, 2)) @ frame


@pytest.mark.parametrize("seed", range(5))
def test_it_vanishes_on_planar_points(seed):
    points = planar_points(np.random.default_rng(seed))
    assert np.abs(distance(points).residual).max() < 1e-12


@pytest.mark.parametrize("height", [0.25, -3.0])
def test_it_is_the_signed_distance_from_the_plane(height):
    points = [[0.3, 0.4, height], [0, 0, 0], [2, 0, 0], [0, 5, 0]]
    assert distance(points).residual[0, 0] == pytest.approx(height, abs=1e-15)


def test_it_does_not_depend_on_the_size_of_the_spanning_triangle():
    small = [[0.3, 0.4, 2.0], [0, 0, 0], [0.1, 0, 0], [0, 0.1, 0]]
    assert distance(small).residual[0, 0] == pytest.approx(2.0, abs=1e-15)


def test_it_does_not_change_under_a_motion():
    rng = np.random.default_rng(4)
    points = rng.normal(size=(4, 3))
    q, r = np.linalg.qr(rng.normal(size=(3, 3)))
    rotation = q * np.sign(np.diag(r))
    rotation *= np.sign(np.linalg.det(rotation))
    moved = points @ rotation.T + rng.normal(size=3)
    np.testing.assert_allclose(distance(moved).residual, distance(points).residual, atol=1e-14)


def test_a_reflection_turns_the_sign():
    points = np.random.default_rng(5).normal(size=(4, 3))
    mirrored = distance(points * [1.0, 1.0, -1.0]).residual
    np.testing.assert_allclose(mirrored, -distance(points).residual, atol=1e-15)


def test_translations_are_in_the_kernel_of_the_jacobian():
    values = distance(np.random.default_rng(6).normal(size=(4, 3))).values
    np.testing.assert_allclose(values.reshape(4, 3).sum(axis=0), 0.0, atol=1e-14)


def test_collinear_points_give_finite_numbers():
    found = distance([[0, 0, 1], [0, 0, 0], [1, 0, 0], [2, 0, 0]])
    assert np.isfinite(found.residual).all()
    assert np.isfinite(found.values).all()
