from functools import cache

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import gridshell as gs
from fabrication.bars import Bar, BarPiece
from fabrication.cutting_stock import cut_bars
from fabrication.errors import StockError


def pieces(lengths):
    return [BarPiece(f"A{i + 1}", float(length)) for i, length in enumerate(lengths)]


def fewest(lengths, bar):
    """Bars by trying all subsets for every bar in turn."""
    whole = (1 << len(lengths)) - 1
    fits = [
        bar.filled([x for i, x in enumerate(lengths) if m >> i & 1]) <= bar.room + 1e-6
        for m in range(whole + 1)
    ]

    @cache
    def least(left):
        if not left:
            return 0
        first, best, part = left & -left, len(lengths), left
        while part:
            if part & first and fits[part]:
                best = min(best, 1 + least(left & ~part))
            part = (part - 1) & left
        return best

    return least(whole)


BAR = Bar(1000.0, kerf=3.0, trim=10.0)
some = st.lists(st.floats(60.0, 980.0), min_size=1, max_size=60)


@settings(max_examples=25)
@given(some)
def test_every_piece_is_cut_once_and_no_bar_is_overfull(lengths):
    plan = cut_bars(pieces(lengths), BAR)
    marks = [piece.mark for cut in plan.cut for piece in cut.pieces]
    assert sorted(marks) == sorted(piece.mark for piece in pieces(lengths))
    for cut in plan.cut:
        end = cut.positions[-1] + cut.pieces[-1].length
        assert end <= BAR.length - BAR.trim + 1e-5
    assert plan.bound <= plan.bars


@settings(max_examples=40)
@given(st.lists(st.floats(60.0, 980.0), min_size=1, max_size=8))
def test_small_plans_equal_brute_force(lengths):
    plan = cut_bars(pieces(lengths), BAR)
    assert plan.proven
    assert plan.bars == fewest(lengths, BAR)


def test_a_classic_of_gilmore_and_gomory_kind():
    """Rolls of 5600: 13 widths, 73 rolls is the known optimum."""
    wanted = {1380: 22, 1520: 25, 1560: 12, 1710: 14, 1820: 18, 1880: 18, 1930: 20}
    wanted |= {2000: 10, 2050: 12, 2100: 14, 2140: 16, 2150: 18, 2200: 20}
    lengths = [size for size, count in wanted.items() for _ in range(count)]
    plan = cut_bars(pieces(lengths), Bar(5600.0, kerf=0.0, trim=0.0))
    assert (plan.bars, plan.bound, plan.proven) == (73, 73, True)


def test_first_fit_decreasing_is_beaten():
    lengths = [44, 24, 24, 22, 21, 17, 8, 8, 6, 6]
    plan = cut_bars(pieces(lengths), Bar(60.0, kerf=0.0, trim=0.0))
    assert plan.bars == 3


def test_equal_pieces_make_one_pattern():
    plan = cut_bars(pieces([300.0] * 30), BAR)
    assert [(p.lengths, p.bars) for p in plan.patterns] == [((300.0,) * 3, 10)]
    assert plan.used == pytest.approx(0.9)
    assert plan.waste == pytest.approx(1000.0)


def test_kerf_and_trim_decide_whether_pieces_fit():
    assert cut_bars(pieces([488.5, 488.5]), BAR).bars == 1
    assert cut_bars(pieces([488.5, 488.6]), BAR).bars == 2


def test_no_pieces_need_no_bar():
    plan = cut_bars([], BAR)
    assert (plan.bars, plan.bound, plan.used) == (0, 0, 1.0)


def test_the_longest_piece_that_does_not_fit_is_named():
    with pytest.raises(StockError, match="too long") as info:
        cut_bars(pieces([500.0, 990.0, 1200.0]), BAR)
    assert (info.value.where, info.value.value) == ("A3", "1200.0 mm")
    assert "980.0 mm" in info.value.limit


@pytest.mark.parametrize(
    "sizes", [(0.0, 3.0, 10.0), (1000.0, -1.0, 10.0), (1000.0, 3.0, 500.0), (float("nan"), 0, 0)]
)
def test_stock_that_is_none_is_refused(sizes):
    with pytest.raises(gs.SettingError):
        Bar(*sizes)
