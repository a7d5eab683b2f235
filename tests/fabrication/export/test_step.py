import errno
import pathlib
import re
from datetime import datetime

import cadquery
import pytest
from OCP.Message import Message, Message_PrinterOStream

import fabrication as fab
from fabrication.colours import FAMILY_COLOURS
from fabrication.errors import OutputError
from fabrication.export.step import step_string
from fabrication.solid import volume

pytestmark = pytest.mark.xdist_group("kernel")


@pytest.fixture(scope="module")
def imported(pair, files):
    """The four lamellas as cadquery reads them from the file."""
    return cadquery.importers.importStep(str(files(pair).step)).solids().vals()


@pytest.fixture(scope="module")
def tree(pair, files):
    """The assembly as cadquery reads it from the file."""
    return cadquery.Assembly.importStep(str(files(pair).step))


def test_the_assembly_has_one_named_child_per_lamella(pair, files):
    whole = fab.assembly(files(pair).solids, pair.structure, name="shell")
    assert whole.name == "shell"
    assert [child.name for child in whole.children] == ["A1", "A2", "B1", "B2"]


def test_a_file_read_by_cadquery_holds_one_valid_solid_per_lamella(imported):
    assert len(imported) == 4
    assert all(body.isValid() for body in imported)


def test_volumes_survive_the_file(imported, pair):
    flat = sorted(part.area * part.thickness for part in pair.parts)
    assert sorted(volume(body.wrapped) for body in imported) == pytest.approx(flat, rel=20e-6)


def test_solids_stay_where_they_stood(imported, pair, files):
    centres = [tuple(body.center()) for body in files(pair).solids]
    found = [body.Center().toTuple() for body in imported]
    assert sorted(found) == [pytest.approx(centre, abs=0.1) for centre in sorted(centres)]


def test_names_survive_the_file(tree):
    assert tree.name == "shell"
    assert [child.name for child in tree.children] == ["A1", "A2", "B1", "B2"]


def test_colours_survive_the_file(tree, pair):
    for child, lamella in zip(tree.children, pair.structure.lamellas, strict=True):
        assert child.color.toTuple()[:3] == pytest.approx(FAMILY_COLOURS[lamella.family], abs=1e-3)


def test_the_file_is_in_millimetres(pair, files):
    text = files(pair).step.read_text()
    assert text.startswith("ISO-10303-21;")
    assert "SI_UNIT(.MILLI.,.METRE.)" in text


def test_the_file_carries_no_curves_in_the_parameters_of_faces(pair, files):
    assert "PCURVE" not in files(pair).step.read_text()


def test_as_many_solids_as_lamellas_are_needed(pair, files):
    with pytest.raises(ValueError, match="argument"):
        fab.assembly(files(pair).solids[:-1], pair.structure, name="shell")


def test_a_folder_that_is_not_there_is_an_error(pair, files, tmp_path):
    whole = fab.assembly(files(pair).solids[:], pair.structure, name="shell")
    with pytest.raises(OutputError, match="STEP file cannot be written") as info:
        fab.write_step(whole, tmp_path / "missing" / "structure.step")
    assert "structure.step" in info.value.where


def test_a_disk_that_fills_up_is_an_error_with_its_reason(pair, files, tmp_path, monkeypatch):
    def full(self, content):
        raise OSError(errno.ENOSPC, "No space left on device")

    whole = fab.assembly(files(pair).solids[:], pair.structure, name="shell")
    monkeypatch.setattr(pathlib.Path, "write_bytes", full)
    with pytest.raises(OutputError, match="STEP file cannot be written") as info:
        fab.write_step(whole, tmp_path / "structure.step")
    assert info.value.value == "No space left on device"


def test_the_kernel_s_own_messages_are_kept_off_the_terminal(pair, files, tmp_path):
    messenger = Message.DefaultMessenger_s()
    messenger.AddPrinter(Message_PrinterOStream())
    whole = fab.assembly(files(pair).solids, pair.structure, name="shell")
    fab.write_step(whole, tmp_path / "structure.step")
    assert messenger.Printers().Size() == 0


@pytest.mark.parametrize("name", ["Dächle", "a/b", 'it\'s "quoted"; {ok}', "1"])
def test_any_name_of_the_whole_can_be_written(pair, files, tmp_path, name):
    path = tmp_path / "structure.step"
    fab.write_step(fab.assembly(files(pair).solids, pair.structure, name=name), path)
    assert [part.mark for part in fab.read_step(path)] == ["A1", "A2", "B1", "B2"]


@pytest.mark.parametrize("name", ["é☃", "Dächle", "𝄞 key", "it's a\\b", "x" * 200 + "é", "日本\tX"])
def test_the_name_of_the_whole_survives_in_seven_bits(pair, files, tmp_path, name):
    path = tmp_path / "structure.step"
    fab.write_step(fab.assembly(files(pair).solids, pair.structure, name=name), path)
    assert path.read_bytes().isascii()
    assert cadquery.Assembly.importStep(str(path)).name == name


@pytest.mark.parametrize(
    ("text", "written"),
    [
        ("plain", "'plain'"),
        ("é☃", r"'\X2\00E92603\X0\'"),
        ("a𝄞b", r"'a\X4\0001D11E\X0\b'"),
        ("it's", "'it''s'"),
        ("a\\b", r"'a\\b'"),
        ("", "''"),
    ],
)
def test_strings_are_written_as_the_standard_asks(text, written):
    assert step_string(text) == written


def test_the_header_names_the_file_the_program_and_no_stand_in_person(pair, files):
    head = files(pair).step.read_text().split("DATA;")[0]
    assert f"FILE_NAME('{files(pair).step.name}'" in head
    assert "'gridshell" in head
    assert "Author" not in head
    assert "Shape Model" not in head
    assert "FILE_SCHEMA(('AUTOMOTIVE_DESIGN" in head


def test_the_same_solids_at_the_same_time_give_the_same_bytes_up_to_the_colours(
    pair, files, tmp_path
):
    whole = fab.assembly(files(pair).solids, pair.structure, name="shell")
    paths = [tmp_path / folder / "structure.step" for folder in "ab"]
    for path in paths:
        path.parent.mkdir()
        fab.write_step(whole, path, written=datetime(2001, 2, 3, 4, 5, 6))
    colours = re.compile(rb"MECHANICAL_DESIGN_GEOMETRIC_PRESENTATION_REPRESENTATION")
    (first, tail), (second, other) = (colours.split(p.read_bytes(), maxsplit=1) for p in paths)
    assert first == second
    assert tail.count(b";") == other.count(b";")
    assert first.count(b"MANIFOLD_SOLID_BREP(") == first.count(b"NEXT_ASSEMBLY_USAGE") == 4
    assert b"'2001-02-03T04:05:06'" in first
    assert whole.name == "shell"


def test_the_time_stamp_follows_the_environment(pair, files, tmp_path, monkeypatch):
    monkeypatch.setenv("SOURCE_DATE_EPOCH", "86400")
    path = tmp_path / "structure.step"
    fab.write_step(fab.assembly(files(pair).solids, pair.structure, name="shell"), path)
    assert "'1970-01-02T00:00:00'" in path.read_text().split("DATA;")[0]
