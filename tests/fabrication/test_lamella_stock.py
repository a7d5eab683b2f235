from itertools import pairwise

import pytest

import fabrication as fab
from fabrication.errors import StockError
from fabrication.lamella_sections import BarsSection, SpliceSection
from fabrication.lamella_stock import bar_stock, other_sheets, splice_plate, strip_sheets
from fabrication.parts import parts_of
from fabrication.sections import Project

PROJECT = Project.model_validate(
    {
        "name": "roof",
        "surface": {"kind": "hypar", "scale": 6000.0},
        "patch": {"layout": "asymptotic", "p": (-0.2, 0.2), "q": (-0.2, 0.2), "lamellas": (3, 3)},
        "net": {"anchor": "free"},
        "profile": {"width": 100.0, "thickness": 2.5, "material": "stainless"},
        "joint": {"kind": "slot"},
        "sheet": {"length": 8000.0, "width": 1500.0},
    }
)


@pytest.fixture(scope="module")
def jointed(catenoid):
    return fab.SlotJoint().build(catenoid.structure)


def test_strips_lie_on_sheets_with_the_bound_of_their_area(jointed, profile):
    found = strip_sheets(parts_of(jointed), PROJECT, profile, None)
    assert (found.prefix, found.material.name) == ("sheet", "stainless")
    assert len(found.sheets) >= found.bound >= 1
    assert found.figures()["sheets"] == len(found.sheets)


def test_strips_longer_than_a_bar_are_spliced_and_every_piece_lies_on_a_bar(jointed, profile):
    section = BarsSection(length=3000.0, splice=SpliceSection(length=160.0))
    stock = bar_stock(jointed, section)
    cut = stock.applied(jointed)
    assert len(cut.strips.lamellas) == len(jointed.strips.lamellas) + stock.plan.count
    bars = strip_sheets(parts_of(cut), PROJECT, profile, stock)
    assert bars.prefix == "bar"
    assert len(bars.sheets) == stock.plan.bars.bars >= bars.bound
    placed = [placement.part.mark for sheet in bars.sheets for placement in sheet.placements]
    assert sorted(placed) == sorted(lamella.mark for lamella in cut.strips.lamellas)
    for sheet in bars.sheets:
        ends = [(p.x, p.x + p.part.length) for p in sheet.placements]
        assert ends[0][0] >= 10.0
        assert ends[-1][1] <= 3000.0 - 10.0 + 1e-6
        assert all(b[0] - a[1] >= 3.0 - 1e-6 for a, b in pairwise(ends))


def test_plates_of_splices_and_washers_get_sheets_of_their_own(catenoid, profile):
    washer = fab.StarWasher(4.0, 18.0, 8.0, fab.S235)
    double = fab.DoubleSlotJoint(30.0, 8.0, washer).build(catenoid.structure)
    stock = bar_stock(double, BarsSection(length=2500.0, splice=SpliceSection(length=120.0)))
    sets = {own.prefix: own for own in other_sheets(double, PROJECT, stock)}
    assert set(sets) == {"star-washers", "splices"}
    assert sets["star-washers"].material.name == "S235"
    count = sum(len(sheet.placements) for sheet in sets["splices"].sheets)
    assert count == 2 * stock.plan.count


def test_without_splices_a_strip_longer_than_a_bar_is_named(jointed):
    with pytest.raises(StockError) as info:
        bar_stock(jointed, BarsSection(length=1000.0))
    assert info.value.where.split(",")[0] in {one.mark for one in jointed.strips.lamellas}


def test_bars_longer_than_all_strips_need_no_splice(jointed):
    stock = bar_stock(jointed, BarsSection(length=12_000.0))
    assert stock.applied(jointed) is jointed
    assert stock.findings == ()


def test_a_plate_is_three_quarters_as_wide_as_the_strip_unless_said_otherwise(profile):
    plate = splice_plate(SpliceSection(length=160.0), profile)
    assert (plate.width, plate.thickness, plate.material) == (75.0, 2.5, fab.STAINLESS)
    own = splice_plate(SpliceSection(length=160.0, width=50.0, material="S235"), profile)
    assert (own.width, own.material) == (50.0, fab.S235)
