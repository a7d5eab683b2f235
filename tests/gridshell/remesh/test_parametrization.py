"""One coordinate at a time, where its minimum is known."""

import numpy as np
import pytest
from charts_by_hand import convex
from surfaces import CASES

from gridshell.remesh.charts import charts
from gridshell.remesh.cut import Cut
from gridshell.remesh.parametrization import (
    GRAIN,
    Target,
    coordinate,
    gradients,
    ring,
    winding,
)
from gridshell.solve import Engine
from gridshell.surface import TriangleMesh


@pytest.fixture(scope="module")
def square():
    points, triangles = convex(
        np.random.default_rng(0), [(0, 0), (6, 0), (6, 5), (0, 5)], count=80, side=8
    )
    return TriangleMesh(np.column_stack([points, 0 * points[:, 0]]), triangles)


def in_frames(mesh, vector):
    return np.einsum("fic,c->fi", mesh.face_frames[:, :2], np.asarray(vector, dtype=float))


def test_gradients_of_linear_functions_are_exact(square):
    corners = (square.corners @ np.array([2.0, -3.0, 0.0]))[..., None]
    found = (gradients(square) @ corners)[..., 0]
    np.testing.assert_allclose(found, in_frames(square, [2.0, -3.0, 0.0]), atol=1e-9)


def test_winding_of_the_plane(square):
    area, total = winding(square, square.corners[..., :2])
    np.testing.assert_allclose(area, 2.0 * square.areas)
    np.testing.assert_allclose(total[~square.on_boundary], 2.0 * np.pi)
    area, total = winding(square, square.corners[..., :2] * [1.0, -1.0])
    assert (area < 0.0).all()
    np.testing.assert_allclose(total[~square.on_boundary], -2.0 * np.pi)


def test_rings_grow(square):
    inside = int(np.flatnonzero(~square.on_boundary)[0])
    sizes = [len(ring(square, np.array([inside]), times)) for times in (0, 1, 2, 30)]
    assert sizes[0] == 0
    assert sizes[1] == square.valence[inside]
    assert sizes[2] > sizes[1]
    assert sizes[3] == len(square.triangles)
    assert len(ring(square, np.zeros(0, dtype=np.int64), 3)) == 0


def solved(mesh, turn, rise, lam=100.0, scale=1.0):
    f = len(mesh.triangles)
    along = in_frames(mesh, [np.cos(turn), np.sin(turn), 0.0])
    across = in_frames(mesh, [np.sin(turn), -np.cos(turn), 0.0])
    none = np.zeros(len(mesh.vertices), dtype=bool)
    whole = Cut(
        np.ones(f, dtype=np.int64), np.zeros(3 * f, dtype=bool), np.ones(3 * f, dtype=np.int64)
    )
    unknowns = charts(mesh, whole, none, np.zeros(3 * f, dtype=bool), origin=0)
    target = Target(along, across, np.full(f, rise), np.full(f, scale), np.full(f, lam))
    return coordinate(mesh, unknowns, target, Engine())


@pytest.mark.parametrize("turn", [0.0, 0.7, 2.0])
@pytest.mark.parametrize("lam", [1.0, 100.0])
def test_parallel_lines_are_met_exactly(square, turn, lam):
    found = solved(square, turn, 0.8, lam)
    gradient = (gradients(square) @ found.corners[..., None])[..., 0]
    wanted = 0.8 * in_frames(square, [np.sin(turn), -np.cos(turn), 0.0])
    shortest = square.edge_lengths.min()
    np.testing.assert_allclose(gradient, wanted, atol=40.0 * GRAIN / shortest)
    assert found.stretch == pytest.approx(1.0)
    assert (found.corners / GRAIN == np.rint(found.corners / GRAIN)).all()
    assert found.integers.exact


def test_the_rise_is_right_on_average_where_it_cannot_be_everywhere():
    mesh = CASES["saddle"].triangles(800).mesh
    found = solved(mesh, 0.3, 0.01)
    gradient = (gradients(mesh) @ found.corners[..., None])[..., 0]
    across = in_frames(mesh, [np.sin(0.3), -np.cos(0.3), 0.0])
    rise = np.einsum("fi,fi->f", gradient, across)
    assert np.average(rise, weights=mesh.areas) == pytest.approx(0.01, rel=1e-3)


def test_a_weight_on_everything_changes_nothing(square):
    one, two = solved(square, 0.4, 0.5), solved(square, 0.4, 0.5, scale=7.0)
    np.testing.assert_allclose(one.corners, two.corners, atol=4.0 * GRAIN)
