import csv

import pytest

import fabrication as fab
from fabrication.errors import OutputError
from fabrication.export.schedule import COLUMNS, mass


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
