import json
import sys

import numpy as np
import pytest

import gridshell as gs
from fabrication import cli
from gridshell.mesh import grid_quads


@pytest.fixture
def command(capsys, monkeypatch, tmp_path):
    """Run ``gridshell optimize`` in a folder of its own: exit code, output, errors."""
    monkeypatch.chdir(tmp_path)

    def run(*arguments):
        monkeypatch.setattr(sys, "argv", ["gridshell", "optimize", *map(str, arguments)])
        with pytest.raises(SystemExit) as info:
            cli.main()
        out, err = capsys.readouterr()
        return info.value.code or 0, out, err

    return run


@pytest.fixture
def mesh(tmp_path):
    """Write a mesh over z = height(x, y), in metres."""

    def write(height, m=8, n=8, noise=0.0):
        x, y = np.meshgrid(np.linspace(-1, 1, m + 1), np.linspace(-1, 1, n + 1), indexing="ij")
        points = np.stack([x, y, height(x, y)], axis=-1).reshape(-1, 3)
        points += noise * np.random.default_rng(2).normal(size=points.shape)
        found = gs.QuadMesh(1000.0 * points, grid_quads(m, n))
        gs.write_obj(tmp_path / "in.obj", found, unit=gs.Unit.M)
        return found

    return write


def saddle(x, y):
    return 0.4 * (x * x - y * y)


def wave(x, y):
    return 0.35 * np.sin(1.5 * x + 0.7 * y) * np.cos(1.1 * y) + 0.2 * x * y


def dome(x, y):
    return -0.3 * x * x - 0.2 * y * y


@pytest.mark.parametrize("suffix", ["3dm", "json"])
def test_a_net_of_rhino_or_compas_becomes_exact(command, mesh, suffix, in_program, tmp_path):
    start = mesh(saddle, noise=0.01)
    in_program(tmp_path / f"in.{suffix}", start)
    rest = ("--unit", "m", "--angle", 90, "--out")
    assert command(f"in.{suffix}", *rest, "a.obj")[0] == 0
    assert command("in.obj", *rest, "b.obj")[0] == 0
    a, b = (gs.read_obj(tmp_path / name, unit=gs.Unit.M) for name in ("a.obj", "b.obj"))
    assert a.quads.tolist() == b.quads.tolist()
    assert np.abs(a.vertices - b.vertices).max() < 1e-6


def test_a_noisy_net_becomes_exact_in_its_own_unit_and_numbering(command, mesh, tmp_path):
    start = mesh(saddle, noise=0.01)
    code, out, _ = command(
        "in.obj", "--unit", "m", "--angle", 90, "--out", "out.obj", "--report", "r.json"
    )
    assert code == 0
    assert "Converged in" in out
    found = gs.read_obj(tmp_path / "out.obj", unit=gs.Unit.M)
    np.testing.assert_array_equal(found.quads, start.quads)
    assert np.linalg.norm(found.vertices - start.vertices, axis=1).max() < 100.0
    report = json.loads((tmp_path / "r.json").read_text())
    assert report["net"]["kind"] == "asymptotic"
    assert report["net"]["angle_error_deg"]["max"] < 1e-5
    quality = gs.net_quality(gs.as_control_mesh(found), angle=np.pi / 2.0)
    assert quality.star_planarity.max == pytest.approx(
        report["net"]["star_planarity"]["max"], rel=1e-3
    )
    assert len(report["history"]) == report["net"]["iterations"]
    assert sorted(p.name for p in tmp_path.iterdir()) == ["in.obj", "out.obj", "r.json"]


