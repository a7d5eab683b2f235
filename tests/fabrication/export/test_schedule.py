import csv
from dataclasses import replace

import numpy as np
import pytest

import fabrication as fab
from fabrication.cut import Hole
from fabrication.errors import OutputError
from fabrication.export.schedule import BILL_COLUMNS, COLUMNS, Line, mass, write_bill


@pytest.fixture
def rows(enneper, tmp_path):
    """The cut list of a design on two sheets, read back."""
    nested = fab.nest(enneper.parts, fab.Sheet(12000.0, 350.0))
    assert len(nested) > 1
    fab.write_schedule(tmp_path / "parts.csv", enneper.parts, nested, fab.STAINLESS)
    with (tmp_path / "parts.csv").open(newline="", encoding="utf-8") as file:
        return nested, list(csv.DictReader(file))


def test_the_list_has_the_agreed_columns(rows):
    assert tuple(rows[1][0]) == COLUMNS


def test_there_is_one_line_per_part_in_order(rows, enneper):
    assert [row["mark"] for row in rows[1]] == [part.mark for part in enneper.parts]
    assert {row["quantity"] for row in rows[1]} == {"1"}


def test_sizes_are_those_of_the_parts(rows, enneper):
    for row, part in zip(rows[1], enneper.parts, strict=True):
        assert float(row["length_mm"]) == pytest.approx(part.length, abs=0.005)
        assert (row["width_mm"], row["thickness_mm"]) == ("100", "2.5")
        assert row["material"] == "stainless"


def test_slots_are_counted_and_their_widths_ranged(rows, enneper):
    for row, part in zip(rows[1], enneper.parts, strict=True):
        widths = [slot.width for slot in part.slots]
        assert int(row["slots"]) == len(widths)
        assert float(row["slot_width_min_mm"]) == pytest.approx(min(widths), abs=0.005)
        assert float(row["slot_width_max_mm"]) == pytest.approx(max(widths), abs=0.005)


def test_every_part_names_the_sheet_it_lies_on(rows):
    nested, lines = rows
    where = {p.part.mark: str(sheet.number) for sheet in nested for p in sheet.placements}
    assert {row["mark"]: row["sheet"] for row in lines} == where


def test_mass_is_net_area_times_thickness_times_density(rows, enneper):
    for row, part in zip(rows[1], enneper.parts, strict=True):
        removed = sum(slot.width * slot.depth for slot in part.slots)
        volume = (part.length * part.width - removed) * part.thickness
        assert float(row["mass_kg"]) == pytest.approx(volume * 7900.0e-9, abs=0.001)


def test_a_metre_of_steel_weighs_what_it_weighs(strip):
    assert mass(strip("A1", 1000.0), fab.STAINLESS) == pytest.approx(1.975)


def test_the_mass_of_a_small_part_keeps_six_digits(strip, tmp_path):
    parts = [strip("A1", 123.4567)]
    light = fab.Material("paper", modulus=1000.0, strength=10.0, density=1.0)
    nested = fab.nest(parts, fab.Sheet(3000.0, 1000.0))
    fab.write_schedule(tmp_path / "parts.csv", parts, nested, light)
    (row,) = csv.DictReader((tmp_path / "parts.csv").read_text().splitlines())
    assert float(row["mass_kg"]) == pytest.approx(mass(parts[0], light), rel=5e-6)
    assert float(row["mass_kg"]) < 1e-4
    assert "e" not in row["mass_kg"]


def test_a_part_without_slots_leaves_their_widths_empty(strip, tmp_path):
    parts = [strip("A1", 1000.0)]
    fab.write_schedule(
        tmp_path / "parts.csv", parts, fab.nest(parts, fab.Sheet(3e3, 1e3)), fab.S235
    )
    (row,) = csv.DictReader((tmp_path / "parts.csv").read_text().splitlines())
    assert (row["slots"], row["slot_width_min_mm"], row["slot_width_max_mm"]) == ("0", "", "")


def test_a_folder_that_is_not_there_is_an_error(strip, tmp_path):
    parts = [strip("A1", 1000.0)]
    nested = fab.nest(parts, fab.Sheet(3000.0, 1000.0))
    with pytest.raises(OutputError) as info:
        fab.write_schedule(tmp_path / "missing" / "parts.csv", parts, nested, fab.S235)
    assert "parts.csv" in info.value.where


def test_holes_and_bevels_are_listed(strip, tmp_path):
    holes = tuple(Hole(100.0 * k, 50.0, 9.0, "N1", "bolt M8") for k in (1, 2, 3))
    parts = [replace(strip("A1", 1000.0), holes=holes, bevels=(3.25, 0.0))]
    nested = fab.nest(parts, fab.Sheet(3e3, 1e3))
    fab.write_schedule(tmp_path / "parts.csv", parts, nested, fab.S235)
    (row,) = csv.DictReader((tmp_path / "parts.csv").read_text().splitlines())
    assert (row["holes"], row["bevel_start_mm"], row["bevel_end_mm"]) == ("3", "3.25", "")
    removed = 3.0 * np.pi * 9.0**2 / 4.0 + 3.25 * 100.0 / 2.0
    assert float(row["mass_kg"]) == pytest.approx((100e3 - removed) * 2.5 * 7850e-9, rel=1e-5)


def test_a_strip_cut_from_no_sheet_names_none(strip, tmp_path):
    fab.write_schedule(tmp_path / "parts.csv", [strip("A1", 1000.0)], [], fab.S235)
    (row,) = csv.DictReader((tmp_path / "parts.csv").read_text().splitlines())
    assert row["sheet"] == ""


def test_more_lines_stand_in_the_same_columns(strip, tmp_path):
    more = [Line("T1", 1200.0, mass=2.5, sheet="panels-01")]
    fab.write_schedule(tmp_path / "parts.csv", [strip("A1", 1000.0)], [], fab.S235, more)
    row = list(csv.DictReader((tmp_path / "parts.csv").read_text().splitlines()))[1]
    assert (row["mark"], row["mass_kg"], row["sheet"]) == ("T1", "2.5", "panels-01")


def test_the_bill_of_a_double_lamella_lists_bolts_and_washers(enneper, tmp_path):
    washer = fab.StarWasher(4.0, 18.0, 8.0, fab.S235)
    jointed = fab.DoubleSlotJoint(30.0, 8.0, washer).build(enneper.structure)
    write_bill(tmp_path / "bill.csv", jointed.bill)
    rows = list(csv.DictReader((tmp_path / "bill.csv").read_text().splitlines()))
    assert tuple(rows[0]) == BILL_COLUMNS
    assert [(row["item"], row["size"]) for row in rows] == [
        (line.item, line.size) for line in jointed.bill
    ]
    washers = [row for row in rows if row["item"] == "star washer"]
    assert sum(int(row["quantity"]) for row in washers) == 2 * len(enneper.structure.nodes)
    for row in washers:
        total = float(row["mass_kg"]) * int(row["quantity"])
        assert float(row["total_kg"]) == pytest.approx(total, rel=1e-5)
    assert {row["mass_kg"] for row in rows if row["item"] == "nut"} == {""}
