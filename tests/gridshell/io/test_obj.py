import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

import gridshell as gs
from gridshell.mesh import grid_quads

SQUARE = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n"
COORDINATE = st.floats(-1e12, 1e12).filter(lambda x: x == 0.0 or abs(x) > 1e-250)


@pytest.fixture
def read(tmp_path):
    """Reads a text as an OBJ file."""

    def reader(text, unit=gs.Unit.MM):
        path = tmp_path / "mesh.obj"
        path.write_text(text, encoding="utf-8")
        return gs.read_obj(path, unit=unit)

    return reader


# ---- reading --------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("unit", "mm"),
    [
        (gs.Unit.MM, 1.0),
        (gs.Unit.CM, 10.0),
        (gs.Unit.M, 1000.0),
        (gs.Unit.INCH, 25.4),
        (gs.Unit.FOOT, 304.8),
    ],
)
def test_the_mesh_comes_back_in_mm(read, unit, mm):
    mesh = read(SQUARE + "f 1 2 3 4\n", unit)
    assert mesh.vertices[2].tolist() == [mm, mm, 0.0]


@pytest.mark.parametrize(
    "face",
    [
        "f 1 2 3 4",
        "f 1/9 2/9 3/9 4/9",
        "f 1//5 2//5 3//5 4//5",
        "f 1/1/1 2 3/2 4//4",
        "f -4 -3 -2 -1",
    ],
)
def test_all_ways_to_write_a_face_are_read(read, face):
    assert read(SQUARE + face).quads.tolist() == [[0, 1, 2, 3]]


def test_other_lines_are_skipped(read):
    extra = "# a comment\no roof\nvn 0 0 1\nvt 0 0\ng shell\ns off\nusemtl steel\n\n"
    mesh = read(extra + SQUARE + extra + "f 1 2 3 4\n" + extra)
    assert mesh.quads.tolist() == [[0, 1, 2, 3]]


def test_colours_behind_the_coordinates_are_skipped(read):
    mesh = read(SQUARE.replace("v 1 1 0", "v 1 1 0 0.5 0.5 0.5") + "f 1 2 3 4\n")
    assert mesh.vertices[2].tolist() == [1.0, 1.0, 0.0]


def test_relative_indices_count_from_where_they_stand(read):
    mesh = read(SQUARE + "f -4 -3 -2 -1\nv 2 0 0\nv 2 1 0\nf 2 -2 -1 3\n")
    assert mesh.quads.tolist() == [[0, 1, 2, 3], [1, 4, 5, 2]]


def test_faces_are_turned_to_the_orientation_of_the_first(read):
    mesh = read(SQUARE + "v 2 0 0\nv 2 1 0\nf 1 2 3 4\nf 3 6 5 2\n")
    assert mesh.quads.tolist() == [[0, 1, 2, 3], [1, 4, 5, 2]]


def test_vertices_without_a_face_keep_their_numbers(read):
    mesh = read("v 9 9 9\n" + SQUARE + "v 8 8 8\nf 2 3 4 5\n")
    assert mesh.vertices.max() == 9.0
    assert mesh.quads.tolist() == [[1, 2, 3, 4]]
    assert len(gs.remarks(mesh)) == 1


def test_a_path_may_be_given_as_text(tmp_path):
    (tmp_path / "mesh.obj").write_text(SQUARE + "f 1 2 3 4\n")
    assert len(gs.read_obj(str(tmp_path / "mesh.obj"), unit=gs.Unit.M).quads) == 1


# ---- writing --------------------------------------------------------------------------------


def test_the_file_states_its_unit_and_is_written_in_it(tmp_path, grid):
    mesh = grid(1, 1)
    gs.write_obj(tmp_path / "a.obj", mesh.moved(1000.0 * mesh.vertices), unit=gs.Unit.M)
    lines = (tmp_path / "a.obj").read_text().splitlines()
    assert lines[0] == "# unit: m"
    assert lines[1:] == [
        "v 0.0 0.0 0.0",
        "v 0.0 1.0 0.0",
        "v 1.0 0.0 0.0",
        "v 1.0 1.0 0.0",
        "f 1 3 4 2",
    ]


@given(
    vertices=arrays(np.float64, (9, 3), elements=st.floats(allow_nan=False, allow_infinity=False))
)
def test_a_round_trip_in_mm_keeps_every_bit(tmp_path_factory, vertices):
    path = tmp_path_factory.getbasetemp() / "bits.obj"
    gs.write_obj(path, gs.QuadMesh(vertices, grid_quads(2, 2)), unit=gs.Unit.MM)
    back = gs.read_obj(path, unit=gs.Unit.MM)
    assert back.vertices.tobytes() == vertices.tobytes()
    np.testing.assert_array_equal(back.quads, grid_quads(2, 2))


@given(vertices=arrays(np.float64, (9, 3), elements=COORDINATE), unit=st.sampled_from(gs.Unit))
def test_a_round_trip_in_any_unit_is_exact_to_double_precision(tmp_path_factory, vertices, unit):
    """One division and one multiplication: two roundings of at most half a unit each."""
    path = tmp_path_factory.getbasetemp() / "unit.obj"
    gs.write_obj(path, gs.QuadMesh(vertices, grid_quads(2, 2)), unit=unit)
    back = gs.read_obj(path, unit=unit).vertices
    assert (np.abs(back - vertices) <= np.finfo(float).eps * 1.01 * np.abs(vertices)).all()


