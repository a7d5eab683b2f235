from itertools import combinations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from shapely import Polygon, box

import fabrication as fab
from fabrication.cut import Edge, Slot, outline
from fabrication.errors import StockError
from fabrication.nesting import sheet_bound, sheets_of
from fabrication.unroll import Development

SHEET = fab.Sheet(6000.0, 767.0, margin=12.0, gap=8.0)


def part(number, length, width=100.0):
    slots = [Slot(length / 2.0, 3.0, width / 2.0, Edge.UPPER, "N1", "B1")]
    return fab.FlatPart(
        f"A{number}",
        outline(length, width, slots),
        tuple(slots),
        (),
        width,
        2.5,
        Development(length, np.zeros(0), 0.0, 0.0),
    )


def placed(sheet):
    return [
        Polygon(placement.part.outline + np.array([placement.x, placement.y]))
        for placement in sheet.placements
    ]


lengths = st.lists(st.floats(20.0, 5976.0), min_size=1, max_size=40)


@given(lengths)
def test_every_part_is_placed_exactly_once(sizes):
    parts = [part(i, length) for i, length in enumerate(sizes)]
    marks = [p.part.mark for sheet in fab.nest(parts, SHEET) for p in sheet.placements]
    assert sorted(marks) == sorted(one.mark for one in parts)


@given(lengths)
def test_parts_stay_inside_the_margins(sizes):
    room = box(12.0, 12.0, 6000.0 - 12.0, 767.0 - 12.0).buffer(1e-6)
    for sheet in fab.nest([part(i, length) for i, length in enumerate(sizes)], SHEET):
        assert all(room.contains(shape) for shape in placed(sheet))


@given(lengths)
def test_parts_keep_the_gap_from_each_other(sizes):
    for sheet in fab.nest([part(i, length) for i, length in enumerate(sizes)], SHEET):
        hulls = [shape.envelope for shape in placed(sheet)]
        assert all(a.distance(b) > 8.0 - 1e-6 for a, b in combinations(hulls, 2))


def test_sheets_are_numbered_from_one():
    sheets = fab.nest([part(i, 5000.0) for i in range(14)], SHEET)
    assert [sheet.number for sheet in sheets] == [1, 2, 3]


def test_a_mark_is_on_every_sheet_that_holds_one():
    sheets = fab.nest([part(1, 5000.0)] * 14 + [part(2, 100.0)], SHEET)
    on = sheets_of(sheets)
    for mark, numbers in on.items():
        assert numbers == [s.number for s in sheets if mark in {p.part.mark for p in s.placements}]
    assert on[part(1, 5000.0).mark] == [1, 2, 3]


def test_short_strips_share_a_row_with_long_ones():
    sheets = fab.nest([part(i, length) for i, length in enumerate([2000.0, 3900.0])], SHEET)
    assert [(p.part.mark, p.y) for p in sheets[0].placements] == [("A1", 12.0), ("A0", 12.0)]


def test_a_strip_of_exactly_the_room_fits():
    (sheet,) = fab.nest([part(1, 5976.0)], SHEET)
    assert len(sheet.placements) == 1


def test_rows_fill_a_sheet_to_its_last_millimetre():
    sheet = fab.Sheet(6000.0, 2 * 12.0 + 3 * 100.0 + 2 * 8.0, margin=12.0, gap=8.0)
    assert len(fab.nest([part(i, 5000.0) for i in range(3)], sheet)) == 1


def test_nothing_needs_no_sheet():
    assert fab.nest([], SHEET) == ()


def test_the_longest_strip_that_does_not_fit_is_named():
    parts = [part(1, 6100.0), part(2, 7000.0), part(3, 500.0)]
    with pytest.raises(StockError, match="too long") as info:
        fab.nest(parts, SHEET)
    assert (info.value.where, info.value.value) == ("A2", "7000.0 mm")
    assert "5976.0 mm" in info.value.limit


def test_a_strip_wider_than_the_sheet_is_named():
    sheet = fab.Sheet(6000.0, 110.0)
    with pytest.raises(StockError, match="too wide") as info:
        fab.nest([part(7, 500.0)], sheet)
    assert (info.value.where, info.value.value) == ("A7", "100.0 mm")
    assert "90.0 mm" in info.value.limit


def test_the_same_parts_are_placed_the_same_way_in_any_order():
    parts = [part(i, 1000.0 + 10.0 * (i % 4)) for i in range(12)]

    def places(several):
        sheets = fab.nest(several, SHEET)
        return [(s.number, p.part.mark, p.x, p.y) for s in sheets for p in s.placements]

    assert places(parts) == places(parts[::-1])


def test_the_used_share_of_a_sheet_is_part_area_over_sheet_area():
    (sheet,) = fab.nest([part(1, 3000.0)], SHEET)
    assert sheet.used == pytest.approx((3000.0 * 100.0 - 3.0 * 50.0) / (6000.0 * 767.0))


sizes = st.lists(
    st.tuples(st.floats(20.0, 2000.0), st.floats(20.0, 740.0)), min_size=1, max_size=40
)


@given(sizes)
def test_parts_of_different_widths_stay_apart_and_inside(pairs):
    room = box(12.0, 12.0, 6000.0 - 12.0, 767.0 - 12.0).buffer(1e-6)
    parts = [part(i, length, width) for i, (length, width) in enumerate(pairs)]
    sheets = fab.nest(parts, SHEET)
    assert sum(len(sheet.placements) for sheet in sheets) == len(parts)
    for sheet in sheets:
        hulls = [shape.envelope for shape in placed(sheet)]
        assert all(room.contains(hull) for hull in hulls)
        assert all(a.distance(b) > 8.0 - 1e-6 for a, b in combinations(hulls, 2))


def test_rows_of_low_parts_share_a_sheet_with_rows_of_high_ones():
    parts = [part(0, 5000.0, 500.0), *(part(i, 5000.0, 100.0) for i in range(1, 4))]
    sheets = fab.nest(parts, SHEET)
    assert [len(sheet.placements) for sheet in sheets] == [3, 1]


@given(sizes)
def test_no_nesting_needs_fewer_sheets_than_the_areas(pairs):
    parts = [part(i, length, width) for i, (length, width) in enumerate(pairs)]
    assert 1 <= sheet_bound(parts, SHEET) <= len(fab.nest(parts, SHEET))
