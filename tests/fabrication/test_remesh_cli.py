import json
import sys

import numpy as np
import pytest

import gridshell as gs
from fabrication import cli
from gridshell.mesh import grid_quads

# ---- files ------------------------------------------------------------------------------------


def wave(x, y):
    return 0.35 * x * x - 0.3 * y * y + 0.06 * np.sin(1.3 * x + 0.7 * y)


def cap(x, y):
    return np.sqrt(4.0 - x * x - y * y)


def grid(height, size=(2.4, 2.0), count=24):
    """Vertices and triangles over z = height(x, y), m."""
    x, y = np.meshgrid(*(np.linspace(-s / 2, s / 2, count + 1) for s in size), indexing="ij")
    points = np.stack([x, y, height(x, y)], axis=-1).reshape(-1, 3)
    quads = grid_quads(count, count)
    return points, np.concatenate([quads[:, :3], quads[:, [0, 2, 3]]])


def obj(path, points, triangles=(), lines=()):
    rows = ["v {!r} {!r} {!r}".format(*map(float, point)) for point in points]
    rows += ["f " + " ".join(str(i + 1) for i in face) for face in np.asarray(triangles).tolist()]
    rows += ["l " + " ".join(str(i + 1) for i in line) for line in lines]
    path.write_text("\n".join(rows) + "\n")


@pytest.fixture
def command(capsys, monkeypatch, tmp_path):
    """Run ``gridshell remesh`` in a folder of its own: exit code, output, errors."""
    monkeypatch.chdir(tmp_path)
    obj(tmp_path / "s.obj", *grid(wave))

    def run(*arguments):
        monkeypatch.setattr(sys, "argv", ["gridshell", "remesh", *map(str, arguments)])
        with pytest.raises(SystemExit) as info:
            cli.main()
        out, err = capsys.readouterr()
        return info.value.code or 0, out, err

    return run


USUAL = ("s.obj", "--unit", "m", "--directions", "asymptotic", "--quads", "150")


@pytest.fixture
def refused(command, tmp_path):
    """The message of a run that must end with 2 and leave nothing behind."""

    def run(*arguments):
        before = sorted(tmp_path.rglob("*"))
        outputs = ("-o", "m.obj", "--report", "r.json", "--control", "c.obj", "--pictures", "p")
        code, out, err = command(*arguments, *outputs)
        assert (code, out) == (2, "")
        assert err.count("\n") == 1
        assert err.startswith("gridshell: ")
        assert "Traceback" not in err
        assert sorted(tmp_path.rglob("*")) == before
        return err

    return run


# ---- what is written --------------------------------------------------------------------------


def test_a_mesh_its_control_mesh_a_report_and_pictures(command, tmp_path):
    options = ("-o", "m.obj", "--report", "r.json", "--control", "c.obj", "--pictures", "p")
    code, out, err = command(*USUAL, *options)
    assert (code, err) == (0, "")
    assert "quads" in out
    assert "written to m.obj" in out
    names = {path.name for path in tmp_path.iterdir()}
    assert names == {"s.obj", "m.obj", "r.json", "c.obj", "p"}
    pictures = ["a-surface", "b-directions", "c-quad-mesh-m", "d-control-mesh-c", "e-alignment"]
    assert {path.name for path in (tmp_path / "p").iterdir()} == {
        "stages.html",
        *(f"{name}.svg" for name in pictures),
    }
    mesh = gs.read_obj(tmp_path / "m.obj", unit=gs.Unit.M)
    control = gs.read_obj(tmp_path / "c.obj", unit=gs.Unit.M)
    report = json.loads((tmp_path / "r.json").read_text())
    laid = report["remesh"]
    assert laid["quads"] == len(mesh.quads)
    assert laid["control_quads"] == len(control.quads)
    assert (laid["non_quads"], laid["odd_valences"], laid["colour_conflicts"]) == (0, 0, 0)
    assert set(laid["alignment_deg"]) == {"mean", "p95", "max"}
    assert laid["alignment_deg"]["mean"] < 1.0
    assert laid["coverage"] > 0.9
    assert laid["infeasible_area"] == 0.0
    assert laid["seconds"] > 0.0
    assert laid["singularities"] == []
    assert laid["findings"] == report["findings"]
    assert abs(laid["quads"] - 150) < 40
    foot = gs.read_surface(tmp_path / "s.obj", unit=gs.Unit.M).closest(mesh.vertices)
    inside = np.linalg.norm(foot.points - mesh.vertices, axis=1)
    assert np.median(inside) < 1.0


