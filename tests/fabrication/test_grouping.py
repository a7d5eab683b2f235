import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

import gridshell as gs
from fabrication.grouping import equal_groups, instance_frame
from fabrication.outlines import best_frame

KITE = np.array([[0.0, 0.0], [100.0, 10.0], [120.0, 90.0], [-20.0, 70.0]])
TURNS = st.tuples(
    st.floats(-7.0, 7.0), st.floats(-1e4, 1e4), st.floats(-1e4, 1e4), st.integers(0, 3)
)


def moved(shape, turn, x=0.0, y=0.0, shift=0):
    c, s = np.cos(turn), np.sin(turn)
    return np.roll(shape @ np.array([[c, s], [-s, c]]) + [x, y], -shift, axis=0)


def mirrored(shape):
    """Turned over; the corners counter-clockwise again."""
    return (shape * [1.0, -1.0])[::-1]


@given(TURNS)
def test_a_moved_outline_is_the_same_part(turn):
    (group,) = equal_groups([KITE, moved(KITE, *turn)], 0.01, prefix="G")
    member = group.members[1]
    assert not member.mirrored
    assert member.deviation < 1e-6
    # corner c of the first is corner c + shift of the second
    assert (turn[3] + member.shift) % 4 == 0


@given(TURNS)
def test_a_mirrored_outline_is_the_same_part_only_where_it_may_be_turned_over(turn):
    other = moved(mirrored(KITE), *turn)
    assert len(equal_groups([KITE, other], 0.01, prefix="G")) == 2
    (group,) = equal_groups([KITE, other], 0.01, prefix="G", mirror=True)
    member = group.members[1]
    assert member.mirrored
    counterpart = other[(member.shift - np.arange(4)) % 4]
    for c in range(4):
        sides = [np.linalg.norm(s[c] - s[(c + 1) % 4]) for s in (KITE, counterpart)]
        assert sides[0] == pytest.approx(sides[1], abs=1e-6)


@given(st.floats(0.2, 50.0), st.integers(0, 3))
def test_a_corner_out_of_tolerance_makes_another_part(by, corner):
    other = KITE.copy()
    other[corner] += by * np.array([0.6, 0.8])
    assert len(equal_groups([KITE, other], 0.1, prefix="G", mirror=True)) == 2
    (group,) = equal_groups([KITE, other], by, prefix="G")
    # a quarter of the move is taken up by the other corners
    assert 0.4 * by <= group.members[1].deviation <= by


def test_names_follow_the_first_members():
    wide = KITE * [2.0, 1.0]
    groups = equal_groups([wide, KITE, KITE[:3], wide, moved(KITE, 1.0)], 0.01, prefix="H")
    assert [g.name for g in groups] == ["H1", "H2", "H3"]
    assert [[m.index for m in g.members] for g in groups] == [[0, 3], [1, 4], [2]]


@given(st.lists(st.floats(0.0, 3.0), min_size=1, max_size=12))
def test_every_part_is_in_one_group_and_within_its_tolerance(stretches):
    shapes = [KITE + np.array([[0, 0], [s, 0], [s, 0], [0, 0]]) for s in stretches]
    groups = equal_groups(shapes, 0.5, prefix="G")
    indices = sorted(m.index for g in groups for m in g.members)
    assert indices == list(range(len(shapes)))
    for group in groups:
        first = stretches[group.members[0].index]
        for member in group.members:
            assert member.deviation <= 0.5
            assert abs(stretches[member.index] - first) <= 2.0


def test_a_square_fits_without_turning():
    square = np.array([[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]])
    (group,) = equal_groups([square, square], 1e-6, prefix="G", mirror=True)
    assert (group.members[1].shift, group.members[1].mirrored) == (0, False)


@pytest.mark.parametrize("tolerance", [0.0, -1.0, np.nan])
def test_a_tolerance_that_is_not_positive_is_refused(tolerance):
    with pytest.raises(gs.SettingError, match="tolerance"):
        equal_groups([KITE], tolerance, prefix="G")


@given(TURNS, st.booleans(), st.floats(0.0, 0.05))
def test_the_first_part_can_be_put_in_the_place_of_any_other(turn, over, bend):
    other = moved(mirrored(KITE) if over else KITE, *turn)
    other[0] += bend
    space = np.column_stack([other, 0.3 * other[:, 0] + 0.2 * other[:, 1]])
    frame = best_frame(space)
    flat = frame.flat(space)
    # the first is drawn nowhere near its mean
    first = KITE + 500.0
    groups = equal_groups([first, flat], 200.0, prefix="G", mirror=True)
    member = groups[0].members[1]
    placed = instance_frame(first, flat, frame, member)
    numbers = member.shift - np.arange(4) if member.mirrored else member.shift + np.arange(4)
    apart = np.linalg.norm(placed.place(first) - frame.place(flat)[numbers % 4], axis=1)
    assert apart.max() == pytest.approx(member.deviation, abs=1e-6)
    assert placed.normal @ frame.normal == pytest.approx(-1.0 if member.mirrored else 1.0)
