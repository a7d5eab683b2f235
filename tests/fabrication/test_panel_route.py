import csv
import json
import subprocess
import sys
from pathlib import Path

import ezdxf
import numpy as np
import pytest

import fabrication as fab
import gridshell as gs
from fabrication import routes
from fabrication.errors import KernelError, StockError
from fabrication.panel_route import PanelRoute

pytestmark = [pytest.mark.xdist_group("kernel"), pytest.mark.usefixtures("kernel_here")]

SMALL = {
    "name": "small panels",
    "surface": {"kind": "hyperboloid", "radius": 2000.0, "height": 3000.0},
    "patch": {"layout": "conjugate", "v": (-0.4, 0.5), "panels": (8, 3)},
    "net": {"kind": "planar", "angle": 90.0, "anchor": "free"},
    "panels": {"thickness": 8.0, "gap": 12.0},
    "supports": {"below": -100.0, "thickness": 6.0},
    "connector": {"radius": 30.0},
    "sheet": {"length": 3000.0, "width": 2000.0},
}
BARE = {"supports": None, "connector": None}


def project(**sections):
    """SMALL with other sections; a section that is None is left out."""
    merged = {**SMALL, **sections}
    return fab.Project.model_validate({k: v for k, v in merged.items() if v is not None})


def names(folder):
    return {p.relative_to(folder).as_posix() for p in folder.rglob("*") if p.is_file()}


@pytest.fixture(scope="module")
def done(tmp_path_factory, kernel_here):
    out = tmp_path_factory.mktemp("panels") / "out"
    (out / "sheets").mkdir(parents=True)
    for old in ("sheet-01", "panels-77", "plates-99"):
        (out / "sheets" / f"{old}.dxf").write_text("old")
    stages = []
    return fab.run(project(), out, announce=stages.append), out, stages


@pytest.fixture(scope="module")
def rows(done):
    with (done[1] / "parts.csv").open(newline="") as file:
        return list(csv.DictReader(file))


def test_every_file_of_the_package_is_there_and_none_of_an_earlier_run(done):
    report, out, _ = done
    built = report["structure"]
    sheets = {f"sheets/panels-{n:02d}.dxf" for n in range(1, built["panel_sheets"] + 1)}
    sheets |= {f"sheets/plates-{n:02d}.dxf" for n in range(1, built["plate_sheets"] + 1)}
    whole = {"net.json", "net.obj", "parts.csv", "structure.step"}
    whole |= {"report.html", "report.json", "report.pdf"}
    assert names(out) == whole | sheets


def test_the_stages_are_told_in_order(done):
    stages = ["start mesh", "optimise", "structure", "parts", "sheets", "solids", "closure"]
    assert done[2] == [*stages, "report"]
    assert list(done[0]["timing"]) == done[2]


def test_the_report_has_the_agreed_figures(done):
    report, out, _ = done
    assert json.loads((out / "report.json").read_text()) == report
    assert report["net"]["kind"] == "planar"
    assert report["net"]["face_planarity"]["max"] < 1e-9
    assert report["net"]["angle_error_deg"]["max"] < 1e-6
    built = report["structure"]
    assert (built["panels"], built["plates"], built["connectors"]) == (24, 56, 32)
    assert built["panel_groups"] == 3
    assert report["closure"]["max_mm"] < 1e-3 < routes.CLOSURE_LIMIT
    assert report["closure"]["volume_ppm"] < 1.0
    assert report["supports"]["out_of_plane_mm"]["max"] < 1e-6
    assert report["supports"]["twist_deg"]["max"] < 1e-6
    assert "classical_out_of_plane_mm" in report["supports"]
    assert report["findings"] == []


def test_the_cut_list_names_every_part_with_its_sheet(done, rows):
    report, out, _ = done
    assert [row["kind"] for row in rows] == ["panel"] * 24 + ["plate"] * 56 + ["connector"] * 32
    for row in rows:
        assert row["sheet"] == "" or (out / "sheets" / f"{row['sheet']}.dxf").is_file()
        assert row["quantity"] == "1"
    mass = sum(float(row["mass_kg"]) for row in rows)
    assert mass == pytest.approx(report["structure"]["mass_kg"], rel=1e-4)
    alike = {row["group"]: int(row["alike"]) for row in rows}
    assert sum(alike.values()) == len(rows)