def test_the_same_command_writes_the_same_bytes(command, tmp_path):
    kept = []
    for _ in range(2):
        assert command(*USUAL, "-o", "m.obj", "--report", "r.json")[0] == 0
        report = json.loads((tmp_path / "r.json").read_text())
        del report["seconds"], report["remesh"]["seconds"]
        kept.append(((tmp_path / "m.obj").read_bytes(), json.dumps(report)))
    assert kept[0] == kept[1]


def test_the_unit_is_that_of_the_file_and_changes_nothing_else(command, tmp_path):
    points, triangles = grid(wave)
    obj(tmp_path / "mm.obj", 1000.0 * points, triangles)
    assert command(*USUAL, "-o", "m.obj")[0] == 0
    options = ("--directions", "asymptotic", "--quads", "150", "-o", "n.obj")
    assert command("mm.obj", "--unit", "mm", *options)[0] == 0
    here = gs.read_obj(tmp_path / "m.obj", unit=gs.Unit.M)
    there = gs.read_obj(tmp_path / "n.obj", unit=gs.Unit.MM)
    np.testing.assert_array_equal(here.quads, there.quads)
    np.testing.assert_allclose(here.vertices, there.vertices, atol=1e-3)
    assert np.ptp(here.vertices[:, 0]) > 1000.0


def test_the_length_of_the_edges_is_in_the_unit_of_the_file(command, tmp_path):
    options = ("--directions", "principal", "--edge", "0.2", "-o", "m.obj", "--report", "r.json")
    assert command("s.obj", "--unit", "m", *options)[0] == 0
    assert json.loads((tmp_path / "r.json").read_text())["remesh"]["spacing_mm"] == 200.0


@pytest.mark.parametrize("extent", ["inside", "cover", "trimmed"])
def test_the_mesh_goes_as_far_as_it_is_told(command, tmp_path, extent):
    code, _, _ = command(*USUAL, "--extent", extent, "-o", "m.obj", "--report", "r.json")
    assert code == 0
    found = json.loads((tmp_path / "r.json").read_text())["remesh"]["coverage"]
    assert found < 0.95 if extent == "inside" else found > 0.93


def test_the_two_hands_are_two_meshes_at_one_angle(command, tmp_path):
    meshes = []
    for hand in ("left", "right"):
        options = ("--directions", "conjugate", "--angle", "60", "--hand", hand, "--quads", "150")
        code, _, _ = command("s.obj", "--unit", "m", *options, "-o", "m.obj", "--report", "r.json")
        assert code == 0
        laid = json.loads((tmp_path / "r.json").read_text())["remesh"]
        assert laid["hand"] == hand
        assert laid["angle_deg"][1] == pytest.approx(60.0, abs=0.1)
        meshes.append(gs.read_obj(tmp_path / "m.obj", unit=gs.Unit.M))
    left, right = meshes
    assert left.vertices.shape != right.vertices.shape or not np.allclose(
        left.vertices, right.vertices, atol=10.0
    )


def test_a_right_angle_gives_the_principal_directions(command, tmp_path):
    options = ("--quads", "150", "-o", "m.obj", "-q")
    assert command("s.obj", "--unit", "m", "--directions", "principal", *options)[0] == 0
    principal = (tmp_path / "m.obj").read_bytes()
    conjugate = ("--directions", "conjugate", "--angle", "90")
    assert command("s.obj", "--unit", "m", *conjugate, *options) == (0, "", "")
    here = gs.read_obj(tmp_path / "m.obj", unit=gs.Unit.M)
    (tmp_path / "p.obj").write_bytes(principal)
    there = gs.read_obj(tmp_path / "p.obj", unit=gs.Unit.M)
    np.testing.assert_allclose(here.vertices, there.vertices, atol=1e-3)


