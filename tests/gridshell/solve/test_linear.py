import sys

import numpy as np
import pytest

import gridshell as gs
from gridshell.solve import Engine, Evaluation, Pattern
from gridshell.solve.linear import NormalEquations, factorisation

SIZE, FIXED, WEIGHTS = 12, np.array([2, 7]), [1.0, 0.25]


def dense(pattern, values):
    jacobian = np.zeros((len(pattern.columns) * pattern.rows, SIZE))
    rows = np.arange(len(jacobian)).reshape(-1, pattern.rows)
    for element, columns in enumerate(pattern.columns):
        jacobian[np.ix_(rows[element], columns)] = values[element]
    return jacobian


@pytest.fixture
def elements():
    """Two terms of random elements over twelve unknowns, some seen by no element."""
    rng = np.random.default_rng(3)
    columns = [np.array([rng.permutation(10)[:k] for _ in range(m)]) for m, k in ((9, 4), (5, 3))]
    patterns = [Pattern(c, rows) for c, rows in zip(columns, (2, 1), strict=True)]
    evaluations = [
        Evaluation(
            rng.normal(size=(len(p.columns), p.rows)),
            rng.normal(size=(len(p.columns), p.rows, p.columns.shape[1])),
        )
        for p in patterns
    ]
    return patterns, evaluations


@pytest.fixture
def truth(elements):
    """J^T W J and J^T W r of the free unknowns, dense."""
    matrix, gradient = np.zeros((SIZE, SIZE)), np.zeros(SIZE)
    for pattern, evaluation, weight in zip(*elements, WEIGHTS, strict=True):
        jacobian = dense(pattern, evaluation.values)
        matrix += weight * jacobian.T @ jacobian
        gradient += weight * jacobian.T @ evaluation.residual.ravel()
    free = np.setdiff1d(np.arange(SIZE), FIXED)
    return matrix[np.ix_(free, free)], gradient[free]


def upper(equations, data):
    n = len(equations.free)
    matrix = np.zeros((n, n))
    rows = np.repeat(np.arange(n), np.diff(equations.indptr))
    matrix[rows, equations.indices] = data
    return matrix


def test_assembled_entries_are_the_upper_triangle_of_the_dense_product(elements, truth):
    patterns, evaluations = elements
    equations = NormalEquations(SIZE, patterns, FIXED)
    data, gradient = equations.assemble(evaluations, WEIGHTS)
    np.testing.assert_allclose(upper(equations, data), np.triu(truth[0]), atol=1e-13)
    np.testing.assert_allclose(gradient, truth[1], atol=1e-13)


def test_without_fixed_unknowns_every_one_is_free(elements):
    patterns, _ = elements
    equations = NormalEquations(SIZE, patterns, np.empty(0, dtype=np.int64))
    assert equations.free.tolist() == list(range(SIZE))


def test_an_unknown_no_element_sees_keeps_its_diagonal_entry(elements):
    patterns, evaluations = elements
    equations = NormalEquations(SIZE, patterns, FIXED)
    data, _ = equations.assemble(evaluations, WEIGHTS)
    matrix = upper(equations, equations.damped(data, 0.5))
    np.testing.assert_array_equal(np.diag(matrix)[-2:], [0.5, 0.5])


def test_damping_touches_the_diagonal_only_and_not_its_input(elements):
    patterns, evaluations = elements
    equations = NormalEquations(SIZE, patterns, FIXED)
    data, _ = equations.assemble(evaluations, WEIGHTS)
    before = data.copy()
    added = upper(equations, equations.damped(data, 2.0)) - upper(equations, data)
    np.testing.assert_allclose(added, 2.0 * np.eye(10), atol=1e-14)
    np.testing.assert_array_equal(data, before)


def test_entries_that_become_zero_keep_their_place(elements):
    patterns, evaluations = elements
    equations = NormalEquations(SIZE, patterns, FIXED)
    nothing = [Evaluation(e.residual, 0.0 * e.values) for e in evaluations]
    data, _ = equations.assemble(nothing, WEIGHTS)
    assert data.tolist() == [0.0] * equations.nonzeros


def test_column_indices_are_sorted_in_every_row(elements):
    equations = NormalEquations(SIZE, elements[0], FIXED)
    for start, stop in zip(equations.indptr[:-1], equations.indptr[1:], strict=True):
        row = equations.indices[start:stop]
        assert (np.diff(row) > 0).all()


def test_expanding_a_step_puts_zero_at_fixed_unknowns(elements):
    equations = NormalEquations(SIZE, elements[0], FIXED)
    full = equations.expand(np.arange(1.0, 11.0))
    assert full.tolist() == [1, 2, 0, 3, 4, 5, 6, 0, 7, 8, 9, 10]


@pytest.fixture(params=["fastest", "portable"])
def solver(request, elements):
    equations = NormalEquations(SIZE, elements[0], FIXED)
    found = factorisation(equations, Engine(portable=request.param == "portable"))
    yield equations, found
    found.close()


def test_a_factorisation_solves_the_damped_equations(solver, elements, truth):
    equations, factor = solver
    data, gradient = equations.assemble(elements[1], WEIGHTS)
    step = factor.solve(equations.damped(data, 0.1), gradient)
    expected = np.linalg.solve(truth[0] + 0.1 * np.eye(10), truth[1])
    np.testing.assert_allclose(step, expected, rtol=1e-11)


def test_a_factorisation_can_be_used_again_with_other_entries(solver, elements, truth):
    equations, factor = solver
    data, gradient = equations.assemble(elements[1], WEIGHTS)
    for damping in (0.1, 10.0, 0.5):
        step = factor.solve(equations.damped(data, damping), gradient)
        expected = np.linalg.solve(truth[0] + damping * np.eye(10), truth[1])
        np.testing.assert_allclose(step, expected, rtol=1e-11)


def test_a_matrix_that_cannot_be_factored_raises_a_solve_error(solver):
    equations, factor = solver
    with pytest.raises(gs.SolveError, match="could not be factored"):
        factor.solve(np.zeros(equations.nonzeros), np.ones(len(equations.free)))


def test_without_pardiso_the_portable_solver_steps_in(monkeypatch, elements, truth):
    monkeypatch.setitem(sys.modules, "pypardiso", None)
    equations = NormalEquations(SIZE, elements[0], FIXED)
    portable = factorisation(equations, Engine(portable=True))
    fallen_back = factorisation(equations)
    assert type(fallen_back) is type(portable)


def test_pardiso_is_used_where_it_is_installed(elements):
    pytest.importorskip("pypardiso")
    equations = NormalEquations(SIZE, elements[0], FIXED)
    fastest, portable = factorisation(equations), factorisation(equations, Engine(portable=True))
    assert type(fastest) is not type(portable)
    fastest.close()
