import subprocess
import sys

import numpy as np
import pytest

import gridshell as gs
from gridshell.mesh import grid_quads


@pytest.fixture
def saddle(tmp_path):
    """A saddle of 2 m in metres, as OBJ; returns its path and triangles."""
    x, y = np.meshgrid(*[np.linspace(-1, 1, 9)] * 2, indexing="ij")
    points = np.stack([x, y, 0.3 * (x * x - y * y)], axis=-1).reshape(-1, 3)
    mesh = gs.QuadMesh(1000.0 * points, grid_quads(8, 8))
    gs.write_obj(tmp_path / "s.obj", mesh, unit=gs.Unit.M)
    return tmp_path / "s.obj"


def ring(count=40, lift=0.5):
    t = 2.0 * np.pi * np.arange(count) / count
    return np.stack([2.0 * np.cos(t), 1.5 * np.sin(t), lift * np.cos(2 * t)], axis=1)


def test_triangles_come_in_mm(saddle):
    found = gs.read_design(saddle, unit=gs.Unit.M)
    assert isinstance(found, gs.TriangulatedSurface)
    assert len(found.triangles) == 128
    assert np.ptp(found.vertices[:, 0]) == pytest.approx(2000.0)


@pytest.mark.parametrize("name", ["s.stl", "s.ply", "s.glb"])
def test_other_mesh_files(saddle, tmp_path, name):
    import trimesh

    trimesh.load_mesh(saddle).export(tmp_path / name)
    found = gs.read_design(tmp_path / name, unit=gs.Unit.M)
    assert np.ptp(found.vertices[:, 0]) == pytest.approx(2000.0, rel=1e-6)
    assert len(found.triangles) == 128


@pytest.mark.parametrize("name", ["rim.csv", "rim.xyz", "rim.TXT", "rim.obj"])
def test_a_closed_curve_bounds_a_minimal_surface(tmp_path, name):
    loop = ring()
    if name == "rim.obj":
        rows = ["v {} {} {}".format(*p) for p in loop]
        rows.append("l " + " ".join(str(k + 1) for k in [*range(40), 0]))
        (tmp_path / name).write_text("\n".join(rows))
    else:
        np.savetxt(tmp_path / name, loop, delimiter="," if name == "rim.csv" else " ")
    found = gs.read_design(tmp_path / name, unit=gs.Unit.M, triangles=600)
    assert isinstance(found, gs.TriangulatedSurface)
    assert 400 < len(found.triangles) < 900
    size = np.ptp(found.vertices, axis=0)
    np.testing.assert_allclose(size, [4000.0, 3000.0, 1000.0], rtol=1e-2)


def test_an_obj_file_with_faces_is_a_surface_whatever_lines_it_has(saddle):
    saddle.write_text(saddle.read_text() + "l 1 2 3\n")
    assert len(gs.read_design(saddle, unit=gs.Unit.M).triangles) == 128


@pytest.mark.parametrize("name", ["s.obj", "rim.csv", "s.stl", "no.ply"])
def test_a_unit_is_needed(saddle, tmp_path, name):
    np.savetxt(tmp_path / "rim.csv", ring(), delimiter=",")
    with pytest.raises(gs.UnitError, match="states no unit") as info:
        gs.read_design(tmp_path / name)
    assert info.value.limit == "mm, cm, m, inch, foot"


@pytest.mark.parametrize("name", ["no.obj", "no.csv", "no.step", "no.ply"])
def test_a_missing_file_is_named(tmp_path, name):
    with pytest.raises(gs.FileError) as info:
        gs.read_design(tmp_path / name, unit=gs.Unit.MM)
    assert name in str(info.value)


def test_a_vertex_that_is_no_number_is_named_by_its_place(saddle):
    text = saddle.read_text().splitlines()
    text[5] = "v nan 0 0"
    saddle.write_text("\n".join(text))
    with pytest.raises(gs.DegenerateSurfaceError, match="vertex 4"):
        gs.read_design(saddle, unit=gs.Unit.M)


