"""Seamless charts whose quad mesh is known: plane pieces, rings and cones, triangulated at random.

Points are multiples of 1/16, half of them lattice points or on lattice lines, so that every way in
which a line can meet a triangulation occurs. ``scrambled`` gives every triangle a chart of its own.
"""

from __future__ import annotations

import numpy as np
from scipy.spatial import Delaunay

from gridshell.remesh.seamless import Seamless
from gridshell.surface import TriangleMesh


def seamless_of(mesh, corners, flips=None):
    none = np.zeros(0, dtype=np.int64)
    flips = np.ones(len(mesh.twin), dtype=np.int64) if flips is None else flips
    signs = np.ones(len(mesh.triangles), dtype=np.int64)
    return Seamless(mesh, np.asarray(corners, dtype=float), flips, signs, 1.0, none, none, ())


def scrambled(chart, rng):
    """The same chart with every triangle turned by 0 or pi and moved by whole numbers."""
    f = len(chart.mesh.triangles)
    sign, shift = rng.choice([-1, 1], size=f), rng.integers(-3, 4, size=(f, 2))
    corners = sign[:, None, None] * chart.corners + shift[:, None]
    twin = chart.mesh.twin
    own = np.repeat(np.arange(f), 3)
    other = np.where(twin < 0, own, twin // 3)
    return seamless_of(chart.mesh, corners, chart.flips * sign[own] * sign[other])


def permuted(chart, rng):
    """The same chart with the triangles in another order and their corners turned."""
    f = len(chart.mesh.triangles)
    order, turn = rng.permutation(f), rng.integers(0, 3, size=f)
    corner = (np.arange(3)[None, :] + turn[:, None]) % 3
    mesh = TriangleMesh(
        chart.mesh.vertices, np.take_along_axis(chart.mesh.triangles[order], corner, axis=1)
    )
    halfedges = (3 * order[:, None] + corner).ravel()
    return seamless_of(
        mesh, chart.corners.reshape(-1, 2)[halfedges].reshape(-1, 3, 2), chart.flips[halfedges]
    )


def inner_points(rng, low, high, count):
    """(k, 2) distinct points, multiples of 1/16; many on lattice lines and lattice points."""
    points = rng.integers(np.array(low) * 16, np.array(high) * 16 + 1, size=(count, 2)) / 16.0
    kind = rng.integers(0, 4, size=count)
    points[kind == 0] = np.round(points[kind == 0])
    points[kind == 1, 0] = np.round(points[kind == 1, 0])
    points[kind == 2, 1] = np.round(points[kind == 2, 1])
    return np.unique(points, axis=0)


def side_points(rng, start, end, count):
    """(k, 2) points from *start* on, without *end*, at multiples of 1/16 of the way."""
    share = np.unique(np.concatenate([[0], rng.integers(1, 16, size=count)])) / 16.0
    start, end = np.array(start, dtype=float), np.array(end, dtype=float)
    return start + share[:, None] * (end - start)


def convex(rng, outline, count=30, side=3):
    """A random triangulation of a convex polygon: points (n, 2) and triangles."""
    outline = np.asarray(outline, dtype=float)
    loop = [
        side_points(rng, a, b, side) for a, b in zip(outline, np.roll(outline, -1, 0), strict=True)
    ]
    rim = np.concatenate(loop)
    inside = inner_points(rng, np.floor(outline.min(0)), np.ceil(outline.max(0)), count)
    along = np.roll(outline, -1, axis=0) - outline
    off = inside[:, None] - outline
    inside = inside[(along[:, 0] * off[..., 1] - along[:, 1] * off[..., 0] > 0).all(axis=1)]
    return triangulated(np.concatenate([rim, inside]))


def triangulated(points):
    triangles = Delaunay(points).simplices
    a, b, c = np.moveaxis(points[triangles], 1, 0)
    area = (b - a)[:, 0] * (c - a)[:, 1] - (b - a)[:, 1] * (c - a)[:, 0]
    triangles = np.where((area > 0)[:, None], triangles, triangles[:, ::-1])[area != 0]
    return points, triangles.astype(np.int64)


def plane(points, triangles):
    mesh = TriangleMesh(np.column_stack([points, np.zeros(len(points))]), triangles)
    return seamless_of(mesh, points[triangles])


def ring(rng, around, across, shift=0, count=40):
    """A ring: the sides u = 0 and u = *around* are one, *shift* higher on the right."""
    left = side_points(rng, (0, 0), (0, across), 4)
    right = left + np.array([around, shift])
    top, bottom = np.array([[0.0, across]]), np.array([[around, across + shift]], dtype=float)
    outline = np.array([[0, 0], [around, shift], [around, across + shift], [0, across]])
    left, right = np.concatenate([left, top]), np.concatenate([right, bottom])
    low = side_points(rng, (0, 0), (around, shift), 4)[1:]
    high = side_points(rng, (0, across), (around, across + shift), 4)[1:]
    inside = inner_points(rng, outline.min(0), outline.max(0), count)
    along = np.roll(outline, -1, axis=0) - outline
    off = inside[:, None] - outline
    inside = inside[(along[:, 0] * off[..., 1] - along[:, 1] * off[..., 0] > 0).all(axis=1)]
    points, triangles = triangulated(np.concatenate([left, right, low, high, inside]))
    name = np.arange(len(points))
    name[len(left) : 2 * len(left)] = np.arange(len(left))
    used, compact = np.unique(name[triangles], return_inverse=True)
    vertices = np.column_stack([points[used], np.zeros(len(used))])
    return seamless_of(TriangleMesh(vertices, compact.reshape(-1, 3)), points[triangles])


def cone(rng, valence, size, count=12):
    """*valence* (even) quarter planes [0, size]^2 around one point."""
    axis = np.unique(np.concatenate([[0, 16 * size], rng.integers(2, 16 * size, size=4)])) / 16.0
    low = np.column_stack([axis, 0 * axis])
    turned = low[:, ::-1]
    far = side_points(rng, (size, 0), (size, size), 3)[1:]
    corner = np.array([[size, size]], dtype=float)
    far2 = side_points(rng, (size, size), (0, size), 3)[1:]
    inside = inner_points(rng, (0, 0), (size, size), count)
    inside = inside[((inside > 0) & (inside < size)).all(axis=1)]
    if valence == 2:  # no triangle may reach from axis to axis: both sectors share both axes
        diagonal = np.repeat(np.arange(1, 16 * size)[:, None] / 16.0, 2, axis=1)
        inside = np.unique(np.concatenate([inside, diagonal]), axis=0)
    points, triangles = triangulated(np.concatenate([low, turned[1:], far, corner, far2, inside]))
    k, n = len(low), len(points)
    names = np.arange(valence * n).reshape(valence, n)
    for s in range(valence):
        names[(s + 1) % valence, 1:k] = names[s, k : 2 * k - 1]  # its u axis is our v axis
    names[:, 0] = names[0, 0]
    corners, faces, quarter = [], [], points.copy()
    for s in range(valence):
        corners.append(quarter[triangles])
        faces.append(names[s][triangles])
        quarter = np.column_stack([-quarter[:, 1], quarter[:, 0]])
    used, compact = np.unique(np.concatenate(faces), return_inverse=True)
    vertices = rng.random((len(used), 3))
    mesh = TriangleMesh(vertices, compact.reshape(-1, 3))
    sector = np.repeat(np.arange(valence), 3 * len(triangles))
    other = np.where(mesh.twin < 0, sector, sector[mesh.twin])
    closing = np.abs(sector - other) == valence - 1 if valence > 2 else np.zeros(len(sector), bool)
    if valence == 2:  # both seams join the same two sectors: the second one is along v of sector 1
        origin_v = names[1, k : 2 * k - 1]
        used_v = np.searchsorted(used, np.append(origin_v, names[0, 0]))
        on = np.isin(mesh.origin, used_v) & np.isin(mesh.target, used_v)
        closing = on & (sector != other)
    flips = np.where(closing & (valence % 4 != 0), -1, 1)
    return seamless_of(mesh, np.concatenate(corners), flips)
