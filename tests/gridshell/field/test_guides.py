"""Guide lines decide where curvature does not, and only there."""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np
import pytest

from gridshell.arrays import Floats
from gridshell.errors import SettingError, UmbilicRegionError
from gridshell.field import (
    Guide,
    confidence,
    conjugate_field,
    principal_field,
    singularities,
)
from gridshell.field.principal_frames import principal_frames
from gridshell.surface import CurvedMesh

DIAGONAL = Guide(np.array([[0.1, 0.1, 0.0], [0.5, 0.5, 0.0], [0.9, 0.9, 0.0]]))


def test_a_plane_follows_one_guide_everywhere(plane: CurvedMesh) -> None:
    field = principal_field(plane, guides=[DIAGONAL])
    cosine = np.abs(field.first_directions @ np.array([1.0, 1.0, 0.0])) / math.sqrt(2.0)
    np.testing.assert_allclose(cosine, 1.0, atol=1e-9)
    np.testing.assert_allclose(field.angle, math.pi / 2.0, atol=1e-12)


@pytest.mark.parametrize("family", [1, 2])
def test_the_named_family_follows_at_any_angle(plane: CurvedMesh, family: int) -> None:
    guide = Guide(DIAGONAL.points, family)
    field = conjugate_field(plane, 1.1, guides=[guide])
    lines = field.first_directions if family == 1 else field.second_directions
    cosine = np.abs(lines @ np.array([1.0, 1.0, 0.0])) / math.sqrt(2.0)
    np.testing.assert_allclose(cosine, 1.0, atol=1e-9)
    np.testing.assert_allclose(field.angle, 1.1, atol=1e-12)


def test_a_guide_across_a_sphere_cap_makes_a_field_without_singular_points(
    on_ellipsoid: Callable[..., CurvedMesh],
) -> None:
    cap = on_ellipsoid((1.0, 1.0, 1.0), 4, 0.6)
    turn = np.linspace(-0.85, 0.85, 40)
    guide = Guide(np.stack([np.sin(turn), 0.0 * turn, np.cos(turn)], axis=1))
    with pytest.raises(UmbilicRegionError):
        principal_field(cap)
    field = principal_field(cap, guides=[guide])
    assert len(singularities(field).vertices) == 0
    near = np.abs(cap.mesh.centroids[:, 1]) < 0.02
    cosine = np.abs(field.first_directions[near] @ np.array([0.0, 1.0, 0.0]))
    assert np.degrees(np.arcsin(cosine)).max() < 3.0


def test_noise_in_the_curvature_of_a_sphere_does_not_show(
    on_ellipsoid: Callable[..., CurvedMesh],
) -> None:
    cap = on_ellipsoid((1.0, 1.0, 1.0), 4, 0.6)
    noise = 0.005 * np.random.default_rng(0).normal(size=cap.face_shapes.shape)
    noisy = CurvedMesh(cap.mesh, cap.normals, cap.shapes, cap.face_shapes + noise)
    turn = np.linspace(-0.85, 0.85, 40)
    guide = Guide(np.stack([np.sin(turn), 0.0 * turn, np.cos(turn)], axis=1))
    field, exact = (principal_field(c, guides=[guide]) for c in (noisy, cap))
    assert len(singularities(field).vertices) == 0
    assert np.degrees(np.abs(np.arcsin(np.sin(field.first - exact.first)))).max() < 3.0


def half_flat(x: Floats, y: Floats) -> tuple[Floats, ...]:
    """A parabolic gutter along the diagonal x + y = 0 for x + y > 0 that runs out into a plane."""
    s = np.maximum(x + y, 0.0)
    return s**4, 4.0 * s**3, 4.0 * s**3, 12.0 * s**2, 12.0 * s**2, 12.0 * s**2


def test_clear_curvature_is_not_moved(on_disk: Callable[..., CurvedMesh]) -> None:
    curved = on_disk(half_flat, 24)
    clear = confidence(curved) >= 1.0
    assert 0.3 < clear.mean() < 0.7
    guides = [
        Guide(np.array([[-0.7, -0.2, 0.0], [-0.2, -0.5, 0.0]])),
        Guide(np.array([[0.4, 0.4, 0.5], [0.6, 0.4, 0.5]])),
    ]
    field = principal_field(curved, guides=guides)
    assert (field.first[clear] == principal_frames(curved).axis[clear]).all()
    wanted = np.array([0.5, -0.3, 0.0]) / math.hypot(0.5, 0.3)
    under = np.linalg.norm(curved.mesh.centroids - [-0.45, -0.35, 0.0], axis=1) < 0.04
    assert under.any()
    assert np.abs(field.first_directions @ wanted)[under].min() > 0.999
    # in between it turns smoothly: no singular point, no jump
    assert len(singularities(field).vertices) == 0


def test_a_region_no_guide_reaches_is_still_refused(
    on_ellipsoid: Callable[..., CurvedMesh],
) -> None:
    one = on_ellipsoid((1.0, 1.0, 1.0), 3, 0.5)
    shapes = one.face_shapes.copy()
    belt = np.abs(one.mesh.centroids[:, 0]) < 0.2
    shapes[belt] = [-1.0, 0.0, -3.0]
    curved = CurvedMesh(one.mesh, one.normals, one.shapes, shapes)
    turn = np.linspace(-0.3, 0.3, 9)
    side = Guide(np.stack([0.5 + 0.0 * turn, turn, 0.8 + 0.0 * turn], axis=1))
    with pytest.raises(UmbilicRegionError):
        principal_field(curved, guides=[side])
    other = Guide(side.points * [-1.0, 1.0, 1.0])
    field = principal_field(curved, guides=[side, other])
    assert np.isfinite(field.first).all()


def test_a_guide_that_pierces_the_surface_is_refused(plane: CurvedMesh) -> None:
    with pytest.raises(SettingError, match="across the surface"):
        principal_field(plane, guides=[Guide(np.array([[0.5, 0.5, -1.0], [0.5, 0.5, 1.0]]))])


@pytest.mark.parametrize(
    ("points", "family", "text"),
    [
        (np.zeros((0, 3)), 1, "two points"),
        (np.ones((3, 3)), 1, "one place"),
        (DIAGONAL.points, 3, "two families"),
    ],
)
def test_a_guide_that_is_no_line_is_refused(points: Floats, family: int, text: str) -> None:
    with pytest.raises(SettingError, match=text):
        Guide(points, family)
