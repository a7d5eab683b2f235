"""Planar quads from start to skin: constant angles on every kind of curvature (Figs. 7, 8, 12)."""

from math import radians

import numpy as np
import pytest

import gridshell as gs
from gridshell.mesh import grid_quads

SHAPES = {
    "positive": (lambda p: -0.5 * p**2, lambda q: -0.35 * q**2),
    "negative": (lambda p: -0.5 * p**2, lambda q: 0.4 * q**2),
    "mixed": (lambda p: -0.4 * p**2, lambda q: 0.12 * np.sin(3.0 * q)),
}


def swept(name, degrees, rows=20, columns=24):
    """A curve swept along another at an angle; the diagonals of the mesh follow the two curves."""
    first, second = SHAPES[name]
    i, j = np.meshgrid(
        np.linspace(-1, 1, rows + 1),
        np.linspace(-1, 1, columns + 1) * columns / rows,
        indexing="ij",
    )
    p, q = (i + j) / 2.0, (i - j) / 2.0
    half = np.pi / 2.0 - radians(degrees) / 2.0
    x, y = (p + q) * np.cos(half) * np.sqrt(2.0), (p - q) * np.sin(half) * np.sqrt(2.0)
    points = 5000.0 * np.stack([x, y, first(p) + second(q)], axis=-1).reshape(-1, 3)
    return gs.as_control_mesh(gs.QuadMesh(points, grid_quads(rows, columns)))


def rotational(degrees, around=50, across=15):
    """A sphere cut conformally for rhombi at an angle: the start of Fig. 7."""
    turn = radians(degrees)
    v = (np.arange(across + 1) - across / 2.0) * 2.0 * np.pi / around / np.tan(turn / 2.0)
    u, v = np.meshgrid(2.0 * np.pi * np.arange(around) / around, v, indexing="ij")
    xyz = [np.cos(u) / np.cosh(v), np.sin(u) / np.cosh(v), np.tanh(v)]
    points = 1000.0 * np.stack(xyz, axis=-1).reshape(-1, 3)
    return gs.as_control_mesh(gs.QuadMesh(points, grid_quads(around, across, ring=True)))


def black_shapes(control):
    """Inner angles at the first corner, radians, and both sides of every black parallelogram."""
    mesh = gs.skin(control, gs.Skin.PATTERN)
    corners = mesh.vertices[mesh.faces[mesh.black][:, :4]]
    ahead, back = corners[:, 1] - corners[:, 0], corners[:, 3] - corners[:, 0]
    a, b = np.linalg.norm(ahead, axis=1), np.linalg.norm(back, axis=1)
    return np.arccos(np.einsum("fc,fc->f", ahead, back) / a / b), a, b


def flatness(mesh):
    """Largest distance of a corner from its panel's plane over the mean edge."""
    normals, worst = mesh.normals(), 0.0
    for face in range(len(mesh.faces)):
        corners = mesh.corner_points(face)
        worst = max(worst, float(np.abs((corners - corners.mean(axis=0)) @ normals[face]).max()))
    return worst / mesh.edge_lengths.mean()


@pytest.mark.parametrize("degrees", [90.0, 75.0, 60.0])
@pytest.mark.parametrize("rhombus", [False, True])
@pytest.mark.parametrize("name", list(SHAPES))
def test_constant_angles_on_every_curvature(name, degrees, rhombus):
    start = swept(name, degrees)
    recipe = gs.pq_net(angle=radians(degrees), rhombus=rhombus)
    control = gs.optimize(start, recipe, anchor=gs.Free()).require().control
    for which in gs.Skin:
        assert flatness(gs.skin(control, which)) < 1e-8
    angle, a, b = black_shapes(control)
    np.testing.assert_allclose(np.minimum(angle, np.pi - angle), radians(degrees), atol=1e-8)
    assert rhombus == bool(np.abs(a / b - 1.0).max() < 1e-8)
    _, kappa = gs.principal_curvatures(control.mesh)
    share = float((kappa[:, 0] * kappa[:, 1] > 0.0).mean())
    assert share == pytest.approx({"positive": 1.0, "negative": 0.0, "mixed": 0.5}[name], abs=0.1)


def test_black_squares_are_a_discrete_isothermic_surface():
    control = gs.optimize(swept("mixed", 90.0), gs.pq_net(square=True), anchor=gs.Free())
    angle, a, b = black_shapes(control.require().control)
    np.testing.assert_allclose(angle, np.pi / 2.0, atol=1e-8)
    np.testing.assert_allclose(a, b, rtol=1e-8)


@pytest.mark.parametrize("degrees", [60.0, 90.0, 120.0])
def test_rotational_rhombi_have_a_constant_curvature_ratio(degrees):
    """tan(alpha / 2)^2 = kappa1 / kappa2 (Fig. 7); the one at 90 degrees is a sphere."""
    recipe = gs.pq_net(angle=radians(degrees), rhombus=True)
    start = rotational(degrees)
    control = gs.optimize(start, recipe, anchor=gs.Free()).require().control
    _, kappa = gs.principal_curvatures(control.mesh)
    size = np.sort(np.abs(kappa), axis=1)
    expected = np.tan(radians(degrees) / 2.0) ** 2
    np.testing.assert_allclose(size[:, 0] / size[:, 1], min(expected, 1.0 / expected), rtol=0.04)
    assert (kappa[:, 0] * kappa[:, 1] > 0.0).all()
    turned = start.mesh.vertices.reshape(50, 16, 3)
    ring = control.vertices.reshape(turned.shape)
    radius = np.linalg.norm(ring[..., :2], axis=-1)
    np.testing.assert_allclose(radius, np.broadcast_to(radius[:1], radius.shape), rtol=1e-6)


@pytest.mark.parametrize("name", list(SHAPES))
def test_right_angles_give_torsion_free_axes_and_others_do_not(name):
    def torsion(degrees):
        start = swept(name, degrees)
        recipe = gs.pq_net(angle=radians(degrees))
        control = gs.optimize(start, recipe, anchor=gs.Free()).require().control
        mesh = gs.skin(control, gs.Skin.D1)
        i, j = mesh.edges.T
        run = mesh.vertices[j] - mesh.vertices[i]
        triple = np.einsum("mc,mc->m", np.cross(run, mesh.axes[i]), mesh.axes[j])
        return float(np.abs(triple / mesh.edge_lengths).max())

    assert torsion(90.0) < 1e-8
    assert torsion(75.0) > 1e-4
