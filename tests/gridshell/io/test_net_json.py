import json

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

import gridshell as gs
from gridshell.mesh import grid_quads

GOOD = {
    "format": "gridshell-net",
    "version": 1,
    "unit": "mm",
    "vertices": [[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]],
    "quads": [[0, 1, 2, 3]],
    "colour": [0, 1, 0, 1],
}


@pytest.fixture
def read(tmp_path):
    """Reads GOOD with some keys changed; None takes a key out."""

    def reader(**changes):
        document = {k: v for k, v in {**GOOD, **changes}.items() if v is not None}
        path = tmp_path / "a.net.json"
        path.write_text(json.dumps(document), encoding="utf-8")
        return gs.read_net(path)

    return reader


# ---- round trips ----------------------------------------------------------------------------


@given(
    vertices=arrays(np.float64, (9, 3), elements=st.floats(allow_nan=False, allow_infinity=False))
)
def test_a_round_trip_keeps_every_bit(tmp_path_factory, vertices):
    path = tmp_path_factory.getbasetemp() / "bits.net.json"
    control = gs.as_control_mesh(gs.QuadMesh(vertices, grid_quads(2, 2)))
    gs.write_net(path, control)
    back = gs.read_net(path)
    assert back.vertices.tobytes() == control.vertices.tobytes()
    np.testing.assert_array_equal(back.quads, control.quads)
    np.testing.assert_array_equal(back.colour, control.colour)


def test_the_same_diagonal_meshes_come_back_with_the_same_numbers(tmp_path, monkey_saddle):
    control = gs.as_control_mesh(monkey_saddle)
    gs.write_net(tmp_path / "a.net.json", control)
    back = gs.read_net(tmp_path / "a.net.json")
    for net, again in zip(gs.diagonal_meshes(control), gs.diagonal_meshes(back), strict=True):
        np.testing.assert_array_equal(again.edges, net.edges)
        np.testing.assert_array_equal(again.family, net.family)
        np.testing.assert_array_equal(again.control_vertices, net.control_vertices)


def test_writing_what_was_read_gives_the_same_file(tmp_path, monkey_saddle):
    first, second = tmp_path / "a.net.json", tmp_path / "b.net.json"
    gs.write_net(first, gs.control_mesh(monkey_saddle))
    gs.write_net(second, gs.read_net(first))
    assert first.read_bytes() == second.read_bytes()


def test_an_unused_vertex_keeps_its_place(tmp_path, grid):
    mesh = grid(2, 2)
    widened = gs.QuadMesh(np.vstack([[9.0, 9.0, 9.0], mesh.vertices]), mesh.quads + 1)
    gs.write_net(tmp_path / "a.net.json", gs.as_control_mesh(widened))
    back = gs.read_net(str(tmp_path / "a.net.json"))
    assert back.vertices[0].tolist() == [9.0, 9.0, 9.0]
    assert back.colour[0] == -1


def test_the_file_says_what_it_is(tmp_path, grid):
    gs.write_net(tmp_path / "a.net.json", gs.as_control_mesh(grid(1, 1)))
    document = json.loads((tmp_path / "a.net.json").read_text())
    assert list(document) == list(GOOD)
    assert [document[key] for key in ("format", "version", "unit")] == ["gridshell-net", 1, "mm"]


def test_what_is_read_is_read_only(read):
    control = read()
    assert not control.vertices.flags.writeable
    assert not control.colour.flags.writeable


# ---- what is refused ------------------------------------------------------------------------


def test_a_missing_file_is_refused_by_its_path(tmp_path):
    with pytest.raises(gs.FileError, match="cannot be read") as info:
        gs.read_net(tmp_path / "none.net.json")
    assert info.value.where == str(tmp_path / "none.net.json")
    assert info.value.value == "No such file or directory"


@pytest.mark.parametrize("content", [b"", b"{", b"not json", b"\xff\xfe"])
def test_what_is_not_json_is_refused(tmp_path, content):
    (tmp_path / "a.net.json").write_bytes(content)
    with pytest.raises(gs.FileError, match="not JSON"):
        gs.read_net(tmp_path / "a.net.json")


@pytest.mark.parametrize("content", ["[]", "null", "1", '"net"', "{}", '{"format": "other"}'])
def test_json_that_is_no_net_is_refused(tmp_path, content):
    (tmp_path / "a.net.json").write_text(content)
    with pytest.raises(gs.FileError, match="not a gridshell-net"):
        gs.read_net(tmp_path / "a.net.json")


@pytest.mark.parametrize("version", [0, 2, "1", None])
def test_another_version_is_refused_with_both_numbers(read, version):
    with pytest.raises(gs.FileError, match="another version") as info:
        read(version=version)
    assert (info.value.value, info.value.limit) == (str(version), "1")


@pytest.mark.parametrize("key", ["vertices", "quads", "colour"])
def test_a_missing_key_is_refused_by_its_name(read, key):
    with pytest.raises(gs.FileError, match="incomplete") as info:
        read(**{key: None})
    assert key in info.value.value


@pytest.mark.parametrize(
    "changes",
    [
        {"vertices": [[0, 0, 0], [1, 0]]},
        {"vertices": [[0, 0, "x"]]},
        {"quads": [[0, 1, 2, None]]},
        {"colour": ["red", "blue", "red", "blue"]},
        {"vertices": {}},
    ],
)
def test_entries_of_another_kind_are_refused(read, changes):
    with pytest.raises(gs.FileError, match="incomplete"):
        read(**changes)


@pytest.mark.parametrize(
    "changes", [{"vertices": [[10**400, 0, 0]] * 4}, {"quads": [[2**70, 1, 2, 3]]}]
)
def test_numbers_too_large_for_an_array_are_refused(read, changes):
    with pytest.raises(gs.FileError):
        read(**changes)


def test_vertices_that_are_one_number_are_refused(read):
    with pytest.raises((gs.FileError, gs.MeshError)):
        read(vertices=5)


@pytest.mark.parametrize("colour", [[0, 1], [[0, 1, 0, 1]], [0, 1, 0, 1, 0]])
def test_another_number_of_colours_is_refused(read, colour):
    with pytest.raises(gs.FileError, match="needs a colour") as info:
        read(colour=colour)
    assert info.value.where.endswith("a.net.json, colour")


@pytest.mark.parametrize("colour", [[0, 0, 0, 0], [0, 1, 2, 3], [7, 7, 7, 7], [0, 1, 0, -1]])
def test_colours_that_do_not_alternate_are_refused(read, colour):
    with pytest.raises((gs.FileError, gs.MeshError)):
        read(colour=colour)


def test_another_unit_is_refused(read):
    with pytest.raises(gs.FileError):
        read(unit="m")


def test_quads_that_form_no_surface_are_refused(read):
    with pytest.raises(gs.MeshError):
        read(quads=[[0, 1, 2, 9]])


def test_a_coordinate_that_is_no_number_is_refused(read):
    with pytest.raises(gs.MeshError, match="not a number"):
        read(vertices=[[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, float("nan"), 0]])
