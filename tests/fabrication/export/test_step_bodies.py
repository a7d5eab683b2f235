import build123d
import pytest

from fabrication.bodies import structure_bodies
from fabrication.errors import OutputError
from fabrication.export.step_bodies import write_bodies
from fabrication.export.step_prism_reader import read_prisms
from fabrication.panel_structure import section_area

pytestmark = pytest.mark.xdist_group("kernel")


@pytest.fixture(scope="module")
def imported(bodies_file, leaning):
    return build123d.import_step(str(bodies_file(leaning)))


def test_another_reader_finds_every_solid_valid_and_of_the_right_volume(imported, leaning):
    solids = imported.solids()
    parts = [*leaning.panels, *leaning.plates]
    assert len(solids) == len(parts) + len(leaning.connectors)
    assert all(solid.is_valid for solid in solids)
    densities = {"P": 2500e-9, "S": 7850e-9}
    wanted = [p.mass / densities[p.mark[0]] for p in parts]
    wanted += [section_area(c) * c.spec.height for c in leaning.connectors]
    found = sorted(solid.volume for solid in solids)
    assert found == pytest.approx(sorted(wanted), rel=1e-5)


def test_the_file_s_tree_is_sorted_by_kind(imported):
    assert imported.label == "Käfig"
    assert [child.label for child in imported.children] == ["panels", "plates", "connectors"]


def test_equal_parts_are_one_solid_with_many_places(bodies_file, tower):
    text = bodies_file(tower).read_text()
    shapes = structure_bodies(tower).shapes
    assert text.count("MANIFOLD_SOLID_BREP(") == len(shapes) < 20
    assert text.count("NEXT_ASSEMBLY_USAGE_OCCURRENCE(") == 24 + 56 + 32 + 3
    assert "'P1, 8 alike'" in text


def test_colours_and_units_are_in_the_file(bodies_file, tower):
    text = bodies_file(tower).read_text()
    assert "COLOUR_RGB" in text
    assert ".MILLI.,.METRE." in text


def test_the_same_bodies_give_the_same_geometry(tower, tmp_path):
    files = []
    for name in ("a", "b"):
        write_bodies(structure_bodies(tower), tmp_path / f"{name}.step", name="tower")
        files.append(read_prisms(tmp_path / f"{name}.step"))
    for first, second in zip(*files, strict=True):
        assert first.mark == second.mark
        assert first.low.tolist() == second.low.tolist()


def test_a_folder_that_is_not_there_is_an_output_error(tower, tmp_path):
    with pytest.raises(OutputError, match="cannot be written"):
        write_bodies(structure_bodies(tower), tmp_path / "none" / "x.step", name="tower")
