from collections import Counter

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
    bolts = [item for item in model.items if "bolt" in item.layer or "nut" in item.layer]
    assert len(file.by_type("IfcMechanicalFastener")) == len(bolts) > 0


def test_panels_are_plates(panels, tmp_path):
    write_ifc(tmp_path / "a.ifc", panels)
    file = ifcopenshell.open(tmp_path / "a.ifc")
    flat = [item for item in panels.items if "panel" in item.layer or "plate" in item.layer]
    assert len(file.by_type("IfcPlate")) == len(flat) > 0


def test_the_file_follows_the_schema(written):
    path, _ = written
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
