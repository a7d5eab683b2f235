"""Least bending of a planar net of strips that keeps the distances of its slots.

With d the chord of a bay, c its wanted length, and p-, p, p+ three nodes in a row on a strip with
developed lengths l-, l+ between them, the energy in units of the mean bay is

    sum (|d| - c)^2 / 2
    + w sum |2 / (l- + l+) ((p+ - p) / l+ - (p - p-) / l-)|^2 (l- + l+) / 4
    + n (mean node angle - opening)^2 / 2

The weight w of bending falls to 1e-7, so that lengths are kept as exactly as the net allows and
bending is least among all states that do. The last term holds the scissors open; it couples all
nodes, and enters the Newton step by the formula of Sherman and Morrison.

A strip that bends is longer than the chords between its nodes. What the elastic line through the
nodes is longer than its chords is taken off the wanted lengths, again after every solve.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from scipy.sparse import coo_matrix, csc_matrix, identity
from scipy.sparse.linalg import splu

from fabrication.flat_grid import FlatGrid
from gridshell.arrays import Floats, Indices

_WEIGHTS = (1e-1, 1e-2, 1e-3, 1e-4, 1e-5, 1e-6, 1e-7)
_STEPS = 30
_SETTLED = 1e-7
_DAMPING = 1e-6


@dataclass(frozen=True, eq=False)
class _Problem:
    """The constant part, in units of the mean bay."""

    grid: FlatGrid
    bending: csc_matrix
    columns: Indices
    opening: float

    @property
    def size(self) -> int:
        return 2 * len(self.grid.nodes)


def settle(
    grid: FlatGrid,
    start: Floats,
    opening: float,
    arcs: Callable[[Floats], Floats],
    kept: Callable[[Floats, Floats], bool],
) -> Floats:
    """(n, 2) positions of least bending with the lengths of *grid*, mm.

    Parameters
    ----------
    start : (n, 2) positions to begin with, mm.
    opening : the mean node angle to hold, radians.
    arcs : takes positions (n, 2) to the developed lengths (m,) of the strips through them, mm.
    kept : whether positions (n, 2) that miss the lengths by (m,) mm keep them well enough.
    """
    unit = float(grid.lengths.mean())
    problem = _Problem(grid, _bending(grid, unit), _columns(grid), opening)
    p = start / unit
    lengths = grid.lengths / unit
    found = arcs(start) / unit
    for weight in _WEIGHTS:
        longer = found - np.linalg.norm(_along(p, grid), axis=1)
        # a first guess may be bent as no strip will ever be
        p = _minimum(problem, p, lengths - np.clip(longer, 0.0, 0.05 * lengths), weight)
        found = arcs(p * unit) / unit
        if kept(p * unit, (found - lengths) * unit):
            break
    return p * unit


def node_angles(grid: FlatGrid, p: Floats) -> Floats:
    """(c,) turn from the first strip to the second at regular nodes, in (-pi, pi], radians."""
    u, v = _arms(grid, p)
    return np.asarray(np.arctan2(u[:, 0] * v[:, 1] - u[:, 1] * v[:, 0], (u * v).sum(axis=1)))


def _arms(grid: FlatGrid, p: Floats) -> tuple[Floats, Floats]:
    a, b, c, d = grid.arms.T
    return p[b] - p[a], p[d] - p[c]


def _along(p: Floats, grid: FlatGrid) -> Floats:
    return np.asarray(p[grid.edges[:, 1]] - p[grid.edges[:, 0]])


def _bending(grid: FlatGrid, unit: float) -> csc_matrix:
    """(2n, 2n) matrix of the bending energy; half of its quadratic form is the energy."""
    before, after = grid.spans.T / unit
    width = (before + after) / 2.0
    root = np.sqrt(width) / width
    share = np.column_stack([root / before, -root / before - root / after, root / after])
    rows = np.repeat(np.arange(len(grid.turns)), 3)
    parts = [
        coo_matrix(
            (share.ravel(), (rows, 2 * grid.turns.ravel() + side)),
            shape=(len(grid.turns), 2 * len(grid.nodes)),
        ).tocsr()
        for side in (0, 1)
    ]
    return csc_matrix(sum(part.T @ part for part in parts))


def _columns(grid: FlatGrid) -> Indices:
    """(m, 4) unknowns of each bay."""
    return np.asarray((2 * grid.edges[..., None] + np.arange(2)).reshape(-1, 4))


def _minimum(problem: _Problem, p: Floats, wanted: Floats, weight: float) -> Floats:
    """Newton's way with damping, from *p*."""
    damping, energy = _DAMPING, _energy(problem, p, wanted, weight)
    for _ in range(_STEPS):
        gradient, matrix, pull, torque = _model(problem, p, wanted, weight)
        step = _step(problem, matrix, gradient, pull, torque, damping)
        then = p + step.reshape(-1, 2)
        after = _energy(problem, then, wanted, weight)
        if after < energy:
            p, energy, damping = then, after, max(damping / 10.0, 1e-12)
        elif damping > 1e3:
            break
        else:
            damping *= 10.0
            continue
        if np.abs(step).max() < _SETTLED:
            break
    return p


