import numpy as np
import pytest

from fabrication.cut import area
from fabrication.export.step_loops import landmarks, quadrature, segments

NOTCHED = np.array(
    [[0, 0], [40, 0], [40, 20], [44, 20], [44, 0], [100, 0], [100, 50], [0, 50]], dtype=float
)


def test_landmarks_are_corners_and_the_tops_of_arcs():
    rows = np.array([[0, 0, 0], [10, 0, 1.0], [10, 6, 0], [0, 6, 0]], dtype=float)
    found = landmarks(rows)
    assert found[:4].tolist() == rows[:, :2].tolist()
    assert found[4].tolist() == [13.0, 3.0]
    assert landmarks(NOTCHED) is not None
    assert len(landmarks(NOTCHED)) == len(NOTCHED)


@pytest.mark.parametrize(
    ("power", "slanted"), [((0, 0), False), ((1, 2), False), ((3, 1), False), ((2, 2), True)]
)
def test_monomials_over_a_polygon_are_integrated_exactly(power, slanted):
    loop = NOTCHED.copy()
    if slanted:  # corners of the notch cut off, as chords of a dogbone are
        loop = np.array(
            [[0, 0], [40, 0], [40, 15], [43, 20], [50, 0], [100, 0], [90, 50], [0, 50]], dtype=float
        )
    p, q = power
    u, v, weight = quadrature(loop, np.array([0.0, 30.0, 77.0]))
    found = float((u**p * v**q) @ weight)
    assert found == pytest.approx(_moment(loop, p, q), rel=1e-10)


def _moment(loop, p, q):
    """Integral of u^p v^q over a polygon by Green's theorem, with Gauss points along its edges."""
    nodes, weights = np.polynomial.legendre.leggauss(12)
    total = 0.0
    for a, b in zip(loop, np.roll(loop, -1, axis=0), strict=True):
        middle, half = (a + b) / 2.0, (b - a) / 2.0
        x, y = (middle + half * nodes[:, None]).T
        total += float((x ** (p + 1) / (p + 1) * y**q * half[1]) @ weights)
    return total


def test_segments_make_up_for_what_chords_leave_out():
    rows = np.array([[0, 0, 0], [20, 0, 0.4], [20, 10, 0], [0, 10, -0.7]], dtype=float)
    _, areas = segments(rows)
    assert area(rows[:, :2]) + areas.sum() == pytest.approx(area(rows))
