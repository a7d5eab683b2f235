import csv
import json
import re
from dataclasses import replace
from types import SimpleNamespace

import ezdxf
import numpy as np
import pytest
from pypdf import PdfReader

import fabrication as fab
import gridshell as gs
from fabrication import lamella_system, package, routes
from fabrication.cut import area
from fabrication.errors import KernelError, OutputError, StockError
from fabrication.finding import Finding, Severity
from fabrication.words import number
from gridshell.mesh import grid_quads

pytestmark = [pytest.mark.xdist_group("kernel"), pytest.mark.usefixtures("kernel_here")]

SMALL = {
    "name": "small",
    "surface": {"kind": "hypar", "scale": 6000.0},
    "patch": {"layout": "asymptotic", "p": (-0.2, 0.2), "q": (-0.2, 0.2), "lamellas": (3, 3)},
    "net": {"anchor": "free"},
    "profile": {"width": 100.0, "thickness": 2.5, "material": "stainless"},
    "joint": {"kind": "slot"},
    "sheet": {"length": 4000.0, "width": 350.0},
}
FILES = {
    *["net.json", "net.obj", "structure.step", "parts.csv"],
    *["report.json", "report.html", "report.pdf"],
    *["assembly.csv", "bays.csv", "bill.csv", "drawings.pdf"],
    *["sheets/sheet-01.dxf", "sheets/sheet-02.dxf"],
}


def project(**sections):
    """SMALL with other sections; a section that is None is left out."""
    merged = {**SMALL, **sections}
    return fab.Project.model_validate({k: v for k, v in merged.items() if v is not None})


def content(folder):
    """Every file below *folder* with its bytes."""
    return {
        path.relative_to(folder).as_posix(): path.read_bytes()
        for path in folder.rglob("*")
        if path.is_file()
    }


@pytest.fixture(scope="module")
def earlier(tmp_path_factory):
    """A folder with what an earlier run, and a person, left there."""
    out = tmp_path_factory.mktemp("package") / "out"
    (out / "sheets").mkdir(parents=True)
    for name in ("sheets/sheet-01.dxf", "sheets/sheet-07.dxf", "report.json", "parts.csv"):
        (out / name).write_text("old")
    for name in ("order.txt", "sheets/offcuts.txt", "photos/site.jpg"):
        (out / name).parent.mkdir(exist_ok=True)
        (out / name).write_text("mine")
    return out


@pytest.fixture(scope="module")
def done(earlier, kernel_here):
    """The folder after a run, what the run returned, and the stages it announced."""
    stages = []
    report = fab.run(project(), earlier, announce=stages.append)
    return earlier, report, stages


# ---- what is written ------------------------------------------------------------------------


def test_every_file_of_the_package_is_there(done):
    out, _, _ = done
    mine = {"order.txt", "sheets/offcuts.txt", "photos/site.jpg"}
    assert set(content(out)) - mine == FILES


def test_no_file_of_an_earlier_run_is_left(done):
    out, _, _ = done
    assert b"old" not in content(out).values()
    assert not (out / "sheets" / "sheet-07.dxf").exists()


@pytest.mark.parametrize("name", ["order.txt", "photos/site.jpg", "sheets/offcuts.txt"])
def test_files_that_are_not_ours_stay(done, name):
    assert (done[0] / name).read_text() == "mine"


def test_nothing_is_left_beside_the_folder(done):
    out, _, _ = done
    assert [path.name for path in out.parent.iterdir()] == [out.name]


def test_the_report_on_disk_is_what_the_run_returned(done):
    out, report, _ = done
    assert json.loads((out / "report.json").read_text()) == report


def test_the_report_on_paper_holds_the_figures_of_the_one_on_disk(done):
    out, report, _ = done
    text = "\n".join(page.extract_text() for page in PdfReader(out / "report.pdf").pages)
    built, net = report["structure"], report["net"]
    for value in (
        f"{built['total_length_m']:.1f} m",
        f"{number(built['mass_kg'])} kg",
        f"{net['node_angle_deg']['min']:.2f} to {net['node_angle_deg']['max']:.2f}",
        report["stress"]["utilisation"]["where"],
        report["closure"]["worst"],
    ):
        assert value in text
    assert f"{built['lamellas']} lamellas, {built['nodes']} nodes" in text
    assert "Utilisation of the strength, by bay" in text


