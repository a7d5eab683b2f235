"""Minimal surfaces against the closed forms that have the same boundary."""

import numpy as np
import pytest

from gridshell.errors import NoMinimalSurfaceError, SettingError, SurfaceError
from gridshell.surface import Catenoid, Enneper, minimal_surface


def circle(radius, z, x=0.0, start=0.0, sense=1):
    a = start + sense * 2 * np.pi * np.arange(400) / 400
    return np.stack([x + radius * np.cos(a), radius * np.sin(a), np.full(400, z)], axis=1)


def distance(surface, mesh):
    return np.linalg.norm(mesh.vertices - surface.closest(mesh.vertices).points, axis=1).max()


def test_two_circles_span_the_catenoid_to_second_order():
    surface, v = Catenoid(1000.0), 0.8
    radius = 1000 * np.cosh(v)
    loops = [circle(radius, 1000 * v), circle(radius, -1000 * v, start=1.0, sense=-1)]
    found = [minimal_surface(loops, edge=edge) for edge in (160.0, 80.0)]
    coarse, fine = (distance(surface, mesh) for mesh in found)
    assert fine < 0.6
    assert fine < coarse / 2.5
    assert found[1].euler_characteristic == 0
    assert found[1].mean_edge == pytest.approx(80.0, rel=0.1)
    sides = found[1].edge_lengths.reshape(-1, 3)
    assert (sides.max(axis=1) / sides.min(axis=1)).max() < 3.0


def test_a_loop_of_enneper_spans_enneper():
    surface = Enneper(1000.0)
    t = 2 * np.pi * np.arange(800) / 800
    mesh = minimal_surface([surface.point(0.8 * np.cos(t), 0.8 * np.sin(t))], edge=60.0)
    assert mesh.euler_characteristic == 1
    assert distance(surface, mesh) < 0.5


def test_a_skew_quadrilateral_spans_less_than_its_hypar():
    corners = np.array([[0, 0, 0], [2000, 0, 1500], [2000, 2000, 0], [0, 2000, 1500.0]])
    mesh = minimal_surface([corners], edge=100.0)
    assert all(np.linalg.norm(mesh.vertices - c, axis=1).min() < 1e-9 for c in corners)
    x, y = mesh.vertices[:, :2].T / 2000.0
    hypar = np.stack([2000 * x, 2000 * y, 1500 * (x + y - 2 * x * y)], axis=1)[mesh.triangles]
    normal = np.cross(hypar[:, 1] - hypar[:, 0], hypar[:, 2] - hypar[:, 0])
    area = np.linalg.norm(normal, axis=1).sum() / 2
    assert mesh.areas.sum() < area * (1 - 1e-5)


def test_a_flat_loop_spans_the_plane():
    mesh = minimal_surface([circle(1000.0, 5.0)], edge=150.0)
    np.testing.assert_allclose(mesh.vertices[:, 2], 5.0, atol=1e-9)
    assert mesh.face_normals[:, 2].min() > 0.999


@pytest.mark.parametrize("apart", [1400.0, 2000.0])
def test_circles_too_far_apart_are_named(apart):
    loops = [circle(1000.0, 0.0), circle(1000.0, apart)]
    with pytest.raises(NoMinimalSurfaceError, match="neck") as info:
        minimal_surface(loops, edge=100.0)
    assert "mm" in info.value.where


def test_circles_just_near_enough_are_joined():
    mesh = minimal_surface([circle(1000.0, 0.0), circle(1000.0, 1300.0)], edge=100.0)
    # the stable catenoid a cosh(650 / a) = 1000
    a = 1000.0
    for _ in range(500):
        a = 1000.0 / np.cosh(650.0 / a)
    waist = np.abs(mesh.vertices[:, 2] - 650.0) < 60.0
    assert np.linalg.norm(mesh.vertices[waist, :2], axis=1).min() == pytest.approx(a, rel=0.02)


def test_three_circles_span_a_pair_of_pants():
    loops = [circle(2000.0, 0.0), circle(300.0, 200.0, 700.0), circle(300.0, 300.0, -700.0)]
    assert minimal_surface(loops, edge=150.0).euler_characteristic == -1


def test_three_curves_that_cross_in_projection_are_named():
    loops = [circle(1000.0, 0.0), circle(1000.0, 500.0, 200.0), circle(300.0, 900.0)]
    with pytest.raises(SurfaceError, match="Three or more"):
        minimal_surface(loops, edge=100.0)


@pytest.mark.parametrize("loops", [[], [np.zeros((2, 3))]])
def test_no_curve_is_named(loops):
    with pytest.raises(SettingError, match="closed curves"):
        minimal_surface(loops, edge=100.0)
