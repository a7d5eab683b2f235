"""Triangles over parameter domains: shape, size, topology, and what is refused."""

import itertools

import numpy as np
import pytest

from gridshell.errors import SettingError, SurfaceError
from gridshell.surface import Enneper, TriangleMesh, mesh_domain
from gridshell.surface.constrained_delaunay import constrained_delaunay, inside
from gridshell.surface.forms import Derivatives


def plane(u, v):
    none, one = np.zeros_like(u), np.ones_like(u)
    flat = np.zeros((len(u), 3))
    return Derivatives(
        np.stack([u, v, none], 1), np.stack([one, none, none], 1), np.stack([none, one, none], 1),
        flat, flat, flat,
    )  # fmt: skip


def ring(count, radius, x=0.0, sense=1):
    a = sense * 2 * np.pi * np.arange(count) / count
    return np.stack([x + radius * np.cos(a), radius * np.sin(a)], axis=1)


def square(count):
    t = np.arange(count) / count * 2 - 1
    one = np.ones(count)
    sides = [(t, -one), (one, t), (-t, one), (-one, -t)]
    return np.concatenate([np.stack(side, axis=1) for side in sides])


def ratios(mesh):
    sides = mesh.edge_lengths.reshape(-1, 3)
    return sides.max(axis=1) / sides.min(axis=1)


@pytest.mark.parametrize("edge", [0.2, 0.05])
def test_a_disk_with_a_hole(edge):
    n = round(2 * np.pi / edge)
    loops = [ring(n, 1.0), ring(max(n // 4, 8), 0.25, 0.3, -1)]
    uv, triangles = mesh_domain(plane, loops, edge=edge)
    mesh = TriangleMesh(plane(*uv.T).x, triangles)
    assert mesh.euler_characteristic == 0
    np.testing.assert_array_equal(uv[: n + max(n // 4, 8)], np.concatenate(loops))
    whole = sum(
        np.sum(p[:, 0] * np.roll(p[:, 1], -1) - p[:, 1] * np.roll(p[:, 0], -1)) / 2 for p in loops
    )
    assert mesh.areas.sum() == pytest.approx(whole, rel=1e-12)
    assert mesh.face_normals[:, 2].min() > 0.999
    assert ratios(mesh).max() < 3.0
    assert mesh.mean_edge == pytest.approx(edge, rel=0.15)


def test_edges_are_even_in_space_where_the_metric_changes_ninefold():
    surface = Enneper(1000.0)
    # |xu| = scale (1 + u^2 + v^2): put the border's points where space wants them
    border = square(100)
    x = surface.derivatives(*border.T).x
    station = np.concatenate(
        [[0], np.cumsum(np.linalg.norm(np.diff(x, axis=0, append=x[:1]), axis=1))]
    )
    corners = station[[0, 100, 200, 300, 400]]
    steps = np.concatenate(
        [np.linspace(a, b, round((b - a) / 60.0) + 1)[:-1] for a, b in itertools.pairwise(corners)]
    )
    closed = np.concatenate([border, border[:1]])
    loop = np.stack([np.interp(steps, station, closed[:, k]) for k in range(2)], axis=1)
    uv, triangles = mesh_domain(surface.derivatives, [loop], edge=60.0)
    mesh = TriangleMesh(surface.derivatives(*uv.T).x, triangles)
    assert ratios(mesh).max() < 3.0
    assert mesh.edge_lengths.min() > 0.35 * mesh.mean_edge
    assert mesh.edge_lengths.max() < 1.7 * mesh.mean_edge
    again = mesh_domain(surface.derivatives, [loop], edge=60.0)
    np.testing.assert_array_equal(uv, again[0])
    np.testing.assert_array_equal(triangles, again[1])


def test_missing_boundary_edges_are_recovered():
    # a spike of points far from the edge 0-1 in the plane, but near enough to break it
    points = np.array([[0.0, 0], [10, 0], [10, 5], [5.2, 0.1], [5, 5], [4.8, 0.1], [0, 5]])
    edges = np.stack([np.arange(7), np.roll(np.arange(7), -1)], axis=1)
    triangles = constrained_delaunay(points, edges)
    found = {tuple(e) for t in triangles for e in ((t[0], t[1]), (t[1], t[2]), (t[2], t[0]))}
    assert {tuple(e) for e in edges} <= found
    assert len(triangles) == 5


def test_an_outline_that_crosses_itself_is_named():
    points = np.array([[0.0, 0], [1, 1], [1, 0], [0, 1.2]])
    edges = np.array([[0, 1], [1, 2], [2, 3], [3, 0]])
    with pytest.raises(SurfaceError, match="crosses itself"):
        constrained_delaunay(points, edges)


def test_inside_counts_crossings():
    points = np.array([[0.0, 0.0], [0.9, 0.0], [1.1, 0.0], [0.5, 0.5]])
    found = inside(points, [square(5), ring(40, 0.2)])
    np.testing.assert_array_equal(found, [False, True, False, True])


@pytest.mark.parametrize("edge", [0.0, -1.0, np.nan, 1e-5])
def test_an_edge_length_that_makes_no_sense_is_named(edge):
    with pytest.raises(SettingError, match="too many triangles"):
        mesh_domain(plane, [square(10)], edge=edge)


def test_a_clockwise_outline_is_named():
    with pytest.raises(SurfaceError, match="wrong way round"):
        mesh_domain(plane, [square(10)[::-1]], edge=0.2)
