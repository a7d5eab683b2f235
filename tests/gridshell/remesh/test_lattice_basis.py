"""Integer solutions against brute force."""

from itertools import product

import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from gridshell.remesh.lattice_basis import integer_solutions

COEFFICIENTS = st.integers(-4, 4)
EQUATIONS = st.integers(1, 4).flatmap(
    lambda size: st.tuples(
        st.just(size),
        st.lists(st.lists(COEFFICIENTS, min_size=size, max_size=size), min_size=0, max_size=3),
    )
)


def as_rows(equations):
    return [{i: c for i, c in enumerate(row) if c} for row in equations]


@given(EQUATIONS)
def test_every_small_solution_is_a_whole_combination_of_the_basis(case):
    size, equations = case
    basis = integer_solutions(as_rows(equations), size)
    matrix = np.array(equations, dtype=np.int64).reshape(-1, size)
    assert basis.shape == (size, size - np.linalg.matrix_rank(matrix) if len(matrix) else size)
    assert not (matrix @ basis).any()
    for z in product(range(-3, 4), repeat=size):
        if (matrix @ np.array(z)).any():
            continue
        if basis.shape[1] == 0:
            assert not any(z)
            continue
        share = np.linalg.lstsq(basis.astype(float), np.array(z, dtype=float), rcond=None)[0]
        assert (basis @ np.rint(share).astype(np.int64) == z).all()


def test_a_common_divisor_is_divided_out():
    # 2 x = 4 y has the solutions (2, 1) t, not (4, 2) t
    assert sorted(np.abs(integer_solutions([{0: 2, 1: -4}], 2)).ravel().tolist()) == [1, 2]


def test_large_coefficients_are_exact():
    big = 10**17
    basis = integer_solutions([{0: big, 1: big + 1, 2: 3 * big}], 3)
    assert basis.shape == (3, 2)
    for column in basis.T.tolist():
        assert big * column[0] + (big + 1) * column[1] + 3 * big * column[2] == 0
