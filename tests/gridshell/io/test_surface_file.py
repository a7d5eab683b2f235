import numpy as np
import pytest

import gridshell as gs


def test_quads_are_cut_to_triangles_and_lengths_come_in_mm(tmp_path, grid):
    mesh = grid(3, 4)
    gs.write_obj(tmp_path / "s.obj", mesh, unit=gs.Unit.MM)
    found = gs.read_surface(tmp_path / "s.obj", unit=gs.Unit.M)
    assert len(found.triangles) == 24
    foot = found.closest(np.array([[1500.0, 2500.0, 70.0]]))
    np.testing.assert_allclose(foot.points, [[1500.0, 2500.0, 0.0]], atol=1e-9)


@pytest.mark.parametrize("name", ["s.stl", "s.ply"])
def test_triangles_of_other_formats(tmp_path, name):
    import trimesh

    trimesh.creation.icosphere(subdivisions=3, radius=2.0).export(tmp_path / name)
    found = gs.read_surface(tmp_path / name, unit=gs.Unit.MM)
    foot = found.closest(np.array([[0.0, 0.0, 5.0]]))
    assert np.linalg.norm(foot.points) == pytest.approx(2.0, abs=0.02)


def test_a_missing_file_is_named(tmp_path):
    with pytest.raises(gs.FileError, match="missing") as info:
        gs.read_surface(tmp_path / "s.obj", unit=gs.Unit.M)
    assert info.value.where.endswith("s.obj")


@pytest.mark.parametrize(
    ("name", "content"), [("s.obj", b"v 0 0 0\n"), ("s.ply", b"\x00\x01"), ("s.xyz9", b"1")]
)
def test_a_file_without_faces_is_no_surface(tmp_path, name, content):
    (tmp_path / name).write_bytes(content)
    with pytest.raises(gs.FileError, match="cannot be read"):
        gs.read_surface(tmp_path / name, unit=gs.Unit.M)
