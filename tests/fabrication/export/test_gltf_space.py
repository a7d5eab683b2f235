import numpy as np
import pytest

from fabrication.export.gltf_space import linear, upright


def test_z_becomes_y_and_hands_stay():
    axes = upright(1000.0 * np.eye(3))
    assert axes[2].tolist() == [0.0, 1.0, 0.0]
    assert np.linalg.det(axes) == pytest.approx(1.0)


def test_black_and_white_stay_and_grey_is_darker():
    assert linear((0.0, 1.0, 0.5)) == pytest.approx((0.0, 1.0, 0.5**2.2))