def test_triangles_that_collapsed_are_left_out(saddle):
    saddle.write_text(saddle.read_text() + "f 1 2 2\n")
    assert len(gs.read_design(saddle, unit=gs.Unit.M).triangles) == 128


def test_meshes_and_curves_do_not_load_the_cad_kernel(saddle, tmp_path):
    np.savetxt(tmp_path / "rim.csv", ring(), delimiter=",")
    code = (
        "import sys, gridshell as gs\n"
        f"for name in ({str(saddle)!r}, {str(tmp_path / 'rim.csv')!r}):\n"
        "    gs.read_design(name, unit=gs.Unit.M, triangles=300)\n"
        "assert 'OCP' not in sys.modules\n"
    )
    subprocess.run([sys.executable, "-c", code], check=True)


@pytest.mark.parametrize(
    ("name", "states"), [("a.STEP", True), ("a.igs", True), ("a.brep", False), ("a.obj", False)]
)
def test_which_files_state_their_unit(name, states):
    assert gs.states_unit(name) is states


def test_polylines_need_not_be_closed(tmp_path):
    (tmp_path / "g.csv").write_text("0,0,0\n1,0,0\n1,1,0\n\n5,5,5\n6,5,5\n")
    first, second = gs.read_polylines(tmp_path / "g.csv", unit=gs.Unit.M)
    np.testing.assert_array_equal(first[-1], [1000.0, 1000.0, 0.0])
    assert len(second) == 2
    with pytest.raises(gs.UnitError):
        gs.read_polylines(tmp_path / "g.csv")
    (tmp_path / "empty.csv").write_text("# nothing\n")
    with pytest.raises(gs.FileError, match="no curves"):
        gs.read_polylines(tmp_path / "empty.csv", unit=gs.Unit.M)


@pytest.mark.xdist_group("kernel")
class TestBreps:
    @pytest.fixture
    def kernel(self):
        return pytest.importorskip("build123d")

    def test_a_face_is_exact_and_needs_no_unit(self, kernel, tmp_path):
        face = kernel.Face.make_rect(2000, 1000)
        kernel.export_step(face, str(tmp_path / "f.step"))
        found = gs.read_design(tmp_path / "f.step")
        assert isinstance(found, gs.BrepSurface)
        assert found.area == pytest.approx(2e6, rel=1e-6)
        with pytest.raises(gs.UnitError, match="contradicts"):
            gs.read_design(tmp_path / "f.step", unit=gs.Unit.M)

    def test_edges_without_a_face_bound_a_minimal_surface(self, kernel, tmp_path):
        points = [tuple(1000.0 * p) for p in ring()]
        wire = kernel.Wire.make_polygon([kernel.Vector(*p) for p in points], close=True)
        kernel.export_step(wire, str(tmp_path / "w.step"))
        found = gs.read_design(tmp_path / "w.step", triangles=600)
        assert isinstance(found, gs.TriangulatedSurface)
        assert np.ptp(found.vertices[:, 0]) == pytest.approx(4000.0, rel=1e-3)

    def test_a_solid_is_refused(self, kernel, tmp_path):
        kernel.export_step(kernel.Box(10, 10, 10), str(tmp_path / "b.step"))
        with pytest.raises(gs.NotOnePatchError):
            gs.read_design(tmp_path / "b.step")

    def test_a_brep_file_needs_a_unit(self, kernel, tmp_path):
        kernel.export_brep(kernel.Face.make_rect(2, 1), str(tmp_path / "f.brep"))
        with pytest.raises(gs.UnitError, match="states no unit"):
            gs.read_design(tmp_path / "f.brep")
        found = gs.read_design(tmp_path / "f.brep", unit=gs.Unit.M)
        assert found.area == pytest.approx(2e6, rel=1e-6)
