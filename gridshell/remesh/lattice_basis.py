"""Integer solutions of integer equations: a basis of all of them, by exact elimination.

Unimodular column operations bring the equations to echelon form (H. Cohen, A Course in
Computational Algebraic Number Theory, section 2.4.3); the columns that become zero span the
solutions.
"""

from __future__ import annotations

import numpy as np

from gridshell.arrays import Indices


def integer_solutions(equations: list[dict[int, int]], size: int) -> Indices:
    """(size, k) basis of all integer vectors z with ``sum c_i z_i = 0`` for every equation.

    Every integer solution is an integer combination of the columns.

    Parameters
    ----------
    equations : coefficients by index; Python integers, so nothing overflows on the way.
    """
    basis = [[int(i == j) for i in range(size)] for j in range(size)]  # columns
    for equation in equations:
        basis = _solving(equation, basis)
    return np.array(basis, dtype=np.int64).reshape(len(basis), size).T


def _solving(equation: dict[int, int], basis: list[list[int]]) -> list[list[int]]:
    """The combinations of *basis* that also solve *equation*: Euclid's algorithm on its values."""
    values = [sum(c * column[i] for i, c in equation.items()) for column in basis]
    while True:
        live = [k for k, value in enumerate(values) if value]
        if len(live) < 2:
            return [column for k, column in enumerate(basis) if not values[k]]
        pivot = min(live, key=lambda k: abs(values[k]))
        for k in live:
            if k != pivot:
                times = values[k] // values[pivot]
                values[k] -= times * values[pivot]
                basis[k] = [x - times * y for x, y in zip(basis[k], basis[pivot], strict=True)]
