"""Any source made ready."""

import numpy as np
import pytest
from surfaces import CASES

from gridshell.errors import SettingError
from gridshell.remesh import working_surface
from gridshell.remesh.working_surface import area_of
from gridshell.surface import SmoothSurface, TriangulatedSurface


def triangles(name, count, noise=0.0):
    mesh = CASES[name].triangles(count).mesh
    away = np.random.default_rng(0).normal(size=mesh.vertices.shape) * noise * mesh.mean_edge
    return TriangulatedSurface(mesh.vertices + away, mesh.triangles)


def test_triangles_are_refined_until_there_are_enough_per_quad():
    ready = working_surface(triangles("enneper", 400), quads=300)
    assert len(ready.curved.mesh.triangles) >= 6 * 300
    assert not ready.exact
    assert isinstance(ready.reference, SmoothSurface)
    assert ready.reference.curved is ready.curved


def test_curvature_that_comes_along_is_kept():
    curved = CASES["enneper"].triangles(500)
    ready = working_surface(curved, quads=1000)
    assert ready.curved is curved
    assert ready.remarks == ()


def test_the_estimated_surface_is_the_exact_one():
    ready = working_surface(triangles("scherk", 3000), quads=300)
    normals, _ = CASES["scherk"].shapes_at(ready.curved.mesh.vertices)
    assert np.abs(np.einsum("nc,nc->n", normals, ready.curved.normals)).min() > np.cos(0.01)


def test_areas():
    curved = CASES["flat"].triangles(800)
    wanted = 4e6 * np.hypot(1.0, 0.3)
    assert area_of(curved) == pytest.approx(wanted, rel=1e-6)
    assert area_of(triangles("flat", 800)) == pytest.approx(wanted, rel=1e-6)


def test_noise_and_coarse_triangles_are_said():
    noisy = working_surface(triangles("enneper", 3000, noise=0.03), quads=300)
    assert [r.code for r in noisy.remarks] == ["noise"]
    assert 0.01 < noisy.remarks[0].value < 0.1
    assert "rings" in noisy.remarks[0].message
    assert working_surface(triangles("enneper", 3000), quads=300).remarks == ()


@pytest.mark.parametrize("quads", [0.0, -1.0, float("nan"), float("inf")])
def test_the_number_of_quads_must_be_positive(quads):
    with pytest.raises(SettingError, match="quads"):
        working_surface(triangles("enneper", 400), quads=quads)
