"""The integer vector closest to a real one in a positive definite form, exactly.

Schnorr and Euchner's enumeration (Lattice basis reduction, Math. Programming 66, 1994): integers
are tried from the last coordinate to the first, nearest values first, and branches that cannot beat
the best one found are left out. The first vector tried is Babai's, the greedy rounding.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from gridshell.arrays import Floats, Indices
from gridshell.errors import SolveError

MOST_NODES = 200_000
"""Branches looked at before the search settles for the best one found."""


@dataclass(frozen=True, eq=False)
class LatticePoint:
    """A vector of integers.

    Parameters
    ----------
    integers : (m,) the vector.
    energy : its value in the form, over that of the real optimum.
    greedy : the energy of Babai's rounding, the first vector tried.
    exact : whether no other vector can be closer.
    """

    integers: Indices
    energy: float
    greedy: float
    exact: bool


def closest_lattice_point(form: Floats, target: Floats, *, most: int = MOST_NODES) -> LatticePoint:
    """Minimise ``(t - target)^T form (t - target)`` over integer vectors t.

    Parameters
    ----------
    form : (m, m) symmetric positive definite.
    target : (m,) the real optimum.
    most : branches looked at before the search settles for the best one found; the greedy vector
        is always found.

    Raises
    ------
    SolveError
        When the form is not positive definite.
    """
    m = len(target)
    if m == 0:
        return LatticePoint(np.zeros(0, dtype=np.int64), 0.0, 0.0, True)
    upper = _upper(form)
    scale = np.diag(upper).copy()
    share = (upper / scale[:, None]).tolist()
    weight = (scale**2).tolist()
    goal = target.tolist()
    best: list[int] = []
    best_energy, greedy, nodes = float("inf"), float("inf"), 0
    point = [0] * m
    centre, partial, step = [0.0] * m, [0.0] * (m + 1), [0] * m
    k = m - 1
    centre[k] = goal[k]
    point[k] = round(centre[k])
    step[k] = 1 if centre[k] >= point[k] else -1
    while True:
        energy = partial[k + 1] + weight[k] * (point[k] - centre[k]) ** 2
        nodes += 1
        if energy < best_energy and (nodes <= most or not best):
            if k > 0:
                partial[k] = energy
                k -= 1
                row = share[k]
                centre[k] = goal[k] - sum(row[i] * (point[i] - goal[i]) for i in range(k + 1, m))
                point[k] = round(centre[k])
                step[k] = 1 if centre[k] >= point[k] else -1
                continue
            greedy = energy if not best else greedy
            best, best_energy = point.copy(), energy
        else:
            k += 1
            if k == m or (nodes > most and best):
                break
        point[k] += step[k]
        step[k] = -step[k] - (1 if step[k] > 0 else -1)
    return LatticePoint(np.array(best, dtype=np.int64), best_energy, greedy, nodes <= most)


def _upper(form: Floats) -> Floats:
    """The factor with ``form = upper^T upper``."""
    try:
        return np.asarray(np.linalg.cholesky(form).T)
    except np.linalg.LinAlgError as error:
        raise SolveError(
            "The integers of the chart are not determined by its energy",
            value=f"{len(form)} integers; {error}",
            advice="a smaller part of the surface, or other directions",
        ) from error
