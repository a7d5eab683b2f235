import pytest

from fabrication.errors import OutputError
from fabrication.whole_files import require_places, text_file, write_whole


def test_all_files_are_written(tmp_path):
    write_whole({tmp_path / name: text_file(name) for name in ("a", "b")})
    assert {path.name: path.read_text() for path in tmp_path.iterdir()} == {"a": "a", "b": "b"}


def test_a_failure_leaves_what_was_there(tmp_path):
    (tmp_path / "a").write_text("old")

    def full(path):
        path.write_text("half")
        raise OSError(28, "No space left on device")

    with pytest.raises(OutputError, match="No space left") as info:
        write_whole({tmp_path / "a": text_file("new"), tmp_path / "b": full})
    assert info.value.where.endswith("b")
    assert [path.name for path in tmp_path.iterdir()] == ["a"]
    assert (tmp_path / "a").read_text() == "old"


@pytest.mark.parametrize("names", [["."], ["no/a"], ["a", "./a"]])
def test_places_where_no_file_can_be(tmp_path, monkeypatch, names):
    from pathlib import Path

    monkeypatch.chdir(tmp_path)
    with pytest.raises(OutputError):
        require_places(*map(Path, names))