# ---- units ----------------------------------------------------------------------------------


@pytest.mark.parametrize("name", ["mm", "cm", "m", "inch", "foot"])
def test_units_are_called_by_their_names(name):
    assert gs.Unit.named(name).name.lower() == name
    assert gs.Unit.named(name.upper()) is gs.Unit.named(name)


@pytest.mark.parametrize("name", ["", "metre", "km", "1000"])
def test_an_unknown_unit_is_refused_with_the_known_ones(name):
    with pytest.raises(gs.FileError, match="Unknown unit") as info:
        gs.Unit.named(name)
    assert info.value.value == repr(name)
    assert info.value.limit == "mm, cm, m, inch, foot"


# ---- what is refused ------------------------------------------------------------------------


def test_a_missing_file_is_refused_by_its_path(tmp_path):
    with pytest.raises(gs.FileError, match="cannot be read") as info:
        gs.read_obj(tmp_path / "none.obj", unit=gs.Unit.M)
    assert info.value.where == str(tmp_path / "none.obj")
    assert info.value.value == "No such file or directory"


def test_a_folder_is_refused(tmp_path):
    with pytest.raises(gs.FileError, match="cannot be read"):
        gs.read_obj(tmp_path, unit=gs.Unit.M)


@pytest.mark.parametrize(
    "line",
    ["v 1 2", "v", "v 1 2 x", "f 1 2 3 x", "f 1 2 3 4.5", "f 1 2 3 /4", "v 1,0 2,0 3,0"],
)
def test_a_line_that_cannot_be_read_is_refused_by_number_and_text(read, line):
    with pytest.raises(gs.FileError, match="line cannot be read") as info:
        read(SQUARE + line + "\nf 1 2 3 4\n")
    assert info.value.where.endswith("mesh.obj, line 5")
    assert info.value.value == repr(line)


@pytest.mark.parametrize(("face", "corners"), [("f 1 2 3", 3), ("f 1 2 3 4 1", 5), ("f", 0)])
def test_a_face_with_other_than_four_corners_is_refused_by_line_and_number(read, face, corners):
    with pytest.raises(gs.FileError, match="not a quad") as info:
        read(SQUARE + "f 1 2 3 4\n" + face + "\n")
    assert info.value.where.endswith("mesh.obj, line 6, face 1")
    assert info.value.value == f"{corners} corners"


@pytest.mark.parametrize("text", ["", SQUARE, "# nothing\n"])
def test_a_file_without_faces_is_refused(read, text):
    with pytest.raises(gs.FileError, match="no faces"):
        read(text)


def test_an_index_beyond_the_last_vertex_is_refused(read):
    with pytest.raises(gs.FileError, match="does not exist") as info:
        read(SQUARE + "f 1 2 3 7\n")
    assert info.value.value == "vertex 7"
    assert info.value.limit == "1 .. 4"


def test_a_relative_index_before_the_first_vertex_is_refused(read):
    with pytest.raises(gs.FileError, match="does not exist"):
        read(SQUARE + "f -5 -3 -2 -1\n")


def test_a_relative_index_before_the_first_vertex_is_not_reported_as_an_existing_vertex(read):
    with pytest.raises(gs.FileError, match="does not exist") as info:
        read(SQUARE + "f -5 -3 -2 -1\n")
    assert info.value.value != "vertex 4"


def test_index_zero_is_refused_even_when_another_vertex_follows(read):
    with pytest.raises(gs.FileError):
        read(SQUARE + "f 0 1 2 3\nv 5 5 5\n")


def test_an_index_too_large_for_any_array_is_refused(read):
    with pytest.raises(gs.FileError):
        read(SQUARE + "f 1 2 3 99999999999999999999\n")


def test_a_coordinate_that_is_no_number_is_refused(read):
    with pytest.raises(gs.MeshError, match="not a number"):
        read(SQUARE.replace("v 1 1 0", "v 1 nan 0") + "f 1 2 3 4\n")


def test_a_file_that_is_no_text_is_refused(tmp_path):
    (tmp_path / "mesh.obj").write_bytes(bytes(range(256)))
    with pytest.raises(gs.FileError):
        gs.read_obj(tmp_path / "mesh.obj", unit=gs.Unit.M)


def test_a_moebius_strip_is_refused(read, moebius):
    vertices, quads = moebius
    text = "".join("v {} {} {}\n".format(*row) for row in vertices.tolist())
    text += "".join("f {} {} {} {}\n".format(*row) for row in (quads + 1).tolist())
    with pytest.raises(gs.OrientationError):
        read(text)


def test_a_byte_order_mark_and_trailing_comments_and_continued_lines_are_read(tmp_path):
    path = tmp_path / "mesh.obj"
    text = "\ufeffv 0 0 0 # first\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 \\\n3 4 # quad\n"
    path.write_text(text, encoding="utf-8")
    mesh = gs.read_obj(path, unit=gs.Unit.MM)
    assert mesh.vertices.tolist() == [[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]]
