import numpy as np

from gridshell.constraints import EdgeLength


def test_it_is_what_an_edge_is_too_long():
    x = np.array([[0, 0, 0], [3, 4, 0], [0, 0, 2]], dtype=float).ravel()
    found = EdgeLength(np.array([[0, 1], [2, 0]]), np.array([4.5, 2.0])).evaluate(x, None)
    np.testing.assert_allclose(found.residual[:, 0], [0.5, 0.0], atol=1e-15)
    np.testing.assert_allclose(found.values[0, 0], [-0.6, -0.8, 0, 0.6, 0.8, 0], atol=1e-15)


def test_an_edge_without_length_has_a_finite_derivative():
    found = EdgeLength(np.array([[0, 1]]), np.array([1.0])).evaluate(np.zeros(6), None)
    assert found.residual[0, 0] == -1.0 + 1e-12
    assert np.isfinite(found.values).all()
