"""Triangulations of exact surfaces, and what is true on them."""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

import numpy as np
import pytest
from scipy.spatial import Delaunay

import gridshell as gs
from gridshell.arrays import Floats, Vectors
from gridshell.surface import AnalyticSurface, TriangleMesh, forms


class Exact(NamedTuple):
    """A triangulation whose normals point as the surface's do, and the truth at its vertices."""

    surface: AnalyticSurface
    mesh: TriangleMesh
    normals: Vectors
    shapes: Floats


CASES = {
    "enneper": (gs.Enneper(1000.0), 0.9, 0.9),
    "catenoid": (gs.Catenoid(1000.0), 1.5, 1.0),
    "helicoid": (gs.Helicoid(1000.0), 1.0, 1.0),
    "hypar": (gs.Hypar(1000.0), 0.7, 0.7),
    "scherk": (gs.Scherk(1000.0), 0.8, 0.8),
    "torus": (gs.Torus(3000.0, 1000.0), 0.6, 1.1),
}


def _triangulated(surface: AnalyticSurface, u: float, v: float, n: int) -> Exact:
    """An irregular triangulation of |u|, |v| below the limits, n x n x 2 triangles."""
    rng = np.random.default_rng(5)
    i, j = (a.astype(float) for a in np.mgrid[0 : n + 1, 0 : n + 1])
    inside_i, inside_j = (i > 0) & (i < n), (j > 0) & (j < n)
    a = i + inside_i * (rng.uniform(-0.15, 0.15, i.shape) + (j % 2) * 0.4)
    b = j + inside_j * rng.uniform(-0.15, 0.15, i.shape)
    flat = np.stack([a.ravel(), b.ravel()], axis=1)
    triangles = Delaunay(flat).simplices
    p, q, r = np.moveaxis(flat[triangles], 1, 0)
    doubled = (q - p)[:, 0] * (r - p)[:, 1] - (q - p)[:, 1] * (r - p)[:, 0]
    triangles = np.where((doubled > 0.0)[:, None], triangles, triangles[:, ::-1])
    triangles = triangles[np.abs(doubled) > 1e-9]
    d = surface.derivatives(u * (2.0 * flat[:, 0] / n - 1.0), v * (2.0 * flat[:, 1] / n - 1.0))
    normals, frame = forms.unit_normal(d), forms.frame(d)
    s11, s12, s22 = forms.shape_operator(d)
    e1 = d.xu / frame.length[:, None]
    tangents = np.stack([e1, np.cross(normals, e1)], axis=1)
    local = np.stack([s11, s12, s12, s22], axis=1).reshape(-1, 2, 2)
    return Exact(
        surface,
        TriangleMesh(d.x, triangles),
        normals,
        tangents.transpose(0, 2, 1) @ local @ tangents,
    )


@pytest.fixture(scope="session")
def exact() -> Callable[..., Exact]:
    """Build ``exact(name, n)``: one of CASES in about 2 n^2 triangles."""

    def build(name: str, n: int = 50) -> Exact:
        return _triangulated(*CASES[name], n)

    return build


@pytest.fixture(scope="session")
def direction_error() -> Callable[[Floats, Floats], Floats]:
    """Angles (n,) between the directions of smallest curvature of two operators, degrees."""

    def measure(found: Floats, truth: Floats) -> Floats:
        a, b = (np.linalg.eigh(s)[1][:, :, 0] for s in (found, truth))
        cosine = np.abs(np.einsum("nc,nc->n", a, b))
        return np.asarray(np.degrees(np.arccos(np.clip(cosine, 0.0, 1.0))))

    return measure
