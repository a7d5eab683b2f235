import numpy as np
import pytest

import fabrication as fab
import gridshell as gs
from fabrication.stock import require_web


@pytest.mark.parametrize("key", ["width", "thickness"])
@pytest.mark.parametrize("value", [0.0, -2.5, np.nan, np.inf])
def test_a_profile_needs_positive_sizes(key, value):
    with pytest.raises(gs.SettingError, match="must be positive") as info:
        fab.Profile(**{"width": 100.0, "thickness": 2.5, key: value}, material=fab.S235)
    assert info.value.where == key


def test_a_profile_thicker_than_a_third_of_its_width_is_no_strip():
    with pytest.raises(gs.SettingError, match="must be a strip") as info:
        fab.Profile(width=30.0, thickness=10.1, material=fab.S235)
    assert (info.value.where, info.value.value) == ("thickness", "10.1 mm")
    assert "10 mm" in info.value.limit


def test_a_profile_of_exactly_a_third_is_one():
    assert fab.Profile(width=30.0, thickness=10.0, material=fab.S235).thickness == 10.0


@pytest.mark.parametrize(("clearance", "left"), [(39.99, True), (40.0, False), (60.0, False)])
def test_slots_must_leave_something_of_a_strip(clearance, left):
    profile = fab.Profile(width=80.0, thickness=2.0, material=fab.S235)
    if left:
        require_web(profile, clearance)
        return
    with pytest.raises(gs.SettingError, match="cut the strips through") as info:
        require_web(profile, clearance)
    assert (info.value.where, info.value.value) == ("depth_clearance", f"{clearance:g} mm")
    assert "40 mm" in info.value.limit


@pytest.mark.parametrize("key", ["length", "width"])
@pytest.mark.parametrize("value", [0.0, -1.0, np.nan])
def test_a_sheet_needs_positive_sizes(key, value):
    with pytest.raises(gs.SettingError, match="must be positive") as info:
        fab.Sheet(**{"length": 3000.0, "width": 1500.0, key: value})
    assert info.value.where == key


@pytest.mark.parametrize("key", ["margin", "gap"])
@pytest.mark.parametrize("value", [-0.1, np.nan, np.inf])
def test_a_sheet_refuses_negative_distances(key, value):
    with pytest.raises(gs.SettingError, match="cannot be negative") as info:
        fab.Sheet(3000.0, 1500.0, **{key: value})
    assert info.value.where == key


@pytest.mark.parametrize("key", ["margin", "gap"])
def test_a_sheet_without_margin_or_gap_is_allowed(key):
    assert getattr(fab.Sheet(3000.0, 1500.0, **{key: 0.0}), key) == 0.0


def test_margins_that_leave_nothing_of_a_sheet_are_refused():
    with pytest.raises(gs.SettingError, match="leave nothing") as info:
        fab.Sheet(3000.0, 100.0, margin=50.0)
    assert (info.value.where, info.value.limit) == ("margin", "below 50 mm")


@pytest.mark.parametrize(
    ("width", "thickness", "wall", "key"),
    [
        (40.0, 50.0, 2.0, "thickness"),
        (40.0, 14.0, 7.0, "wall"),
        (40.0, 14.0, 0.0, "wall"),
        (0.0, 14.0, 2.0, "width"),
    ],
)
def test_tubes_that_cannot_be_are_refused(width, thickness, wall, key):
    with pytest.raises(gs.SettingError) as info:
        fab.HollowProfile(width, thickness, fab.GRP, wall)
    assert info.value.where == key


def test_a_tube_may_be_as_thick_as_wide_and_says_its_size():
    assert fab.HollowProfile(40.0, 40.0, fab.GRP, 3.0).size == "40 x 40 x 3"
    assert fab.Profile(100.0, 2.5, fab.S235).size == "100 x 2.5"
