import numpy as np

from gridshell.constraints import Closeness


def test_it_is_the_move_from_the_start():
    found = Closeness(np.array([1.0, 2.0])).evaluate(np.array([1.5, 1.0]), None)
    assert found.residual.tolist() == [[0.5], [-1.0]]


def test_unknowns_behind_the_start_are_left_out():
    constraint = Closeness(np.zeros(3))
    assert constraint.pattern().columns.tolist() == [[0], [1], [2]]
    assert constraint.evaluate(np.full(6, 9.0), None).residual.shape == (3, 1)
