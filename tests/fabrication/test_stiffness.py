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


def test_a_tube_by_integrals_over_its_wall():
    profile = fab.HollowProfile(50.0, 20.0, fab.GRP, 2.0)
    z, y = (np.linspace(-a / 2, a / 2, 2001) for a in (50.0, 20.0))
    z, y = np.meshgrid((z[1:] + z[:-1]) / 2, (y[1:] + y[:-1]) / 2, indexing="ij")
    in_wall = (np.abs(z) > 23.0) | (np.abs(y) > 8.0)
    piece = 50.0 * 20.0 / z.size
    found = stiffness(profile)
    weak, strong = (float((v**2)[in_wall].sum() * piece) for v in (y, z))
    assert found.weak == pytest.approx(fab.GRP.modulus * weak, rel=1e-3)
    assert found.strong == pytest.approx(fab.GRP.modulus * strong, rel=1e-3)
    ring = 4.0 * (48.0 * 18.0) ** 2 * 2.0 / (2.0 * (48.0 + 18.0))
    assert found.torsion == pytest.approx(fab.GRP.rigidity * ring)
    solid = stiffness(fab.Profile(60.0, 20.0, fab.GRP))
    assert found.torsion < solid.torsion
