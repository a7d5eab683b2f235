"""Closed curves from OBJ, text and B-rep files."""

import numpy as np
import pytest

from gridshell.errors import FileError, NotOnePatchError, SettingError, UnitError
from gridshell.io import Unit, read_curves

SQUARE = np.array([[0, 0, 0], [1, 0, 1], [1, 1, 0], [0, 1, 1.0]])


def write(path, text):
    path.write_text(text)
    return path


@pytest.mark.parametrize("separator", [" ", ",", "; ", "\t"])
def test_blocks_of_points_are_loops(tmp_path, separator):
    block = "\n".join(separator.join(map(str, row)) for row in SQUARE)
    path = write(
        tmp_path / "c.csv", f"# two loops\n{block}\n\n\n{block}\n{block.splitlines()[0]}\n"
    )
    first, second = read_curves(path, unit=Unit.M)
    np.testing.assert_array_equal(first, 1000 * SQUARE)
    np.testing.assert_array_equal(second, 1000 * SQUARE)


def test_lines_of_an_obj_are_joined(tmp_path):
    points = "\n".join("v {} {} {}".format(*row) for row in SQUARE)
    path = write(tmp_path / "c.obj", f"{points}\nl 1 2 3\nl 1 4\nl 4 -2\n")
    (loop,) = read_curves(path, unit=Unit.CM)
    np.testing.assert_array_equal(loop, 10 * SQUARE)


@pytest.mark.parametrize("name", ["c.step", "c.igs", "c.brep"])
def test_edges_of_a_brep_are_sampled_and_joined(tmp_path, brep_shapes, name):
    import build123d as bd

    circle = bd.Edge.make_circle(1000.0)
    pieces = [bd.Edge.make_circle(500.0, start_angle=a, end_angle=a + 120) for a in (0, 240, 120)]
    shape = brep_shapes.compound(
        circle.wrapped, *(p.moved(bd.Pos(0, 0, 300)).wrapped for p in pieces)
    )
    brep_shapes.write(shape, tmp_path / name)
    unit = Unit.MM if name == "c.brep" else None
    loops = read_curves(tmp_path / name, unit=unit, tolerance=0.05)
    assert len(loops) == 2
    for loop, radius in zip(sorted(loops, key=lambda p: p[0, 2]), (1000.0, 500.0), strict=True):
        np.testing.assert_allclose(np.linalg.norm(loop[:, :2], axis=1), radius, rtol=1e-9)
        middle = (loop + np.roll(loop, -1, axis=0)) / 2
        assert np.linalg.norm(middle[:, :2], axis=1).min() > radius - 0.051


@pytest.mark.parametrize(
    ("name", "text", "what"),
    [
        ("c.csv", "", "no curves"),
        ("c.csv", "some words here\n", "line cannot be read"),
        ("c.csv", "1 2\n", "line cannot be read"),
        ("c.csv", "1 2 nan\n", "line cannot be read"),
        ("c.csv", "0 0 0\n1 0 0\n", "three points"),
        ("c.obj", "v 0 0 0\nl 1 x\n", "line cannot be read"),
        ("c.obj", "v 0 0 0\nv 1 0 0\nl 1 7\n", "does not exist"),
        ("c.obj", "v 0 0 0\nv 1 0 0\nv 1 1 0\nl 1 2 3\n", "not closed"),
        ("c.obj", "v 0 0 0\n", "no curves"),
    ],
)
def test_what_cannot_be_read_is_named(tmp_path, name, text, what):
    with pytest.raises(FileError, match=what) as info:
        read_curves(write(tmp_path / name, text), unit=Unit.MM)
    assert name in info.value.where


def test_a_file_of_points_demands_a_unit(tmp_path):
    with pytest.raises(UnitError, match="states no unit"):
        read_curves(write(tmp_path / "c.csv", "0 0 0\n"))


def test_a_missing_file_is_named(tmp_path):
    with pytest.raises(FileError, match="cannot be read"):
        read_curves(tmp_path / "none.csv", unit=Unit.MM)


def test_a_surface_is_no_curve_and_a_tolerance_is_positive(tmp_path, brep_shapes):
    brep_shapes.write(brep_shapes.saddle(), tmp_path / "s.step")
    with pytest.raises(NotOnePatchError, match="holds faces"):
        read_curves(tmp_path / "s.step")
    with pytest.raises(SettingError, match="tolerance"):
        read_curves(tmp_path / "s.step", tolerance=0.0)
