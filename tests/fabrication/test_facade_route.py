import csv
from dataclasses import replace

import numpy as np
import pytest

import fabrication as fab
import gridshell as gs
from fabrication.export.step_prism_reader import read_prisms
from fabrication.facade_route import facade_findings
from fabrication.panel_loop import PanelClosure

pytestmark = [pytest.mark.xdist_group("kernel"), pytest.mark.usefixtures("kernel_here")]

SMALL = {
    "name": "glazed",
    "surface": {"kind": "hypar", "scale": 6000.0},
    "patch": {"layout": "asymptotic", "p": (-0.2, 0.2), "q": (-0.2, 0.2), "lamellas": (3, 4)},
    "net": {"anchor": "free"},
    "profile": {"width": 100.0, "thickness": 2.5, "material": "stainless"},
    "joint": {"kind": "slot"},
    "facade": {"thickness": 6.0, "gap": 10.0},
    "sheet": {"length": 4000.0, "width": 1000.0},
}


@pytest.fixture(scope="module")
def done(tmp_path_factory, kernel_here):
    out = tmp_path_factory.mktemp("glazed") / "out"
    return fab.run(fab.Project.model_validate(SMALL), out), out


def test_two_panels_and_a_profile_fill_every_bay(done):
    report, _ = done
    glass = report["facade"]
    assert (glass["panels"], glass["profiles"]) == (12, 6)
    assert glass["height_mm"] == 50.0
    assert glass["closure_mm"]["max"] < 1e-3
    assert glass["volume_ppm"] < 1.0
    assert report["findings"] == []


def test_the_glass_lies_on_the_strips_upper_edges(done):
    _, out = done
    net = gs.diagonal_meshes(gs.read_net(out / "net.json"))[0]
    profile = fab.Profile(100.0, 2.5, fab.STAINLESS)
    nodes = fab.structure(net, profile).nodes
    edge = np.array([node.position + 50.0 * node.axis for node in nodes])
    for prism in read_prisms(out / "facade.step"):
        apart = np.linalg.norm(prism.low[:, None] - edge[None], axis=2).min(axis=1)
        assert apart.max() < 40.0
        assert len(prism.low) == 3


def test_sheets_and_cut_list_hold_panels_and_profiles(done):
    report, out = done
    drawn = [p.mark for path in (out / "sheets").glob("panels-*") for p in fab.read_dxf(path)]
    assert sorted(drawn) == sorted(f"P{n}" for n in range(1, 13))
    with (out / "parts.csv").open(newline="") as file:
        rows = list(csv.DictReader(file))
    panels = [row for row in rows if row["mark"].startswith("P")]
    profiles = [row for row in rows if row["mark"].startswith("T")]
    assert (len(panels), len(profiles)) == (12, 6)
    mass = sum(float(row["mass_kg"]) for row in panels)
    assert mass == pytest.approx(report["facade"]["mass_kg"], rel=1e-4)
    metres = sum(float(row["length_mm"]) for row in profiles) / 1e3
    assert metres == pytest.approx(report["facade"]["profile_length_m"], abs=1e-3)
    assert profiles[0]["mark"] == "T1 (P1/P2)"


def test_the_page_shows_the_panels(done):
    page = (done[1] / "report.html").read_text()
    assert "Triangular panels" in page
    assert '"name": "Panels"' in page


def test_a_run_without_the_facade_takes_its_files_away(tmp_path):
    out = tmp_path / "out"
    fab.run(fab.Project.model_validate(SMALL), out)
    bare = {key: value for key, value in SMALL.items() if key != "facade"}
    report = fab.run(fab.Project.model_validate(bare), out)
    assert "facade" not in report
    assert not (out / "facade.step").exists()
    assert not list((out / "sheets").glob("panels-*"))


def test_a_gap_that_leaves_nothing_is_named_and_leaves_nothing(tmp_path):
    wide = {**SMALL, "facade": {"thickness": 6.0, "gap": 2000.0}}
    with pytest.raises(gs.SettingError) as info:
        fab.run(fab.Project.model_validate(wide), tmp_path / "out")
    assert "panel P1" in info.value.where
    assert list(tmp_path.iterdir()) == []


def test_panels_that_do_not_close_are_errors():
    good = PanelClosure(0.0, 0.0, 0.0, "P1", 0.0, 1, 0, 0)
    assert facade_findings(good) == []
    bad = replace(good, max_mm=0.1, volume_ppm=30.0)
    assert [f.code for f in facade_findings(bad)] == ["facade-closure", "facade-volume"]
