import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from fabrication.cut import Edge, Slot, area, outline

LENGTH, WIDTH = 1000.0, 100.0


def slot(x, edge=Edge.UPPER, *, width=3.0, depth=50.0):
    return Slot(x, width, depth, edge, node="N1", partner="B1")


def rows(corners):
    return [tuple(corner) for corner in corners.tolist()]


slots = st.lists(
    st.builds(
        slot,
        st.integers(0, 19).map(lambda i: 25.0 + 50.0 * i),
        st.sampled_from(Edge),
        width=st.floats(0.5, 20.0),
        depth=st.floats(1.0, 60.0),
    ),
    max_size=12,
    unique_by=lambda s: s.x,
)


def test_a_strip_without_slots_is_a_rectangle():
    assert rows(outline(LENGTH, WIDTH, [])) == [(0, 0), (1000, 0), (1000, 100), (0, 100)]


def test_a_slot_from_below_opens_to_the_lower_edge():
    corners = rows(outline(LENGTH, WIDTH, [slot(500.0, Edge.LOWER, width=4.0, depth=50.5)]))
    assert corners[1:5] == [(498, 0), (498, 50.5), (502, 50.5), (502, 0)]


def test_a_slot_from_above_opens_to_the_upper_edge():
    corners = rows(outline(LENGTH, WIDTH, [slot(500.0, Edge.UPPER, width=4.0, depth=50.5)]))
    assert corners[3:7] == [(502, 100), (502, 49.5), (498, 49.5), (498, 100)]


def test_the_order_in_which_slots_are_named_does_not_matter():
    several = [slot(300.0), slot(700.0), slot(500.0, Edge.LOWER)]
    assert rows(outline(LENGTH, WIDTH, several)) == rows(outline(LENGTH, WIDTH, several[::-1]))


@given(slots)
def test_the_area_of_an_outline_is_the_strip_less_its_slots(several):
    removed = sum(s.width * s.depth for s in several)
    assert area(outline(LENGTH, WIDTH, several)) == pytest.approx(
        LENGTH * WIDTH - removed, rel=1e-12
    )


@given(slots)
def test_every_edge_of_an_outline_is_axis_parallel_and_has_a_length(several):
    corners = outline(LENGTH, WIDTH, several)
    steps = np.abs(np.roll(corners, -1, axis=0) - corners)
    assert ((steps > 0.0).sum(axis=1) == 1).all()


def test_an_outline_cannot_be_edited():
    with pytest.raises(ValueError, match="read-only"):
        outline(LENGTH, WIDTH, [])[0, 0] = 1.0


def test_a_polygon_has_positive_area_counter_clockwise():
    triangle = np.array([[0.0, 0.0], [4.0, 0.0], [0.0, 3.0]])
    assert area(triangle) == 6.0
    assert area(triangle[::-1]) == -6.0
