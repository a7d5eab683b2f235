"""Two coordinates whose integer lines follow two families of directions.

For each family an anisotropic Poisson energy is minimised over the real unknowns and the integers
at once: the field says where the lines run (weight *lam*), and the spacing gives way. *lam* = 1 is
the energy of mixed-integer quadrangulation (Bommes, Zimmer and Kobbelt 2009). Integers are found
exactly, by the closest lattice point in the reduced form.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.sparse import csr_matrix

from gridshell.arrays import Floats, Indices
from gridshell.errors import SolveError
from gridshell.remesh.charts import Charts
from gridshell.remesh.closest_lattice_point import LatticePoint, closest_lattice_point
from gridshell.solve import Engine, solve_definite
from gridshell.surface import TriangleMesh

LATTICE = 2
"""Singular vertices and transitions lie on even numbers: the grid of D1 in that of M."""

GRAIN = 2.0**-20
"""Real values are rounded to multiples of it, so that the net is traced in exact integers."""


@dataclass(frozen=True, eq=False)
class Target:
    """What one coordinate shall do on every triangle.

    Parameters
    ----------
    lines : (f, 2) unit direction, in the face's frame, along which the coordinate is constant.
    across : (f, 2) unit normal of *lines* towards which the coordinate grows.
    rise : (f,) derivative wanted across the lines, 1/mm.
    weight : (f,) factor on the whole energy of a triangle.
    lam : (f,) weight of direction against spacing.
    """

    lines: Floats
    across: Floats
    rise: Floats
    weight: Floats
    lam: Floats


@dataclass(frozen=True, eq=False)
class Coordinate:
    """The coordinate that was found.

    Parameters
    ----------
    corners : (f, 3) values at the corners of every triangle, multiples of ``GRAIN``.
    integers : how the integers were found.
    stretch : mean rise over the rise that was asked for, before it was scaled to one.
    """

    corners: Floats
    integers: LatticePoint
    stretch: float


def gradients(mesh: TriangleMesh) -> Floats:
    """(f, 2, 3) gradient in the face's frame of a function by its values at the corners, 1/mm."""
    p = mesh.flat_corners
    edge = np.roll(p, -2, axis=1) - np.roll(p, -1, axis=1)  # opposite to each corner
    turned = np.stack([-edge[..., 1], edge[..., 0]], axis=1)
    return np.asarray(turned / (2.0 * mesh.areas)[:, None, None])


def coordinate(mesh: TriangleMesh, unknowns: Charts, target: Target, engine: Engine) -> Coordinate:
    """Minimise the energy of one family.

    Raises
    ------
    SolveError
        When the linear system cannot be factored, or does not determine the integers.
    """
    operator, right = _rows(mesh, target)
    real = (operator @ unknowns.reals).tocsr()
    whole = np.asarray((operator @ unknowns.integers).todense()) * LATTICE
    coupled = real.T @ np.column_stack([right, whole])
    solved = solve_definite((real.T @ real).tocsr(), coupled, engine)
    # reduced to the integers: the reals follow them
    form = whole.T @ whole - coupled[:, 1:].T @ solved[:, 1:]
    pull = whole.T @ right - coupled[:, 1:].T @ solved[:, 0]
    free = _determined(form, pull)
    values = real @ (solved[:, 0] - solved[:, 1:] @ free) + whole @ free
    stretch = _stretch(values, right)
    found = closest_lattice_point((form + form.T) / 2.0, free / stretch)
    reals = solved[:, 0] / stretch - solved[:, 1:] @ found.integers
    reals = np.round(reals / GRAIN) * GRAIN
    corners = unknowns.reals @ reals + unknowns.integers @ (LATTICE * found.integers)
    return Coordinate(np.asarray(corners).reshape(-1, 3), found, stretch)


def _determined(form: Floats, pull: Floats) -> Floats:
    """The real optimum of the integers (m,)."""
    if len(pull) == 0:
        return pull
    try:
        return np.asarray(np.linalg.solve(form, pull))
    except np.linalg.LinAlgError as error:
        raise SolveError(
            "The integers of the chart are not determined by its energy",
            value=f"{len(pull)} integers; {error}",
            advice="a smaller part of the surface, or other directions",
        ) from error


def _rows(mesh: TriangleMesh, target: Target) -> tuple[csr_matrix, Floats]:
    """(2f, 3f) rows: rise across the lines, rise along them; and (2f,) what they shall be."""
    f = len(mesh.triangles)
    grad = gradients(mesh)
    size = np.sqrt(mesh.areas * target.weight) / target.rise
    across = np.einsum("fi,fik->fk", target.across, grad) * size[:, None]
    along = np.einsum("fi,fik->fk", target.lines, grad) * (size * np.sqrt(target.lam))[:, None]
    data = np.concatenate([across, along]).ravel()
    columns = np.tile(np.arange(3 * f), 2)
    operator = csr_matrix((data, columns, np.arange(0, 6 * f + 1, 3)), shape=(2 * f, 3 * f))
    return operator, np.concatenate([size * target.rise, np.zeros(f)])


def _stretch(values: Floats, right: Floats) -> float:
    """Mean rise over the wanted one, by area."""
    f = len(right) // 2
    weight = right[:f]  # square root of area times weight
    return float((values[:f] * weight).sum() / (weight**2).sum())


def winding(mesh: TriangleMesh, corners: Floats) -> tuple[Floats, Floats]:
    """Twice the signed area of every triangle in the chart (f,), and the chart's angle sum (n,).

    Parameters
    ----------
    corners : (f, 3, 2) chart positions.
    """
    a, b, c = np.moveaxis(corners, 1, 0)
    area = (b - a)[:, 0] * (c - a)[:, 1] - (b - a)[:, 1] * (c - a)[:, 0]
    ahead = np.roll(corners, -1, axis=1) - corners
    back = np.roll(corners, 1, axis=1) - corners
    cross = ahead[..., 0] * back[..., 1] - ahead[..., 1] * back[..., 0]
    angle = np.arctan2(cross, (ahead * back).sum(axis=2))
    total = np.bincount(mesh.origin, angle.ravel(), len(mesh.vertices))
    return np.asarray(area), np.asarray(total, dtype=np.float64)


def ring(mesh: TriangleMesh, vertices: Indices, times: int) -> Indices:
    """Faces within *times* rings of *vertices*."""
    near = np.zeros(len(mesh.vertices), dtype=bool)
    near[vertices] = True
    touched = np.zeros(len(mesh.triangles), dtype=bool)
    for _ in range(times):
        touched = np.asarray(near[mesh.triangles].any(axis=1))
        near[mesh.triangles[touched]] = True
    return np.flatnonzero(touched)
