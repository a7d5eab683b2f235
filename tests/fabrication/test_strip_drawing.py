import re
from dataclasses import replace

import numpy as np
import pytest

from fabrication.cut import Edge, Floor, Hole, Relief, Slot
from fabrication.strip_drawing import strip_drawing


def slots_at(*x, width=3.0, edge=Edge.UPPER, relief=None):
    relief = relief or Relief()
    return [Slot(s, width, 50.0, edge, f"N{k}", f"B{k}L", relief) for k, s in enumerate(x)]


def test_stations_are_to_scale_and_their_figures_a_pitch_apart(strip):
    drawing = strip_drawing(strip("A1", 5000.0, slots_at(50.0, 60.0, 2500.0)))
    x, at, figures = (np.array(column) for column in zip(*drawing["stations"], strict=True))
    np.testing.assert_allclose(x, np.array([0, 50, 60, 2500, 5000]) * 1040.0 / 5000.0, atol=0.06)
    assert np.diff(at).min() >= 12.9
    assert figures[3] == "2\u202f500.0"


@pytest.mark.parametrize("edge", [Edge.UPPER, Edge.LOWER])
def test_marks_of_close_slots_do_not_lie_on_each_other_nor_beside_the_strip(strip, edge):
    part = strip("A1", 9000.0, slots_at(35.0, 65.0, 1000.0, 1030.0, 8950.0, edge=edge))
    drawing = strip_drawing(part)
    labels = drawing["labels"]
    for k, (x, y, text) in enumerate(labels):
        half = 3.3 * len(text)
        assert half <= x <= drawing["length"] - half
        assert 4.0 < y < drawing["height"] - 4.0
        for other_x, other_y, _ in labels[:k]:
            assert abs(x - other_x) > 2.0 * half or abs(y - other_y) > 9.0


@pytest.mark.parametrize("relief", [None, Relief(Floor.ROUND), Relief(Floor.DOGBONE, 0.5)])
def test_close_slots_are_drawn_apart(strip, relief):
    part = strip("A1", 9000.0, slots_at(1000.0, 1030.0, width=1.8, relief=relief))
    ends = [
        float(x)
        for x in re.findall(r"[ML]?([\d.]+) 0\.0\b", strip_drawing(part)["path"].replace("L", " L"))
    ]
    walls = sorted(x for x in ends if 100.0 < x < 130.0)
    assert len(walls) == 4
    assert walls[0] < walls[1] < walls[2] < walls[3]


def test_arcs_turn_into_the_strip(strip):
    """A round floor is a half circle below its walls, drawn from right to left: clockwise."""
    part = strip("A1", 1000.0, slots_at(500.0, width=10.0, relief=Relief(Floor.ROUND)))
    (arc,) = re.findall(
        r"A([\d.]+) [\d.]+ 0 (\d) (\d) ([\d.]+) ([\d.]+)", strip_drawing(part)["path"]
    )
    radius, large, sweep, x, y = (float(value) for value in arc)
    assert radius == pytest.approx(10.0 * 1.04 / 2.0, abs=0.01)
    assert (large, y) == (0.0, pytest.approx(31.0))
    assert x == pytest.approx(520.0 - radius, abs=0.06)  # from right to left, along the outline
    assert sweep == 1.0


def test_a_strip_with_holes_alone_shows_their_stations(strip):
    holes = tuple(Hole(x, 50.0, 9.0, "N1", "stud") for x in (100.0, 700.0))
    drawing = strip_drawing(replace(strip("A1", 1000.0), holes=holes, bevels=(0.0, 4.0)))
    assert [figure for _, _, figure in drawing["stations"]] == [
        "0.0",
        "100.0",
        "700.0",
        "1\u202f000.0",
    ]
    assert drawing["labels"] == []
    assert [x for x, _, _ in drawing["holes"]] == pytest.approx([104.0, 728.0])
    assert drawing["bevels"] == [1035.0]
