"""The ``export/`` folder of a package, from a project's formats to the files."""

import csv
import json
import sys
from collections import Counter
from xml.etree import ElementTree

import ifcopenshell
import pytest
import rhino3dm
import trimesh

import fabrication as fab
import gridshell as gs
from fabrication.exporting import FORMATS, require_formats

pytestmark = [pytest.mark.xdist_group("kernel"), pytest.mark.usefixtures("kernel_here")]


def project(*formats):
    return fab.Project.model_validate(
        {
            "name": "small",
            "surface": {"kind": "hypar", "scale": 6000.0},
            "patch": {
                "layout": "asymptotic",
                "p": (-0.2, 0.2),
                "q": (-0.2, 0.2),
                "lamellas": (3, 3),
            },
            "net": {"anchor": "free"},
            "profile": {"width": 100.0, "thickness": 2.5, "material": "stainless"},
            "joint": {"kind": "slot"},
            "sheet": {"length": 4000.0, "width": 350.0},
            "export": {"formats": formats},
        }
    )


@pytest.fixture(scope="module")
def package(tmp_path_factory):
    out = tmp_path_factory.mktemp("export")
    fab.run(project(*FORMATS), out, folder=out)
    return out


def test_every_format_holds_what_the_report_counts(package):
    report = json.loads((package / "report.json").read_text("utf-8"))
    strips = report["structure"]["strips"]
    folder = package / "export"
    assert sorted(path.name for path in folder.iterdir()) == sorted(
        f"structure.{form}" for form in FORMATS
    )
    glb = trimesh.load(folder / "structure.glb")
    assert len(glb.geometry) == strips
    file = rhino3dm.File3dm.Read(str(folder / "structure.3dm"))
    assert sum(isinstance(one.Geometry, rhino3dm.Mesh) for one in file.Objects) == strips
    members = ifcopenshell.open(folder / "structure.ifc").by_type("IfcMember")
    assert len(members) == strips


def test_formats_left_out_are_taken_away(package):
    fab.run(project("obj"), package, folder=package)
    assert [path.name for path in (package / "export").iterdir()] == ["structure.obj"]


GLAZED = """
name = "glazed"
[surface]
kind = "hypar"
scale = 6000.0
[patch]
layout = "asymptotic"
p = [0.05, 0.4]
q = [-0.4, -0.05]
lamellas = [3, 3]
[net]
anchor = "free"
[profile]
width = 100.0
thickness = 2.5
material = "stainless"
[joint]
kind = "slot"
[sheet]
length = 4000.0
width = 1500.0
[export]
formats = ["glb", "ifc"]
"""
GLASS = """
[facade]
thickness = 8.0
gap = 20.0
material = "glass"
"""
SEGMENTS = """
[segments]
count = 4
"""


@pytest.mark.parametrize("more", ["", GLASS, SEGMENTS])
def test_glass_and_segments_are_in_the_files(more, tmp_path):
    path = tmp_path / "p.toml"
    path.write_text(GLAZED + more)
    report = fab.run(fab.read_project(path), tmp_path / "out", folder=tmp_path)
    scene = trimesh.load(tmp_path / "out" / "export" / "structure.glb")
    ifc = ifcopenshell.open(tmp_path / "out" / "export" / "structure.ifc")
    copies = report["structure"].get("segments", 1)
    glass = len(fab.read_prisms(tmp_path / "out" / "facade.step")) if more == GLASS else 0
    assert (glass > 0) == (more == GLASS)
    assert len(scene.geometry) == copies * report["structure"]["strips"] + glass
    assert len(ifc.by_type("IfcMember")) == copies * report["structure"]["strips"]
    assert len(ifc.by_type("IfcPlate")) == glass


def test_a_missing_library_stops_before_anything_is_made(monkeypatch, tmp_path):
    monkeypatch.setitem(sys.modules, "ifcopenshell", None)
    with pytest.raises(gs.SettingError, match="ifcopenshell"):
        fab.run(project("glb", "ifc"), tmp_path / "out", folder=tmp_path)
    assert not (tmp_path / "out").exists()
    require_formats(["glb", "3dm"])


STEEL = """
name = "steel"
[surface]
kind = "hypar"
scale = 6000.0
[patch]
layout = "asymptotic"
p = [-0.3, 0.3]
q = [-0.3, 0.3]
lamellas = [4, 4]
[net]
anchor = "free"
[profile]
width = 100.0
thickness = 2.5
material = "S235"
[joint]
kind = "double-slot"
spacing = 30.0
bolt = 8.0
washer = { thickness = 4.0, arm = 18.0, beyond = 8.0 }
[bars]
length = 2000.0
[bars.splice]
length = 160.0
[sheet]
length = 4000.0
width = 1500.0
[segments]
count = 2
centre = [9000.0, 0.0]
[export]
formats = ["nc1", "obj"]
"""