KEYS = {
    "net": {
        *["kind", "vertices", "faces", "iterations", "seconds", "angle_error_deg"],
        *["star_planarity", "edge_ratio", "surface_distance_mm"],
    },
    "structure": {"lamellas", "nodes"},
    "closure": {"max_mm"},
    "fit": {"clash_mm3", "nodes"},
}


@pytest.mark.parametrize("section", KEYS)
def test_the_report_has_the_agreed_keys(done, section):
    assert KEYS[section] <= set(done[1][section])


@pytest.mark.parametrize(
    ("section", "key", "inside"),
    [
        ("net", "star_planarity", {"max", "mean"}),
        ("net", "surface_distance_mm", {"max", "mean"}),
        ("net", "edge_ratio", {"min", "max"}),
        ("fit", "clash_mm3", {"max"}),
    ],
)
def test_figures_of_the_report_have_the_agreed_parts(done, section, key, inside):
    assert inside <= set(done[1][section][key])


def test_the_report_counts_what_is_built(done):
    out, report, _ = done
    control = gs.read_net(out / "net.json")
    assert (report["structure"]["lamellas"], report["structure"]["nodes"]) == (6, 9)
    assert report["net"]["faces"] == len(control.quads)
    assert report["net"]["vertices"] == len(control.vertices)
    assert (report["name"], report["net"]["kind"]) == ("small", "asymptotic")


def test_a_good_project_has_no_findings_and_closes(done):
    _, report, _ = done
    assert report["findings"] == []
    assert report["closure"]["max_mm"] < routes.CLOSURE_LIMIT
    assert report["closure"]["volume_ppm"] < routes.VOLUME_LIMIT
    assert report["fit"]["clash_mm3"]["max"] < lamella_system.CLASH_LIMIT
    assert report["fit"]["nodes"] == 9


def test_every_stage_is_announced_once_and_timed(done):
    _, report, stages = done
    assert list(report["timing"]) == stages
    assert len(set(stages)) == len(stages) > 5
    assert min(report["timing"].values()) >= 0.0


def test_the_sum_of_lengths_and_masses_is_that_of_the_cut_list(done):
    out, report, _ = done
    rows = list(csv.DictReader((out / "parts.csv").read_text().splitlines()))
    assert [row["mark"] for row in rows] == ["A1", "A2", "A3", "B1", "B2", "B3"]
    metres = sum(float(row["length_mm"]) for row in rows) / 1000.0
    assert report["structure"]["total_length_m"] == pytest.approx(metres, abs=1e-3)
    kilograms = sum(float(row["mass_kg"]) for row in rows)
    assert report["structure"]["mass_kg"] == pytest.approx(kilograms, abs=0.01)
    assert {int(row["sheet"]) for row in rows} == {1, 2}
    assert report["structure"]["sheets"] == 2


def test_the_net_as_obj_is_the_net_as_json(done):
    out, _, _ = done
    control, mesh = gs.read_net(out / "net.json"), gs.read_obj(out / "net.obj", unit=gs.Unit.MM)
    np.testing.assert_array_equal(mesh.vertices, control.vertices)
    np.testing.assert_array_equal(np.sort(mesh.quads), np.sort(control.quads))


def test_sheets_and_assembly_hold_every_lamella(done):
    out, _, _ = done
    drawn = [part.mark for path in (out / "sheets").glob("*.dxf") for part in fab.read_dxf(path)]
    bent = [part.mark for part in fab.read_step(out / "structure.step")]
    assert sorted(drawn) == sorted(bent) == ["A1", "A2", "A3", "B1", "B2", "B3"]


# ---- other projects -------------------------------------------------------------------------


