import numpy as np
import pytest

from gridshell.constraints import EqualDiagonals

QUAD = np.array([[0, 1, 2, 3]])


def residual(a, b, **settings):
    """Of a flat quad with diagonals of length a and b."""
    x = np.array([[-a / 2, 0, 0], [0, -b / 2, 0], [a / 2, 0, 0], [0, b / 2, 0]])
    return EqualDiagonals(QUAD, **settings).evaluate(x.ravel(), None).residual[0, 0]


def test_equal_diagonals_have_no_residual():
    assert residual(1.3, 1.3) == 0.0
    assert residual(1.3, 1.3, as_printed=True) == 0.0


def test_it_is_the_difference_of_squares_over_their_sum():
    assert residual(2.0, 1.0) == pytest.approx(3.0 / 5.0, rel=1e-15)
    assert residual(1.0, 2.0) == pytest.approx(-3.0 / 5.0, rel=1e-15)


def test_as_printed_it_is_the_difference_of_squares():
    assert residual(2.0, 1.0, as_printed=True) == pytest.approx(3.0, rel=1e-15)


def test_it_does_not_fall_with_the_size_of_the_quad_but_the_printed_one_does():
    assert residual(2e-3, 1e-3) == pytest.approx(residual(2.0, 1.0), rel=1e-12)
    assert residual(2e-3, 1e-3, as_printed=True) < 1e-5
