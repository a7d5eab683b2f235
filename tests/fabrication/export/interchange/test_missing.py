import sys

import pytest

import gridshell as gs
from fabrication.export.interchange.missing import required


def test_a_missing_library_says_what_to_install(monkeypatch):
    monkeypatch.setitem(sys.modules, "rhino3dm", None)
    with pytest.raises(gs.SettingError, match="rhino3dm") as caught:
        required("rhino3dm", "3dm")
    assert "interchange" in str(caught.value)
    assert caught.value.value == "3dm"


def test_a_library_that_is_there_is_given():
    assert required("json", "3dm").dumps([1]) == "[1]"
