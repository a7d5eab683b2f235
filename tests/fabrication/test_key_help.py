import pytest

from fabrication.key_help import KEYS, key_help
from fabrication.project import _sections
from fabrication.sections import Project

SECTIONS = {**_sections(), "Project": Project}


@pytest.mark.parametrize("name", SECTIONS)
def test_every_key_has_a_line(name):
    missing = [key for key in SECTIONS[name].model_fields if not key_help(name, key)]
    assert missing == []


def test_every_line_belongs_to_a_key_that_is_there():
    for name, lines in KEYS.items():
        known = {key for s in SECTIONS.values() for key in s.model_fields}
        own = known if name == "*" else set(SECTIONS[name].model_fields)
        assert set(lines) <= own, name


def test_what_is_not_there_has_no_line():
    assert key_help("net", "nothing") == ""
