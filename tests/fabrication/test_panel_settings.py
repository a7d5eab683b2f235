import tomllib

import pytest

import fabrication as fab
from fabrication.errors import ProjectError
from fabrication.panel_settings import connector_spec, panel_spec, panel_system, plate_section

PLANAR = """
name = "planar"
[surface]
kind = "catenoid"
radius = 3000.0
[patch]
layout = "conjugate"
v = [-0.5, 0.5]
panels = [12, 4]
[net]
kind = "planar"
anchor = "free"
[panels]
thickness = 8.0
[supports]
below = -150.0
thickness = 8.0
[connector]
radius = 40.0
[sheet]
length = 3000.0
width = 1500.0
"""
LAMELLAS = """
name = "lamellas"
[surface]
kind = "catenoid"
radius = 3000.0
[patch]
layout = "bisecting"
v = [-0.5, 0.5]
cells = 24
[net]
anchor = "free"
[profile]
width = 80.0
thickness = 2.0
material = "S235"
[joint]
kind = "slot"
[sheet]
length = 3000.0
width = 1500.0
"""
MATERIAL = '{ name = "acrylic", modulus = 3200.0, strength = 70.0, density = 1190.0 }'


@pytest.fixture
def read(tmp_path):
    def build(text):
        path = tmp_path / "project.toml"
        path.write_text(text)
        return fab.read_project(path)

    return build


@pytest.fixture
def refused(read):
    def build(text):
        with pytest.raises(ProjectError) as info:
            read(text)
        return info.value

    return build


def test_what_check_prints_is_the_same_project(read):
    for text in (PLANAR, LAMELLAS):
        project = read(text)
        printed = fab.project_text(project)
        assert read(printed) == project
        assert set(tomllib.loads(printed)) == set(tomllib.loads(text))


def test_what_is_left_out_follows_from_what_is_there(read):
    project = read(PLANAR)
    connector, plates = connector_spec(project), plate_section(project)
    assert (connector.height, connector.depth, connector.plate_thickness) == (150.0, 20.0, 8.0)
    assert plates.setback == connector.floor + connector.clearance
    assert plates.material is fab.S235
    assert panel_spec(project.panels).material is fab.GLASS
    assert panel_system(project, project.panels).connector_material is fab.S235


def test_plates_without_connectors_end_their_thickness_before_the_axis(read):
    project = read(PLANAR.replace("[connector]\nradius = 40.0\n", ""))
    assert connector_spec(project) is None
    assert plate_section(project).setback == 8.0


def test_a_material_of_one_s_own_is_taken(read):
    project = read(PLANAR.replace("[supports]", f"material = {MATERIAL}\n[supports]"))
    assert panel_spec(project.panels).material.density == 1190.0


FOREIGN = [
    (PLANAR + '[profile]\nwidth = 80.0\nthickness = 2.0\nmaterial = "S235"\n', "profile"),
    (PLANAR + '[joint]\nkind = "slot"\n', "joint"),
    (PLANAR + "[facade]\nthickness = 6.0\n", "facade"),
    (LAMELLAS + "[panels]\nthickness = 8.0\n", "panels"),
    (LAMELLAS + "[supports]\nbelow = -90.0\nthickness = 8.0\n", "supports"),
    (LAMELLAS + "[panel_sheet]\nlength = 3000.0\nwidth = 1500.0\n", "panel_sheet"),
    (LAMELLAS.replace("[net]", "[net]\nrhombus = true"), "net.rhombus"),
    (LAMELLAS.replace("[net]", "[net]\nsquare = true"), "net.square"),
    (LAMELLAS.replace("[net]", '[net]\nskin = "P"'), "net.skin"),
    (PLANAR.replace("[supports]\nbelow = -150.0\nthickness = 8.0\n", ""), "connector"),
]


@pytest.mark.parametrize(("text", "key"), FOREIGN, ids=[key for _, key in FOREIGN])
def test_a_setting_of_the_other_kind_is_refused_by_its_name(refused, text, key):
    error = refused(text)
    assert error.what == "This setting does not belong here"
    assert error.where.endswith(f", {key}")


@pytest.mark.parametrize(
    ("text", "key"),
    [
        (PLANAR.replace("[panels]\nthickness = 8.0\n", ""), "panels"),
        (LAMELLAS.replace('[joint]\nkind = "slot"\n', ""), "joint"),
    ],
)
def test_a_section_that_is_missing_is_named(refused, text, key):
    error = refused(text)
    assert error.what == "A key is missing"
    assert error.where.endswith(f", {key}")


CROSSED = [
    PLANAR.replace('"conjugate"', '"bisecting"').replace("panels = [12, 4]", "cells = 24"),
    LAMELLAS.replace('"bisecting"', '"conjugate"').replace("cells = 24", "panels = [8, 4]"),
]


@pytest.mark.parametrize("text", CROSSED, ids=["planar", "asymptotic"])
def test_a_layout_of_the_other_kind_is_refused(refused, text):
    assert refused(text).where.endswith("patch.layout")


@pytest.mark.parametrize(
    ("change", "key"),
    [
        (("below = -150.0", "below = 0.0"), "supports.below"),
        (("radius = 40.0", "radius = 40.0\ndepth = 40.0"), "connector.depth"),
        (("[net]", "[net]\nsquare = true\nangle = 70.0"), "net.angle"),
        (("radius = 40.0", "radius = 4.0"), "connector"),
        (("[panels]", "[panels]\nthicknes = 1.0"), "panels.thicknes"),
        (("thickness = 8.0\n[supports]", "thickness = -8.0\n[supports]"), "panels.thickness"),
    ],
)
def test_settings_that_cannot_be_made_are_named(refused, change, key):
    assert key in refused(PLANAR.replace(*change)).where


def test_a_mesh_says_what_runs_along_it_by_the_kind_of_net(read, refused, tmp_path):
    (tmp_path / "m.obj").write_text("")
    mesh = '[mesh]\nfile = "m.obj"\nunit = "m"\n'
    a, b = PLANAR.index("[surface]"), PLANAR.index("[net]")
    text = PLANAR[:a] + mesh + "{}\n" + PLANAR[b:]
    assert read(text.format('panels_along = "edges"')).mesh.along == "edges"
    assert refused(text.format('lamellas_along = "edges"')).where.endswith("mesh.lamellas_along")
    assert refused(text.format("")).where.endswith("mesh.panels_along")


@pytest.mark.parametrize(("directions", "good"), [("principal", True), ("asymptotic", False)])
def test_panels_stand_along_conjugate_directions(read, refused, tmp_path, directions, good):
    (tmp_path / "s.obj").write_text("")
    source = f'[surface]\nfile = "s.obj"\nunit = "m"\n[remesh]\ndirections = "{directions}"\n'
    a, b = PLANAR.index("[surface]"), PLANAR.index("[net]")
    text = PLANAR[:a] + source + PLANAR[b:]
    if good:
        assert read(text).remesh.directions == directions
    else:
        assert refused(text).where.endswith("remesh.directions")
