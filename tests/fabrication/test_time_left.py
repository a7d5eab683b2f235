import json

import pytest

from fabrication.time_left import TimeLeft, times_before


class Hand:
    """A clock that is moved by hand."""

    def __init__(self):
        self.time = 100.0

    def __call__(self):
        return self.time


@pytest.fixture
def hand():
    return Hand()


def test_nothing_is_said_where_nothing_is_known(hand):
    left = TimeLeft({}, hand)
    left.begin("optimise")
    hand.time += 5.0
    assert left.seconds() is None
    assert left.words() == ""


def test_a_share_tells_the_rest_of_its_stage(hand):
    left = TimeLeft({}, hand)
    left.begin("sheets")
    hand.time += 3.0
    left.reach(0.25)
    assert left.seconds() == pytest.approx(9.0)
    assert left.words() == "about 9 s left"
    left.reach(0.1)  # never back
    assert left.share == 0.25


def test_a_share_too_small_or_too_early_is_no_ground(hand):
    left = TimeLeft({}, hand)
    left.begin("sheets")
    hand.time += 3.0
    left.reach(0.05)
    assert left.seconds() is None
    left.begin("solids")
    hand.time += 0.1
    left.reach(0.5)
    assert left.seconds() is None


def test_an_earlier_run_tells_the_stages_to_come(hand):
    left = TimeLeft({"optimise": 4.0, "sheets": 10.0, "solids": 100.0}, hand)
    left.begin("optimise")
    assert left.seconds() == pytest.approx(114.0)
    hand.time += 3.0
    assert left.seconds() == pytest.approx(111.0)
    left.begin("sheets")
    hand.time += 20.0  # later than before: nothing more of this stage is promised
    assert left.seconds() == pytest.approx(100.0)
    left.begin("solids")
    hand.time += 90.0
    left.reach(0.5)  # what is measured now counts more than what was
    assert left.seconds() == pytest.approx(90.0)
    assert left.words() == "about 2 min left"


def test_a_stage_that_is_new_is_not_guessed(hand):
    left = TimeLeft({"optimise": 4.0}, hand)
    left.begin("motion")
    assert left.seconds() is None


@pytest.mark.parametrize("text", ["", "[]", "{}", '{"timing": 3}', '{"timing": {"a": "x"}}'])
def test_a_report_that_is_none_of_ours_tells_nothing(tmp_path, text):
    (tmp_path / "report.json").write_text(text)
    assert times_before(tmp_path) == {}


def test_times_come_from_the_report_of_an_earlier_run(tmp_path):
    assert times_before(tmp_path / "nowhere") == {}
    (tmp_path / "report.json").write_text(json.dumps({"timing": {"a": 1, "b": 2.5}}))
    assert times_before(tmp_path) == {"a": 1.0, "b": 2.5}