def test_a_boundary_curve_alone_gives_its_minimal_surface(command, tmp_path):
    t = 2.0 * np.pi * np.arange(60) / 60
    loop = np.stack([3.0 * np.cos(t), 2.5 * np.sin(t), 0.7 * np.cos(2 * t)], axis=1)
    np.savetxt(tmp_path / "rim.csv", loop, delimiter=",", fmt="%.6f")
    options = ("--directions", "asymptotic", "--quads", "120", "-o", "m.obj", "--report", "r.json")
    code, _, err = command("rim.csv", "--unit", "m", *options)
    assert (code, err) == (0, "")
    laid = json.loads((tmp_path / "r.json").read_text())["remesh"]
    assert laid["angle_deg"] == pytest.approx([90.0, 90.0, 90.0], abs=1.5)


def test_a_mesh_that_is_not_good_is_written_with_exit_code_1(command, tmp_path, monkeypatch):
    import fabrication.remesh_job as job
    from fabrication.finding import Finding, Severity

    bad = Finding("non-quads", Severity.ERROR, "a hole", 1.0, 0.0, "faces", "One is no quad.")
    monkeypatch.setattr(job, "check_quads", lambda made, extent: [bad])
    code, out, _ = command(*USUAL, "-o", "m.obj", "--report", "r.json")
    assert code == 1
    assert "error non-quads: One is no quad. [a hole]" in out
    (found,) = json.loads((tmp_path / "r.json").read_text())["findings"]
    assert (found["code"], found["severity"], found["where"]) == ("non-quads", "error", "a hole")
    assert (tmp_path / "m.obj").exists()
    assert "non-quads" in command(*USUAL, "-o", "m.obj", "--quiet")[2]


# ---- guide lines ------------------------------------------------------------------------------


@pytest.fixture
def sphere(tmp_path):
    obj(tmp_path / "cap.obj", *grid(cap))
    x = np.linspace(-1.0, 1.0, 21)
    line = np.stack([x, 0.3 * x, cap(x, 0.3 * x)], axis=1)
    np.savetxt(tmp_path / "line.xyz", line)
    return ("cap.obj", "--unit", "m", "--directions", "principal", "--quads", "100")


@pytest.mark.parametrize(("suffix", "family"), [("", 1), (":1", 1), (":2", 2)])
def test_a_guide_leads_where_the_surface_does_not(command, sphere, tmp_path, suffix, family):
    code, _, err = command(*sphere, "--guide", f"line.xyz{suffix}", "-o", "m.obj")
    assert (code, err) == (0, "")
    mesh = gs.read_obj(tmp_path / "m.obj", unit=gs.Unit.M)
    middle = np.argmin(np.linalg.norm(mesh.vertices[mesh.quads].mean(axis=1)[:, :2], axis=1))
    a, b, c, _ = mesh.vertices[mesh.quads[middle]]
    along = ((b - a) if family == 1 else (c - b))[:2]
    turned = np.degrees(np.arctan2(along[1], along[0]) - np.arctan2(0.3, 1.0))
    assert abs((turned + 90.0) % 180.0 - 90.0) < 6.0


def test_without_a_guide_a_sphere_is_refused_with_its_place(refused, sphere):
    err = refused(*sphere)
    assert "bends alike in all directions" in err
    assert "at triangle" in err
    assert "Try: draw guide lines" in err


def test_a_guide_that_is_elsewhere_is_refused(refused, sphere, tmp_path):
    (tmp_path / "far.csv").write_text("0,0,9\n1,0,9\n")
    assert "does not lie on the surface (at far.csv, point" in refused(
        *sphere, "--guide", "far.csv"
    )


def test_guides_do_not_lead_asymptotic_directions(refused, tmp_path):
    (tmp_path / "line.csv").write_text("0,0,0\n1,0,0.35\n")
    assert "at --guide" in refused(*USUAL, "--guide", "line.csv")


def test_a_guide_file_that_is_missing_is_named(refused, sphere):
    assert "no.csv" in refused(*sphere, "--guide", "no.csv:2")


