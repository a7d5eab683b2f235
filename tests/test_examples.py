"""Every example runs and fails unless its own figures hold."""

import csv
import json
import os
import subprocess
import sys
from collections import Counter
from math import pi, radians, sqrt, tan
from pathlib import Path

import numpy as np
import pytest

import fabrication as fab
import gridshell as gs
from fabrication.loop import slot_centres

EXAMPLES = Path(__file__).parents[1] / "examples"
PROJECTS = sorted(EXAMPLES.glob("*.toml"))
PANELS = [path for path in PROJECTS if 'kind = "planar"' in path.read_text()]
LAMELLAS = [path for path in PROJECTS if path not in PANELS]
SCRIPTS = sorted(EXAMPLES.glob("*.py"))


@pytest.fixture(scope="session")
def packages(tmp_path_factory):
    cache = {}

    def package(name):
        if name not in cache:
            project = fab.read_project(EXAMPLES / f"{name}.toml")
            out = tmp_path_factory.mktemp(name)
            cache[name] = fab.run(project, out, folder=EXAMPLES), out
        return cache[name]

    return package


TOLD = {
    "13_timber_prototype": {"stud-assembly", "level-bend", "splice-stagger"},
    "17_plywood_workshop": {"angle-play"},
}
"""Findings that belong to a project; all others have none."""


@pytest.mark.parametrize("path", LAMELLAS, ids=lambda p: p.stem)
@pytest.mark.xdist_group("examples")
def test_project_gives_a_package_that_closes(path, packages):
    report, out = packages(path.stem)
    assert {f["code"] for f in report["findings"]} == TOLD.get(path.stem, set())
    assert not [f for f in report["findings"] if f["severity"] == "error"]
    assert report["stress"]["utilisation"]["max"] < 1.0
    assert report["closure"]["max_mm"] < 0.05
    assert report["closure"]["volume_ppm"] < 20.0
    assert report["fit"]["clash_mm3"]["max"] < 1e-3
    assert report["net"]["star_planarity"]["max"] < 1e-5
    assert report["net"]["edge_ratio"]["min"] > 0.5
    assert report["net"]["edge_ratio"]["max"] < 2.0
    written = json.loads((out / "report.json").read_text())
    assert written == json.loads(json.dumps(report))


@pytest.mark.parametrize("path", PANELS, ids=lambda p: p.stem)
@pytest.mark.xdist_group("examples")
def test_project_of_panels_gives_a_package_that_closes(path, packages):
    report, out = packages(path.stem)
    assert report["closure"]["max_mm"] < 0.05
    assert report["closure"]["volume_ppm"] < 20.0
    assert report["net"]["face_planarity"]["max"] < 1e-6
    assert report["net"]["angle_error_deg"]["max"] < 1e-3
    assert not [f for f in report["findings"] if f["severity"] == "error"]
    for kind in ("panels", "plates"):
        parts = [p for file in (out / "sheets").glob(f"{kind}-*") for p in fab.read_dxf(file)]
        assert len(parts) == report["structure"][kind]
    written = json.loads((out / "report.json").read_text())
    assert written == json.loads(json.dumps(report))


@pytest.mark.parametrize("name", ["09_tower_panels", "11_roof_panels"])
@pytest.mark.xdist_group("examples")
def test_support_plates_at_90_degrees_are_flat(name, packages):
    report, _ = packages(name)
    assert report["findings"] == []
    assert report["supports"]["out_of_plane_mm"]["max"] < 1e-4
    assert report["supports"]["flat"] == report["structure"]["plates"]


@pytest.mark.xdist_group("examples")
def test_panels_of_a_storey_are_equal_and_share_a_solid(packages):
    report, out = packages("09_tower_panels")
    assert report["structure"]["panels"] == 140
    assert report["structure"]["panel_groups"] == 7
    shapes = (out / "structure.step").read_text().count("MANIFOLD_SOLID_BREP(")
    assert shapes == report["structure"]["distinct_solids"] <= 30


