import numpy as np
import pytest

import gridshell as gs

STATE = gs.State(np.array([0.1, -1e-300, np.pi]), 7, 1.25e-8, 16.0)


def test_a_state_comes_back_bit_for_bit(tmp_path):
    gs.write_state(tmp_path / "a.npz", STATE)
    found = gs.read_state(tmp_path / "a.npz")
    assert found.x.tolist() == STATE.x.tolist()
    assert (found.steps, found.damping, found.growth) == (7, 1.25e-8, 16.0)


def test_the_file_has_the_name_it_was_given(tmp_path):
    gs.write_state(tmp_path / "state", STATE)
    assert [path.name for path in tmp_path.iterdir()] == ["state"]


def test_a_folder_that_is_not_there_is_named(tmp_path):
    with pytest.raises(gs.FileError, match="cannot be written") as info:
        gs.write_state(tmp_path / "no" / "a.npz", STATE)
    assert info.value.where.endswith("a.npz")


def test_a_missing_file_is_named(tmp_path):
    with pytest.raises(gs.FileError, match="cannot be read"):
        gs.read_state(tmp_path / "a.npz")


@pytest.mark.parametrize("content", [b"", b"text", b"PK\x03\x04broken"])
def test_another_file_is_no_state(tmp_path, content):
    (tmp_path / "a.npz").write_bytes(content)
    with pytest.raises(gs.FileError, match="not a saved state"):
        gs.read_state(tmp_path / "a.npz")


def test_an_archive_of_something_else_is_no_state(tmp_path):
    np.savez(tmp_path / "a.npz", x=np.zeros(3))
    with pytest.raises(gs.FileError, match="not a saved state"):
        gs.read_state(tmp_path / "a.npz")
