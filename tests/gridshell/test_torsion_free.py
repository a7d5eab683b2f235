from math import radians

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

import gridshell as gs
from gridshell.mesh import grid_quads


def translation(shear=0.0, rows=8, columns=7):
    """z = (x^2 + y^2) / (2 R) swept over sheared steps: planar parallelograms as panels."""
    i, j = np.meshgrid(
        np.linspace(-1500.0, 1500.0, rows + 1),
        np.linspace(-1200.0, 1200.0, columns + 1),
        indexing="ij",
    )
    # the second curve runs in a vertical plane turned by the shear
    x, y = i + np.sin(shear) * j, np.cos(shear) * j
    z = (i**2 + j**2) / 10_000.0
    points = np.stack([x, y, z], axis=-1).reshape(-1, 3)
    quads = grid_quads(rows, columns)
    flat = gs.panel_mesh(points, quads, np.tile([0.0, 0.0, 1.0], (len(points), 1)))
    return flat.with_axes(gs.averaged_normals(flat))


def torsion(mesh, axes):
    """Largest volume of edge direction and its two axes."""
    i, j = mesh.edges.T
    run = (mesh.vertices[j] - mesh.vertices[i]) / mesh.edge_lengths[:, None]
    return float(np.abs(np.einsum("mc,mc->m", np.cross(run, axes[i]), axes[j])).max())


@pytest.mark.parametrize("degrees", [0.0, 15.0, 30.0])
def test_no_torsion_is_left_at_any_angle(degrees):
    mesh = translation(radians(degrees))
    assert torsion(mesh, mesh.axes) > 1e-4
    found = gs.torsion_free_axes(mesh)
    assert torsion(mesh, found.axes) < 1e-9
    assert found.residual < 1e-9
    assert found.tilt.max() < radians(60.0)


def test_axes_through_one_point_stay_as_they_are():
    turn, rise = np.meshgrid(np.linspace(-0.5, 0.5, 9), np.linspace(-0.4, 0.4, 8), indexing="ij")
    ball = np.stack([np.cos(turn) * np.cos(rise), np.sin(turn) * np.cos(rise), np.sin(rise)], -1)
    points = 7000.0 * ball.reshape(-1, 3)
    mesh = gs.panel_mesh(points, grid_quads(8, 7), points)
    found = gs.torsion_free_axes(mesh)
    np.testing.assert_allclose(found.axes, mesh.axes, atol=1e-7)
    np.testing.assert_allclose(found.distance, 1.0, atol=1e-7)
    assert found.tilt.max() < 1e-7


@given(st.floats(0.3, 3.0), st.integers(0, 2**31))
def test_no_parallel_mesh_is_nearer(size, seed):
    """Any other one: a parallelogram mesh has one that moves each of its curves on its own."""
    mesh = translation(0.3)
    found = gs.torsion_free_axes(mesh)
    offsets = found.axes * found.distance[:, None]
    # (columns + 1) nodes along j in each of the (rows + 1) rows: stretch one row's steps by a
    # factor, which keeps every edge parallel, and shift by a constant
    rng = np.random.default_rng(seed)
    row = np.repeat(np.arange(9), 8)
    k = int(rng.integers(8))
    step = mesh.vertices[(k + 1) * 8] - mesh.vertices[k * 8]
    change = 1e-4 * size * (row > k)[:, None] * step + 0.05 * size * rng.normal(size=3)
    i, j = mesh.edges.T
    assert np.abs(np.cross(change[j] - change[i], mesh.vertices[j] - mesh.vertices[i])).max() < 1e-6
    best = np.sum((offsets - mesh.axes) ** 2)
    assert np.sum((offsets + change - mesh.axes) ** 2) > best
    assert np.sum((offsets - change - mesh.axes) ** 2) > best


def test_they_turn_with_the_net():
    mesh = translation(0.3)
    turn = Rotation.from_rotvec([0.4, 1.0, -2.0])
    points, axes = (turn.apply(np.array(v)) for v in (mesh.vertices, mesh.axes))
    other = gs.torsion_free_axes(gs.panel_mesh(points, mesh.faces, axes))
    found = gs.torsion_free_axes(mesh)
    np.testing.assert_allclose(other.axes, turn.apply(np.array(found.axes)), atol=1e-8)


def test_a_net_without_such_axes_is_refused():
    """A tetrahedron's parallel meshes are its own enlargements; normals all alike are not near."""
    points = 1000.0 * np.array([[1.0, 1, 1], [1, -1, -1], [-1, 1, -1], [-1, -1, 1]])
    faces = np.array([[0, 1, 2], [0, 3, 1], [0, 2, 3], [1, 3, 2]])
    radial = points / np.linalg.norm(points, axis=1)[:, None]
    found = gs.torsion_free_axes(gs.panel_mesh(points, faces, points))
    np.testing.assert_allclose(found.axes, radial, atol=1e-9)
    # across the radii and without a mean
    whole = np.array([[1.0, -1, 0], [1, 1, 0], [-1, -1, 0], [-1, 1, 0]])
    with pytest.raises(gs.MeshError, match="torsion-free"):
        gs.torsion_free_axes(gs.panel_mesh(points, faces, whole))
