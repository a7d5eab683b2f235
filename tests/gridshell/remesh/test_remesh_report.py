"""Figures of a quad mesh."""

import json

import numpy as np
import pytest
from surfaces import CASES

from gridshell.mesh import grid_quads
from gridshell.remesh import Asymptotic, quadrangulate
from gridshell.remesh.remesh_report import Spread, coverage
from gridshell.surface import TriangulatedSurface


def patch(columns, of=10, lift=0.0):
    """Quads over the first *columns* of ten strips of the flat case, z = 0.3 x."""
    x, y = np.meshgrid(
        np.linspace(-1.0, 1.0, of + 1)[: columns + 1], np.linspace(-1.0, 1.0, of + 1), indexing="ij"
    )
    points = 1000.0 * np.stack([x, y, 0.3 * x + lift], axis=-1).reshape(-1, 3)
    return TriangulatedSurface.of_quads(points, grid_quads(columns, of))


@pytest.mark.parametrize("columns", [3, 5, 10])
def test_coverage_is_the_share_of_the_area(columns):
    curved = CASES["flat"].triangles(3000)
    assert coverage(curved, patch(columns), 200.0) == pytest.approx(columns / 10, abs=0.02)


def test_a_distance_along_the_normal_does_not_uncover():
    curved = CASES["flat"].triangles(3000)
    assert coverage(curved, patch(10, lift=0.01), 200.0) > 0.97


def test_coarse_quads_cover_the_curved_surface_they_stand_for():
    curved = CASES["catenoid"].triangles(2000)
    result = quadrangulate(curved, Asymptotic(), quads=40)
    assert result.report.coverage > 0.95


def test_spreads():
    spread = Spread.of(np.arange(101.0))
    assert (spread.mean, spread.p95, spread.max) == (50.0, 95.0, 100.0)
    assert Spread.of(np.zeros(0)) == Spread(0.0, 0.0, 0.0)


def test_a_report_is_plain_data():
    report = quadrangulate(CASES["monkey"].triangles(1500), Asymptotic(), quads=100).report
    plain = json.loads(json.dumps(report.plain()))
    assert plain["quads"] == report.quads
    assert plain["singularities"][0]["valence"] == 6
    assert set(plain["alignment_deg"]) == {"mean", "p95", "max"}
    assert plain["integers_exact"] is True
