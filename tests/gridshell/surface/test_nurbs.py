"""NURBS evaluation against the kernel's own, closed forms and difference quotients."""

import numpy as np
import pytest

from gridshell.errors import SurfaceError
from gridshell.surface.nurbs import NurbsCurve, NurbsPatch, basis_functions

KNOTS = np.array([0, 0, 0, 0, 0.3, 0.5, 0.5, 1, 1, 1, 1.0])


@pytest.fixture(scope="module")
def patch():
    rng = np.random.default_rng(3)
    x, y = np.meshgrid(np.linspace(0, 900, 7), np.linspace(0, 700, 4), indexing="ij")
    poles = np.stack([x, y, rng.uniform(0, 300, x.shape)], axis=2)
    return NurbsPatch(
        KNOTS, np.array([0, 0, 0, 0.6, 1, 1, 1.0]), poles, rng.uniform(0.5, 2.0, x.shape)
    )


def test_basis_functions_add_up_to_one_and_their_derivatives_to_zero():
    first, basis = basis_functions(KNOTS, 3, np.linspace(0, 1, 101))
    np.testing.assert_allclose(
        basis.sum(axis=2), [[1.0] * 101, [0.0] * 101, [0.0] * 101], atol=1e-11
    )
    assert first.min() == 0
    assert first.max() == len(KNOTS) - 8


def test_derivatives_are_difference_quotients(patch):
    rng = np.random.default_rng(0)
    u, v = rng.uniform(0.51, 0.99, 50), rng.uniform(0.05, 0.55, 50)
    h, d = 1e-6, patch.derivatives(u, v)
    up, um = patch.derivatives(u + h, v), patch.derivatives(u - h, v)
    vp, vm = patch.derivatives(u, v + h), patch.derivatives(u, v - h)
    for exact, plus, minus in (
        (d.xu, up.x, um.x),
        (d.xv, vp.x, vm.x),
        (d.xuu, up.xu, um.xu),
        (d.xuv, vp.xu, vm.xu),
        (d.xvv, vp.xv, vm.xv),
    ):
        np.testing.assert_allclose((plus - minus) / (2 * h), exact, rtol=1e-6, atol=2e-3)


def test_a_rational_quarter_is_a_circle():
    poles = np.array([[1, 0], [1, 1], [0, 1.0]]) * 500.0
    curve = NurbsCurve(np.array([0, 0, 0, 1, 1, 1.0]), poles, np.array([1, np.sqrt(0.5), 1]))
    x, x1, x2 = curve.derivatives(np.linspace(0, 1, 33))
    np.testing.assert_allclose(np.linalg.norm(x, axis=1), 500.0, rtol=1e-14)
    turn = x1[:, 0] * x2[:, 1] - x1[:, 1] * x2[:, 0]
    np.testing.assert_allclose(turn / np.linalg.norm(x1, axis=1) ** 3, 1 / 500.0, rtol=1e-12)


def test_a_rigid_motion_moves_points_and_derivatives(patch):
    q, _ = np.linalg.qr(np.random.default_rng(1).normal(size=(3, 3)))
    shift, u = np.array([10.0, -20.0, 30.0]), np.linspace(0.1, 0.9, 9)
    moved = NurbsPatch(patch.knots_u, patch.knots_v, patch.poles @ q.T + shift, patch.weights)
    a, b = patch.derivatives(u, u[::-1]), moved.derivatives(u, u[::-1])
    np.testing.assert_allclose(b.x, a.x @ q.T + shift, atol=1e-10)
    np.testing.assert_allclose(b.xuv, a.xuv @ q.T, atol=1e-8)


def test_arrays_that_do_not_fit_are_refused():
    with pytest.raises(SurfaceError, match="do not belong together"):
        NurbsCurve(np.array([0, 0, 1, 1.0]), np.zeros((3, 2)), np.ones(3))