@pytest.fixture(scope="module")
def special(tmp_path_factory, kernel_here):
    """A folder made with every setting other than the usual one."""
    out = tmp_path_factory.mktemp("special") / "out"
    own = {"name": "corten", "modulus": 210e3, "strength": 355.0, "density": 1000.0}
    fab.run(
        project(
            patch={**SMALL["patch"], "lamellas": (2, 2)},
            profile={"width": 60.0, "thickness": 2.0, "material": own, "overhang": 25.0},
            joint={"kind": "slot", "clearance": 1.0, "depth_clearance": 3.0},
            sheet={"length": 3500.0, "width": 500.0, "margin": 40.0, "gap": 20.0},
        ),
        out,
    )
    (sheet,) = (out / "sheets").iterdir()
    row = next(csv.DictReader((out / "parts.csv").read_text().splitlines()))
    return out, row, fab.read_dxf(sheet)[0].outline


def test_a_profile_of_one_s_own_is_used(special):
    _, row, outline = special
    assert (row["material"], row["width_mm"], row["thickness_mm"]) == ("corten", "60", "2")
    assert float(row["mass_kg"]) == pytest.approx(area(outline) * 2.0 * 1000.0e-9, abs=1e-3)


def test_an_overhang_of_one_s_own_is_used(special):
    out, row, _ = special
    net = gs.diagonal_meshes(gs.read_net(out / "net.json"))[0]
    axis = np.linalg.norm(net.vertices[1] - net.vertices[0])
    assert float(row["length_mm"]) == pytest.approx(axis + 50.0, abs=1.0)


def test_clearances_of_one_s_own_are_used(special):
    _, row, outline = special
    assert float(row["slot_width_min_mm"]) == pytest.approx(3.0, abs=0.1)
    floors = np.unique(outline[(outline[:, 1] > 0.0) & (outline[:, 1] < 60.0), 1])
    assert floors == pytest.approx([27.0])


def test_a_sheet_of_one_s_own_is_used(special):
    document = ezdxf.readfile(next((special[0] / "sheets").iterdir()))
    parts = [np.array(e.get_points("xy")) for e in document.query('LWPOLYLINE[layer=="CUT"]')]
    assert [part[0, 1] for part in parts] == pytest.approx([40.0 + 80.0 * row for row in range(4)])
    assert {part[0, 0] for part in parts} == {40.0}


def test_a_bad_design_is_still_built_and_its_findings_are_in_the_report(tmp_path):
    weak = {"name": "weak", "modulus": 200e3, "strength": 10.0, "density": 7900.0}
    profile = {"width": 100.0, "thickness": 2.5, "material": weak}
    report = fab.run(project(profile=profile), tmp_path)
    found = report["findings"]
    assert {(f["code"], f["severity"]) for f in found} == {("twist", "error"), ("stress", "error")}
    for code in ("twist", "stress"):
        told = [f["where"] for f in found if f["code"] == code]
        assert told == ["A1", "A2", "A3", "B1", "B2", "B3"]
    assert set(found[0]) >= {"code", "severity", "where", "value", "limit", "message"}
    assert set(content(tmp_path)) == FILES


def test_the_other_skin_is_built_of_the_other_half_of_the_net(tmp_path):
    report = fab.run(project(net={"anchor": "free", "skin": "D2"}), tmp_path)
    control = gs.read_net(tmp_path / "net.json")
    assert report["structure"]["nodes"] == np.count_nonzero(control.colour == 1)
    assert report["findings"] == []


def test_files_that_do_not_close_are_findings_of_severity_error():
    closed = {"worst": "A1 at N1", "max_mm": 0.06, "volume_ppm": 21.0}
    fit = fab.Fit(max_mm3=0.002, worst="N3", nodes=9)
    found = lamella_system.lamella_loop_findings(closed, fit)
    assert [(f.code, f.where, f.value, f.limit) for f in found] == [
        ("closure", "A1 at N1", 0.06, 0.05),
        ("volume", "all", 21.0, 20.0),
        ("clash", "N3", 0.002, 0.001),
    ]
    assert {f.severity for f in found} == {fab.Severity.ERROR}


