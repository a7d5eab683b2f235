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


def test_the_factor_of_the_angle_falls_with_the_radius():
    """Exactly it is one over the radius; triangle by triangle the scheme scatters about that."""
    mesh = CASES["flat"].triangles(3000).mesh
    q, radius = around(mesh)
    found = integrating_factor(mesh, q, np.ones(len(mesh.twin), dtype=np.int64))
    assert (found > 0.0).all()
    slope, _ = np.polyfit(np.log(radius), np.log(found), 1)
    assert -1.1 < slope < -0.6


def test_a_gradient_needs_none():
    mesh = CASES["flat"].triangles(1000).mesh
    q = in_frames(mesh, np.broadcast_to([1.0, 2.0, 0.0], (len(mesh.triangles), 3)))
    slope = np.linalg.norm(q, axis=1)
    found = integrating_factor(mesh, q / slope[:, None], np.ones(len(mesh.twin), dtype=np.int64))
    np.testing.assert_allclose(found, 1.0, atol=0.02)


def test_flips_and_engines_do_not_matter():
    mesh = CASES["flat"].triangles(1000).mesh
    q, _ = around(mesh)
    sign = np.random.default_rng(0).choice([-1, 1], size=len(mesh.triangles))
    own = np.repeat(np.arange(len(mesh.triangles)), 3)
    flips = sign[own] * sign[np.where(mesh.twin < 0, own, mesh.twin // 3)]
    plain = integrating_factor(mesh, q, np.ones(len(mesh.twin), dtype=np.int64))
    flipped = integrating_factor(mesh, q * sign[:, None], flips, Engine(portable=True))
    np.testing.assert_allclose(plain, flipped, rtol=1e-6)
