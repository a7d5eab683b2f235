"""Boundaries along a family."""

from math import radians

import numpy as np
import pytest
from surfaces import CASES

from gridshell.field import FrameField, asymptotic_field, principal_field
from gridshell.remesh.boundary_runs import aligned_runs


@pytest.fixture(scope="module")
def curved():
    return CASES["hypar"].triangles(900)


@pytest.fixture(scope="module")
def square(curved):
    return curved.mesh


@pytest.fixture(scope="module")
def turned(curved):
    """The rulings, which are the sides of the square, turned by so many degrees."""
    rulings = asymptotic_field(curved)

    def build(mesh, degrees):
        turn = radians(degrees)
        return FrameField.of_lines(mesh, rulings.first + turn, rulings.second + turn)

    return build


def test_two_sides_run_along_each_family(square, turned):
    field = turned(square, 0.0)
    across = np.abs(square.vertices[square.origin] - square.vertices[square.target])
    axes = []
    for family in (1, 2):
        found = aligned_runs(field, family, 500.0)
        assert (square.twin[found] < 0).all()
        axes.append(int(np.argmax(across[found].sum(axis=0)[:2])))
        assert (across[found, 1 - axes[-1]] < 1e-6).all()
        assert across[found, axes[-1]].sum() > 0.9 * 4000.0
    assert sorted(axes) == [0, 1]


@pytest.mark.parametrize(("degrees", "any_"), [(4.0, True), (15.0, False), (45.0, False)])
def test_a_run_may_stray_a_little(square, turned, degrees, any_):
    assert aligned_runs(turned(square, degrees), 1, 1500.0).any() == any_


def test_short_runs_do_not_count(square, turned):
    assert not aligned_runs(turned(square, 0.0), 1, 4000.0).any()


def test_a_whole_loop_is_a_run():
    curved = CASES["catenoid"].triangles(900)
    field = principal_field(curved)
    runs = [aligned_runs(field, family, 100.0) for family in (1, 2)]
    assert sorted(int(r.sum()) for r in runs) == [0, int((curved.mesh.twin < 0).sum())]
