import json
from pathlib import Path

import pytest

import fabrication as fab
from fabrication.defaults import defaults_of
from fabrication.summary import defaults_line

EXAMPLES = sorted((Path(__file__).parents[2] / "examples").glob("*.toml"))


def test_what_a_project_sets_is_no_default():
    project = fab.read_project(EXAMPLES[0])
    found = defaults_of(project)
    assert "net.angle" not in found
    assert "joint.clearance" not in found  # said there
    assert found["net.steps"] == 30
    assert found["sheet.margin"] == 10.0


@pytest.mark.parametrize("path", EXAMPLES, ids=lambda path: path.stem)
def test_every_default_is_what_the_project_has(path):
    project = fab.read_project(path)
    for key, value in defaults_of(project).items():
        here = project
        for word in key.split("."):
            here = getattr(here, word)
        assert here == (tuple(value) if isinstance(here, tuple) else value)
    json.dumps(defaults_of(project), allow_nan=False)


def test_a_section_that_is_not_there_has_no_keys():
    found = defaults_of(fab.read_project(EXAMPLES[0]))
    assert not any(key.startswith(("bars.", "shop.", "panels.")) for key in found)


def test_the_line_names_what_a_shop_needs_first_and_counts_the_rest():
    line = defaults_line(
        {"net.steps": 30, "net.rhombus": False, "joint.clearance": 0.3, "sheet.gap": 10.0}
    )
    assert line == "by default: joint.clearance = 0.3, sheet.gap = 10, net.steps = 30"
    many = defaults_line({f"net.k{n}": 1 for n in range(9)})
    assert many.endswith(" and 3 more, see report.json")
