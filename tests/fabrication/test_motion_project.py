"""From a project file to the files of a net that moves, and from supports to a form."""

import json
from pathlib import Path

import numpy as np
import pytest

import gridshell as gs
from fabrication.errors import ProjectError
from fabrication.package import optimised, route_of, run
from fabrication.project import read_project
from fabrication.starts import start

UMBRELLA = """
name = "small-umbrella"
[umbrella]
ribs = 8
radius = 900.0
bays = [750.0, 750.0, 700.0]
opening = 0.4
[net]
anchor = "free"
keep_to_surface = false
[profile]
width = 50.0
thickness = 4.0
material = "GRP"
[joint]
kind = "slot"
[motion]
positions = 5
smallest = 20.0
largest = 160.0
[sheet]
length = 6000.0
width = 1500.0
"""


@pytest.fixture
def written(tmp_path):
    def write(text):
        path = tmp_path / "p.toml"
        path.write_text(text)
        return path

    return write


def test_an_umbrella_becomes_a_package_that_moves(written, tmp_path):
    project = read_project(written(UMBRELLA))
    report = run(project, tmp_path / "out")
    out = tmp_path / "out"
    for name in ("motion.csv", "motion.glb", "motion.html", "structure.step", "drawings.pdf"):
        assert (out / name).stat().st_size > 0
    assert report["motion"]["positions"] == 5
    assert report["motion"]["edge_length_change"] < 1e-6
    assert report["closure"]["max_mm"] < 0.05
    assert report["net"]["star_planarity"]["max"] < 1e-12
    angles = np.degrees(gs.Umbrella(8, 900.0, (750.0, 750.0, 700.0)).position(0.4).node_angles)
    told = report["net"]["node_angle_deg"]
    assert (told["min"], told["max"]) == pytest.approx((angles.min(), angles.max()))
    without = UMBRELLA.replace("[motion]\npositions = 5\nsmallest = 20.0\nlargest = 160.0\n", "")
    run(read_project(written(without)), out)
    assert not list(Path(out).glob("motion.*"))


def test_a_ring_of_a_surface_of_revolution_moves_too(written, tmp_path):
    text = UMBRELLA.replace(
        "[umbrella]\nribs = 8\nradius = 900.0\nbays = [750.0, 750.0, 700.0]\nopening = 0.4\n",
        '[surface]\nkind = "catenoid"\nradius = 900.0\n'
        '[patch]\nlayout = "bisecting"\nv = [-0.7, 0.7]\ncells = 20\n',
    )
    report = run(read_project(written(text)), tmp_path / "out")
    assert report["motion"]["edge_length_change"] < 1e-6
    json.loads((tmp_path / "out" / "report.json").read_text())


def test_a_motion_is_not_asked_of_a_net_without_symmetry(written, tmp_path):
    text = UMBRELLA.replace(
        "[umbrella]\nribs = 8\nradius = 900.0\nbays = [750.0, 750.0, 700.0]\nopening = 0.4\n",
        '[surface]\nkind = "enneper"\nscale = 3000.0\n'
        '[patch]\nlayout = "asymptotic"\np = [-0.3, 0.3]\nq = [-0.3, 0.3]\nlamellas = [3, 3]\n',
    )
    with pytest.raises(gs.SettingError, match="not symmetric"):
        run(read_project(written(text)), tmp_path / "out")
    assert not (tmp_path / "out").exists()


@pytest.mark.parametrize(
    ("old", "new", "where", "told"),
    [
        ("opening = 0.4", "opening = 1.2", "umbrella.opening", "<= 1"),
        ("ribs = 8", "ribs = 2", "umbrella.ribs", ">= 3"),
        ("radius = 900.0", "radius = 9000.0", "umbrella.bays", "half a step"),
        ("bays = [750.0, 750.0, 700.0]", "bays = [750.0]", "umbrella.bays", "at least 2"),
        ("ribs = 8", "rips = 8", "umbrella.rips", "'ribs'"),
        ("positions = 5", "position = 5", "motion.position", "'positions'"),
        ("smallest = 20.0", "smallest = 0.0", "motion.smallest", "> 0"),
    ],
)
def test_umbrellas_that_cannot_be_name_the_key(written, old, new, where, told):
    with pytest.raises(ProjectError) as info:
        read_project(written(UMBRELLA.replace(old, new)))
    assert f", {where}" in str(info.value)
    assert told in str(info.value)


def test_a_cable_or_limits_that_cannot_be_are_told_before_a_file_is_written(written, tmp_path):
    for new, where in (("cable = [0, 3]", "motion.cable"), ("largest = 30.0", "smallest, largest")):
        old = "largest = 160.0" if "largest" in new else "positions = 5"
        with pytest.raises(gs.SettingError) as info:
            run(read_project(written(UMBRELLA.replace(old, new))), tmp_path / "out")
        assert where in str(info.value)
        assert info.value.advice
    assert not (tmp_path / "out").exists()


def test_a_form_is_found_from_supports(written, tmp_path):
    corners = [[1700.0, 0.0, 50.0], [-850.0, 1472.0, 50.0], [-850.0, -1472.0, 50.0]]
    text = UMBRELLA.split("[umbrella]")[0] + (
        '[surface]\nkind = "enneper"\nscale = 3000.0\n'
        '[patch]\nlayout = "singular"\nvalence = 6\ncells = 5\nreach = 0.5\n'
        f'[net]\nangle = 80.0\nanchor = "supports"\nsupports = {corners}\nkeep_to_surface = false\n'
        "[profile]" + UMBRELLA.split("[profile]")[1].split("[motion]")[0] + "[sheet]"
        + UMBRELLA.split("[sheet]")[1]
    )  # fmt: skip
    project = read_project(written(text))
    from contextlib import nullcontext

    begun = start(project, tmp_path, lambda name: nullcontext())
    found = optimised(project, route_of(project).recipe(tmp_path), begun).require().control
    gaps = np.linalg.norm(np.array(corners)[:, None] - found.vertices[None], axis=2).min(axis=1)
    assert gaps.max() < 1e-6
    assert np.degrees(np.abs(gs.node_angles(found) - np.radians(80.0))).max() < 1e-5
