"""Surfaces that carry no directions are refused."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pytest

from gridshell.arrays import Floats
from gridshell.errors import FlatSurfaceError, TooManySingularitiesError, UmbilicRegionError
from gridshell.field import asymptotic_field, require_curvature, require_few_singularities
from gridshell.field.checks import distinctness, require_distinct, umbilic
from gridshell.surface import CurvedMesh

Forms = Callable[[Floats], CurvedMesh]


def test_distinctness_of_a_sphere_a_cylinder_and_a_minimal_surface(with_forms: Forms) -> None:
    rows = np.array([[2.0, 0.0, 2.0], [0.0, 0.0, -3.0], [1.0, 2.0, -1.0], [1e-9, 0.0, -1e-9]])
    measured = distinctness(with_forms(rows))[:4]
    np.testing.assert_allclose(measured[:3], [0.0, 0.5, 1.0], atol=1e-12)
    assert measured[3] < 1e-5


@pytest.mark.parametrize(("size", "passes"), [(0.9e-3, False), (1.1e-3, True)])
def test_flatness_is_curvature_times_size(with_forms: Forms, size: float, passes: bool) -> None:
    curved = with_forms(np.array([[size / np.sqrt(2.0), 0.0, 0.0]]))
    if passes:
        require_curvature(curved)
    else:
        with pytest.raises(FlatSurfaceError, match="0\\.0009"):
            require_curvature(curved)


def test_paraboloid_of_revolution_passes_and_names_a_fifth(
    on_disk: Callable[..., CurvedMesh],
) -> None:
    def paraboloid(x: Floats, y: Floats) -> tuple[Floats, ...]:
        o = np.zeros_like(x)
        return 0.3 * (x * x + y * y), 0.6 * x, 0.6 * y, o + 0.6, o, o + 0.6

    curved = on_disk(paraboloid, 20)
    share = curved.mesh.areas[umbilic(curved)].sum() / curved.mesh.areas.sum()
    assert 0.2 < share < 0.3
    require_distinct(curved)


def test_umbilic_area_is_what_no_guide_reaches(with_forms: Forms) -> None:
    curved = with_forms(np.array([[1.0, 0.0, 1.0], [1.0, 0.0, 3.0]]))
    with pytest.raises(UmbilicRegionError, match="50 % of the area"):
        require_distinct(curved)
    require_distinct(curved, umbilic(curved))


def test_two_singular_points_too_close_are_refused(quartic: CurvedMesh) -> None:
    field = asymptotic_field(quartic)
    require_few_singularities(field, 0.07)
    with pytest.raises(TooManySingularitiesError, match=r"0\.15 mm apart"):
        require_few_singularities(field, 0.08)