def _energy(problem: _Problem, p: Floats, wanted: Floats, weight: float) -> float:
    found = np.linalg.norm(_along(p, problem.grid), axis=1)
    x = p.ravel()
    bending = float(x @ (problem.bending @ x)) / 2.0
    opened = float(((found - wanted) ** 2).sum()) / 2.0 + weight * bending
    return opened + len(p) * _ajar(problem, p) ** 2 / 2.0


def _ajar(problem: _Problem, p: Floats) -> float:
    """How far the mean node angle is from the opening."""
    angles = node_angles(problem.grid, p)
    return float(angles.mean() - problem.opening) if len(angles) else 0.0


def _model(
    problem: _Problem, p: Floats, wanted: Floats, weight: float
) -> tuple[Floats, csc_matrix, Floats, float]:
    """Gradient and matrix of lengths and bending; gradient of the mean angle and its miss."""
    grid = problem.grid
    along = _along(p, grid)
    found = np.maximum(np.linalg.norm(along, axis=1), 1e-9)
    direction = along / found[:, None]
    off = found - wanted
    outer = direction[:, :, None] * direction[:, None, :]
    # bars that are pushed lose lateral stiffness: kept out, so that the matrix stays definite
    sideways = (off / found)[:, None, None] * (np.eye(2) - outer)
    block = outer + sideways
    signed = np.concatenate(
        [np.concatenate([block, -block], axis=2), np.concatenate([-block, block], axis=2)], axis=1
    )
    rows = np.repeat(problem.columns, 4, axis=1).ravel()
    columns = np.tile(problem.columns, 4).ravel()
    lengths = coo_matrix((signed.ravel(), (rows, columns)), shape=(problem.size,) * 2)
    gradient = weight * (problem.bending @ p.ravel())
    force = off[:, None] * direction
    np.add.at(gradient, problem.columns, np.concatenate([-force, force], axis=1))
    pull = _pull(problem, p)
    torque = len(p) * _ajar(problem, p)
    matrix = csc_matrix(lengths.tocsc() + weight * problem.bending)
    return gradient + torque * pull, matrix, pull, float(len(p))


def _pull(problem: _Problem, p: Floats) -> Floats:
    """Gradient of the mean node angle."""
    grid = problem.grid
    pull = np.zeros(problem.size)
    for vectors, ends, sign in zip(
        _arms(grid, p), (grid.arms[:, :2], grid.arms[:, 2:]), (-1.0, 1.0), strict=True
    ):
        square = np.maximum((vectors**2).sum(axis=1), 1e-12)
        turned = sign * np.column_stack([-vectors[:, 1], vectors[:, 0]]) / square[:, None]
        for end, way in zip(ends.T, (-1.0, 1.0), strict=True):
            np.add.at(pull, 2 * end[:, None] + np.arange(2), way * turned / len(ends))
    return pull


def _step(
    problem: _Problem,
    matrix: csc_matrix,
    gradient: Floats,
    pull: Floats,
    torque: float,
    damping: float,
) -> Floats:
    factor = splu(csc_matrix(matrix + damping * identity(problem.size)), permc_spec="MMD_AT_PLUS_A")
    free, by_pull = factor.solve(np.column_stack([gradient, pull])).T
    share = torque * (pull @ free) / (1.0 + torque * (pull @ by_pull))
    return np.asarray(-(free - share * by_pull))
