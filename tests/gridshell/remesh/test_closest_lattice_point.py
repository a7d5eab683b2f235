"""The closest integer vector against brute force."""

from itertools import product

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from gridshell.errors import SolveError
from gridshell.remesh.closest_lattice_point import closest_lattice_point


def problem(seed, m, skew=2.0):
    rng = np.random.default_rng(seed)
    root = rng.normal(size=(m, m)) + skew * np.triu(np.ones((m, m)))
    return root.T @ root + 1e-3 * np.eye(m), rng.normal(scale=3.0, size=m)


def energy(form, target, point):
    away = np.asarray(point) - target
    return float(away @ form @ away)


@given(st.integers(0, 10_000), st.integers(1, 3))
@settings(max_examples=60)
def test_no_vector_nearby_is_closer(seed, m):
    form, target = problem(seed, m)
    found = closest_lattice_point(form, target)
    assert found.exact
    np.testing.assert_allclose(found.energy, energy(form, target, found.integers), rtol=1e-9)
    around = np.rint(target).astype(int)
    best = min(energy(form, target, around + np.array(d)) for d in product(range(-5, 6), repeat=m))
    assert found.energy <= best * (1.0 + 1e-9)


@given(st.integers(0, 10_000), st.integers(1, 14))
@settings(max_examples=60)
def test_never_worse_than_rounding_one_after_the_other(seed, m):
    form, target = problem(seed, m)
    found = closest_lattice_point(form, target)
    point, upper = np.zeros(m), np.linalg.cholesky(form).T
    for k in reversed(range(m)):
        centre = target[k] - upper[k, k + 1 :] @ (point - target)[k + 1 :] / upper[k, k]
        point[k] = np.rint(centre)
    greedy = energy(form, target, point)
    np.testing.assert_allclose(found.greedy, greedy, rtol=1e-6)
    assert found.energy <= greedy * (1.0 + 1e-9)
    assert found.energy <= energy(form, target, np.rint(target)) * (1.0 + 1e-9)


def test_greedy_is_worse_in_a_skew_form():
    form = np.array([[1.0, 0.95], [0.95, 1.0]])
    found = closest_lattice_point(form, np.array([0.45, 0.55]))
    assert found.energy < found.greedy or found.energy == pytest.approx(found.greedy)
    assert energy(form, np.array([0.45, 0.55]), [1, 0]) >= found.energy


def test_a_limit_of_nodes_still_gives_a_vector_and_says_it_is_not_exact():
    form, target = problem(5, 25, skew=0.3)
    limited = closest_lattice_point(form, target, most=30)
    assert not limited.exact
    assert limited.energy == pytest.approx(energy(form, target, limited.integers), rel=1e-6)
    assert limited.energy <= limited.greedy


def test_fewer_nodes_than_numbers_still_give_the_greedy_vector():
    form, target = problem(5, 25, skew=0.3)
    limited = closest_lattice_point(form, target, most=3)
    assert len(limited.integers) == 25
    assert limited.energy == pytest.approx(limited.greedy)


def test_nothing_to_round():
    found = closest_lattice_point(np.zeros((0, 0)), np.zeros(0))
    assert len(found.integers) == 0
    assert found.exact


def test_a_form_that_is_not_definite_is_a_named_error():
    with pytest.raises(SolveError, match="integers"):
        closest_lattice_point(np.array([[1.0, 1.0], [1.0, 1.0]]) - 1e-3, np.zeros(2))
