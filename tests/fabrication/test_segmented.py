"""From a project with segments to its files: quantities, copies in the STEP file, mistakes."""

import csv
import json
import re
from collections import Counter

import pytest
from pypdf import PdfReader

import fabrication as fab
import gridshell as gs
from fabrication.errors import ProjectError
from fabrication.export.step_prism_reader import read_copies
from fabrication.package import run
from fabrication.project import read_project

PROJECT = """
name = "canopy"
[surface]
kind = "hypar"
scale = 3000.0
[patch]
layout = "asymptotic"
p = [0.03, 0.8]
q = [-0.8, -0.03]
lamellas = [4, 4]
[net]
anchor = "free"
[profile]
width = 80.0
thickness = 2.0
material = "stainless"
[joint]
kind = "slot"
weld = 20.0
[papers]
labels = true
[sheet]
length = 4000.0
width = 1500.0
"""
SEGMENTS = "[segments]\ncount = 4\nseam = 20.0\n"


@pytest.fixture(scope="module")
def built(tmp_path_factory):
    folder = tmp_path_factory.mktemp("segments")
    reports = {}
    for name, more in (("one", ""), ("four", SEGMENTS)):
        path = folder / f"{name}.toml"
        path.write_text(PROJECT + more)
        reports[name] = run(read_project(path), folder / name)
    return folder, reports


def table(path):
    with path.open() as file:
        return list(csv.DictReader(file))


def test_lists_and_sheets_hold_every_part_four_times(built):
    folder, reports = built
    parts = table(folder / "four" / "parts.csv")
    assert {row["quantity"] for row in parts} == {"4"}
    files = sorted((folder / "four" / "sheets").glob("sheet-*.dxf"))
    drawn = Counter(part.mark for file in files for part in fab.read_dxf(file))
    assert drawn == {row["mark"]: 4 for row in parts}
    welds = [float(table(folder / n / "bill.csv")[0]["quantity"]) for n in ("one", "four")]
    assert welds[1] == 4.0 * welds[0]
    metres = f"{welds[1] / 1e3:.2f} m"
    assert metres in PdfReader(folder / "four" / "drawings.pdf").pages[1].extract_text()
    page = (folder / "four" / "report.html").read_text("utf-8")
    assert f"{welds[1]:,.0f}".replace(",", "\N{NARROW NO-BREAK SPACE}") in page
    one, four = reports["one"]["structure"], reports["four"]["structure"]
    assert four["mass_kg"] == pytest.approx(4.0 * one["mass_kg"], rel=1e-5)
    assert four["total_length_m"] == pytest.approx(4.0 * one["total_length_m"], abs=2e-3)
    assert not [f for f in reports["four"]["findings"] if f["severity"] == "error"]


def test_the_step_file_holds_one_segment_four_times(built):
    folder, reports = built
    copies = read_copies(folder / "four" / "structure.step", "segment")
    assert [c.name for c in copies] == [f"segment-{k}" for k in (1, 2, 3, 4)]
    assert reports["four"]["segments"]["identical_mm"] < 1e-6
    assert reports["four"]["segments"]["parts"] == 4 * reports["four"]["segments"]["distinct_parts"]
    sizes = [(folder / name / "structure.step").stat().st_size for name in ("one", "four")]
    assert sizes[1] - sizes[0] < 10_000
    assert reports["four"]["closure"] == reports["one"]["closure"]


def test_another_program_finds_all_solids_in_their_places(built):
    import build123d

    folder, _ = built
    one, four = (
        build123d.import_step(folder / name / "structure.step") for name in ("one", "four")
    )
    assert len(four.solids()) == 4 * len(one.solids())
    volumes = [sum(solid.volume for solid in whole.solids()) for whole in (one, four)]
    assert volumes[1] == pytest.approx(4.0 * volumes[0], rel=1e-9)
    box = four.bounding_box()
    assert pytest.approx(-box.max.X, abs=1e-3) == box.min.X
    assert pytest.approx(-box.max.X, abs=1e-3) == box.min.Y


def test_without_segments_nothing_is_said_of_them(built):
    folder, reports = built
    assert "segments" not in reports["one"]
    assert not (folder / "one" / "hanging.csv").exists()
    assert len(table(folder / "four" / "hanging.csv")) == reports["four"]["structure"]["nodes"]


def test_the_cut_list_counts_the_pieces_and_names_all_their_sheets(built):
    folder, reports = built
    page = (folder / "four" / "report.html").read_text("utf-8")
    rows = re.findall(r"<tr>(.*?)</tr>", page[page.index('id="cut-list"') :], re.DOTALL)
    cells = [re.findall(r"<t[dh][^>]*>(.*?)</t[dh]>", row, re.DOTALL) for row in rows]
    heading = [re.sub(r"<[^>]*>", "", cell).strip() for cell in cells[0]]
    pieces, sheet = heading.index("Pieces"), heading.index("Sheet")
    parts = table(folder / "four" / "parts.csv")
    for part, row in zip(parts, cells[1:], strict=False):
        assert row[pieces] == "4"
        assert row[sheet] == part["sheet"]
    mass = heading.index("Mass, kg")
    total = next(row for row in cells if row[0] == f"{len(parts)} strips")
    assert float(total[mass]) == pytest.approx(reports["four"]["structure"]["mass_kg"], rel=1e-2)


def test_the_files_of_segments_go_when_they_are_gone(tmp_path):
    path = tmp_path / "p.toml"
    path.write_text(PROJECT + SEGMENTS + "hang = true\n")
    run(read_project(path), tmp_path / "out")
    path.write_text(PROJECT + SEGMENTS + "hang = false\n")
    run(read_project(path), tmp_path / "out")
    assert not (tmp_path / "out" / "hanging.csv").exists()
    json.loads((tmp_path / "out" / "report.json").read_text())


def test_bars_are_cut_for_all_segments(tmp_path):
    path = tmp_path / "p.toml"
    bars = "[bars]\nlength = 2000.0\nsplice = { length = 120.0, bolt = 6.0 }\n"
    path.write_text(PROJECT + SEGMENTS + bars)
    report = run(read_project(path), tmp_path / "out")
    cut = Counter(row["mark"] for row in table(tmp_path / "out" / "bars.csv"))
    assert set(cut.values()) == {4}
    (plates,) = [r for r in table(tmp_path / "out" / "bill.csv") if r["item"] == "splice plate"]
    assert float(plates["quantity"]) == 2.0 * report["stock"]["bars"]["splices"]
    assert report["stock"]["bars"]["splices"] % 4 == 0


@pytest.mark.parametrize(
    ("section", "where"),
    [
        ("[segments]\ncount = 1\n", "segments.count"),
        ("[segments]\nnumber = 4\n", "segments.number"),
        ("[segments]\ncount = 4\nseam = -1.0\n", "segments.seam"),
    ],
)
def test_segments_that_cannot_be_name_the_key(tmp_path, section, where):
    path = tmp_path / "p.toml"
    path.write_text(PROJECT + section)
    with pytest.raises(ProjectError) as info:
        read_project(path)
    assert f", {where}" in str(info.value)


def test_a_canopy_whose_segments_overlap_writes_nothing(tmp_path):
    path = tmp_path / "p.toml"
    path.write_text(PROJECT + SEGMENTS.replace("4", "6"))
    with pytest.raises(gs.SettingError, match="reach into each other") as info:
        run(read_project(path), tmp_path / "out")
    assert info.value.advice == "count = 4"
    assert not (tmp_path / "out").exists()
