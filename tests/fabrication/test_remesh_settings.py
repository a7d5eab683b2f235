import subprocess
import sys

import pytest

import fabrication as fab
from fabrication.errors import ProjectError
from fabrication.settings import require_makeable

REST = {
    "name": "roof",
    "net": {"anchor": "free"},
    "profile": {"width": 80.0, "thickness": 2.0, "material": "S235"},
    "joint": {"kind": "slot"},
    "sheet": {"length": 8000.0, "width": 1500.0},
}


@pytest.fixture
def told(tmp_path):
    """What is wrong with a project over a file, or None."""

    def build(remesh, surface, files=("roof.step", "roof.obj", "roof.brep", "rim.csv")):
        for name in files:
            (tmp_path / name).touch()
        remesh = {"directions": "asymptotic", **remesh}
        content = {**REST, "surface": surface, "remesh": remesh}
        try:
            require_makeable(fab.Project.model_validate(content), tmp_path / "roof.toml")
        except ProjectError as error:
            return str(error)
        return None

    return build


STEP = {"file": "roof.step"}


@pytest.mark.parametrize(
    "surface",
    [
        *(STEP, {"file": "roof.step", "unit": "mm"}, {"file": "roof.obj", "unit": "m"}),
        *({"file": "roof.brep", "unit": "m"}, {"file": "rim.csv", "unit": "inch"}),
    ],
)
def test_surfaces_that_can_be_read(told, surface):
    assert told({}, surface) is None
    assert told({"edge": 250.0}, surface) is None


@pytest.mark.parametrize("name", ["roof.obj", "roof.brep", "rim.csv"])
def test_files_without_a_unit_need_one(told, name):
    assert "surface.unit). Try: add surface.unit" in told({}, {"file": name})


def test_a_surface_file_that_is_not_there_is_named_with_its_key(told):
    assert "surface.file" in told({}, {"file": "no.step"})


def test_an_ending_that_is_not_known_is_told(told):
    message = told({}, {"file": "roof.3dm"}, files=["roof.3dm"])
    assert "found '.3dm'; allowed: .obj, " in message


@pytest.mark.parametrize(
    ("remesh", "words"),
    [
        ({"angle": 60.0}, "remesh.angle; found 60.0 with 'asymptotic'"),
        ({"directions": "principal", "hand": "left"}, "remesh.hand"),
        ({"directions": "principal", "infeasible": "clamp"}, "remesh.infeasible"),
        ({"directions": "conjugate"}, "add remesh.angle"),
        ({"quads": 100, "edge": 100.0}, "remesh.edge; found quads and edge"),
        ({"guides": [{"file": "rim.csv"}]}, "remesh.guides"),
        ({"directions": "principal", "guides": [{"file": "no.csv"}]}, "remesh.guides.0.file"),
    ],
)
def test_settings_that_do_not_go_together_are_named(told, remesh, words):
    assert words in told(remesh, STEP)


@pytest.mark.parametrize("remesh", [{"directions": "principal"}, {"directions": "conjugate"}])
def test_lamellas_need_asymptotic_directions_and_the_way_to_others_is_told(told, remesh):
    more = {"angle": 60.0} if remesh["directions"] == "conjugate" else {}
    message = told({**remesh, **more}, STEP)
    assert "remesh.directions" in message
    assert "net.kind = 'planar'" in message


def test_a_check_loads_nothing_heavy(tmp_path):
    (tmp_path / "roof.step").touch()
    text = (
        'name = "roof"\n[surface]\nfile = "roof.step"\n[remesh]\ndirections = "asymptotic"\n'
        '[net]\nanchor = "free"\n[profile]\nwidth = 80.0\nthickness = 2.0\nmaterial = "S235"\n'
        '[joint]\nkind = "slot"\n[sheet]\nlength = 8000.0\nwidth = 1500.0\n'
    )
    (tmp_path / "p.toml").write_text(text)
    code = (
        "import sys\nfrom fabrication.project import read_project\n"
        f"read_project({str(tmp_path / 'p.toml')!r})\n"
        "heavy = {'OCP', 'build123d', 'scipy', 'trimesh'} & set(sys.modules)\n"
        "assert not heavy, heavy\n"
    )
    subprocess.run([sys.executable, "-c", code], check=True)
