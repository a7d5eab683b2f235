"""Integrating factor: a spacing that lets one family of lines be level lines exactly.

A single family always has one locally: a covector q with its lines as kernel, times exp(sigma), can
be a gradient. With q = |q| n, n at the angle phi and the lines along d, a quarter turn clockwise of
it, d(exp(sigma) q) = 0 asks that sigma + log |q| falls along d as fast as phi grows along n. Across
the lines sigma is free, and kept smooth.
"""

from __future__ import annotations

import numpy as np
from scipy.sparse import csr_matrix, identity

from gridshell.arrays import Floats, Indices
from gridshell.field import transport
from gridshell.remesh.parametrization import gradients
from gridshell.solve import Engine, solve_definite
from gridshell.surface import TriangleMesh

_SMOOTH = 1e-3
_HELD = 1e-9
_STEEP = 12.0
"""A slope over the size of a triangle that counts for half: beside singular vertices none holds."""

_LEVEL = 1e-3
"""Share of a slope that is given up where the neighbours lie nearly on a line, as at the rim."""


def integrating_factor(mesh: TriangleMesh, q: Floats, engine: Engine | None = None) -> Floats:
    """(f,) positive factors on the covectors *q* (f, 2), about one on average.

    Parameters
    ----------
    q : in the faces' frames, 1/mm, up to their signs.
    engine : solver of the linear system.

    Raises
    ------
    SolveError
        When the linear system cannot be factored.
    """
    size = np.linalg.norm(q, axis=1)
    across = q / size[:, None]
    along = np.stack([across[:, 1], -across[:, 0]], axis=1)
    turn, growth = _slopes(mesh, np.arctan2(q[:, 1], q[:, 0]), np.log(size))
    fall = -(turn * across).sum(axis=1) - (growth * along).sum(axis=1)
    grad, root = gradients(mesh), np.sqrt(mesh.areas)
    trust = 1.0 / (1.0 + (_STEEP * fall * root) ** 2)
    rows = np.concatenate(
        [
            (root * trust)[:, None] * np.einsum("fi,fik->fk", along, grad),
            *(np.sqrt(_SMOOTH) * root[:, None] * grad[:, i] for i in range(2)),
        ]
    )
    f, n = len(mesh.triangles), len(mesh.vertices)
    columns = np.tile(mesh.triangles.ravel(), 3)
    operator = csr_matrix((rows.ravel(), columns, np.arange(0, 9 * f + 1, 3)), shape=(3 * f, n))
    right = operator.T @ np.concatenate([root * trust * fall, np.zeros(2 * f)])
    matrix = csr_matrix(operator.T @ operator + _HELD * identity(n))
    sigma = solve_definite(matrix, np.asarray(right)[:, None], engine)[:, 0]
    level = sigma[mesh.triangles].mean(axis=1)
    return np.asarray(np.exp(level - np.average(level, weights=mesh.areas)))


def _slopes(mesh: TriangleMesh, angles: Floats, logs: Floats) -> tuple[Floats, Floats]:
    """Slopes (f, 2) of *angles* (f,), which count up to half turns, and of *logs* (f,), per mm."""
    halfedges: Indices = np.flatnonzero(mesh.twin >= 0)
    f, g = halfedges // 3, mesh.twin[halfedges] // 3
    step = np.einsum("hic,hc->hi", mesh.face_frames[f, :2], mesh.centroids[g] - mesh.centroids[f])
    turn = angles[g] - angles[f] - transport(mesh)[halfedges]
    turn -= np.pi * np.rint(turn / np.pi)
    count = len(mesh.triangles)
    xx, xy, yy = (
        np.bincount(f, step[:, i] * step[:, j], count) for i, j in ((0, 0), (0, 1), (1, 1))
    )
    level = _LEVEL * (xx + yy)
    xx, yy = xx + level, yy + level
    scale = 1.0 / np.maximum(xx * yy - xy * xy, np.finfo(float).tiny)
    found = []
    for change in (turn, logs[g] - logs[f]):
        x, y = (np.bincount(f, change * step[:, i], count) for i in range(2))
        found.append(np.stack([(yy * x - xy * y) * scale, (xx * y - xy * x) * scale], axis=1))
    return found[0], found[1]