@pytest.mark.xdist_group("examples")
def test_principal_plates_of_a_free_roof_beat_averaged_normals(packages):
    report, _ = packages("11_roof_panels")
    assert report["supports"]["classical_out_of_plane_mm"]["max"] > 0.5


@pytest.mark.xdist_group("examples")
def test_every_bay_of_the_glazed_net_has_two_triangles(packages):
    report, out = packages("12_glazed_enneper")
    assert report["facade"]["panels"] == 2 * 8 * 8
    assert report["facade"]["profiles"] == 8 * 8
    assert report["facade"]["closure_mm"]["max"] < 0.05
    assert (out / "facade.step").is_file()


@pytest.mark.xdist_group("examples")
def test_rhombi_at_70_degrees_cost_a_twist_that_is_told(packages):
    report, folder = packages("10_rhombus_panels_70")
    lines = (folder / "beams.csv").read_text().splitlines()
    assert len(lines) - 1 == report["structure"]["beams"] == report["structure"]["plates"]
    assert report["net"]["rhombus_error"]["max"] < 1e-6
    assert {f["code"] for f in report["findings"]} == {"support-twist"}
    assert 1.0 < report["supports"]["out_of_plane_mm"]["max"] < 4.0
    assert report["moulds"]["panels"] == report["structure"]["panels"]
    assert 1 < report["moulds"]["moulds"] < report["moulds"]["panels"]


@pytest.mark.parametrize(
    ("name", "degrees"), [("01_enneper_60", 60), ("02_enneper_75", 75), ("03_enneper_90", 90)]
)
@pytest.mark.xdist_group("examples")
def test_enneper_reaches_its_angle_and_the_paper_s_curvature_ratio(name, degrees, packages):
    report, _ = packages(name)
    assert report["net"]["angle_error_deg"]["max"] < 0.01
    assert report["net"]["iterations"] <= 30
    expected = -(tan(radians(degrees) / 2) ** 2)
    assert report["net"]["curvature_ratio"] == pytest.approx(expected, rel=0.02)


@pytest.mark.xdist_group("examples")
def test_catenoid_ring_is_an_annulus_of_equal_lamellas(packages):
    _, out = packages("04_catenoid_ring")
    control = gs.read_net(out / "net.json")
    assert control.mesh.euler_characteristic == 0
    net = gs.diagonal_meshes(control)[0]
    built = fab.structure(net, fab.Profile(100.0, 2.5, fab.STAINLESS))
    lengths = [lamella.axis.length for lamella in built.lamellas]
    height = abs(net.vertices[built.lamellas[0].nodes[[0, -1]], 2]).max() / 3000.0
    assert np.ptp(lengths) < 1e-3
    assert lengths[0] == pytest.approx(2 * 3000.0 * sqrt(2) * np.sinh(height), rel=1e-3)


@pytest.mark.xdist_group("examples")
def test_hypar_lamellas_are_straight_and_as_long_as_their_chords(packages):
    report, out = packages("05_hypar")
    net = gs.diagonal_meshes(gs.read_net(out / "net.json"))[0]
    built = fab.structure(net, fab.Profile(80.0, 2.0, fab.S235))
    for lamella in built.lamellas:
        ends = net.vertices[lamella.nodes[[0, -1]]]
        assert lamella.axis.length == pytest.approx(np.linalg.norm(ends[1] - ends[0]), abs=1e-6)
    assert report["structure"]["max_edgewise_mm"] < 1e-6
    assert report["net"]["iterations"] == 0