def test_a_small_mass_keeps_its_digits(tmp_path):
    tiny = {"width": 4.0, "thickness": 0.2, "material": "stainless"}
    report = fab.run(project(surface={"kind": "hypar", "scale": 100.0}, profile=tiny), tmp_path)
    control = gs.read_net(tmp_path / "net.json")
    structure = fab.structure(gs.diagonal_meshes(control)[0], fab.Profile(4.0, 0.2, fab.STAINLESS))
    areas = [part.area for part in fab.flat_parts(structure, fab.SlotJoint())]
    kilograms = sum(areas) * 0.2 * 7900.0e-9
    assert kilograms < 0.01
    assert report["structure"]["mass_kg"] == pytest.approx(kilograms, rel=1e-5)


@pytest.fixture
def refusing(monkeypatch):
    """Let the CAD kernel refuse a lamella, or fail at all."""

    def build(where):
        class Refusing:
            def __init__(self, folder):
                pass

            def order(self, *args, **kwargs):
                pass

            def result(self):
                raise KernelError("Refused", where=where, value="1", limit="2", advice="none")

            def end(self):
                pass

        monkeypatch.setattr("fabrication.kernel_job.Kernel", Refusing)

    return build


def test_a_lamella_the_kernel_refuses_is_told_with_what_the_checks_found(fails, refusing):
    refusing("A1")
    weak = {"name": "weak", "modulus": 200e3, "strength": 10.0, "density": 7900.0}
    error = fails(project(profile={**SMALL["profile"], "material": weak}), KernelError)
    assert (error.what, error.where, error.value, error.limit) == ("Refused", "A1", "1", "2")
    assert re.search(r"A1 N\d+-N\d+ twists by", error.advice)
    assert "A2" not in error.advice


def test_a_lamella_the_kernel_refuses_without_a_finding_is_told_with_its_slots(fails, refusing):
    refusing("B2")
    error = fails(project(), KernelError)
    distance = float(error.advice.split("slots are ")[1].split(" mm")[0])
    assert distance == pytest.approx(1200.0, abs=100.0)
    assert "no error" in error.advice


def test_a_kernel_that_fails_at_all_keeps_its_words(fails, refusing):
    refusing(None)
    assert fails(project(), KernelError).advice == "none"


class AskedError(Exception):
    """Stops a run where the net would be optimised, with what is asked of it."""


@pytest.fixture
def asked(monkeypatch, tmp_path):
    """What the [net] of a project asks of the optimisation: recipe, anchor and reference."""

    def stop(control, recipe, *, anchor, reference=None, progress=None, workspace=None):
        raise AskedError(recipe, anchor, reference)

    monkeypatch.setattr(gs, "optimize", stop)

    def build(**net):
        with pytest.raises(AskedError) as info:
            fab.run(project(net={"anchor": "free", **net}), tmp_path / "out")
        return info.value.args

    return build


@pytest.mark.parametrize(
    ("name", "anchor"),
    [
        ("free", gs.Free()),
        ("boundary-pinned", gs.BoundaryPinned()),
        ("boundary-glide", gs.BoundaryGlide()),
    ],
)
def test_the_anchor_is_the_one_that_is_named(asked, name, anchor):
    assert asked(anchor=name)[1] == anchor


def test_the_recipe_has_the_project_s_angle_steps_and_tolerance(asked):
    recipe, _, _ = asked(angle=60.0, steps=12, tolerance=1e-7)
    wanted = gs.a_net(angle=np.pi / 3.0, steps=12, tolerance=1e-7)
    assert vars(recipe) == vars(wanted)


@pytest.mark.parametrize(("keep", "reference"), [(True, gs.Hypar(6000.0)), (False, None)])
def test_the_surface_is_kept_to_unless_it_must_give_way(asked, keep, reference):
    assert asked(keep_to_surface=keep)[2] == reference


def test_the_angle_that_is_asked_for_is_built(tmp_path):
    net = {"anchor": "free", "angle": 60.0, "keep_to_surface": False}
    enneper = {"kind": "enneper", "scale": 4000.0}
    report = fab.run(project(net=net, surface=enneper), tmp_path)
    assert report["net"]["angle_error_deg"]["max"] < 1e-4
    assert report["net"]["node_angle_deg"] == pytest.approx({"min": 60.0, "max": 60.0}, abs=1e-4)
    at_joints = report["structure"]["joint_angle_deg"]
    assert 58.0 < at_joints["min"] < 60.0 < at_joints["max"] < 62.0
    assert report["net"]["surface_distance_mm"]["max"] > 100.0
    assert "off-surface" not in {finding["code"] for finding in report["findings"]}


