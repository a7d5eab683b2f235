from math import radians

import numpy as np
import pytest

import gridshell as gs
from gridshell.quality import quad_planarity


@pytest.fixture(scope="module")
def bent():
    """A net on a catenoid, its vertices moved at random."""
    surface = gs.Catenoid(1000.0)
    control = gs.control_patch(surface, gs.BisectingPatch((-0.8, 0.8), 24))
    away = np.random.default_rng(3).normal(scale=5.0, size=control.vertices.shape)
    return control.moved(control.vertices + away), surface


def test_the_worst_quad_is_as_bad_as_the_net(bent):
    control, surface = bent
    angle = radians(80.0)
    quality = gs.net_quality(control, angle=angle, reference=surface)
    figures = gs.quad_figures(control, angle=angle, reference=surface)
    error = np.degrees(figures.angle_error)
    assert error.max() == pytest.approx(quality.angle_error_deg.max)
    assert error.mean() == pytest.approx(quality.angle_error_deg.mean)
    assert figures.planarity.max() == pytest.approx(quality.star_planarity.max)
    assert figures.surface_distance.max() == pytest.approx(quality.surface_distance_mm.max)


def test_faces_are_measured_themselves(bent):
    control, _ = bent
    figures = gs.quad_figures(control, planarity=gs.Planarity.FACES)
    np.testing.assert_allclose(figures.planarity, quad_planarity(control.vertices[control.quads]))
    assert figures.angle_error is None
    assert figures.surface_distance is None


def test_a_minimal_surface_has_the_ratio_minus_one():
    control = gs.control_patch(gs.Catenoid(1000.0), gs.BisectingPatch((-0.8, 0.8), 48))
    ratio = gs.quad_figures(control).curvature_ratio
    assert np.nanmedian(ratio) == pytest.approx(-1.0, abs=0.02)


def test_a_mesh_too_small_to_tell_has_no_ratio():
    patch = gs.AsymptoticPatch((-0.2, 0.2), (-0.2, 0.2), (2, 2))
    figures = gs.quad_figures(gs.control_patch(gs.Enneper(4000.0), patch))
    assert np.isnan(figures.curvature_ratio).all()


def test_figures_do_not_change_with_place_and_size(bent):
    control, _ = bent
    turn = np.linalg.qr(np.random.default_rng(1).normal(size=(3, 3)))[0]
    moved = control.moved(3.0 * control.vertices @ turn.T + 1e4)
    here = gs.quad_figures(control, angle=1.2)
    there = gs.quad_figures(moved, angle=1.2)
    np.testing.assert_allclose(here.angle_error, there.angle_error, atol=1e-9)
    np.testing.assert_allclose(here.planarity, there.planarity, atol=1e-9)