@pytest.mark.parametrize(
    ("options", "figures"),
    [
        (["--net", "planar"], {"face_planarity"}),
        (["--net", "planar", "--on", "faces"], {"face_planarity"}),
        (["--net", "planar", "--rhombus", "--angle", "75"], {"face_planarity", "rhombus_error"}),
        (["--net", "planar", "--square"], {"face_planarity", "rhombus_error"}),
        (["--net", "symmetric"], {"sphericity"}),
        (["--net", "planar", "--mode", "form", "--angle", "80"], {"face_planarity"}),
        (["--net", "planar", "--portable"], {"face_planarity"}),
    ],
)
def test_other_nets_on_a_dome(command, mesh, tmp_path, options, figures):
    mesh(dome, noise=0.003)
    code, _, err = command("in.obj", "--unit", "m", *options, "-o", "o.obj", "--report", "r.json")
    assert code == 0, err
    net = json.loads((tmp_path / "r.json").read_text())["net"]
    assert figures <= set(net)
    assert all(net[key]["max"] < 1e-7 for key in figures)


def test_planar_stars_of_the_edges(command, mesh, tmp_path):
    mesh(lambda x, y: 0.5 * x * y, noise=0.005)
    options = ("--on", "edges", "--out", "o.obj", "--report", "r.json", "--quiet")
    code, out, err = command("in.obj", "--unit", "m", *options)
    assert (code, out, err) == (0, "", "")
    assert json.loads((tmp_path / "r.json").read_text())["net"]["star_planarity"]["max"] < 1e-7


def test_a_reference_keeps_it_near(command, mesh, tmp_path):
    start = mesh(saddle, noise=0.01)
    clean = start.moved(start.vertices * [1.0, 1.0, 0.0])
    x, y, _ = (start.vertices / 1000.0).T
    clean = clean.moved(np.stack([1000 * x, 1000 * y, 1000 * saddle(x, y)], axis=1))
    gs.write_obj(tmp_path / "s.obj", clean, unit=gs.Unit.M)
    options = ("--reference", "s.obj", "-o", "o.obj", "--report", "r.json")
    code, out, _ = command("in.obj", "--unit", "m", *options)
    assert code == 0
    assert "distance" in out
    distance = json.loads((tmp_path / "r.json").read_text())["net"]["surface_distance_mm"]
    assert distance["mean"] < 10.0


@pytest.mark.xdist_group("kernel")
def test_a_step_face_is_a_reference_in_its_own_unit(command, mesh, tmp_path):
    build123d = pytest.importorskip("build123d")
    x, y = np.meshgrid(*[np.linspace(-1.1, 1.1, 8)] * 2, indexing="ij")
    rows = 1000.0 * np.stack([x, y, saddle(x, y)], axis=-1)
    face = build123d.Face.make_surface_from_array_of_points(
        [[build123d.Vector(*p) for p in row] for row in rows.tolist()]
    )
    build123d.export_step(face, str(tmp_path / "s.step"))
    mesh(saddle, noise=0.005)
    options = ("--reference", "s.step", "-o", "o.obj", "--report", "r.json")
    code, _, err = command("in.obj", "--unit", "m", *options)
    assert code == 0, err
    distance = json.loads((tmp_path / "r.json").read_text())["net"]["surface_distance_mm"]
    assert distance["mean"] < 5.0


def test_a_field_of_two_angles(command, mesh, tmp_path):
    mesh(saddle, 12, 12)
    options = ("--mode", "form", "--angle", "90:80", "-o", "o.obj", "--report", "r.json")
    code, _, _ = command("in.obj", "--unit", "m", *options)
    net = json.loads((tmp_path / "r.json").read_text())["net"]
    assert code == 0
    assert net["node_angle_deg"]["max"] - net["node_angle_deg"]["min"] > 5.0
    assert net["angle_error_deg"]["max"] < 1e-4


