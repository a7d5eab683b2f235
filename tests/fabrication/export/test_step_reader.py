import re
from ctypes import CDLL
from dataclasses import replace

import cadquery
import numpy as np
import pytest
from OCP.Message import Message, Message_PrinterOStream
from scipy.interpolate import BSpline

import fabrication as fab
import gridshell as gs
from fabrication.export.step_reader import RuledSide
from fabrication.solid import volume

pytestmark = pytest.mark.xdist_group("kernel")

NAMES = ["catenoid", "enneper", "hypar"]


@pytest.fixture(scope="module", params=NAMES)
def case(request, files):
    """A design, its solids and what its file says."""
    design = request.getfixturevalue(request.param)
    written = files(design)
    return design, written.solids, fab.read_step(written.step)


def test_marks_come_back_in_order(case):
    design, _, found = case
    assert [part.mark for part in found] == [one.mark for one in design.structure.lamellas]


def test_the_volume_of_the_file_is_that_of_the_kernel(case):
    _, solids, found = case
    for part, body in zip(found, solids, strict=True):
        assert part.volume() == pytest.approx(volume(body.wrapped), rel=1e-7)


def test_the_unrolled_loop_is_the_flat_outline(case):
    design, _, found = case
    for part, flat in zip(found, design.parts, strict=True):
        apart = np.linalg.norm(part.unrolled_loop()[:, None] - flat.outline, axis=2)
        assert len(part.loop) == len(flat.outline)
        assert apart.min(axis=1).max() < 0.05
        assert apart.min(axis=0).max() < 0.05


def test_points_are_laid_where_the_lamella_lies(case):
    design, _, found = case
    for part, lamella in zip(found, design.structure.lamellas, strict=True):
        x, y = np.linspace(0.0, lamella.length, 30), np.linspace(0.0, 100.0, 30)
        expected = lamella.place(x + lamella.start, np.zeros(30), y - 50.0)
        np.testing.assert_allclose(part.place(x, y), expected, atol=0.01)


def test_both_sides_are_half_a_thickness_from_the_middle(case):
    design, _, found = case
    for part in found:
        u = np.linspace(part.near.lower.t[0], part.near.lower.t[-1], 20)
        v = np.linspace(0.0, part.near.width, 20)
        apart = np.linalg.norm(part.near.points(u, v) - part.far.points(u, v), axis=1)
        np.testing.assert_allclose(apart, design.structure.profile.thickness, atol=1e-3)


def test_parameters_are_found_back_from_points(case):
    side = case[2][0].near
    uv = np.stack([np.linspace(100.0, 900.0, 9), np.linspace(5.0, 95.0, 9)], axis=1)
    np.testing.assert_allclose(side.parameters(side.points(*uv.T)), uv, atol=1e-6)


def test_slopes_are_the_derivatives_of_points(case):
    side, step = case[2][0].near, 1e-3
    u, v = np.array([333.0, 700.0]), np.array([20.0, 80.0])
    by_u, by_v = side.slopes(u, v)
    along = (side.points(u + step, v) - side.points(u - step, v)) / (2.0 * step)
    across = (side.points(u, v + step) - side.points(u, v - step)) / (2.0 * step)
    np.testing.assert_allclose(by_u, along, atol=1e-6)
    np.testing.assert_allclose(by_v, across, atol=1e-6)


def stretched(side, factor):
    """The same face with *factor* times its parameters u."""
    edges = (BSpline(factor * edge.t, edge.c, 3) for edge in (side.lower, side.upper))
    return RuledSide(*edges, side.width)


def test_x_is_measured_along_the_strip_whatever_the_parameters_are(case):
    part = case[2][0]
    other = replace(
        part,
        near=stretched(part.near, 2.5),
        far=stretched(part.far, 2.5),
        near_loops=tuple(loop * np.array([2.5, 1.0, 1.0]) for loop in part.near_loops),
        far_loops=tuple(loop * np.array([2.5, 1.0, 1.0]) for loop in part.far_loops),
    )
    x, y = np.linspace(0.0, 900.0, 9), np.linspace(0.0, 100.0, 9)
    np.testing.assert_allclose(other.place(x, y), part.place(x, y), atol=1e-6)
    np.testing.assert_allclose(other.unrolled_loop(), part.unrolled_loop(), atol=1e-6)
    assert other.volume() == pytest.approx(part.volume(), rel=1e-9)


# ---- files that are not ours ----------------------------------------------------------------


def test_a_missing_file_is_named(tmp_path):
    with pytest.raises(gs.FileError, match="missing") as info:
        fab.read_step(tmp_path / "structure.step")
    assert "structure.step" in info.value.where


def test_a_folder_is_no_file(tmp_path):
    with pytest.raises(gs.FileError, match="missing"):
        fab.read_step(tmp_path)


def test_a_file_that_is_no_step_is_refused_without_the_kernel_s_own_words(tmp_path, capfd):
    messenger = Message.DefaultMessenger_s()
    messenger.AddPrinter(Message_PrinterOStream())
    (tmp_path / "structure.step").write_text("hello\n")
    with pytest.raises(gs.FileError):
        fab.read_step(tmp_path / "structure.step")
    CDLL(None).fflush(None)
    assert capfd.readouterr() == ("", "")


@pytest.mark.parametrize("content", ["", "hello\n", "ISO-10303-21;\nHEADER;\n"])
def test_a_file_that_is_no_step_is_refused(tmp_path, content):
    (tmp_path / "structure.step").write_text(content)
    with pytest.raises(gs.FileError, match="cannot be read"):
        fab.read_step(tmp_path / "structure.step")


def exported(shape, path):
    whole = cadquery.Assembly(name="shell")
    whole.add(shape, name="A1")
    fab.write_step(whole, path)
    return path


def test_a_solid_with_plane_faces_is_refused_by_name(tmp_path):
    box = cadquery.Workplane().box(1.0, 2.0, 3.0)
    with pytest.raises(gs.FileError, match="No solid has two large ruled faces") as info:
        fab.read_step(exported(box, tmp_path / "box.step"))
    assert info.value.where == str(tmp_path / "box.step")


def test_a_solid_whose_large_faces_differ_is_refused_by_name(pair, files, tmp_path):
    """The first face of the file gets one of its knots moved."""
    text = files(pair).step.read_text()
    surface = re.search(r"B_SPLINE_SURFACE_WITH_KNOTS\([^;]*;", text)[0]
    *rest, u_knots, v_knots, form = re.split(r"(?<=\)),", surface)
    first, second, *others = u_knots.split(",")
    moved = ",".join([first, f"{float(second) + 0.1:.6f}", *others])
    path = tmp_path / "structure.step"
    path.write_text(text.replace(surface, ",".join([*rest, moved, v_knots, form])))
    with pytest.raises(gs.FileError, match="large faces of a solid differ") as info:
        fab.read_step(path)
    assert "A1" in info.value.where


def test_a_file_without_solids_holds_no_parts(tmp_path):
    wire = cadquery.Workplane().rect(1.0, 2.0).wires().val()
    assert fab.read_step(exported(wire, tmp_path / "wire.step")) == ()
