import json

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import fabrication as fab
import gridshell as gs
from fabrication.bars import Bar
from fabrication.errors import StockError
from fabrication.export.bar_schedule import stock_report, write_bars
from fabrication.parts import parts_of
from fabrication.splice_plan import Splices, preferred, tradeoff
from fabrication.splice_plate import SplicePlate
from fabrication.splice_search import Place, Run
from fabrication.splices import runs_of, splice_plates, spliced

PLATE = SplicePlate(160.0, 80.0, 3.0, fab.STAINLESS)
BAR = Bar(2000.0)


@pytest.fixture(scope="module")
def jointed(catenoid):
    return fab.SlotJoint().build(catenoid.structure)


@pytest.fixture(scope="module")
def front(jointed):
    return tradeoff(runs_of(jointed, PLATE), BAR, shortest=300.0)


@pytest.fixture(scope="module")
def built(jointed, front):
    return spliced(jointed, preferred(front, Splices.BALANCED), PLATE)


def rows(count=12, seed=3):
    rng = np.random.default_rng(seed)
    runs = []
    for i in range(count):
        length = float(rng.uniform(8000.0, 12000.0))
        x = np.linspace(50.0, length - 50.0, 25)
        places = tuple(Place(float(m), (k, k + 1)) for k, m in enumerate((x[1:] + x[:-1]) / 2.0))
        beside = tuple(f"A{j + 1}" for j in (i - 1, i + 1) if 0 <= j < count)
        runs.append(Run(f"A{i + 1}", length, places, beside))
    return runs


def test_no_splice_is_near_a_slot(jointed, front):
    for plan in front:
        for mark, places in plan.splices.items():
            for place in places:
                for slot in jointed.cuts[mark].slots:
                    assert abs(place.x - slot.x) >= PLATE.length / 2.0 + 5.0 + slot.spread - 1e-9


@pytest.mark.parametrize("seed", [1, 2, 3])
def test_neighbours_are_spliced_in_different_bays_or_it_is_told(seed):
    runs = rows(seed=seed)
    for plan in tradeoff(runs, Bar(6000.0)):
        bays = {mark: {p.bay for p in places} for mark, places in plan.splices.items()}
        same = {
            (run.mark, other)
            for run in runs
            for other in run.neighbours
            if bays.get(run.mark, set()) & bays.get(other, set())
        }
        assert len(plan.findings) == len(same) / 2
        assert not same


def test_no_plan_of_the_front_is_beaten_by_another():
    front = tradeoff(rows(), Bar(6000.0))
    counts, bars = [p.count for p in front], [p.bars.bars for p in front]
    assert counts == sorted(set(counts))
    assert bars == sorted(set(bars), reverse=True)
    assert preferred(front, Splices.FEW) is front[0]
    assert preferred(front, Splices.FEW_BARS) is front[-1]
    assert all(p.floor <= p.bars.bound <= p.bars.bars for p in front)


def test_two_runs_give_the_same_plans():
    first, second = (tradeoff(rows(6), Bar(6000.0)) for _ in range(2))
    assert [(p.splices, p.bars.cut) for p in first] == [(p.splices, p.bars.cut) for p in second]


def test_pieces_and_gaps_make_the_strip(jointed, front):
    plan = front[-1]
    lengths = {piece.mark: piece.length for cut in plan.bars.cut for piece in cut.pieces}
    for strip in jointed.strips.lamellas:
        places = plan.splices.get(strip.mark, ())
        marks = (
            [f"{strip.mark}.{k + 1}" for k in range(len(places) + 1)] if places else [strip.mark]
        )
        assert sum(lengths[m] for m in marks) + len(places) == pytest.approx(strip.length)


def test_a_bay_longer_than_a_bar_is_named():
    run = Run("A7", 9000.0, (Place(1000.0, (0, 1)), Place(8000.0, (1, 2))))
    with pytest.raises(StockError, match="cannot be spliced") as info:
        tradeoff([run], Bar(6000.0))
    assert "A7" in info.value.where
    assert info.value.value.startswith("7000.0 mm")
    assert "5980.0 mm" in info.value.limit


