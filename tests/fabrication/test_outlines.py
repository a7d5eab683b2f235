import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation
from shapely.geometry import Polygon

from fabrication.outlines import (
    Frame,
    best_frame,
    corner_angles,
    inset,
    is_simple,
    polygon_area,
)

SQUARE = np.array([[0.0, 0.0], [10.0, 0.0], [10.0, 10.0], [0.0, 10.0]])
GAPS = st.lists(st.floats(0.5, 0.9), min_size=3, max_size=8)
"""Shares of the full turn from corner to corner, none of them half of it."""


def around(gaps, radius=100.0):
    """Convex corners on a circle, counter-clockwise."""
    turn = 2.0 * np.pi * np.cumsum(gaps) / sum(gaps)
    return radius * np.stack([np.cos(turn), np.sin(turn)], axis=1)


@given(GAPS, st.floats(0.1, 60.0))
def test_an_inset_is_shapely_s_or_nothing(gaps, distance):
    polygon = around(gaps)
    expected = Polygon(polygon).buffer(-distance, join_style="mitre", mitre_limit=1e6)
    found = inset(polygon, distance)
    if found is None:
        # an edge has gone: what remains has fewer corners, or nothing does
        assert expected.is_empty or len(expected.exterior.coords) - 1 < len(polygon)
    else:
        assert polygon_area(found) == pytest.approx(expected.area, rel=1e-9, abs=1e-6)


def test_every_edge_has_its_own_distance():
    found = inset(SQUARE, np.array([1.0, 2.0, 3.0, 4.0]))
    np.testing.assert_allclose(found, [[4, 1], [8, 1], [8, 7], [4, 7]], atol=1e-12)


def test_a_straight_corner_moves_square_to_its_edge():
    polygon = np.array([[0.0, 0.0], [5.0, 0.0], [10.0, 0.0], [10.0, 10.0], [0.0, 10.0]])
    found = inset(polygon, 1.0)
    np.testing.assert_allclose(found[1], [5.0, 1.0], atol=1e-12)
    assert inset(polygon, np.array([1.0, 2.0, 1.0, 1.0, 1.0])) is None


@pytest.mark.parametrize("distance", [5.0, 7.0, 1e3])
def test_nothing_is_left_of_a_square_set_back_by_half(distance):
    assert inset(SQUARE, distance) is None


def test_a_re_entrant_corner_that_meets_the_far_side_is_refused():
    arrow = np.array([[0.0, 0.0], [10.0, 0.0], [5.0, 2.0], [5.0, 8.0]])[[0, 1, 2, 3]]
    assert is_simple(arrow)
    dart = np.array([[0.0, 0.0], [10.0, 0.0], [10.0, 10.0], [9.0, 1.0]])
    assert inset(dart, 0.1) is not None
    assert inset(dart, 0.6) is None


def test_a_bow_tie_is_not_simple():
    assert not is_simple(SQUARE[[0, 2, 1, 3]])
    assert is_simple(SQUARE)


@given(GAPS)
def test_corner_angles_sum_up(gaps):
    polygon = around(gaps)
    assert corner_angles(polygon).sum() == pytest.approx((len(polygon) - 2) * np.pi)
    expected = np.pi / 2.0
    np.testing.assert_allclose(corner_angles(SQUARE), expected)


@given(GAPS, st.tuples(*[st.floats(-3.0, 3.0)] * 3), st.floats(-1e5, 1e5))
def test_flat_and_place_undo_each_other(gaps, turn, away):
    polygon = around(gaps)
    flat = np.column_stack([polygon, np.zeros(len(polygon))])
    space = Rotation.from_rotvec(turn).apply(flat) + away
    frame = best_frame(space)
    np.testing.assert_allclose(frame.place(frame.flat(space)), space, atol=1e-9 * (1 + abs(away)))
    # never turned over: the outline stays counter-clockwise
    assert polygon_area(frame.flat(space)) == pytest.approx(polygon_area(polygon))
    assert np.linalg.det(np.stack([frame.x, frame.y, frame.normal])) == pytest.approx(1.0)


@given(st.floats(0.1, 50.0), st.integers(0, 2**31))
def test_no_plane_is_nearer_to_four_corners(lift, seed):
    corners = np.array([[0.0, 0, 0], [100, 0, lift], [110, 90, 0], [-5, 80, lift]])
    frame = best_frame(corners)
    best = np.abs(frame.distance(corners)).max()
    np.testing.assert_allclose(np.abs(frame.distance(corners)), best, rtol=1e-9)
    rng = np.random.default_rng(seed)
    for _ in range(20):
        normal = frame.normal + 0.02 * rng.normal(size=3)
        normal /= np.linalg.norm(normal)
        heights = corners @ normal
        assert np.ptp(heights) / 2.0 >= best * (1.0 - 1e-9)


def test_the_x_axis_follows_the_direction_asked_for():
    corners = np.column_stack([SQUARE, np.zeros(4)])
    frame = best_frame(corners, np.array([1.0, 1.0, 5.0]))
    np.testing.assert_allclose(frame.x, [np.sqrt(0.5), np.sqrt(0.5), 0.0], atol=1e-12)


def test_a_frame_cannot_be_changed():
    frame = Frame(np.zeros(3), np.eye(3)[0], np.eye(3)[1])
    with pytest.raises(ValueError, match="read-only"):
        frame.x[0] = 2.0


@given(st.tuples(*[st.floats(-3.0, 3.0)] * 3), st.floats(-50.0, 50.0))
def test_heights_are_distances_from_the_plane(turn, height):
    x, y, _ = Rotation.from_rotvec(turn).as_matrix()
    frame = Frame(np.array([1.0, 2.0, 3.0]), x, y)
    (placed,) = frame.place(np.array([[4.0, 5.0, height]]))
    assert frame.flat(placed) == pytest.approx([4.0, 5.0])
    assert float(frame.distance(placed)) == pytest.approx(height)
