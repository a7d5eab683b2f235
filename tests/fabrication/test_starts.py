from contextlib import nullcontext

import numpy as np
import pytest

import fabrication as fab
import gridshell as gs
from fabrication.sections import RemeshSection
from fabrication.starts import start, wish_of
from gridshell.mesh import grid_quads

REST = {
    "name": "roof",
    "net": {"anchor": "free"},
    "profile": {"width": 60.0, "thickness": 2.0, "material": "S235"},
    "joint": {"kind": "slot"},
    "sheet": {"length": 8000.0, "width": 1500.0},
}


@pytest.fixture
def begin(tmp_path):
    x, y = np.meshgrid(*[np.linspace(-1200, 1200, 25)] * 2, indexing="ij")
    points = np.stack([x, y, 2e-4 * (x * x - y * y)], axis=-1).reshape(-1, 3)
    gs.write_obj(tmp_path / "s.obj", gs.QuadMesh(points, grid_quads(24, 24)), unit=gs.Unit.MM)
    stages = []

    def stage(name):
        stages.append(name)
        return nullcontext()

    def build(unit="mm", **remesh):
        remesh = {"directions": "asymptotic", **remesh}
        surface = {"file": "s.obj", **({} if unit is None else {"unit": unit})}
        content = {**REST, "surface": surface, "remesh": remesh}
        return start(fab.Project.model_validate(content), tmp_path, stage)

    build.stages = stages
    return build


def test_a_surface_is_remeshed_and_is_the_reference(begin):
    found = begin(quads=150)
    assert begin.stages == ["surface", "remesh"]
    away = found.surface.closest(found.control.vertices).points - found.control.vertices
    assert np.linalg.norm(away, axis=1).max() < 0.5
    assert found.remeshed.good
    assert len(found.control.quads) == found.remeshed.made.report.control_quads


def test_the_first_diagonals_of_the_control_mesh_are_asymptotic(begin):
    found = begin(quads=150)
    a, b, c, d = np.moveaxis(found.control.vertices[found.control.quads], 1, 0)
    for u, v in ((a, c), (b, d)):  # z = 2e-4 (x - y) (x + y): x - y or x + y is kept
        step = (v - u)[:, :2]
        step /= np.linalg.norm(step, axis=1, keepdims=True)
        assert np.abs(np.abs(step) - np.sqrt(0.5)).max() < 0.02


def test_a_unit_that_is_missing_names_its_key(begin):
    with pytest.raises(gs.UnitError) as info:
        begin(unit=None)
    assert info.value.where.startswith("surface.unit: ")


def test_edges_that_make_too_many_quads_name_their_key(begin):
    with pytest.raises(gs.SettingError) as info:
        begin(edge=0.5)
    assert info.value.where == "remesh.edge"


def test_what_a_section_wishes():
    section = RemeshSection(directions="asymptotic")
    assert (wish_of(section).quads, wish_of(section).edge) == (500, None)
    assert wish_of(section).extent is gs.Extent.INSIDE
    section = RemeshSection(directions="asymptotic", edge=200.0, extent="trimmed")
    assert (wish_of(section).quads, wish_of(section).edge) == (None, 200.0)
    assert wish_of(section).extent is gs.Extent.TRIMMED