def test_a_net_that_leaves_the_surface_it_shall_keep_to_is_a_finding(tmp_path):
    net = {"anchor": "free", "angle": 75.0, "keep_to_surface": True, "steps": 60}
    enneper = {"kind": "enneper", "scale": 4000.0}
    report = fab.run(project(net=net, surface=enneper), tmp_path)
    (found,) = (f for f in report["findings"] if f["code"] == "off-surface")
    assert found["value"] == report["net"]["surface_distance_mm"]["max"]
    assert found["value"] > found["limit"] > 0.0
    assert found["severity"] == "warning"


def test_a_mesh_that_does_not_carry_the_net_is_refused_and_not_flattened(tmp_path):
    """A saddle whose edges are asymptotic, taken by its diagonals with a free boundary."""
    x, y = np.meshgrid(np.linspace(-4, 4, 13), np.linspace(-4, 4, 13), indexing="ij")
    points = np.stack([x, y, x * y / 8.0], axis=-1).reshape(-1, 3) * 1e3
    in_metres(tmp_path / "roof.obj", gs.QuadMesh(points, grid_quads(12, 12)))
    mesh = {"file": "roof.obj", "unit": "m", "lamellas_along": "diagonals"}
    net = {"anchor": "free", "keep_to_surface": False}
    with pytest.raises(gs.SolveError, match="does not carry this net"):
        fab.run(
            project(surface=None, patch=None, mesh=mesh, net=net), tmp_path / "out", folder=tmp_path
        )
    assert not (tmp_path / "out").exists()


def test_a_mesh_is_its_own_surface_to_keep_to(tmp_path):
    patch = gs.BisectingPatch(v=(-0.3, 0.3), cells=8, u=(0.0, 0.6))
    control = gs.control_patch(gs.Catenoid(4000.0), patch)
    in_metres(tmp_path / "roof.obj", control.mesh)
    report = fab.run(from_mesh("diagonals"), tmp_path / "out", folder=tmp_path)
    assert report["net"]["surface_distance_mm"]["max"] < 20.0


# ---- nets from files ------------------------------------------------------------------------


def in_metres(path, mesh):
    gs.write_obj(path, mesh, unit=gs.Unit.M)


def from_mesh(along, name="roof.obj"):
    mesh = {"file": name, "unit": "m", "lamellas_along": along}
    return project(surface=None, patch=None, mesh=mesh)


def test_edges_of_an_exact_hypar_become_straight_lamellas(tmp_path):
    surface, p = gs.Hypar(6000.0), np.linspace(-0.2, 0.2, 7)
    p, q = np.meshgrid(p, p, indexing="ij")
    points = surface.asymptotic_point(p.ravel(), q.ravel())
    in_metres(tmp_path / "roof.obj", gs.QuadMesh(points, grid_quads(6, 6)))
    report = fab.run(from_mesh("edges"), tmp_path / "out", folder=tmp_path)
    assert report["findings"] == []
    assert report["net"]["surface_distance_mm"]["max"] < 1e-6
    assert report["structure"]["max_edgewise_mm"] < 1e-6
    assert report["structure"]["total_length_m"] > 10.0


@pytest.mark.parametrize("suffix", ["3dm", "json"])
def test_a_mesh_of_rhino_or_compas_gives_the_shell_of_the_same_obj(suffix, in_program, tmp_path):
    surface, p = gs.Hypar(6000.0), np.linspace(-0.2, 0.2, 5)
    p, q = np.meshgrid(p, p, indexing="ij")
    mesh = gs.QuadMesh(surface.asymptotic_point(p.ravel(), q.ravel()), grid_quads(4, 4))
    in_metres(tmp_path / "roof.obj", mesh)
    in_program(tmp_path / f"roof.{suffix}", mesh)
    truth = fab.run(from_mesh("edges"), tmp_path / "truth", folder=tmp_path)
    report = fab.run(from_mesh("edges", f"roof.{suffix}"), tmp_path / "out", folder=tmp_path)
    assert report["structure"] == truth["structure"]
    one, other = (gs.read_net(tmp_path / name / "net.json") for name in ("out", "truth"))
    assert np.abs(one.vertices - other.vertices).max() < 1e-9
    assert one.quads.tolist() == other.quads.tolist()


