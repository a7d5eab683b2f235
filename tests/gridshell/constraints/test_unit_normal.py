import numpy as np

from gridshell.constraints import UnitNormal


def test_it_vanishes_for_unit_vectors_only():
    points = np.array([[0.6, 0.0, 0.8], [0.0, 2.0, 0.0], [0.0, 0.0, 0.0]])
    found = UnitNormal(np.array([0, 1, 2])).evaluate(points.ravel(), None).residual
    np.testing.assert_allclose(found.ravel(), [0.0, 3.0, -1.0], atol=1e-15)


def test_it_reads_the_points_it_is_given():
    points = np.array([[9.0, 9.0, 9.0], [0.0, 1.0, 0.0]])
    assert UnitNormal(np.array([1])).evaluate(points.ravel(), None).residual.tolist() == [[0.0]]
