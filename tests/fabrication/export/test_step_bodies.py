import pickle
import subprocess
import sys
from datetime import UTC, datetime
from pathlib import Path

import build123d
import cadquery
import pytest

import fabrication as fab
from fabrication.bodies import structure_bodies
from fabrication.colours import FAMILY_COLOURS
from fabrication.errors import OutputError
from fabrication.export.step_bodies import strip_kinds, write_assembly, write_bodies
from fabrication.export.step_prism_reader import read_prisms
from fabrication.outlines import outline_area
from fabrication.parts import parts_of
from fabrication.shapes import joined

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
    wanted += [outline_area(c.section()) * c.spec.height for c in leaning.connectors]
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


# ---- strips and connectors in one assembly -------------------------------------------------------


@pytest.fixture(scope="module")
def double(pair):
    """Double lamellas with their washers and bolts."""
    washer = fab.StarWasher(4.0, 18.0, 8.0, fab.S235)
    return fab.DoubleSlotJoint(30.0, 8.0, washer).build(pair.structure)


def write_all(jointed, path):
    kinds = strip_kinds(jointed.strips, fab.solids(jointed.strips, parts_of(jointed)))
    bodies = joined(*jointed.connectors)
    written = datetime(2026, 1, 1, tzinfo=UTC)
    write_assembly(path, name="roof", strips=kinds, bodies=bodies, written=written)
    return path


def test_names_tree_and_colours_survive_another_import(double, tmp_path):
    whole = cadquery.Assembly.importStep(str(write_all(double, tmp_path / "roof.step")))
    assert whole.name == "roof"
    found = {kind.name: kind.children for kind in whole.children}
    strips = {f"family {'AB'[f - 1]}": colour for f, colour in FAMILY_COLOURS.items()}
    wanted = strips | {kind.name: kind.colour for kind in double.connectors}
    assert set(found) == set(wanted)
    marks = {strip.mark for strip in double.strips.lamellas}
    marks |= {body.mark for kind in double.connectors for body in kind.bodies}
    assert {part.name for parts in found.values() for part in parts} == marks
    for name, parts in found.items():
        for part in parts:
            assert part.color.toTuple()[:3] == pytest.approx(wanted[name], abs=5e-3)


def test_equal_connectors_are_one_solid_beside_the_strips(double, tmp_path):
    text = write_all(double, tmp_path / "roof.step").read_text()
    shapes = sum(len(kind.shapes) for kind in double.connectors)
    assert text.count("MANIFOLD_SOLID_BREP(") == len(double.strips.lamellas) + shapes


AGAIN = """
import pickle, sys
from pathlib import Path
sys.path.insert(0, sys.argv[3])
from test_step_bodies import write_all
write_all(pickle.loads(Path(sys.argv[1]).read_bytes()), Path(sys.argv[2]))
"""


def test_two_processes_write_the_same_bytes(double, tmp_path):
    order = tmp_path / "order"
    order.write_bytes(pickle.dumps(double))
    files = []
    for folder in ("a", "b"):
        (tmp_path / folder).mkdir()
        path = tmp_path / folder / "roof.step"
        here = str(Path(__file__).parent)
        subprocess.run([sys.executable, "-c", AGAIN, str(order), str(path), here], check=True)
        files.append(path.read_bytes())
    assert files[0] == files[1]
