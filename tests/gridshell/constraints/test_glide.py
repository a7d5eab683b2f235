import numpy as np
import pytest

from gridshell.constraints import Curve, Glide, smooth_curve

LINE = Curve(np.array([[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [2.0, 0.0, 0.0], [3.0, 0.0, 0.0]]))
FULL = np.linspace(0.0, 2.0 * np.pi, 24, endpoint=False)
CIRCLE = np.column_stack([np.cos(FULL), np.sin(FULL), np.zeros(24)])


def evaluated(points, curve=LINE, at=None):
    """At *points*, with the tangent lines found from *at*."""
    x = np.asarray(points, dtype=float).ravel()
    constraint = Glide(np.arange(x.size // 3), curve)
    return constraint.evaluate(x, constraint.lag(x if at is None else np.ravel(at)))


# ---- the curve ------------------------------------------------------------------------------


def test_the_closest_point_of_a_line_by_hand():
    feet, tangents = LINE.closest(np.array([[1.3, 4.0, 0.0], [2.6, 0.0, -3.0]]))
    np.testing.assert_allclose(feet, [[1.3, 0.0, 0.0], [2.6, 0.0, 0.0]], atol=1e-15)
    np.testing.assert_array_equal(tangents, [[1.0, 0.0, 0.0]] * 2)


def test_beyond_its_ends_the_closest_point_is_the_end():
    feet, _ = LINE.closest(np.array([[-2.0, 1.0, 0.0], [9.0, 0.0, 0.0]]))
    np.testing.assert_array_equal(feet, [[0.0, 0.0, 0.0], [3.0, 0.0, 0.0]])


def test_a_curve_of_one_chord_is_enough():
    feet, _ = Curve(LINE.points[:2]).closest(np.array([[0.25, 1.0, 0.0]]))
    np.testing.assert_array_equal(feet, [[0.25, 0.0, 0.0]])


@pytest.mark.parametrize("closed", [True, False])
def test_a_smooth_curve_passes_through_its_vertices(closed):
    curve = smooth_curve(CIRCLE, closed=closed)
    feet, _ = curve.closest(CIRCLE)
    np.testing.assert_allclose(feet, CIRCLE, atol=1e-14)


def test_a_closed_curve_returns_to_its_first_point():
    points = smooth_curve(CIRCLE, closed=True).points
    np.testing.assert_allclose(points[0], points[-1], atol=1e-14)


def test_an_open_curve_ends_with_its_last_vertex():
    np.testing.assert_allclose(
        smooth_curve(CIRCLE, closed=False).points[-1], CIRCLE[-1], atol=1e-14
    )


def test_between_its_vertices_a_smooth_curve_follows_a_circle():
    curve = smooth_curve(CIRCLE, closed=True)
    np.testing.assert_allclose(np.linalg.norm(curve.points, axis=1), 1.0, atol=2e-5)


def test_more_samples_shorten_the_chords():
    coarse, fine = (smooth_curve(CIRCLE, closed=True, samples=n) for n in (4, 16))
    assert (len(coarse.points), len(fine.points)) == (4 * 24 + 1, 16 * 24 + 1)


def test_two_vertices_make_a_straight_curve():
    curve = smooth_curve(LINE.points[:2], closed=False)
    np.testing.assert_allclose(curve.points[:, 1:], 0.0, atol=1e-15)


# ---- gliding --------------------------------------------------------------------------------


def test_on_the_curve_nothing_is_asked():
    assert np.abs(evaluated([[0.4, 0.0, 0.0]]).residual).max() == 0.0


def test_off_the_curve_the_offset_is_across_it():
    found = evaluated([[1.3, 4.0, -3.0]]).residual
    np.testing.assert_allclose(found, [[0.0, 4.0, -3.0]], atol=1e-15)


def test_moving_along_the_tangent_costs_nothing():
    found = evaluated([[1.9, 0.0, 0.0]], at=[[1.3, 0.0, 0.0]])
    np.testing.assert_allclose(found.residual, 0.0, atol=1e-15)


def test_around_a_circle_the_residual_is_the_distance_from_it():
    curve = smooth_curve(CIRCLE, closed=True)
    points = 1.2 * np.column_stack([np.cos(FULL + 0.1), np.sin(FULL + 0.1), np.zeros(24)])
    found = np.linalg.norm(evaluated(points, curve).residual, axis=1)
    np.testing.assert_allclose(found, 0.2, atol=1e-3)


def test_the_derivative_projects_across_the_tangent():
    np.testing.assert_array_equal(evaluated([[1.3, 4.0, 0.0]]).values, [np.diag([0.0, 1.0, 1.0])])
