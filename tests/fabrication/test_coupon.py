"""The fit-test coupon."""

import itertools
from math import pi, radians
from typing import Any

import numpy as np
import pytest

import fabrication as fab
import gridshell as gs
from fabrication.coupon import GRADES, coupon
from fabrication.nesting import SheetPart

PROFILE = fab.Profile(width=60.0, thickness=4.0, material=fab.S235)


@pytest.mark.parametrize(
    ("degrees", "factor"), [(90, 1.0), (60, 3**0.5), (120, 3**0.5), (45, 2.41421)]
)
def test_slots_are_as_wide_as_a_strip_at_the_angle_and_graded(
    degrees: float, factor: float
) -> None:
    made = coupon(PROFILE, angle=radians(degrees), clearance=0.3)
    top = np.sort(made.outline[np.isclose(made.outline[:, 1], 60.0), 0])[1:-1]
    assert np.allclose(top[1::2] - top[::2], 4.0 * factor + 0.3 + np.array(GRADES), atol=1e-4)
    told = [float(label.text) for label in made.labels[1:]]
    assert np.allclose(told, 0.3 + np.array(GRADES))
    assert np.allclose([label.x for label in made.labels[1:]], (top[1::2] + top[::2]) / 2.0)


def test_it_is_a_sheet_part_whose_labels_keep_clear() -> None:
    part: SheetPart = coupon(PROFILE)
    assert np.allclose(part.outline.max(axis=0), (part.length, part.width))
    cut = sum((4.3 + grade) * 30.5 for grade in GRADES)
    assert part.area == pytest.approx(part.length * part.width - cut)
    spans = [
        (x.x - 0.45 * x.height * len(x.text), x.x + 0.45 * x.height * len(x.text))
        for x in part.labels
    ]
    assert all(a[1] < b[0] for a, b in itertools.pairwise(spans))
    assert spans[0][0] > 0.0
    assert spans[-1][1] < part.length
    assert all(x.y + x.height / 2.0 < 29.5 for x in part.labels)


@pytest.mark.parametrize(
    "bad",
    [
        {"angle": 0.0},
        {"angle": pi},
        {"angle": float("nan")},
        {"grades": ()},
        {"grades": (0.1, 0.0)},
        {"grades": (-9.0,)},
        {"clearance": float("nan")},
    ],
)
def test_bad_input_is_refused(bad: dict[str, Any]) -> None:
    with pytest.raises(gs.SettingError):
        coupon(PROFILE, **bad)
