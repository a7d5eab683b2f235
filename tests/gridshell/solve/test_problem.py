import numpy as np
import pytest

import gridshell as gs
from gridshell.solve import Stop, Term, Weight, columns_of


def test_a_weight_is_constant_by_default():
    assert [Weight(0.1).at(step) for step in (0, 1, 100)] == [0.1, 0.1, 0.1]


def test_a_decaying_weight_falls_by_its_factor():
    assert [Weight(8.0, 0.5).at(step) for step in range(4)] == [8.0, 4.0, 2.0, 1.0]


def test_a_weight_never_falls_below_its_floor():
    assert [Weight(8.0, 0.5, 3.0).at(step) for step in range(4)] == [8.0, 4.0, 3.0, 3.0]


@pytest.mark.parametrize("start", [0.0, -1.0, np.nan, np.inf])
def test_a_weight_must_be_positive_and_finite(start):
    with pytest.raises(gs.SettingError, match="weight must be positive") as info:
        Weight(start)
    assert info.value.value == str(start)


@pytest.mark.parametrize("decay", [0.0, -0.5, 1.5, np.nan])
def test_a_decay_must_lie_in_zero_to_one(decay):
    with pytest.raises(gs.SettingError, match="decay") as info:
        Weight(1.0, decay)
    assert info.value.value == str(decay)


@pytest.mark.parametrize("floor", [-0.1, 1.1, np.nan])
def test_a_floor_must_lie_between_zero_and_the_start(floor):
    with pytest.raises(gs.SettingError, match="floor") as info:
        Weight(1.0, 0.5, floor)
    assert info.value.value == str(floor)


def test_a_term_is_a_guide_unless_it_is_called_a_goal():
    assert Term("fairness", Weight(1.0), None).goal is False


def test_columns_of_points_are_their_coordinates_in_order():
    assert columns_of([[2, 0], [1, 1]]).tolist() == [[6, 7, 8, 0, 1, 2], [3, 4, 5, 3, 4, 5]]


def test_columns_of_no_points_keep_their_width():
    assert columns_of(np.empty((0, 5), dtype=np.int64)).shape == (0, 15)


@pytest.mark.parametrize("setting", [{"damping": -1.0}, {"damping_floor": -1e-9}])
def test_negative_damping_is_refused(setting):
    with pytest.raises(gs.SettingError, match="negative"):
        Stop(**setting)
