import re
from xml.etree import ElementTree

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

import gridshell as gs
from fabrication.export.bars import bars_of, round_step
from fabrication.export.histogram import histogram
from fabrication.export.quality_series import histograms, net_series, stress_series
from fabrication.strength import bay_stress

SVG = "{http://www.w3.org/2000/svg}"
NUMBERS = st.floats(-1e12, 1e12, allow_subnormal=False).filter(lambda x: x == 0.0 or abs(x) > 1e-12)


@given(st.lists(NUMBERS, max_size=60), st.none() | NUMBERS)
def test_every_value_is_counted_once_in_the_bar_it_lies_in(values, limit):
    bars = bars_of(values, limit=limit)
    assert bars.counts.sum() == len(values) == bars.known
    assert 1 <= len(bars.counts) <= 60
    steps = np.diff(bars.stops)
    np.testing.assert_allclose(steps, steps[0], rtol=1e-3)
    room = 1e-6 * steps[0]
    for k, count in enumerate(bars.counts[:-1].tolist()):
        inside = [bars.stops[k] - room <= v <= bars.stops[k + 1] + room for v in values]
        assert sum(inside) >= count
    assert all(bars.low - room <= tick <= bars.high + room for tick in bars.ticks.tolist())
    assert 2 <= len(bars.ticks) <= 12
    assert bars.heights[-1] >= bars.counts.max(initial=0)
    if limit is not None and bars.shown:
        assert bars.low - room <= limit <= bars.high + room
    assert len(set(bars.figures())) == len(bars.ticks)


@pytest.mark.parametrize(("least", "step"), [(0.3, 0.5), (1.0, 1.0), (1.1, 2.0), (61.0, 100.0)])
def test_steps_are_round(least, step):
    assert round_step(least) == pytest.approx(step)


def test_what_is_no_number_is_counted_apart():
    bars = bars_of([1.0, np.nan, 2.0, np.inf, -np.inf])
    assert (bars.known, bars.missing) == (2, 3)
    assert (bars.mean, bars.largest) == (1.5, 2.0)
    assert "3 not measured" in histogram([1.0, np.nan, 2.0, np.inf, -np.inf], title="t")


def test_equal_values_are_one_bar_around_them():
    bars = bars_of(np.full(40, 2.5))
    assert np.count_nonzero(bars.counts) == 1
    assert bars.low < 2.5 < bars.high
    nought = bars_of(np.zeros(7))
    assert nought.counts.tolist()[0] == 7
    assert nought.low == 0.0


def test_errors_are_counted_from_nought():
    assert bars_of([1e-9, 4e-9, 9e-9]).low == 0.0
    assert bars_of([0.9, 1.1]).low > 0.5


def test_a_limit_is_a_line_where_it_is_near_and_words_where_it_is_not():
    near, far = (histogram([1.0, 40.0], title="t", unit="%", limit=x) for x in (100.0, 1000.0))
    assert 'class="limit"' in near
    assert 'class="limit"' not in far
    assert "limit 100 %" in near
    assert "limit 1000 %" in far
    assert "limit" not in histogram([1.0, 40.0], title="t", unit="%")


def test_the_limit_stands_between_what_passes_and_what_does_not():
    root = ElementTree.fromstring(histogram([10.0] * 3 + [190.0] * 2, title="t", limit=100.0))
    line = next(path for path in root.iter(f"{SVG}path") if path.get("class") == "limit")
    at = float(re.match(r"M([\d.]+)", line.get("d"))[1])
    bars = [float(rect.get("x")) for rect in root.iter(f"{SVG}rect")]
    assert bars[0] < at < bars[1]


def test_bars_are_as_high_as_their_counts():
    root = ElementTree.fromstring(histogram([1.0] * 10 + [5.0] * 5, title="t"))
    high, low = (float(rect.get("height")) for rect in root.iter(f"{SVG}rect"))
    assert high == pytest.approx(2.0 * low, abs=0.11)


def test_small_values_have_a_power_of_ten_at_their_axis():
    text = histogram([1e-9, 2e-9, 6e-9], title="Angle error", unit="°")
    assert "× 10⁻⁹ °" in text
    assert re.search(r">2</text>", text)


@pytest.mark.parametrize("values", [[], [np.nan, np.nan], np.zeros((0, 3))])
def test_without_values_it_says_so(values):
    root = ElementTree.fromstring(histogram(values, title="t", unit="mm", limit=3.0))
    assert any((text.text or "").startswith("no values") for text in root.iter(f"{SVG}text"))
    assert not list(root.iter(f"{SVG}rect"))


def test_text_is_escaped_and_nothing_runs():
    hostile = "</svg><script>alert('x')</script> & \"é\""
    root = ElementTree.fromstring(histogram([1.0, 2.0], title=hostile, unit=hostile, limit=1.5))
    assert root.get("aria-label") == hostile
    assert root.find(f".//{SVG}script") is None


def test_series_hold_what_the_report_s_figures_are_read_off(enneper):
    control = enneper.control
    surface = gs.Enneper(4000.0)
    quality = gs.net_quality(control, angle=np.radians(60.0), reference=surface)
    found = {one.title: one for one in net_series(quality.figures, surface_limit=50.0)}
    assert found["Node angle error"].values.max() == quality.angle_error_deg.max
    assert found["Star planarity, over mean edge"].values.max() == quality.star_planarity.max
    distance = found["Distance from the surface"]
    assert distance.values.mean() == quality.surface_distance_mm.mean
    assert distance.limit == 50.0
    edges = found["Edge length over the mean"].values
    assert (edges.min(), edges.max()) == quality.edge_ratio
    assert edges.mean() == pytest.approx(1.0)
    assert not any("Face" in title or "Rhombus" in title for title in found)


def test_a_planar_net_has_its_faces_and_rhombi(enneper):
    planarity = gs.Planarity.WHITE_FACES
    quality = gs.net_quality(enneper.control, planarity=planarity, rhombus=True)
    found = {one.title: one for one in net_series(quality.figures)}
    faces = found["Face planarity, over mean diagonal"].values
    assert faces.max() == quality.face_planarity.max
    rhombi = found["Rhombus error, over mean diagonal"].values
    assert rhombi.mean() == quality.rhombus_error.mean
    assert not any("Star" in title or "Distance" in title for title in found)


def test_stress_is_shown_against_the_strength(enneper):
    stress = bay_stress(enneper.structure, enneper.parts)
    series = stress_series(stress)
    assert len(series.values) == len(stress)
    assert series.limit == 100.0
    (text,) = histograms([series])
    assert "limit 100 %" in text
    ElementTree.fromstring(text)
