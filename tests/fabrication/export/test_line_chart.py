import re
import xml.etree.ElementTree as ET

import numpy as np
import pytest

from fabrication.export.line_chart import Course, line_chart

X = np.linspace(10.0, 90.0, 9)
DOWN, UP = Course("falls", "#111111", X[::-1] / 3.0), Course("rises & falls", "#222222", X / 2.0)


@pytest.fixture(scope="module")
def chart():
    return line_chart(X, [DOWN, UP], title="Angles", unit="degrees <", axis="opening, %")


def places(chart):
    for line in re.findall(r'<polyline points="([^"]*)"', chart):
        yield np.array([[float(n) for n in pair.split(",")] for pair in line.split()])


def test_lines_are_to_scale_between_round_figures(chart):
    ticks = re.findall(r'y="([\d.]+)" text-anchor="end" fill="#5a6472">(\d+)</text>', chart)
    at = {float(text): float(y) - 4.0 for y, text in ticks}
    stops = sorted(at)
    assert stops[0] == 0.0
    assert stops[-1] >= 45.0
    per_unit = (at[stops[0]] - at[stops[-1]]) / stops[-1]
    for line, course in zip(places(chart), (DOWN, UP), strict=True):
        np.testing.assert_allclose(at[0.0] - line[:, 1], course.values * per_unit, atol=0.1)
        steps = np.diff(line[:, 0])
        np.testing.assert_allclose(steps, steps.mean(), atol=0.11)


def test_the_mark_runs_from_the_first_place_to_the_last(chart):
    begin = float(re.search(r'class="now"[^>]*d="M([\d.]+) ', chart)[1])
    span = float(re.search(r'data-span="([\d.]+)"', chart)[1])
    line = next(places(chart))
    assert line[0, 0] == pytest.approx(begin, abs=0.1)
    assert line[-1, 0] == pytest.approx(begin + span, abs=0.1)


def test_words_are_text(chart):
    told = [node.text for node in ET.fromstring(chart).iter("{http://www.w3.org/2000/svg}text")]
    assert {"Angles, degrees <", "falls", "rises & falls", "opening, %"} <= set(told)


def test_a_course_of_noughts_has_an_axis_all_the_same():
    flat = line_chart(X, [Course("none", "#111111", 0.0 * X)], title="t", unit="u", axis="a")
    assert "nan" not in flat
    assert len({y for _, y in next(places(flat))}) == 1
