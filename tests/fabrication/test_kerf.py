import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from shapely import Polygon

import gridshell as gs
from fabrication.cut import Edge, Floor, Relief, Slot, outline
from fabrication.flattening import flattened
from fabrication.kerf import moved_out
from fabrication.outlines import outline_area
from fabrication.shapes import circle, with_bulges

RELIEFS = [Relief(), Relief(Floor.ROUND), Relief(Floor.DOGBONE, 1.2)]


def slotted(relief, width=6.0):
    slots = [
        Slot(60.0, width, 50.0, Edge.LOWER, "N1", "B1", relief),
        Slot(150.0, width, 40.0, Edge.UPPER, "N2", "B2", relief),
    ]
    return outline(220.0, 100.0, slots)


def shape(rows):
    return Polygon(flattened(with_bulges(rows), closed=True))


@pytest.mark.parametrize("relief", RELIEFS)
@pytest.mark.parametrize("distance", [0.1, 0.5, -0.4])
def test_it_is_what_shapely_makes_of_a_fine_polygon(relief, distance):
    rows = slotted(relief)
    expected = shape(rows).buffer(distance, join_style="mitre")
    assert shape(moved_out(rows, distance)).symmetric_difference(expected).area < 0.35


@pytest.mark.parametrize("relief", RELIEFS)
@given(distance=st.floats(0.001, 0.6))
def test_there_and_back_is_the_same(relief, distance):
    rows = slotted(relief)
    np.testing.assert_allclose(moved_out(moved_out(rows, distance), -distance), rows, atol=1e-9)


def test_a_circle_stays_a_circle():
    grown = moved_out(circle(10.0, 3.0, 4.0), 0.5)
    np.testing.assert_allclose(grown, circle(10.5, 3.0, 4.0), atol=1e-12)


def test_slots_get_narrower_by_the_kerf_and_the_strip_longer():
    plain = moved_out(slotted(RELIEFS[0]), 0.25)
    assert np.ptp(plain, axis=0) == pytest.approx((220.5, 100.5))
    assert plain[2, 0] - plain[1, 0] == pytest.approx(0.0)
    assert plain[3, 0] - plain[2, 0] == pytest.approx(5.5)


@pytest.mark.parametrize("relief", RELIEFS)
def test_the_area_grows_by_the_way_around(relief):
    rows, tiny = slotted(relief), 1e-4
    grown = (outline_area(moved_out(rows, tiny)) - outline_area(rows)) / tiny
    assert grown == pytest.approx(shape(rows).length, rel=1e-3)


@pytest.mark.parametrize(("relief", "distance"), [(RELIEFS[0], 3.0), (RELIEFS[2], 1.3)])
def test_a_kerf_as_wide_as_a_cut_is_refused(relief, distance):
    with pytest.raises(gs.SettingError, match="kerf leaves nothing"):
        moved_out(slotted(relief), distance)
