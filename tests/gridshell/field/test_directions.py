"""Any two line fields: the families are found, or it is said where they cannot be."""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from gridshell.arrays import Floats, Vectors
from gridshell.errors import InputError, OddValenceError
from gridshell.field import asymptotic_field, directions_field, singularities
from gridshell.surface import CurvedMesh

Rings = Callable[[int], CurvedMesh]


def shuffled(one: Vectors, two: Vectors, seed: int) -> tuple[Vectors, Vectors]:
    """Signs, lengths and names exchanged at random, triangle by triangle, except the first."""
    rng = np.random.default_rng(seed)
    size = rng.uniform(0.5, 2.0, (2, len(one), 1)) * rng.choice([-1.0, 1.0], (2, len(one), 1))
    swap = rng.random(len(one))[:, None] < 0.5
    swap[0] = False
    return size[0] * np.where(swap, two, one), size[1] * np.where(swap, one, two)


def star(curved: CurvedMesh, index: float) -> tuple[Vectors, Vectors]:
    """A cross that turns *index* times around a point near the middle of the plane."""
    x, y, _ = curved.mesh.centroids.T
    turn = index * np.arctan2(y - 0.51, x - 0.52)

    def line(angle: Floats) -> Vectors:
        return np.stack([np.cos(angle), np.sin(angle), 0.0 * angle], axis=1)

    return line(turn), line(turn + math.pi / 2.0)


@given(seed=st.integers(0, 1000))
def test_families_are_found_again(monkey: Rings, seed: int) -> None:
    field = asymptotic_field(monkey(16))
    lines = shuffled(field.first_directions, field.second_directions, seed)
    found = directions_field(field.mesh, *lines)
    np.testing.assert_allclose(np.sin(found.first - field.first), 0.0, atol=1e-9)
    np.testing.assert_allclose(np.sin(found.second - field.second), 0.0, atol=1e-9)
    assert singularities(found).indices.tolist() == [-0.5]


@pytest.mark.parametrize("index", [0.25, -0.25, 0.75])
def test_odd_valence_is_refused_with_its_vertex(plane: CurvedMesh, index: float) -> None:
    with pytest.raises(OddValenceError, match=r"vertex \d+ \(0\.5\d*, 0\.5\d*, 0\)"):
        directions_field(plane.mesh, *star(plane, index))


@pytest.mark.parametrize("index", [0.5, -0.5])
def test_even_valence_passes(plane: CurvedMesh, index: float) -> None:
    found = singularities(directions_field(plane.mesh, *star(plane, index)))
    assert found.indices.tolist() == [index]


def test_families_that_change_around_a_hole_are_refused(
    on_grid: Callable[..., CurvedMesh],
) -> None:
    from gridshell.surface import Catenoid

    box = ((0.0, Catenoid(1.0).period_u), (-0.5, 0.5))
    curved = on_grid(Catenoid(1.0), box, (60, 8), (True, False))
    x, y, z = curved.mesh.centroids.T
    around = np.stack([-y, x, 0.0 * z], axis=1)
    around /= np.linalg.norm(around, axis=1)[:, None]
    turn = np.arctan2(y, x)[:, None] / 4.0
    along = np.cross(curved.mesh.face_normals, around)
    lines = np.cos(turn) * around + np.sin(turn) * along
    with pytest.raises(OddValenceError, match="around a hole"):
        directions_field(curved.mesh, lines, np.cross(curved.mesh.face_normals, lines))


@pytest.mark.parametrize("bad", [[0.0, 0.0, 0.0], [0.0, 0.0, 1.0], [math.nan, 1.0, 0.0]])
def test_a_direction_off_the_surface_is_named(plane: CurvedMesh, bad: list[float]) -> None:
    one, two = star(plane, 0.0)
    two[5] = bad
    with pytest.raises(InputError, match="second, triangle 5"):
        directions_field(plane.mesh, one, two)


def test_one_direction_per_triangle_is_needed(plane: CurvedMesh) -> None:
    one, two = star(plane, 0.0)
    with pytest.raises(InputError, match="one per triangle"):
        directions_field(plane.mesh, one[1:], two)