def test_a_formula_is_met_where_the_net_ends(command, mesh, tmp_path):
    mesh(saddle, 12, 12)
    options = ("--mode", "form", "--angle", "85 + z / 100", "-o", "o.obj", "--report", "r.json")
    code, _, _ = command("in.obj", "--unit", "m", *options)
    assert code == 0
    found = gs.as_control_mesh(gs.read_obj(tmp_path / "o.obj", unit=gs.Unit.M))
    middle = found.vertices[found.quads].mean(axis=1)
    wanted = 85.0 + middle[:, 2] / 100.0
    angles = np.degrees(gs.node_angles(found))
    off = np.minimum(np.abs(angles - wanted), np.abs(180.0 - angles - wanted))
    assert off.max() < 1e-4


def test_bounds_and_near_rhombi(command, mesh, tmp_path):
    mesh(saddle, 12, 12)
    options = ("--angle-between", "84:88", "--near-rhombi", "-o", "o.obj", "--report", "r.json")
    code, _, _ = command("in.obj", "--unit", "m", "--mode", "form", *options)
    net = json.loads((tmp_path / "r.json").read_text())["net"]
    assert code == 0
    assert 84.0 - 1e-5 < net["node_angle_deg"]["min"] < net["node_angle_deg"]["max"] < 88.0 + 1e-5


@pytest.mark.parametrize(
    ("option", "value", "told"),
    [
        ("--angle", "90 + q * x", "'q'"),
        ("--angle", "90 + x +", "does not parse"),
        ("--angle", "x * 1e6", "range of node angles"),
        ("--angle-between", "60", "two angles"),
        ("--angle-between", "90:60", "nothing between"),
        ("--angle-between", "a:b", "cannot be used"),
    ],
)
def test_angles_that_cannot_be_used_end_with_2(command, mesh, tmp_path, option, value, told):
    mesh(saddle)
    code, _, err = command("in.obj", "--unit", "m", option, value, "-o", "o.obj")
    assert code == 2
    assert told in err
    assert not (tmp_path / "o.obj").exists()


def test_a_net_that_is_not_there_ends_with_1_and_says_why(command, mesh, tmp_path):
    mesh(saddle)
    options = ("--angle", "30", "--anchor", "boundary-pinned", "-o", "o.obj", "--report", "r.json")
    code, out, _ = command("in.obj", "--unit", "m", "--mode", "form", *options)
    assert code == 1
    net = json.loads((tmp_path / "r.json").read_text())["net"]
    assert not net["converged"]
    assert net["verdict"]["message"] in out
    assert net["collapsed_faces"] == 0
    assert (tmp_path / "o.obj").exists()


def test_an_exact_net_far_from_the_input_is_told(command, mesh, tmp_path):
    mesh(wave, m=36, n=40)
    options = ["in.obj", "--unit", "m", "--net", "planar", "--on", "faces", "-o", "o.obj"]
    options += ["--report", "r.json"]
    code, out, _ = command(*options)
    net = json.loads((tmp_path / "r.json").read_text())["net"]
    assert code == 0
    assert net["move_edges"]["mean"] > 0.5
    assert "No exact net was found near the input" in out
    command(*options, "--mode", "form")
    net = json.loads((tmp_path / "r.json").read_text())["net"]
    assert net["remarks"] == []


def test_a_stopped_solve_goes_on_to_the_same_net(command, mesh, tmp_path):
    mesh(saddle, noise=0.01)
    basis = ("in.obj", "--unit", "m", "--angle", "90")
    assert command(*basis, "-o", "whole.obj")[0] == 0
    assert command(*basis, "--steps", "3", "--state", "s.npz", "-o", "part.obj")[0] == 1
    assert command(*basis, "--resume", "s.npz", "-o", "rest.obj")[0] == 0
    whole, rest = (
        gs.read_obj(tmp_path / name, unit=gs.Unit.M) for name in ("whole.obj", "rest.obj")
    )
    np.testing.assert_allclose(rest.vertices, whole.vertices, atol=1e-6)


def test_verbose_prints_a_line_per_step(command, mesh):
    mesh(saddle, noise=0.01)
    _, out, _ = command("in.obj", "--unit", "m", "--verbose", "-o", "o.obj")
    assert "fairness" in out.splitlines()[1]