@pytest.mark.parametrize(("suffix", "key"), [("3dm", "mm"), ("json", None)])
def test_a_unit_that_is_wrong_or_missing_names_its_key(suffix, key, in_program, fails, tmp_path):
    mesh = gs.QuadMesh([[0, 0, 0], [1e3, 0, 0], [1e3, 1e3, 0], [0, 1e3, 50]], [[0, 1, 2, 3]])
    in_program(tmp_path / f"roof.{suffix}", mesh)
    source = {"file": f"roof.{suffix}", "unit": key, "lamellas_along": "edges"}
    error = fails(project(surface=None, patch=None, mesh=source), gs.UnitError)
    assert error.where.startswith("mesh.unit: ")


def test_diagonals_of_an_exact_catenoid_become_lamellas(tmp_path):
    patch = gs.BisectingPatch(v=(-0.4, 0.4), cells=6, u=(0.0, 0.8))
    in_metres(tmp_path / "roof.obj", gs.control_patch(gs.Catenoid(4000.0), patch).mesh)
    report = fab.run(from_mesh("diagonals"), tmp_path / "out", folder=tmp_path)
    assert report["structure"]["lamellas"] >= 6
    assert report["closure"]["max_mm"] < 0.05
    assert report["fit"]["clash_mm3"]["max"] < 1e-3
    longest = max(fab.read_dxf(tmp_path / "out/sheets/sheet-01.dxf"), key=lambda p: p.outline.max())
    assert 2e3 < longest.outline.max() < 6e3


def test_a_surface_from_a_file_becomes_lamellas_and_tells_how(tmp_path):
    x, y = np.meshgrid(*[np.linspace(-1.5, 1.5, 25)] * 2, indexing="ij")
    points = np.stack([x, y, 0.2 * (x * x - y * y)], axis=-1).reshape(-1, 3) * 1e3
    in_metres(tmp_path / "roof.obj", gs.QuadMesh(points, grid_quads(24, 24)))
    asked = project(
        surface={"file": "roof.obj", "unit": "m"},
        patch=None,
        remesh={"directions": "asymptotic", "quads": 120},
    )
    stages = []
    report = fab.run(asked, tmp_path / "out", folder=tmp_path, announce=stages.append)
    assert stages[:3] == ["surface", "remesh", "optimise"]
    assert list(report["timing"]) == stages
    assert {f["severity"] for f in report["findings"]} <= {"info"}
    assert report["remesh"]["quads"] > 60
    assert report["remesh"]["alignment_deg"]["mean"] < 1.0
    assert report["net"]["star_planarity"]["max"] < 1e-7
    assert report["net"]["surface_distance_mm"]["max"] < 5.0
    page = (tmp_path / "out" / "report.html").read_text()
    _, way = page.split("From the surface to the net")
    assert way[: way.index("<h2>Findings")].count("<figure>") == 6
    drawn = re.findall(r'<b class="code">([^<]+\.dxf)</b>', page)
    assert sorted(drawn) == sorted(path.name for path in (tmp_path / "out" / "sheets").iterdir())
    assert set(content(tmp_path / "out")) >= FILES - {"sheets/sheet-02.dxf"}


# ---- nets that cannot be built --------------------------------------------------------------


@pytest.fixture
def fails(tmp_path):
    """The error of a run that must leave nothing behind."""

    def build(content, kind):
        before = sorted(tmp_path.rglob("*"))
        with pytest.raises(kind) as info:
            fab.run(content, tmp_path / "out", folder=tmp_path)
        assert sorted(tmp_path.rglob("*")) == before
        return info.value

    return build


