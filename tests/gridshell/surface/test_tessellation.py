"""Tessellated exact surfaces: topology, and curvature against closed forms."""

import math

import numpy as np
import pytest

from gridshell.errors import SettingError
from gridshell.surface import (
    Catenoid,
    Enneper,
    Hypar,
    ParameterDisk,
    Sphere,
    Torus,
    tessellate,
)

RING = ((-math.pi, math.pi), (-1.0, 1.0))


def gauss_and_mean(shapes):
    a, b, c = shapes.T
    return a * c - b * b, (a + c) / 2


@pytest.mark.parametrize(
    ("surface", "over", "holes", "chi"),
    [
        (Catenoid(1000.0), RING, (), 0),
        (Catenoid(1000.0), ((-1.0, 1.0), (-1.0, 1.0)), (ParameterDisk(0.1, 0.0, 0.4),), 0),
        (Enneper(1000.0), ParameterDisk(0.0, 0.0, 1.0), (), 1),
        (Hypar(1000.0), ((-1.0, 1.0), (-1.0, 1.0)), (), 1),
        (Torus(3000.0, 1000.0), None, (), 0),
    ],
)
def test_every_figure_is_the_surfaces_own(surface, over, holes, chi):
    found = tessellate(surface, edge=120.0, over=over, holes=holes)
    mesh = found.mesh
    assert mesh.euler_characteristic == chi
    sides = mesh.edge_lengths.reshape(-1, 3)
    assert (sides.max(axis=1) / sides.min(axis=1)).max() < 3.0
    foot = surface.closest(mesh.vertices)
    np.testing.assert_allclose(foot.points, mesh.vertices, atol=1e-6)
    np.testing.assert_allclose(foot.normals, found.normals, atol=1e-9)
    kappa = np.linalg.eigvalsh(found.shapes)
    np.testing.assert_allclose(kappa.prod(axis=1), 0.0, atol=1e-18)
    np.testing.assert_allclose(
        np.sort(np.concatenate([foot.curvature, np.zeros((len(kappa), 1))], axis=1)),
        kappa,
        atol=1e-12,
    )
    middle = surface.closest(mesh.centroids)
    gauss, mean = gauss_and_mean(found.face_shapes)
    np.testing.assert_allclose(gauss, middle.curvature.prod(axis=1), atol=1e-14)
    np.testing.assert_allclose(mean, middle.curvature.mean(axis=1), atol=1e-11)


def test_a_sphere_bends_away_from_its_outward_normal():
    found = tessellate(Sphere(1000.0), edge=100.0, over=((-1.0, 1.0), (-0.8, 0.8)))
    np.testing.assert_allclose(
        found.face_shapes, [[-1e-3, 0.0, -1e-3]] * len(found.face_shapes), atol=1e-12
    )


def test_a_direction_is_right_as_well_as_the_invariants():
    # on a catenoid the meridian bends towards the outward normal, the circle away from it
    found = tessellate(Catenoid(1000.0), edge=100.0, over=RING)
    circle = np.cross([0.0, 0.0, 1.0], found.normals)
    circle /= np.linalg.norm(circle, axis=1)[:, None]
    v = found.mesh.vertices[:, 2] / 1000.0
    bend = np.einsum("ni,nij,nj->n", circle, found.shapes, circle)
    np.testing.assert_allclose(bend, -1e-3 / np.cosh(v) ** 2, rtol=1e-9)


@pytest.mark.parametrize(
    ("over", "what"),
    [
        (((0.0, 0.0), (0.0, 1.0)), "empty"),
        (((-4.0, 4.0), (0.0, 1.0)), "laps over itself"),
        (((-1.0, 1.0), (0.0, 2.0)), "longitude has no meaning"),
    ],
)
def test_ranges_that_make_no_sense_are_named(over, what):
    with pytest.raises(SettingError, match=what):
        tessellate(Sphere(1000.0), edge=100.0, over=over)
