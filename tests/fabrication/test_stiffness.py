import numpy as np
import pytest

import fabrication as fab
from fabrication.stiffness import stiffness, strip_stress
from fabrication.strength import section_stress


def test_a_strip_of_round_numbers():
    profile = fab.Profile(60.0, 2.0, fab.GRP)
    found = stiffness(profile)
    assert found.weak == pytest.approx(fab.GRP.modulus * 40.0)
    assert found.strong == pytest.approx(fab.GRP.modulus * 36_000.0)
    assert found.torsion == pytest.approx(fab.GRP.rigidity * 160.0)


def test_the_stress_is_that_of_the_bays():
    profile = fab.Profile(60.0, 2.0, fab.GRP)
    rates = [np.array([1e-4, 2e-4]), np.array([0.0, 1e-6]), np.array([1e-5, 0.0])]
    expected = section_stress(*rates, width=60.0, thickness=2.0, material=fab.GRP)
    found = strip_stress(*rates, profile)
    np.testing.assert_array_equal(found["utilisation"], expected["utilisation"])