def test_sheets_hold_what_the_cut_list_says(done, rows):
    _, out, _ = done
    lies = {row["mark"]: row for row in rows}
    seen = set()
    for path in (out / "sheets").iterdir():
        for part in fab.read_dxf(path):
            size = np.ptp(part.outline, axis=0)
            row = lies[part.mark]
            assert row["sheet"] == path.stem
            wanted = [float(row["length_mm"]), float(row["width_mm"])]
            assert size == pytest.approx(wanted, abs=0.01)
            seen.add(part.mark)
    assert seen == {row["mark"] for row in rows if row["sheet"]}


def test_every_sheet_has_closed_outlines_marks_and_says_how_many_are_alike(done):
    _, out, _ = done
    for path in (out / "sheets").iterdir():
        document = ezdxf.readfile(path)
        assert not document.audit().has_errors
        space = document.modelspace()
        assert all(entity.closed for entity in space.query('LWPOLYLINE[layer=="CUT"]'))
        assert len(space.query('LWPOLYLINE[layer=="MARK"]')) > 0
        texts = [entity.dxf.text for entity in space.query("TEXT")]
        assert any(t.startswith("small panels  |  sheet") for t in texts)
        assert any(t.startswith(("alike: ", "no two parts alike")) for t in texts)


def test_panels_alone_need_no_plates_and_have_no_figures_of_them(tmp_path):
    report = fab.run(project(**BARE), tmp_path / "out")
    assert "supports" not in report
    assert report["structure"]["plates"] == report["structure"]["connectors"] == 0
    assert not list((tmp_path / "out" / "sheets").glob("plates-*"))


def test_panels_may_come_from_another_sheet_than_plates(tmp_path):
    wide = {"length": 4000.0, "width": 3000.0}
    fab.run(project(panel_sheet=wide), tmp_path / "out")
    for name, size in (("panels", "4000 x 3000"), ("plates", "3000 x 2000")):
        document = ezdxf.readfile(tmp_path / "out" / "sheets" / f"{name}-01.dxf")
        texts = [entity.dxf.text for entity in document.modelspace().query("TEXT")]
        assert any(f"raw sheet {size} mm" in text for text in texts)


@pytest.mark.parametrize("skin", ["D2", "P"])
def test_the_other_skins_close_too(tmp_path, skin):
    report = fab.run(project(net={**SMALL["net"], "skin": skin}), tmp_path / "out")
    assert report["structure"]["panels"] == {"D2": 16, "P": 96}[skin]
    assert report["closure"]["max_mm"] < 1e-3
    assert report["findings"] == []


def test_plates_at_another_angle_are_findings_with_the_classical_figure_beside(tmp_path):
    changed = {
        "surface": {"kind": "enneper", "scale": 5000.0},
        "patch": {"layout": "conjugate", "u": (-0.3, 0.4), "v": (-0.35, 0.3), "panels": (4, 3)},
        "net": {"kind": "planar", "angle": 70.0, "anchor": "free", "keep_to_surface": False},
    }
    report = fab.run(project(**changed), tmp_path / "out")
    assert {f["code"] for f in report["findings"]} == {"support-twist"}
    assert report["net"]["angle_error_deg"]["max"] < 1e-6
    assert 0.1 < report["supports"]["out_of_plane_mm"]["max"] < 10.0
    assert report["closure"]["max_mm"] < 1e-3


def test_a_quad_mesh_from_a_file_is_a_planar_net(tmp_path):
    control = gs.control_patch(
        gs.Hyperboloid(2000.0, 3000.0), gs.ConjugatePatch(v=(-0.4, 0.5), panels=(8, 3))
    )
    gs.write_obj(tmp_path / "net.obj", control.mesh, unit=gs.Unit.M)
    mesh = {"file": "net.obj", "unit": "m", "panels_along": "diagonals"}
    report = fab.run(
        project(surface=None, patch=None, mesh=mesh), tmp_path / "out", folder=tmp_path
    )
    assert report["structure"]["panels"] in (16, 24)
    assert report["closure"]["max_mm"] < 1e-3


@pytest.mark.parametrize(
    ("sections", "kind", "where"),
    [
        ({"panels": {"thickness": 8.0, "gap": 3000.0}}, gs.SettingError, "panel P1"),
        ({"sheet": {"length": 900.0, "width": 900.0}}, StockError, "P"),
        (
            {"supports": {"below": -100.0, "thickness": 6.0, "setback": 2000.0}},
            gs.SettingError,
            "S",
        ),
    ],
    ids=["gap", "sheet", "setback"],
)
def test_what_cannot_be_made_is_named_and_leaves_nothing(tmp_path, sections, kind, where):
    with pytest.raises(kind) as info:
        fab.run(project(**sections), tmp_path / "out")
    assert where in info.value.where
    assert list(tmp_path.iterdir()) == []


