from collections import Counter
from dataclasses import replace

import ifcopenshell
import ifcopenshell.util.element
import ifcopenshell.util.unit
import ifcopenshell.validate
import numpy as np
import pytest

from fabrication.export.interchange.ifc import write_ifc


@pytest.fixture(scope="module")
def written(model, tmp_path_factory):
    path = tmp_path_factory.mktemp("ifc") / "a.ifc"
    write_ifc(path, model)
    return path, ifcopenshell.open(path)


def test_every_part_is_an_element_with_its_mark(any_model, tmp_path):
    write_ifc(tmp_path / "a.ifc", any_model)
    file = ifcopenshell.open(tmp_path / "a.ifc")
    elements = file.by_type("IfcElement")
    assert Counter(one.Name for one in elements) == Counter(item.mark for item in any_model.items)
    assert all(one.Tag == one.Name for one in elements)


def test_strips_are_members_and_bolts_are_fasteners(written, model):
    _, file = written
    strips = [item for item in model.items if item.axis is not None]
    assert len(file.by_type("IfcMember")) == len(strips)
    washers = [item for item in model.items if "washer" in item.layer]
    assert len(file.by_type("IfcPlate")) == len(washers) > 0
    fasteners = Counter(one.ObjectType for one in file.by_type("IfcMechanicalFastener"))
    bolts, nuts = (len(model.layers[layer]) for layer in ("bolts", "nuts"))
    assert fasteners == {"bolt": bolts, "nut": nuts}
    for one in file.by_type("IfcMechanicalFastener"):
        assert one.PredefinedType == ("BOLT" if one.ObjectType == "bolt" else "USERDEFINED")
    sizes = {(item.mark, item.numbers["length_mm"]) for item in model.layers["bolts"]}
    told = {(one.Name, one.NominalLength) for one in file.by_type("IfcMechanicalFastener")}
    assert sizes <= told
    assert {o.NominalDiameter for o in file.by_type("IfcMechanicalFastener")} == {8.0, None}


def test_panels_are_plates(panels, tmp_path):
    write_ifc(tmp_path / "a.ifc", panels)
    file = ifcopenshell.open(tmp_path / "a.ifc")
    flat = [item for item in panels.items if "panel" in item.layer or "plate" in item.layer]
    assert len(file.by_type("IfcPlate")) == len(flat) > 0


@pytest.mark.parametrize("name", ["shell", "Site", "Gebäude 1"])
def test_the_file_follows_the_schema(model, tmp_path, name):
    path = tmp_path / "a.ifc"
    write_ifc(path, replace(model, name=name))
    log = ifcopenshell.validate.json_logger()
    ifcopenshell.validate.validate(str(path), log, express_rules=True)
    assert log.statements == []


def test_bodies_are_the_models(written, model):
    _, file = written
    assert ifcopenshell.util.unit.calculate_unit_scale(file) == pytest.approx(1e-3)
    places = {one.Name: one for one in file.by_type("IfcElement")}
    for item in model.items:
        (face_set,) = places[item.mark].Representation.Representations[0].Items
        points = np.array(face_set.Coordinates.CoordList)
        assert points == pytest.approx(item.points, abs=0.01)
        assert np.array(face_set.CoordIndex) - 1 == pytest.approx(item.triangles)


def test_numbers_are_properties(written, model):
    _, file = written
    members = {one.Name: one for one in file.by_type("IfcMember")}
    for item in model.items:
        if item.axis is not None:
            numbers = ifcopenshell.util.element.get_psets(members[item.mark])["Gridshell_Part"]
            assert numbers["length_mm"] == pytest.approx(item.numbers["length_mm"], abs=0.01)
            assert numbers["material"] == "stainless"


def test_identifiers_stay_on_a_second_export(written, model, tmp_path):
    _, file = written
    write_ifc(tmp_path / "b.ifc", model)
    again = ifcopenshell.open(tmp_path / "b.ifc")
    first, second = ({one.GlobalId for one in f.by_type("IfcRoot")} for f in (file, again))
    assert first == second
    assert len(first) == len(file.by_type("IfcRoot"))


def test_elements_have_a_material_and_a_colour(any_model, tmp_path):
    write_ifc(tmp_path / "a.ifc", any_model)
    file = ifcopenshell.open(tmp_path / "a.ifc")
    places = {one.Name: one for one in file.by_type("IfcElement")}
    for item in any_model.items:
        element = places[item.name]
        found = ifcopenshell.util.element.get_material(element)
        assert (found and found.Name) == item.numbers.get("material")
        (faces,) = element.Representation.Representations[0].Items
        (styled,) = faces.StyledByItem
        colour = styled.Styles[0].Styles[0].SurfaceColour
        assert (colour.Red, colour.Green, colour.Blue) == pytest.approx(item.colour)


def test_stars_of_a_planar_net_are_what_they_look_like(panels, tmp_path):
    """Connectors of the tower are cylinders; a star plate is flat."""
    write_ifc(tmp_path / "a.ifc", panels)
    file = ifcopenshell.open(tmp_path / "a.ifc")
    connectors = panels.layers["connectors"]
    assert len(file.by_type("IfcDiscreteAccessory")) == len(connectors)
    flat = [replace(one, numbers={**one.numbers, "thickness_mm": 8.0}) for one in connectors]
    write_ifc(tmp_path / "b.ifc", replace(panels, items=tuple(flat)))
    assert len(ifcopenshell.open(tmp_path / "b.ifc").by_type("IfcPlate")) == len(flat)


def test_the_head_says_who_wrote_it_and_when(model, tmp_path, monkeypatch):
    monkeypatch.setenv("SOURCE_DATE_EPOCH", "1000000000")
    for name in ("a", "b"):
        (tmp_path / name).mkdir()
        write_ifc(tmp_path / name / "shell.ifc", model)
    first, second = ((tmp_path / name / "shell.ifc").read_bytes() for name in ("a", "b"))
    assert first == second
    head = first[:600].decode()
    assert "'shell.ifc','2001-09-09T01:46:40'" in head
    assert "gridshell" in head
    assert "ReferenceView" in head
