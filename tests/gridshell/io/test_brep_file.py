"""STEP, IGES and BREP twins of one saddle, their units, and files that are no surface."""

import numpy as np
import pytest

from gridshell.errors import FileError, NotOnePatchError, UnitError
from gridshell.io import Unit, read_brep

POINTS = np.random.default_rng(0).uniform(-900, 900, (50, 3)) * [1, 1, 0.3]


@pytest.mark.parametrize("name", ["s.step", "s.igs", "s.brep"])
def test_three_formats_hold_one_surface(tmp_path, brep_shapes, name):
    brep_shapes.write(brep_shapes.four_saddles(), tmp_path / name)
    found = read_brep(tmp_path / name, unit=Unit.MM if name == "s.brep" else None)
    foot = found.closest(POINTS)
    x, y, z = foot.points.T
    np.testing.assert_allclose(z, (x * x - y * y) / (2 * brep_shapes.BEND), atol=1e-6)
    off = np.cross(foot.normals, POINTS - foot.points)
    np.testing.assert_allclose(off, 0.0, atol=1e-5)
    assert found.area == pytest.approx(4.3161e6, rel=0.01)


@pytest.mark.parametrize("name", ["s.step", "s.igs"])
def test_the_unit_of_a_file_is_respected(tmp_path, brep_shapes, name):
    # the kernel's STEP writer takes coordinates as they are, its IGES writer takes mm
    size = 1.0 if name == "s.step" else 1000.0
    brep_shapes.write(brep_shapes.saddle(-size, -size, 2.0 * size), tmp_path / name, "M")
    for unit in (None, Unit.M):
        found = read_brep(tmp_path / name, unit=unit)
        assert np.ptp(found.curved_mesh(200.0).mesh.vertices[:, 0]) == pytest.approx(2000.0)
    with pytest.raises(UnitError, match="contradicts") as info:
        read_brep(tmp_path / name, unit=Unit.INCH)
    assert info.value.value == "inch; the file says m"


def test_a_brep_demands_a_unit_and_is_scaled_by_it(tmp_path, brep_shapes):
    brep_shapes.write(brep_shapes.saddle(-1.0, -1.0, 2.0), tmp_path / "s.brep")
    with pytest.raises(UnitError, match="states no unit"):
        read_brep(tmp_path / "s.brep")
    metres = read_brep(tmp_path / "s.brep", unit=Unit.M)
    millimetres = read_brep(tmp_path / "s.brep", unit=Unit.MM)
    a = metres.closest(POINTS)
    b = millimetres.closest(POINTS / 1000.0)
    np.testing.assert_allclose(a.points, 1000 * b.points, atol=1e-6)
    np.testing.assert_allclose(a.curvature, b.curvature / 1000, rtol=1e-6, atol=1e-15)


@pytest.mark.parametrize("name", ["s.step", "s.igs", "s.brep"])
@pytest.mark.parametrize("content", [b"", b"this is no surface\n", bytes(range(256)) * 20])
def test_garbage_is_named(tmp_path, name, content):
    (tmp_path / name).write_bytes(content)
    with pytest.raises(FileError, match="cannot be read") as info:
        read_brep(tmp_path / name, unit=Unit.MM)
    assert info.value.where.endswith(name)


def test_missing_and_foreign_files_are_named(tmp_path):
    with pytest.raises(FileError, match="missing"):
        read_brep(tmp_path / "none.step")
    with pytest.raises(FileError, match="not a B-rep"):
        read_brep(tmp_path / "s.obj")


def test_a_solid_and_two_patches_are_named(tmp_path, brep_shapes):
    import build123d as bd

    brep_shapes.write(bd.Box(100, 100, 100).wrapped, tmp_path / "box.step")
    with pytest.raises(NotOnePatchError, match="solid"):
        read_brep(tmp_path / "box.step")
    apart = brep_shapes.compound(brep_shapes.saddle(), brep_shapes.saddle(3000.0))
    brep_shapes.write(apart, tmp_path / "two.step")
    with pytest.raises(NotOnePatchError, match="not one connected patch"):
        read_brep(tmp_path / "two.step")
