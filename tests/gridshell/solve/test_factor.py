"""One factor, many right-hand sides."""

import numpy as np
import pytest
from scipy.sparse import csr_matrix, diags, eye, kron

from gridshell.errors import SolveError
from gridshell.solve import Engine, solve_definite

ENGINES = {"portable": Engine(portable=True), "usual": Engine()}


def laplacian(n):
    line = diags([-1.0, 2.0, -1.0], [-1, 0, 1], shape=(n, n))
    return csr_matrix(kron(line, eye(n)) + kron(eye(n), line) + 0.01 * eye(n * n))


@pytest.mark.parametrize("engine", ENGINES.values(), ids=ENGINES)
def test_all_columns_are_solved(engine):
    matrix = laplacian(30)
    right = np.random.default_rng(0).normal(size=(900, 5))
    found = solve_definite(matrix, right, engine)
    assert found.shape == (900, 5)
    np.testing.assert_allclose(matrix @ found, right, atol=1e-9)


def test_both_engines_agree():
    matrix, right = laplacian(25), np.random.default_rng(1).normal(size=(625, 3))
    np.testing.assert_allclose(
        solve_definite(matrix, right, ENGINES["portable"]),
        solve_definite(matrix, right, ENGINES["usual"]),
        rtol=1e-9,
        atol=1e-10,
    )


@pytest.mark.parametrize("engine", ENGINES.values(), ids=ENGINES)
def test_a_rerun_gives_the_same_bytes(engine):
    matrix, right = laplacian(25), np.random.default_rng(1).normal(size=(625, 3))
    first, second = (solve_definite(matrix, right, engine).tobytes() for _ in range(2))
    assert first == second


@pytest.mark.parametrize("engine", ENGINES.values(), ids=ENGINES)
def test_a_singular_matrix_is_refused(engine):
    singular = csr_matrix(np.array([[1.0, 0.0, 0.0], [0.0, 0.0, 0.0], [0.0, 0.0, 2.0]]))
    with pytest.raises(SolveError):
        solve_definite(singular, np.ones((3, 1)), engine)


@pytest.mark.parametrize("engine", ENGINES.values(), ids=ENGINES)
def test_the_matrix_handed_in_is_not_changed(engine):
    matrix = laplacian(8)
    before = matrix.data.copy()
    solve_definite(matrix, np.ones((64, 1)), engine)
    assert (matrix.data == before).all()
