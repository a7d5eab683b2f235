import pytest

import gridshell as gs
from gridshell.io.text import write_text


def test_a_folder_that_is_missing_is_named(tmp_path):
    path = tmp_path / "missing" / "net.obj"
    with pytest.raises(gs.FileError, match="cannot be written") as caught:
        write_text(path, "")
    assert caught.value.where == str(path)


def test_text_is_written_as_utf8(tmp_path):
    write_text(tmp_path / "a.txt", "\u00e4\n")
    assert (tmp_path / "a.txt").read_bytes() == b"\xc3\xa4\n"
