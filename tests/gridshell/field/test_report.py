"""The figures of a field."""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np

from gridshell.field import Hand, asymptotic_field, conjugate_field, field_report
from gridshell.surface import CurvedMesh


def test_monkey_saddle(monkey: Callable[[int], CurvedMesh]) -> None:
    curved = monkey(12)
    report = field_report(curved, asymptotic_field(curved))
    np.testing.assert_allclose(report.positions, [[0.0, 0.0, 0.0]], atol=1e-15)
    assert (report.indices.tolist(), report.valences.tolist()) == ([-0.5], [6])
    assert (report.infeasible_area, report.umbilic_area, report.hand) == (0.0, 0.0, None)


def test_areas_and_angles_are_weighted_by_area(
    with_forms: Callable[..., CurvedMesh],
) -> None:
    # a quarter: umbilic, hence 90 degrees; a quarter: k1 / k2 = 1/4, hence 2 atan(1/2) at least
    rows = np.array([[1.0, 0.0, 1.0], [1.0, 0.0, 4.0], [-1.0, 0.0, 1.0], [-1.0, 0.0, 1.0]])
    curved = with_forms(rows)
    report = field_report(curved, conjugate_field(curved, 0.6, hand=Hand.LEFT), hand=Hand.LEFT)
    share = np.bincount(np.arange(len(curved.mesh.areas)) % 4, curved.mesh.areas)
    assert report.umbilic_area == np.float64(share[0]).round(12)
    assert abs(report.infeasible_area - 0.5) < 1e-12
    expected = [0.6, 0.6, 0.6, math.pi / 2.0, math.pi / 2.0]
    np.testing.assert_allclose(report.angles, expected, atol=1e-12)
    assert report.hand is Hand.LEFT
