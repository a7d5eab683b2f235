"""Principal directions against closed forms."""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np
import pytest

from gridshell.arrays import Points
from gridshell.errors import FlatSurfaceError, UmbilicRegionError
from gridshell.field import FrameField, principal_field, singularities
from gridshell.surface import Catenoid, CurvedMesh, TriangleMesh

Ellipsoid = Callable[..., CurvedMesh]


def along(field: FrameField, one: Points) -> np.ndarray:
    """|cosine| between the lines of family 1 and vectors (f, 3)."""
    length = np.linalg.norm(one, axis=1)
    return np.asarray(np.abs(np.einsum("fc,fc->f", field.first_directions, one)) / length)


def umbilics(a: float, b: float, c: float) -> Points:
    """The four umbilics of an ellipsoid, a > b > c: in the plane of a and c."""
    x = a * math.sqrt((a * a - b * b) / (a * a - c * c))
    z = c * math.sqrt((b * b - c * c) / (a * a - c * c))
    return np.array([[i * x, 0.0, j * z] for i in (-1, 1) for j in (-1, 1)])


def test_family_one_of_a_catenoid_runs_along_the_smaller_curvature(
    on_grid: Callable[..., CurvedMesh],
) -> None:
    surface = Catenoid(1.0)
    box = ((0.0, surface.period_u), (-1.0, 1.0))
    curved = on_grid(surface, box, (120, 40), (True, False))
    field = principal_field(curved)
    x, y, _ = curved.mesh.centroids.T
    circles = np.stack([-y, x, 0.0 * x], axis=1)
    # the circle bends towards the axis; it has the smaller curvature if normals point outward
    outward = np.einsum("nc,nc->n", curved.normals[:, :2], curved.mesh.vertices[:, :2]).mean() > 0
    cosine = along(field, circles)
    assert cosine.min() > 0.9999 if outward else cosine.max() < 0.01


def test_ellipsoid_has_its_four_umbilics(on_ellipsoid: Ellipsoid) -> None:
    curved = on_ellipsoid((3.0, 2.0, 1.5), 5)
    found = singularities(principal_field(curved))
    assert found.indices.tolist() == [0.5] * 4
    assert found.valence.tolist() == [2] * 4
    away = np.linalg.norm(found.positions(curved.mesh)[:, None] - umbilics(3.0, 2.0, 1.5), axis=2)
    assert away.min(axis=0).max() < 1.5 * curved.mesh.mean_edge


def test_a_dome_has_two_umbilics(on_ellipsoid: Ellipsoid) -> None:
    curved = on_ellipsoid((3.0, 2.0, 1.5), 4, 0.1)
    assert curved.mesh.euler_characteristic == 1
    assert singularities(principal_field(curved)).indices.tolist() == [0.5, 0.5]


def test_turning_the_surface_over_swaps_the_families(
    on_ellipsoid: Ellipsoid, turned_over: Callable[[CurvedMesh], CurvedMesh]
) -> None:
    curved = on_ellipsoid((3.0, 2.0, 1.5), 3)
    field, over = principal_field(curved), principal_field(turned_over(curved))
    np.testing.assert_allclose(along(field, over.second_directions), 1.0, atol=1e-12)


def test_directions_move_with_the_surface_and_ignore_its_size(on_ellipsoid: Ellipsoid) -> None:
    curved = on_ellipsoid((3.0, 2.0, 1.5), 3)
    q, _ = np.linalg.qr(np.random.default_rng(2).normal(size=(3, 3)))
    q *= np.sign(np.linalg.det(q))
    moved = CurvedMesh.of_vertices(
        TriangleMesh(700.0 * curved.mesh.vertices @ q.T + [5.0, -3.0, 40.0], curved.mesh.triangles),
        curved.normals @ q.T,
        q @ curved.shapes @ q.T / 700.0,
    )
    field, other = principal_field(curved), principal_field(moved)
    away = np.linalg.norm(curved.mesh.centroids[:, None] - umbilics(3.0, 2.0, 1.5), axis=2)
    clear = away.min(axis=1) > 0.2
    turned = field.first_directions @ q.T
    np.testing.assert_allclose(along(other, turned)[clear], 1.0, atol=1e-9)


def test_a_sphere_is_refused(on_ellipsoid: Ellipsoid) -> None:
    with pytest.raises(UmbilicRegionError, match="100 % of the area"):
        principal_field(on_ellipsoid((2.0, 2.0, 2.0), 3))


def test_a_plane_is_refused(plane: CurvedMesh) -> None:
    with pytest.raises(FlatSurfaceError, match="flat"):
        principal_field(plane)
