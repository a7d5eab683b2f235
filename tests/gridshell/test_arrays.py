import numpy as np
import pytest

from gridshell.arrays import frozen, unit


def test_frozen_is_a_copy_that_cannot_be_written():
    original = np.zeros(3)
    copy = frozen(original)
    original[0] = 1.0
    assert copy.tolist() == [0.0, 0.0, 0.0]
    with pytest.raises(ValueError, match="read-only"):
        copy[0] = 1.0


def test_frozen_is_contiguous_and_of_the_wanted_type():
    copy = frozen(np.arange(6).reshape(2, 3).T, np.int64)
    assert copy.flags.c_contiguous
    assert copy.dtype == np.int64
    assert frozen([1, 2]).dtype == np.float64


def test_unit_scales_to_length_one_and_leaves_zero_alone():
    np.testing.assert_array_equal(
        unit(np.array([[0.0, 3.0, 4.0], [0.0, 0.0, 0.0]])), [[0, 0.6, 0.8], [0, 0, 0]]
    )
