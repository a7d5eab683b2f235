import tomllib

import pytest
from hypothesis import given
from hypothesis import strategies as st

from fabrication.errors import OutputError, ProjectError
from fabrication.studio.disk import Saved, edited, outside, read, write, write_copy
from fabrication.studio.versions import Version


def turned(path, angle=62.0):
    return Version.of(read(path).document, path).with_value("net.angle", angle, path).document


def test_comments_and_order_stay(path, text):
    write(read(path), turned(path))
    lines, before = path.read_text().splitlines(), text.splitlines()
    changed = [(a, b) for a, b in zip(before, lines, strict=True) if a != b]
    assert changed == [("angle = 70.0        # degrees", "angle = 62.0        # degrees")]


def test_an_array_keeps_its_comment(path):
    document = Version.of(read(path).document, path).with_value("patch.lamellas.0", 8, path)
    write(read(path), document.document)
    assert "lamellas = [8, 5]   # of either family" in path.read_text()


def test_a_new_key_is_put_into_its_table(path):
    version = Version.of(read(path).document, path).with_value("net.fairness", 0.1, path)
    write(read(path), version.document)
    assert read(path).document == version.document


SMALL = """\
[patch]
lamellas = [6, 5]   # of either family
[net]
angle = 70.0        # degrees
"""


@given(st.floats(1.0, 179.0), st.integers(2, 60))
def test_what_is_written_is_what_is_read(angle, count):
    document = tomllib.loads(SMALL)
    document["net"]["angle"] = angle
    document["patch"]["lamellas"] = [count, 5]
    assert tomllib.loads(edited(SMALL, document)) == document


def test_nothing_is_saved_over_what_another_program_wrote(path, text):
    saved = read(path)
    path.write_text(text.replace("70.0", "71.0"))
    assert saved.changed
    with pytest.raises(OutputError, match="another program"):
        write(saved, turned(path))
    assert "71.0" in path.read_text()


def test_a_file_that_went_counts_as_changed(path):
    saved = read(path)
    path.unlink()
    assert saved.changed
    assert saved.now() is None


def test_a_copy_leaves_the_project_alone(path, text):
    made = write_copy(read(path), "pavilion-62.toml", turned(path))
    assert made.path == path.parent / "pavilion-62.toml"
    assert read(made.path).document["net"]["angle"] == 62.0
    assert path.read_text() == text


@pytest.mark.parametrize(
    "name", ["", "../x.toml", "/etc/x.toml", "a/b.toml", "x.txt", ".toml", "..", ".x.toml"]
)
def test_a_copy_stays_in_the_folder(path, name):
    before = sorted(path.parent.iterdir())
    with pytest.raises(OutputError, match="own folder"):
        write_copy(read(path), name, turned(path))
    assert sorted(path.parent.iterdir()) == before


def test_a_copy_is_not_written_over_another_file(path):
    with pytest.raises(OutputError, match="there already"):
        write_copy(read(path), "pavilion.toml", turned(path))


def test_a_folder_that_cannot_be_written_leaves_nothing_behind(path, text):
    gone = Saved(path.parent / "nowhere" / "pavilion.toml", text, text)
    with pytest.raises(OutputError, match="cannot be saved"):
        write_copy(gone, "x.toml", turned(path))


def test_a_file_that_is_no_toml_is_named(path):
    path.write_text("name = ")
    with pytest.raises(ProjectError, match=r"pavilion\.toml"):
        read(path)


def test_files_outside_the_folder_are_found(path):
    folder = path.parent
    assert outside({"mesh": {"file": "net.obj"}}, folder) is None
    assert outside({"mesh": {"file": "sub/net.obj"}}, folder) is None
    assert outside({"mesh": {"file": "../net.obj"}}, folder) == "mesh.file = '../net.obj'"
    guides = {"remesh": {"guides": [{"file": "/etc/passwd"}]}}
    assert outside(guides, folder) == "remesh.guides.0.file = '/etc/passwd'"
    (folder / "link.obj").symlink_to("/etc/passwd")
    assert outside({"mesh": {"file": "link.obj"}}, folder) is not None