@pytest.mark.xdist_group("examples")
def test_a_step_face_becomes_lamellas_beside_it(packages):
    report, out = packages("07_roof_from_step")
    laid = report["remesh"]
    assert (laid["non_quads"], laid["odd_valences"], laid["colour_conflicts"]) == (0, 0, 0)
    assert laid["coverage"] > 0.95
    assert laid["alignment_deg"]["max"] < 1.0
    assert report["net"]["surface_distance_mm"]["mean"] < 1.0
    assert report["structure"]["lamellas"] > 15
    way = (out / "report.html").read_text().split("From the surface to the net")[1]
    assert way[: way.index("<h2>Findings")].count("<figure>") == 6
    assert list(report["timing"])[:2] == ["surface", "remesh"]


@pytest.mark.xdist_group("examples")
def test_a_boundary_curve_becomes_a_net_of_right_angles(packages):
    report, out = packages("08_boundary_curve")
    assert report["net"]["angle_error_deg"]["max"] < 1e-6
    assert report["net"]["surface_distance_mm"]["max"] < 20.0
    assert report["net"]["curvature_ratio"] == pytest.approx(-1.0, abs=0.02)
    rim = np.loadtxt(EXAMPLES / "rim.csv", delimiter=",", comments="#") * 1e3
    nodes = gs.read_net(out / "net.json").vertices
    assert (nodes.max(axis=0) < rim.max(axis=0) + 20.0).all()
    assert (np.ptp(nodes, axis=0) > 0.8 * np.ptp(rim, axis=0)).all()


@pytest.mark.parametrize("path", SCRIPTS, ids=lambda p: p.stem)
@pytest.mark.xdist_group("examples")
def test_script_runs_and_does_the_same_job_as_the_project(path, tmp_path, packages):
    assert len(path.read_text().splitlines()) < 40
    result = subprocess.run(
        [sys.executable, str(path), str(tmp_path)],
        capture_output=True,
        text=True,
        check=False,
        env={**os.environ, "PYTHONDONTWRITEBYTECODE": "1"},
    )
    assert result.returncode == 0, result.stderr
    assert "Converged" in result.stdout
    _, out = packages("01_enneper_60")
    with (out / "parts.csv").open(newline="") as file:
        longest = max(float(row["length_mm"]) for row in csv.DictReader(file))
    assert f"30 lamellas, longest {longest:.1f} mm" in result.stdout
    sheets = {path.name for path in (tmp_path / "sheets").glob("*.dxf")}
    assert sheets == {path.name for path in (out / "sheets").glob("*.dxf")}
    assert (tmp_path / "structure.step").stat().st_size > 1_000_000


def test_angles_of_the_hypar_are_those_of_its_rulings():
    scale = 6000.0
    control = gs.control_patch(
        gs.Hypar(scale), gs.AsymptoticPatch((-0.6, 0.6), (-0.6, 0.6), (9, 9))
    )
    net = gs.diagonal_meshes(control)[0]
    built = fab.structure(net, fab.Profile(80.0, 2.0, fab.S235))
    for node in built.nodes:
        x, y = node.position[:2] / scale
        cosine = x * y / sqrt((1 + x * x) * (1 + y * y))
        assert min(node.angle, pi - node.angle) == pytest.approx(np.arccos(abs(cosine)), abs=1e-9)


# ---- the paper's five built cases ---------------------------------------------------------------


@pytest.mark.xdist_group("examples")
def test_the_timber_prototype_has_two_levels_studs_and_blocks(packages):
    report, out = packages("13_timber_prototype")
    built = report["structure"]
    assert built["connectors"]["studs"] == built["nodes"] == 81
    assert built["connectors"]["shear blocks"] == 2 * 9 * 8
    assert report["closure"]["connectors"] == sum(built["connectors"].values())
    assert report["closure"]["holes"] > 2 * 2 * 81
    assert report["stock"]["bars"]["proven"]
    assert (out / "bars.csv").is_file()
    marks = {part.mark for file in (out / "sheets").glob("bar-*") for part in fab.read_dxf(file)}
    assert len(marks) == built["strips"]


