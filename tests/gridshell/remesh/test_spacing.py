"""The factor that makes a covector a gradient."""

import numpy as np
from surfaces import CASES

from gridshell.remesh.spacing import integrating_factor
from gridshell.solve import Engine


def in_frames(mesh, vectors):
    return np.einsum("fic,fc->fi", mesh.face_frames[:, :2], vectors)


def around(mesh):
    """The unit covector of the angle around a point beside it: a gradient over the radius."""
    e1 = np.array([1.0, 0.0, 0.3]) / np.hypot(1.0, 0.3)
    x, y = mesh.centroids @ e1 + 3000.0, mesh.centroids[:, 1]
    radius = np.hypot(x, y)
    turned = (-y[:, None] * e1 + x[:, None] * np.array([0.0, 1.0, 0.0])) / radius[:, None]
    return in_frames(mesh, turned), radius


def test_the_factor_of_the_angle_is_one_over_the_radius():
    mesh = CASES["flat"].triangles(3000).mesh
    q, radius = around(mesh)
    product = integrating_factor(mesh, q) * radius
    assert np.std(radius) / radius.mean() > 0.15
    assert np.std(product) / product.mean() < 0.005


def test_circles_need_none():
    mesh = CASES["flat"].triangles(1000).mesh
    q, _ = around(mesh)
    turned = np.stack([-q[:, 1], q[:, 0]], axis=1)
    np.testing.assert_allclose(integrating_factor(mesh, turned), 1.0, atol=0.05)


def test_a_length_that_grows_along_the_lines_is_taken_back():
    mesh = CASES["flat"].triangles(1000).mesh
    q = in_frames(mesh, np.broadcast_to([0.0, 1.0, 0.0], (len(mesh.triangles), 3)))
    growth = np.exp(mesh.centroids[:, 0] / 1000.0)
    product = integrating_factor(mesh, q * growth[:, None]) * growth
    assert np.std(product) / product.mean() < 0.01


def test_a_gradient_needs_none():
    mesh = CASES["flat"].triangles(1000).mesh
    q = in_frames(mesh, np.broadcast_to([1.0, 2.0, 0.0], (len(mesh.triangles), 3)))
    np.testing.assert_allclose(integrating_factor(mesh, q), 1.0, atol=1e-9)


def test_signs_engines_and_units_do_not_matter():
    mesh = CASES["flat"].triangles(1000).mesh
    q, _ = around(mesh)
    sign = np.random.default_rng(0).choice([-1, 1], size=len(mesh.triangles))
    plain = integrating_factor(mesh, q)
    other = integrating_factor(mesh, 7.0 * q * sign[:, None], Engine(portable=True))
    np.testing.assert_allclose(plain, other, rtol=1e-6)