# ---- wrong usage ------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("options", "words"),
    [
        (["--directions", "principal", "--angle", "60"], "Only conjugate directions take --angle"),
        (["--directions", "asymptotic", "--hand", "left"], "take --hand"),
        (["--directions", "principal", "--infeasible", "clamp"], "take --infeasible"),
        (["--directions", "conjugate"], "need an angle (at --angle"),
        (["--directions", "conjugate", "--angle", "180"], "between 0 and 180"),
        (["--directions", "conjugate", "--angle", "nan"], "between 0 and 180"),
        (["--directions", "principal", "--quads", "9", "--edge", "1"], "given once"),
        (["--directions", "principal", "--quads", "0"], "at --quads; found 0"),
        (["--directions", "principal", "--quads", "1000000"], "at --quads; found 1000000"),
        (["--directions", "principal", "--edge", "0"], "at --edge; found 0"),
        (["--directions", "principal", "--edge", "1e-4"], "too many quads (at --edge"),
    ],
)
def test_settings_that_do_not_go_together_name_their_option(refused, options, words):
    assert words in refused("s.obj", "--unit", "m", *options)


def test_a_unit_that_is_forgotten_is_asked_for(refused):
    err = refused("s.obj", "--directions", "asymptotic")
    assert "states no unit (at s.obj; allowed: mm, cm, m, inch, foot)" in err
    assert "add --unit" in err


def test_a_unit_that_is_unknown_is_named(refused):
    assert "'yard'" in refused("s.obj", "--unit", "yard", "--directions", "asymptotic")


@pytest.mark.parametrize("out", [".", "no/m.obj"])
def test_a_place_that_cannot_be_written_costs_no_work(command, tmp_path, out, monkeypatch):
    monkeypatch.setattr(gs, "read_design", None)
    code, _, err = command(*USUAL, "-o", out)
    assert (code, err.count("\n")) == (2, 1)
    assert [path.name for path in tmp_path.iterdir()] == ["s.obj"]


def test_one_place_for_two_files_is_refused(command):
    code, _, err = command(*USUAL, "-o", "m.obj", "--control", "m.obj")
    assert code == 2
    assert "one name" in err


def test_a_report_that_cannot_be_written_leaves_no_mesh(command, tmp_path, monkeypatch):
    def full(text):
        def write(path):
            path.write_text("half")
            raise OSError(28, "No space left on device")

        return write

    monkeypatch.setattr("fabrication.remesh_job.text_file", full)
    code, _, err = command(*USUAL, "-o", "m.obj", "--report", "r.json")
    assert code == 2
    assert "No space left" in err
    assert [path.name for path in tmp_path.iterdir()] == ["s.obj"]


def test_an_interrupt_writes_nothing(command, tmp_path, monkeypatch):
    def stop(*args):
        raise KeyboardInterrupt

    monkeypatch.setattr("fabrication.remesh_job.remesh", stop)
    code, _, err = command(*USUAL, "-o", "m.obj", "--pictures", "p")
    assert (code, err) == (130, "gridshell: Interrupted. Nothing was written.\n")
    assert [path.name for path in tmp_path.iterdir()] == ["s.obj"]


# ---- surfaces that cannot be used -------------------------------------------------------------

CASES = {}


def case(words):
    def keep(make):
        CASES[make.__name__] = make, words
        return make

    return keep


@case("no two asymptotic directions (at triangle")
def dome(path):
    obj(path, *grid(lambda x, y: -0.2 * x * x - 0.3 * y * y))


@case("no curvature")
def plane(path):
    obj(path, *grid(lambda x, y: 0.0 * x))


@case("pieces")
def two_pieces(path):
    points, triangles = grid(wave, count=8)
    obj(path, np.concatenate([points, points + 9.0]), np.concatenate([triangles, triangles + 81]))


@case("A vertex is not finite (at vertex 40")
def not_a_number(path):
    points, triangles = grid(wave, count=8)
    points[40, 2] = np.nan
    obj(path, points, triangles)


