"""Asymptotic directions against the parameter lines of exact surfaces."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pytest

from gridshell.arrays import Floats
from gridshell.errors import FlatSurfaceError, NotHyperbolicError
from gridshell.field import asymptotic_field, singularities
from gridshell.surface import (
    AnalyticSurface,
    Catenoid,
    CurvedMesh,
    Enneper,
    Helicoid,
    Hypar,
    Scherk,
    forms,
)

Grid = Callable[..., CurvedMesh]
Forms = Callable[[Floats], CurvedMesh]

BOX = ((-0.6, 0.6), (-0.5, 0.5))
SURFACES = [Enneper(1.0), Catenoid(1.0), Helicoid(5.0), Hypar(1.0), Scherk(1.0)]


def torsion(surface: AnalyticSurface, u: float, v: float, sign: float) -> float:
    """Turn of the normal along u + sign v = const-lines: right-handed lines have a positive one."""
    d = surface.derivatives(u, v)
    step = 1e-5
    normal = forms.unit_normal(d)
    ahead = forms.unit_normal(surface.derivatives(u + step, v + sign * step))
    line = d.xu + sign * d.xv
    tangent = line / np.linalg.norm(line)
    # the binormal is the normal: B' = -tau N with N = B x T
    change = (ahead - normal) / (step * np.linalg.norm(line))
    return float(-change @ np.cross(normal, tangent))


@pytest.mark.parametrize("surface", SURFACES, ids=lambda s: type(s).__name__)
def test_lines_run_along_the_asymptotic_parameters(on_grid: Grid, surface: AnalyticSurface) -> None:
    cells = 64
    curved = on_grid(surface, BOX, (cells, cells))
    mesh = curved.mesh
    field = asymptotic_field(curved)
    assert not field.infeasible.any()
    rows = np.linspace(*BOX[0], cells + 1), np.linspace(*BOX[1], cells + 1)
    u, v = (x.ravel()[mesh.triangles].mean(axis=1) for x in np.meshgrid(*rows, indexing="ij"))
    d = surface.derivatives(u, v)
    # family 1 is left-handed, family 2 right-handed
    left, right = (-1.0, 1.0) if torsion(surface, 0.1, 0.05, 1.0) > 0.0 else (1.0, -1.0)
    assert torsion(surface, 0.1, 0.05, left) < 0.0 < torsion(surface, 0.1, 0.05, right)
    for lines, sign in ((field.first_directions, left), (field.second_directions, right)):
        exact = d.xu + sign * d.xv
        normal = np.cross(lines, exact)
        across = np.abs(np.einsum("fc,fc->f", normal, mesh.face_normals))
        across /= np.linalg.norm(exact, axis=1)
        assert np.degrees(across).mean() < 0.01
        assert np.degrees(across).max() < 0.05
    assert len(singularities(field).vertices) == 0


def test_normal_curvature_vanishes(with_forms: Forms) -> None:
    rng = np.random.default_rng(4)
    k, turn = rng.uniform(0.1, 3.0, (2, 512)), rng.uniform(0.0, 6.3, 512)
    mean, half = (k[1] - k[0]) / 2.0, (k[0] + k[1]) / 2.0
    a, b, c = mean - half * np.cos(turn), -half * np.sin(turn), mean + half * np.cos(turn)
    curved = with_forms(np.stack([a, b, c], axis=1))
    field = asymptotic_field(curved)
    a, b, c = curved.face_shapes.T
    for t in (field.first, field.second):
        bend = a * np.cos(t) ** 2 + b * np.sin(2.0 * t) + c * np.sin(t) ** 2
        assert np.abs(bend).max() < 1e-14 * 10.0


def test_monkey_saddle_has_one_vertex_of_valence_six(monkey: Callable[[int], CurvedMesh]) -> None:
    found = singularities(asymptotic_field(monkey(12)))
    assert found.vertices.tolist() == [0]
    assert found.indices.tolist() == [-0.5]
    assert found.valence.tolist() == [6]


def test_turning_the_surface_over_keeps_left_and_right(
    monkey: Callable[[int], CurvedMesh], turned_over: Callable[[CurvedMesh], CurvedMesh]
) -> None:
    curved = monkey(10)
    field, over = asymptotic_field(curved), asymptotic_field(turned_over(curved))
    cosine = np.einsum("fc,fc->f", field.first_directions, over.first_directions)
    np.testing.assert_allclose(np.abs(cosine), 1.0, atol=1e-9)


def test_a_surface_that_is_half_positive_is_refused(with_forms: Forms) -> None:
    with pytest.raises(NotHyperbolicError, match="K >= 0 on 50 % of the area"):
        asymptotic_field(with_forms(np.array([[-1.0, 0.0, 1.0], [1.0, 0.0, 2.0]])))


def test_a_plane_is_refused(plane: CurvedMesh) -> None:
    with pytest.raises(FlatSurfaceError):
        asymptotic_field(plane)


def test_a_few_bad_triangles_take_the_directions_around_them(on_grid: Grid) -> None:
    curved = on_grid(Enneper(1.0), BOX, (40, 40))
    exact = asymptotic_field(curved)
    shapes = curved.face_shapes.copy()
    bad = np.flatnonzero(np.linalg.norm(curved.mesh.centroids, axis=1) < 0.03)
    assert 0 < len(bad) < 0.01 * len(shapes)
    shapes[bad] = [3.0, 0.5, 2.0]
    spoilt = CurvedMesh(curved.mesh, curved.normals, curved.shapes, shapes)
    field = asymptotic_field(spoilt)
    assert np.flatnonzero(field.infeasible).tolist() == bad.tolist()
    np.testing.assert_allclose(np.sin(field.first - exact.first), 0.0, atol=0.01)
    np.testing.assert_allclose(np.sin(field.second - exact.second), 0.0, atol=0.01)
