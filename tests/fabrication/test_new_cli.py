"""What ``gridshell new`` writes is a project; those without a file of one's own run as they are."""

import shutil
import sys
from pathlib import Path

import pytest

import gridshell as gs
from fabrication import cli
from fabrication.package import run
from fabrication.project import read_project
from fabrication.starting_points import STARTING_POINTS

EXAMPLES = Path(__file__).parents[2] / "examples"
OWN_FILE = {"surface", "panels", "mesh"}


@pytest.fixture
def command(capsys, monkeypatch, tmp_path):
    monkeypatch.chdir(tmp_path)

    def call(*arguments):
        monkeypatch.setattr(sys, "argv", ["gridshell", "new", *map(str, arguments)])
        with pytest.raises(SystemExit) as info:
            cli.main()
        out, err = capsys.readouterr()
        return info.value.code or 0, out, err

    return call


def test_without_a_name_all_starting_points_are_listed(command):
    code, out, _ = command()
    assert code == 0
    for name, about in STARTING_POINTS.items():
        assert name in out
        assert about in out


@pytest.mark.parametrize("name", sorted(set(STARTING_POINTS) - OWN_FILE))
def test_a_starting_point_runs_without_findings_of_severity_error(command, tmp_path, name):
    code, out, _ = command(name, "--out", "my roof.toml")
    assert code == 0
    assert "gridshell run my roof.toml" in out
    project = read_project(tmp_path / "my roof.toml")
    assert project.name == "my roof"
    report = run(project, tmp_path / "out")
    assert [f for f in report["findings"] if f["severity"] != "info"] == []
    assert report["closure"]["max_mm"] < 0.05


def test_a_starting_point_with_a_surface_of_ones_own(command, tmp_path):
    shutil.copy(EXAMPLES / "roof.step", tmp_path / "surface.step")
    for name in ("surface", "panels"):
        assert command(name)[0] == 0
        assert read_project(tmp_path / f"{name}.toml").name == name


def test_a_starting_point_with_a_mesh_drawn_elsewhere(command, tmp_path):
    patch = gs.AsymptoticPatch(p=(-0.6, 0.6), q=(-0.6, 0.6), lamellas=(8, 8))
    net = gs.diagonal_meshes(gs.control_patch(gs.Hypar(4000.0), patch))[0]
    drawn = gs.quads_of(net)
    drawn = drawn.moved(drawn.vertices.round(-1))  # to the centimetre
    gs.write_obj(tmp_path / "net.obj", drawn, unit=gs.Unit.named("m"))
    assert command("mesh")[0] == 0
    report = run(read_project(tmp_path / "mesh.toml"), tmp_path / "out", folder=tmp_path)
    assert report["net"]["star_planarity"]["max"] < 1e-6
    assert not [f for f in report["findings"] if f["severity"] == "error"]


def test_no_file_is_overwritten(command, tmp_path):
    (tmp_path / "strips.toml").write_text("mine")
    code, _, err = command("strips")
    assert code == 2
    assert "there already" in err
    assert (tmp_path / "strips.toml").read_text() == "mine"


def test_another_name_is_told_with_the_nearest(command):
    code, _, err = command("umbrela")
    assert code == 2
    assert "umbrella" in err


def test_every_line_explains_itself(command, tmp_path):
    for name in STARTING_POINTS:
        command(name)
        text = (tmp_path / f"{name}.toml").read_text()
        assert text.startswith("# ")
        assert sum("#" in line for line in text.splitlines()) >= 5


def test_a_folder_that_is_not_there_is_told(command):
    code, _, err = command("strips", "--out", "no/where.toml")
    assert code == 2
    assert "cannot be written" in err