def test_crowded_connectors_are_findings_and_are_built_all_the_same(tmp_path):
    report = fab.run(project(connector={"radius": 16.0, "depth": 10.0}), tmp_path / "out")
    crowded = [f for f in report["findings"] if f["code"] == "connector-crowded"]
    assert crowded
    assert {f["severity"] for f in crowded} == {"error"}
    assert (tmp_path / "out" / "structure.step").is_file()


def test_slots_that_run_into_each_other_are_told_with_the_finding(tmp_path):
    with pytest.raises(KernelError) as info:
        fab.run(project(connector={"radius": 16.0, "depth": 14.0}), tmp_path / "out")
    assert info.value.where.startswith("N")
    assert "Use a radius of" in info.value.advice
    assert list(tmp_path.iterdir()) == []


# ---- the command ----------------------------------------------------------------------------

TEXT = """
name = "small panels"
[surface]
kind = "hyperboloid"
radius = 2000.0
height = 3000.0
[patch]
layout = "conjugate"
v = [-0.4, 0.5]
panels = [8, 3]
[net]
kind = "planar"
angle = 90.0
anchor = "free"
[panels]
thickness = 8.0
gap = {gap}
[sheet]
length = 3000.0
width = 2000.0
"""
ROOT = Path(__file__).parents[2]


def command(*arguments, cwd):
    code = "from fabrication.cli import main; main()"
    return subprocess.run(
        [sys.executable, "-c", code, *arguments],
        cwd=cwd,
        capture_output=True,
        text=True,
        check=False,
        env={"PYTHONPATH": str(ROOT), "PATH": "/usr/bin:/bin", "NO_COLOR": "1"},
    )


def test_the_command_says_what_it_built(tmp_path):
    (tmp_path / "p.toml").write_text(TEXT.format(gap=12.0))
    result = command("run", "p.toml", "--out", "out", cwd=tmp_path)
    assert result.returncode == 0, result.stderr
    assert "24 panels in 3 groups, " in result.stdout
    assert "node angles 90.00 to 90.00 degrees" in result.stdout


def test_the_command_ends_with_2_and_leaves_nothing(tmp_path):
    (tmp_path / "p.toml").write_text(TEXT.format(gap=5000.0))
    result = command("run", "p.toml", "--out", "out", cwd=tmp_path)
    assert result.returncode == 2
    assert "nothing sound left" in result.stderr
    assert "Traceback" not in result.stderr
    assert names(tmp_path) == {"p.toml"}


# ---- the recipe -----------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("anchor", "sections", "flat"),
    [
        ("free", {}, True),
        ("free", BARE, False),
        ("boundary-glide", {}, False),
        ("boundary-pinned", {}, False),
    ],
)
def test_the_rim_is_flat_where_it_is_free_and_carries_plates(anchor, sections, flat):
    content = project(net={**SMALL["net"], "anchor": anchor}, **sections)
    recipe = PanelRoute(content, content.panels).recipe(Path())
    assert [type(c) for c in recipe.conditions] == ([gs.FlatRim] if flat else [])


def test_the_recipe_has_the_project_s_conditions_steps_and_tolerance():
    net = {"kind": "planar", "anchor": "free", "square": True, "steps": 12, "tolerance": 1e-7}
    content = project(net=net)
    recipe = PanelRoute(content, content.panels).recipe(Path())
    assert (recipe.angle, recipe.rhombus) == (pytest.approx(np.pi / 2.0), True)
    assert (recipe.stop.steps, recipe.stop.tolerance) == (12, 1e-7)


# ---- torsion-free axes ----------------------------------------------------------------------

TURNED = {
    "surface": {"kind": "enneper", "scale": 5000.0},
    "patch": {"layout": "conjugate", "u": (-0.3, 0.4), "v": (-0.35, 0.3), "panels": (4, 3)},
    "net": {"kind": "planar", "angle": 70.0, "anchor": "free", "keep_to_surface": False},
    "supports": {**SMALL["supports"], "axes": "torsion-free"},
}


def test_torsion_free_axes_make_plates_flat_at_any_angle_and_tell_their_lean(tmp_path):
    report = fab.run(project(**TURNED), tmp_path / "out")
    assert report["supports"]["out_of_plane_mm"]["max"] < 1e-4
    assert 0.1 < report["supports"]["lean_deg"]["max"] < 30.0
    assert report["closure"]["max_mm"] < 1e-3
    assert report["findings"] == []
    assert "Lean of the axes" in (tmp_path / "out" / "report.html").read_text()


def test_axes_along_the_normals_have_no_lean_to_tell(done):
    assert "lean_deg" not in done[0]["supports"]