@case("A triangle has no area (at triangle")
def no_area(path):
    points, triangles = grid(wave, count=8)
    points[41] = (points[40] + points[42]) / 2.0
    points[[31, 32]] = points[40], points[42]
    obj(path, points, triangles)


@case("more than two triangles (at edge")
def three_at_an_edge(path):
    points, triangles = grid(wave, count=8)
    i, j = triangles[30, :2]
    fin = points[i] + [0.0, 0.1, 0.4]
    obj(path, np.concatenate([points, [fin]]), np.concatenate([triangles, [[i, j, 81]]]))


@case("cuts through itself")
def crossing(path):
    points, triangles = grid(wave, count=16)
    t, y = points[:, 0] * 1.5, points[:, 1]
    obj(path, np.stack([t**3 - 1.5 * t, y + 0.1 * t, t * t], axis=1), triangles)


@case("no faces")
def points_only(path):
    obj(path, grid(wave)[0])


@case("A curve is not closed")
def open_curve(path):
    obj(path, [(0, 0, 0), (1, 0, 0), (1, 1, 0.3), (0, 1, 0)], lines=[(0, 1, 2, 3)])


@case("cannot be read")
def rubbish(path):
    path.write_bytes(b"\x00\x01\x02 f 1")


@pytest.mark.parametrize("name", CASES)
def test_a_surface_that_cannot_be_used_is_told_by_name_and_place(refused, tmp_path, name):
    make, words = CASES[name]
    make(tmp_path / "bad.obj")
    err = refused("bad.obj", "--unit", "m", "--directions", "asymptotic", "--quads", "100")
    assert words in err


def test_a_doubled_face_is_mended_and_told(command, tmp_path):
    points, triangles = grid(wave)
    obj(tmp_path / "s.obj", points, np.concatenate([triangles, triangles[7:8]]))
    code, _, _ = command(*USUAL, "-o", "m.obj", "--report", "r.json")
    assert code == 0
    found = json.loads((tmp_path / "r.json").read_text())["findings"]
    assert {"doubled-triangles"} <= {finding["code"] for finding in found}
    assert all(finding["severity"] == "info" for finding in found)


def test_an_angle_the_surface_does_not_have_is_refused_where_that_is_asked(refused, tmp_path):
    dome(tmp_path / "dome.obj")
    options = ("--directions", "conjugate", "--angle", "30", "--infeasible", "refuse")
    err = refused("dome.obj", "--unit", "m", *options)
    assert "angle" in err
    assert "at triangle" in err


# ---- B-reps -----------------------------------------------------------------------------------


@pytest.mark.xdist_group("kernel")
def test_a_step_face_needs_no_unit_and_is_written_in_mm(command, tmp_path):
    build123d = pytest.importorskip("build123d")
    x, y = np.meshgrid(np.linspace(-1200, 1200, 6), np.linspace(-1000, 1000, 6), indexing="ij")
    z = 2.5e-4 * x * x - 3.0e-4 * y * y
    rows = [[tuple(p) for p in row] for row in np.stack([x, y, z], axis=-1).tolist()]
    face = build123d.Face.make_surface_from_array_of_points(
        [[build123d.Vector(*p) for p in row] for row in rows]
    )
    build123d.export_step(face, "s.step")
    options = ("--directions", "asymptotic", "--quads", "80", "-o", "m.obj", "--report", "r.json")
    code, _, err = command("s.step", *options)
    assert (code, err) == (0, "")
    mesh = gs.read_obj(tmp_path / "m.obj", unit=gs.Unit.MM)
    assert 1500.0 < np.ptp(mesh.vertices[:, 0]) < 3500.0
    assert json.loads((tmp_path / "r.json").read_text())["remesh"]["alignment_deg"]["mean"] < 0.5
    code, _, err = command("s.step", "--unit", "m", *options)
    assert code == 2
    assert "contradicts the file's own" in err


@pytest.mark.xdist_group("kernel")
def test_a_solid_is_no_surface(refused, tmp_path):
    build123d = pytest.importorskip("build123d")
    build123d.export_step(build123d.Box(1000, 800, 500), str(tmp_path / "box.step"))
    assert "solid" in refused("box.step", "--directions", "principal")
