"""The ``export/`` folder of a package, from a project's formats to the files."""

import json
import sys

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


def test_a_format_that_is_none_is_refused():
    with pytest.raises(ValueError, match=r"export\.formats"):
        project("ifcx")