@pytest.mark.xdist_group("examples")
def test_double_lamellas_are_two_different_strips(packages):
    report, out = packages("14_steel_double_lamellas")
    assert report["structure"]["strips"] == 2 * report["structure"]["lamellas"]
    assert report["closure"]["slots"] == 2 * report["structure"]["joints"]
    sheets = (out / "sheets").glob("sheet-*")
    flat = {part.mark: part for file in sheets for part in fab.read_dxf(file)}
    left, right = (np.diff(slot_centres(flat[f"A3{side}"].outline)) for side in "LR")
    assert np.abs(left - right).max() > 0.5
    with (out / "bill.csv").open() as file:
        bill = list(csv.DictReader(file))
    washers = [float(line["quantity"]) for line in bill if line["item"] == "star washer"]
    assert sum(washers) == 2.0 * 135.0
    assert len(washers) <= 2


@pytest.mark.xdist_group("examples")
def test_the_canopy_s_slots_vary_with_the_node_angle(packages):
    report, out = packages("15_stainless_canopy")
    angle = report["net"]["node_angle_deg"]
    assert (angle["min"], angle["max"]) == (
        pytest.approx(60.0, abs=1.0),
        pytest.approx(90.0, abs=0.2),  # a seam's width off the axes
    )
    with (out / "parts.csv").open() as file:
        rows = list(csv.DictReader(file))
    assert min(float(row["slot_width_min_mm"]) for row in rows) < 2.75
    assert max(float(row["slot_width_max_mm"]) for row in rows) > 4.2
    assert report["stock"]["bars"]["splices_not_staggered"] == 0
    assert report["segments"]["count"] == 4
    assert report["segments"]["identical_mm"] < 1e-6
    assert report["segments"]["seam_mm"]["min"] > 50.0
    assert {row["quantity"] for row in rows} == {"4"}
    drawn = Counter(p.mark for file in (out / "sheets").glob("bar-*") for p in fab.read_dxf(file))
    assert set(drawn.values()) == {4}
    assert len(drawn) == report["segments"]["distinct_parts"] == len(rows)
    assert sum(1 for _ in (out / "hanging.csv").open()) == 101


@pytest.mark.xdist_group("examples")
def test_the_umbrella_is_made_of_tubes_and_moves(packages):
    report, out = packages("18_umbrella")
    assert report["structure"]["connectors"]["bolts"] == report["structure"]["nodes"] == 144
    assert report["closure"]["holes"] == 2 * 144
    assert report["motion"]["positions"] == 60
    assert report["motion"]["edge_length_change"] < 1e-6
    assert report["motion"]["star_planarity"] < 1e-6
    assert report["motion"]["utilisation_max"] < 1.0
    for name in ("motion.csv", "motion.glb", "motion.html", "drillings.csv", "bars.csv"):
        assert (out / name).stat().st_size > 500


@pytest.mark.xdist_group("examples")
def test_the_metro_roof_is_made_of_pieces_between_strips_that_run_through(packages):
    report, _ = packages("16_metro_roof")
    built = report["structure"]
    assert built["strips"] == 12 + 12 * 11
    assert built["connectors"]["angle cleats"] == 2 * 2 * 12 * 11
    assert report["closure"]["ends"] >= 2 * 12 * 11
    assert report["facade"]["panels"] == 2 * 11 * 11


@pytest.mark.xdist_group("examples")
def test_the_workshop_gets_loose_slots_templates_and_a_flat_state(packages):
    report, out = packages("17_plywood_workshop")
    assert report["flat"]["possible"]
    assert report["flat"]["angle_deg"]["mean"] == pytest.approx(80.0, abs=0.1)
    for name in ("drawings.pdf", "templates.pdf", "labels.pdf", "flat.csv", "assembly.csv"):
        assert (out / name).stat().st_size > 500
    names = sorted(path.name for path in (out / "sheets").iterdir())
    assert names[0] == "coupon-plywood-workshop-6_mm-01.dxf"
    assert report["sheets"] == names
