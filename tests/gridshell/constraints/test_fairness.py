import numpy as np

import gridshell as gs
from gridshell.constraints import Fairness, second_differences

TRIPLE = np.array([[0, 1, 2]])


def residual(points, target=(0.0, 0.0, 0.0)):
    x = np.asarray(points, dtype=float).ravel()
    return Fairness(TRIPLE, np.array([target])).evaluate(x, None).residual.ravel()


def test_equal_steps_on_a_line_are_fair():
    assert residual([[0, 0, 0], [1, 2, 3], [2, 4, 6]]).tolist() == [0.0, 0.0, 0.0]


def test_unequal_steps_on_a_line_are_not():
    assert residual([[0, 0, 0], [1, 0, 0], [3, 0, 0]]).tolist() == [1.0, 0.0, 0.0]


def test_a_bend_is_its_second_difference():
    assert residual([[0, 0, 1], [1, 0, 0], [2, 0, 1]]).tolist() == [0.0, 0.0, 2.0]


def test_the_shape_given_as_target_is_fair():
    points = np.random.default_rng(1).normal(size=(3, 3))
    target = second_differences(points.ravel(), TRIPLE)
    assert residual(points, target[0]).tolist() == [0.0, 0.0, 0.0]


def test_a_linear_map_of_the_grid_adds_no_second_difference(grid):
    mesh = grid(4, 4)
    triples = gs.edge_stars(mesh).continuations()
    skewed = mesh.vertices @ np.array([[2.0, 1.0, 0.5], [0.0, 3.0, 1.0], [0.0, 0.0, 1.0]])
    np.testing.assert_allclose(second_differences(skewed.ravel(), triples), 0.0, atol=1e-14)


def test_each_coordinate_is_an_element_of_its_own():
    pattern = Fairness(np.array([[4, 0, 2]]), np.zeros((1, 3))).pattern()
    assert pattern.columns.tolist() == [[12, 0, 6], [13, 1, 7], [14, 2, 8]]