def test_the_paper_s_own_formulation_falls_into_a_plane_here_and_says_so(command, mesh, tmp_path):
    mesh(saddle, noise=0.01)
    code, _, _ = command(
        "in.obj", "--unit", "m", "--angle", "90", "--paper", "-o", "o.obj", "--report", "r.json"
    )
    assert code == 1
    net = json.loads((tmp_path / "r.json").read_text())["net"]
    assert net["iterations"] <= 10
    assert net["verdict"]["condition"] == "shape"


# ---- what cannot be used --------------------------------------------------------------------


@pytest.mark.parametrize(
    ("options", "words"),
    [
        (["--unit", "league"], ["Unknown unit", "league"]),
        (["--unit", "m", "--net", "planar", "--on", "edges"], ["--on", "faces, white"]),
        (["--unit", "m", "--angle", "200"], ["--angle", "200"]),
        (["--unit", "m", "--angle", "60:70:80"], ["--angle", "90:60"]),
        (["--unit", "m", "--angle", "steep"], ["--angle", "steep"]),
        (["--unit", "m", "--net", "planar", "--square", "--angle", "60"], ["contradict"]),
        (["--unit", "m", "--reference", "no.obj"], ["surface file is missing"]),
        (["--unit", "m", "--resume", "no.npz"], ["state cannot be read"]),
        (["--unit", "m", "--steps", "0"], ["At least one step"]),
        (["--unit", "m", "--tolerance", "-1"], ["tolerance must be positive"]),
        (["--unit", "m", "--threads", "0"], ["At least one thread"]),
    ],
)
def test_settings_that_cannot_be_used_end_with_2_and_write_nothing(
    command, mesh, tmp_path, options, words
):
    mesh(saddle)
    code, out, err = command("in.obj", *options, "-o", "o.obj", "--report", "r.json")
    assert code == 2
    assert out == ""
    assert all(word in err for word in words)
    assert "Traceback" not in err
    assert [p.name for p in tmp_path.iterdir()] == ["in.obj"]


@pytest.mark.parametrize(
    ("lines", "words"),
    [
        ("v 0 0 0\nv 1 0 0\nv 1 1 0\nf 1 2 3\n", ["not a quad", "3 corners"]),
        ("v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 nan 0\nf 1 2 3 4\n", ["not a number", "vertex 3"]),
        ("v 0 0 0\nv 1 0 0\nv .2 .2 0\nv 0 1 0\nf 1 2 3 4\n", ["concave", "quad 0"]),
        ("v 0 0 0\nv 1 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3 4\n", ["one place", "vertices 1 and 2"]),
    ],
)
def test_meshes_that_cannot_be_used_are_named(command, tmp_path, lines, words):
    (tmp_path / "in.obj").write_text(lines)
    code, _, err = command("in.obj", "--unit", "m", "-o", "o.obj")
    assert code == 2
    assert all(word in err for word in words)


def test_a_folder_that_is_not_there_is_named_and_nothing_is_left(command, mesh, tmp_path):
    mesh(saddle)
    code, _, err = command("in.obj", "--unit", "m", "-o", "no/o.obj")
    assert code == 2
    assert "no/o.obj" in err
    assert [p.name for p in tmp_path.iterdir()] == ["in.obj"]


def test_an_interrupt_keeps_the_last_step(command, mesh, tmp_path, monkeypatch):
    from gridshell.solve.levenberg_marquardt import _Run

    mesh(saddle, noise=0.01)
    step = _Run._step

    def interrupted(self):
        if len(self.steps) == 2:
            raise KeyboardInterrupt
        step(self)

    monkeypatch.setattr(_Run, "_step", interrupted)
    code, out, _ = command("in.obj", "--unit", "m", "--state", "s.npz", "-o", "o.obj")
    assert code == 130
    assert "Interrupted after 2 steps" in out
    assert gs.read_state(tmp_path / "s.npz").steps == 2