def test_pieces_lie_in_space_where_the_strip_lay(jointed, built):
    whole = {strip.mark: strip for strip in jointed.strips.lamellas}
    assert len(built.strips.lamellas) > len(whole)
    for fixture in built.fixtures:
        piece = next(p for p in built.strips.lamellas if p.mark == fixture.mark)
        z = fixture.y - 50.0 if fixture.feature is fab.Feature.HOLE else 0.0
        point = piece.place(np.array([fixture.x + piece.start]), np.zeros(1), np.array([z]))
        assert np.linalg.norm(point[0] - fixture.position) < 0.02
    for piece, carrier in zip(built.strips.lamellas, built.carriers, strict=True):
        strip = jointed.strips.lamellas[carrier]
        assert piece.mark.startswith(strip.mark)
        for s in (piece.start, piece.end):
            point = piece.place(np.array([s]), np.zeros(1), np.array([30.0]))[0]
            near = np.linspace(strip.start, strip.end, 4001)
            path = strip.place(near, 0.0 * near, 0.0 * near + 30.0)
            assert np.linalg.norm(path - point, axis=1).min() < 0.7


def test_no_slot_is_lost_and_all_strips_still_fit(jointed, built):
    slots = [sum(len(c.slots) for c in one.cuts.values()) for one in (jointed, built)]
    assert slots[0] == slots[1]
    assert len(built.fixtures) > len(jointed.fixtures)
    made = fab.fit(built.strips, parts_of(built))
    assert made.nodes == len([node for node in jointed.strips.nodes if node.regular])
    assert made.max_mm3 == 0.0


def test_every_splice_has_its_holes_plates_and_bolts(front, built):
    plan = preferred(front, Splices.BALANCED)
    holes = [hole for cuts in built.cuts.values() for hole in cuts.holes]
    assert len(holes) == 4 * plan.count
    plates = splice_plates(plan, PLATE)
    assert len(plates) == len({plate.mark for plate in plates}) == 2 * plan.count
    bill = {line.item: line.quantity for line in built.bill}
    assert (bill["splice plate"], bill["bolt"]) == (2 * plan.count, 4 * plan.count)
    assert plates[0].area == pytest.approx(160.0 * 80.0 - np.pi * 7.0**2)


def test_the_list_of_bars_holds_every_piece(tmp_path, front, built):
    plan = preferred(front, Splices.BALANCED)
    lines = write_bars(tmp_path / "bars.csv", plan.bars).read_text().splitlines()
    assert lines[0] == "bar,position,mark,start_mm,length_mm,offcut_mm"
    assert {line.split(",")[2] for line in lines[1:]} == {p.mark for p in built.strips.lamellas}
    report = json.loads(json.dumps(stock_report(plan, front)))
    assert report["bars"] == plan.bars.bars
    assert len(report["tradeoff"]) == len(front)
    assert "bars of 2000 mm" in report["text"]


def test_plates_that_cannot_hold_their_bolts_are_refused(jointed, front):
    with pytest.raises(gs.SettingError, match="too near"):
        SplicePlate(60.0, 80.0, 3.0, fab.STAINLESS)
    with pytest.raises(gs.SettingError, match="too narrow"):
        SplicePlate(160.0, 10.0, 3.0, fab.STAINLESS)
    with pytest.raises(gs.SettingError, match="wider than the strip"):
        spliced(jointed, front[0], SplicePlate(160.0, 120.0, 3.0, fab.STAINLESS))


@settings(max_examples=15)
@given(
    st.lists(st.lists(st.floats(100.0, 1500.0), min_size=1, max_size=12), min_size=1, max_size=6),
    st.floats(0.0, 3.0),
)
def test_any_strips_are_cut_into_pieces_that_fit_or_one_is_named(bays, gap):
    bar, runs = Bar(2000.0), []
    for i, spans in enumerate(bays):
        x = np.cumsum(spans)
        places = tuple(
            Place(float(b - a / 2.0), (k, k + 1))
            for k, (a, b) in enumerate(zip(spans, x, strict=True))
        )
        runs.append(Run(f"A{i + 1}", float(x[-1]), places, (f"A{i}", f"A{i + 2}")))
    try:
        front = tradeoff(runs, bar, gap=gap, shortest=200.0)
    except StockError:
        front = ()
    for plan in front:
        pieces = [piece for cut in plan.bars.cut for piece in cut.pieces]
        assert len({p.mark for p in pieces}) == len(pieces) == len(runs) + plan.count
        whole = sum(p.length for p in pieces) + plan.count * gap
        assert whole == pytest.approx(sum(run.length for run in runs))
        for cut in plan.bars.cut:
            assert bar.filled([p.length for p in cut.pieces]) <= bar.room + 1e-5
        assert plan.floor <= plan.bars.bound <= plan.bars.bars