def test_a_steel_shell_has_nc1_files_of_strips_washers_and_splice_plates(tmp_path):
    path = tmp_path / "p.toml"
    path.write_text(STEEL)
    report = fab.run(fab.read_project(path), tmp_path / "out", folder=tmp_path)
    folder = tmp_path / "out" / "export" / "nc1"
    with (folder / "index.csv").open(encoding="utf-8", newline="") as file:
        rows = list(csv.DictReader(file))
    files = {row["file"] for row in rows}
    assert {one.name for one in folder.iterdir()} == {*files, "index.csv"}
    assert len(files) == len(rows)
    count = Counter()
    for row in rows:
        count[row["kind"]] += int(row["quantity"])
    structure, stock = report["structure"], report["stock"]
    assert count["strips"] == 2 * structure["strips"]
    assert count["star-washers"] == 2 * structure["connectors"]["star washers"] > 0
    (plates,) = [row for row in rows if row["kind"] == "splices"]
    assert int(plates["quantity"]) == count["splices"] > 0
    assert stock["splices"]["sheets"] > 0
    texts = {name: (folder / name).read_text("ascii") for name in files}
    assert all(text.startswith("ST\n") and text.endswith("EN\n") for text in texts.values())
    lengths = [float(texts[row["file"]].splitlines()[10]) for row in rows]
    strips = [k for k, row in enumerate(rows) if row["kind"] == "strips"]
    total = sum(lengths[k] * int(rows[k]["quantity"]) for k in strips) / 1e3
    assert total == pytest.approx(structure["total_length_m"], abs=1e-3)


def test_a_timber_shell_has_a_part_per_strip_in_btlx(tmp_path):
    content = project("btlx").model_dump()
    content["profile"].update(material="birch-ply", thickness=9.0, width=80.0)
    content["segments"] = {"count": 2, "centre": (9000.0, 0.0)}
    report = fab.run(fab.Project.model_validate(content), tmp_path, folder=tmp_path)
    root = ElementTree.parse(tmp_path / "export" / "structure.btlx").getroot()
    parts = list(root.iter("{https://www.design2machine.com}Part"))
    assert sum(int(part.get("Count")) for part in parts) == 2 * report["structure"]["strips"]
    total = sum(float(part.get("Length")) * int(part.get("Count")) for part in parts) / 1e3
    assert total == pytest.approx(report["structure"]["total_length_m"], abs=1e-3)


GLASS_ON_STEEL = """
name = "tower"
[surface]
kind = "catenoid"
radius = 2500.0
[patch]
layout = "conjugate"
v = [-0.4, 0.4]
u = [0.0, 1.2]
panels = [5, 4]
[net]
kind = "planar"
anchor = "boundary-glide"
[panels]
gap = 10.0
thickness = 8.0
material = "glass"
[supports]
below = -60.0
above = 0.0
thickness = 4.0
material = "S235"
[sheet]
length = 3000.0
width = 1500.0
[export]
formats = ["nc1"]
"""


def test_of_glass_panels_on_steel_plates_nc1_holds_the_plates(tmp_path):
    path = tmp_path / "p.toml"
    path.write_text(GLASS_ON_STEEL)
    report = fab.run(fab.read_project(path), tmp_path / "out", folder=tmp_path)
    with (tmp_path / "out/export/nc1/index.csv").open(encoding="utf-8", newline="") as file:
        rows = list(csv.DictReader(file))
    assert {row["kind"] for row in rows} == {"plates"}
    assert sum(int(row["quantity"]) for row in rows) == report["structure"]["plates"] > 0


def test_nc1_files_left_out_are_taken_away(tmp_path):
    steel = project("nc1").model_dump()
    fab.run(fab.Project.model_validate(steel), tmp_path, folder=tmp_path)
    assert (tmp_path / "export" / "nc1" / "A1.nc1").is_file()
    steel["export"]["formats"] = ("obj",)
    fab.run(fab.Project.model_validate(steel), tmp_path, folder=tmp_path)
    left = [one.name for one in (tmp_path / "export").rglob("*") if one.is_file()]
    assert left == ["structure.obj"]


def test_a_format_that_is_none_is_refused():
    with pytest.raises(ValueError, match=r"export\.formats"):
        project("ifcx")