def lattice(height, count=7, step=500.0):
    i, j = np.meshgrid(np.arange(count), np.arange(count), indexing="ij")
    x, y = step * (i - count // 2), step * (j - count // 2)
    points = np.stack([x, y, height(x, y)], axis=-1).reshape(-1, 3)
    return gs.QuadMesh(points, grid_quads(count - 1, count - 1))


@pytest.mark.parametrize("along", ["edges", "diagonals"])
@pytest.mark.parametrize(
    "height",
    [lambda x, y: 0.0 * x, lambda x, y: np.sqrt(5000.0**2 - x**2 - y**2)],
    ids=["flat", "sphere"],
)
def test_a_mesh_that_is_not_saddle_shaped_is_refused(fails, tmp_path, height, along):
    in_metres(tmp_path / "roof.obj", lattice(height, count=13))
    error = fails(from_mesh(along), gs.NotHyperbolicError)
    assert error.where.startswith("vertex ")
    assert error.where.endswith("mm")


def test_a_sphere_is_refused_as_a_surface_too(fails):
    patch = {"layout": "bisecting", "u": (0.0, 0.5), "v": (-0.2, 0.2), "cells": 4}
    sphere = project(surface={"kind": "sphere", "radius": 5000.0}, patch=patch)
    assert "Gaussian curvature" in str(fails(sphere, gs.NotHyperbolicError))


def obj(path, points, faces):
    rows = ["v {} {} {}".format(*point) for point in points]
    rows += ["f " + " ".join(str(v + 1) for v in face) for face in faces]
    path.write_text("\n".join(rows) + "\n")


def test_a_vertex_of_odd_valence_is_named_with_its_position(fails, tmp_path):
    ring = np.pi * np.arange(10) / 5.0
    points = [(1.0, 2.0, 3.0), *((1 + np.cos(a), 2 + np.sin(a), 3.0) for a in ring)]
    faces = [(0, 1 + k, 1 + (k + 1) % 10, 1 + (k + 2) % 10) for k in range(0, 10, 2)]
    obj(tmp_path / "roof.obj", points, faces)
    error = fails(from_mesh("diagonals"), gs.OddValenceError)
    assert error.where == "vertex 0 (1000, 2000, 3000) mm"
    assert error.value == "valence 5"


def test_an_edge_of_three_quads_is_named_with_its_position(fails, tmp_path):
    points = [(0, 0, 0), (0, 2, 0)]
    points += [(x, y, z) for x, z in ((1, 0), (-1, 0), (0, 1)) for y in (0, 2)]
    faces = [(0, 1, 3, 2), (1, 0, 4, 5), (0, 1, 7, 6)]
    obj(tmp_path / "roof.obj", points, faces)
    error = fails(from_mesh("diagonals"), gs.NonManifoldError)
    assert error.where == "edge 0-1 (0, 1000, 0) mm, quads [0, 1, 2]"
    assert error.value == "3 quads"


def test_a_moebius_strip_is_named_with_a_quad_and_its_position(fails, tmp_path):
    n, half = 12, np.array([-0.5, 0.5])
    angle = 2.0 * np.pi * np.arange(n)[:, None] / n
    radius = 3.0 + half * np.cos(angle / 2.0)
    xyz = [radius * np.cos(angle), radius * np.sin(angle), half * np.sin(angle / 2.0)]
    faces = [(2 * k, 2 * k + 2, 2 * k + 3, 2 * k + 1) for k in range(n - 1)]
    faces.append((2 * n - 2, 1, 0, 2 * n - 1))
    obj(tmp_path / "roof.obj", np.stack(xyz, axis=-1).reshape(-1, 3), faces)
    error = fails(from_mesh("diagonals"), gs.OrientationError)
    assert error.where.startswith("quad ")
    assert error.where.endswith(" mm")


def test_a_mesh_file_that_is_missing_is_named(fails):
    assert "roof.obj" in fails(from_mesh("edges"), gs.FileError).where


def test_a_mesh_file_is_looked_for_beside_the_project(tmp_path, monkeypatch):
    """Not in the folder the command is run in."""
    (tmp_path / "project").mkdir()
    (tmp_path / "elsewhere").mkdir()
    in_metres(tmp_path / "project" / "roof.obj", lattice(lambda x, y: 0.0 * x))
    monkeypatch.chdir(tmp_path / "elsewhere")
    with pytest.raises(gs.NotHyperbolicError):
        fab.run(from_mesh("edges"), tmp_path / "out", folder=tmp_path / "project")


def test_an_overhang_shorter_than_half_a_slot_is_refused(fails):
    short = {**SMALL["profile"], "overhang": 1.0}
    assert "A1" in fails(project(profile=short), gs.SettingError).where


def test_a_net_that_is_not_found_is_an_error_that_says_how_far_it_came(fails):
    stuck = {"anchor": "boundary-pinned", "angle": 20.0, "steps": 1}
    assert "1 step" in str(fails(project(net=stuck), gs.SolveError))


# ---- folders --------------------------------------------------------------------------------

SHORT = {"length": 1000.0, "width": 350.0}


def test_a_strip_longer_than_the_sheet_leaves_the_folder_as_it_was(tmp_path):
    out = tmp_path / "out"
    (out / "sheets").mkdir(parents=True)
    for name in ("sheets/sheet-01.dxf", "report.json", "order.txt"):
        (out / name).write_text("old")
    before = content(tmp_path)
    with pytest.raises(StockError, match="too long") as info:
        fab.run(project(sheet=SHORT), out)
    assert info.value.where == "A1"
    assert content(tmp_path) == before
    assert [path.name for path in tmp_path.iterdir()] == ["out"]


def test_a_failure_leaves_no_new_folder(tmp_path):
    with pytest.raises(StockError):
        fab.run(project(sheet=SHORT), tmp_path / "out")
    assert list(tmp_path.iterdir()) == []


def test_a_failure_leaves_no_new_folders_above_it_either(tmp_path):
    with pytest.raises(StockError):
        fab.run(project(sheet=SHORT), tmp_path / "jobs" / "roof" / "out")
    assert list(tmp_path.iterdir()) == []


def test_a_failure_while_writing_leaves_nothing(tmp_path, monkeypatch):
    """The disk is full when the cut list is due."""

    def full(*args):
        raise OSError(28, "No space left on device")

    monkeypatch.setattr("fabrication.lamella_files.write_schedule", full)
    with pytest.raises(OSError, match="No space left"):
        fab.run(project(), tmp_path / "out")
    assert list(tmp_path.iterdir()) == []


def test_an_output_that_is_a_file_is_refused_and_kept(tmp_path):
    (tmp_path / "out").write_text("mine")
    with pytest.raises(OutputError, match="is a file") as info:
        fab.run(project(), tmp_path / "out")
    assert "out" in info.value.where
    assert content(tmp_path) == {"out": b"mine"}


def test_an_output_below_a_file_is_refused(tmp_path):
    (tmp_path / "jobs").write_text("mine")
    with pytest.raises(OutputError, match="cannot be written"):
        fab.run(project(), tmp_path / "jobs" / "out")
    assert content(tmp_path) == {"jobs": b"mine"}


@pytest.mark.parametrize("name", ["out", "out/sheets"])
def test_an_output_that_is_refused_costs_no_work(tmp_path, name):
    (tmp_path / name).parent.mkdir(exist_ok=True)
    (tmp_path / name).write_text("mine")
    stages = []
    with pytest.raises(OutputError):
        fab.run(project(), tmp_path / "out", announce=stages.append)
    assert stages == []


def test_a_net_that_is_not_found_is_told_with_what_the_surface_does_not_allow():
    def require():
        raise gs.SolveError("Not converged", advice="more steps")

    result = SimpleNamespace(require=require)
    cause = Finding(
        "angle-infeasible", Severity.WARNING, "there", 0.4, 0.0, "", "no such pair on 40 %"
    )
    other = replace(cause, code="noise", message="noisy")
    begun = SimpleNamespace(remeshed=SimpleNamespace(findings=(other, cause)))
    with pytest.raises(gs.SolveError, match=r"does not allow: no such pair on 40 % \[there\]"):
        package._found(result, begun)
    for remeshed in (None, SimpleNamespace(findings=(other,))):
        with pytest.raises(gs.SolveError, match="more steps"):
            package._found(result, SimpleNamespace(remeshed=remeshed))
