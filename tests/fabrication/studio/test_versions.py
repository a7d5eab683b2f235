import pytest

from fabrication.errors import ProjectError
from fabrication.studio.disk import read
from fabrication.studio.versions import History, Version, differences, set_value


@pytest.fixture
def version(path):
    return Version.of(read(path).document, path)


def test_a_value_is_set_by_its_key_and_the_version_before_stays(version, path):
    turned = version.with_value("net.angle", 62.0, path)
    assert (version.value("net.angle"), turned.value("net.angle")) == (70.0, 62.0)
    assert turned.with_value("patch.lamellas.1", 9, path).value("patch.lamellas.1") == 9


def test_what_nobody_touched_stays_unset(version, path):
    turned = version.with_value("net.fairness", 0.1, path)
    assert set(turned.document["net"]) == {*version.document["net"], "fairness"}
    assert turned.value("joint.clearance") is not None  # by default
    assert turned.value("bars.length") is None


def test_a_value_that_cannot_be_names_its_key(version, path):
    with pytest.raises(ProjectError, match=r"net\.angle"):
        version.with_value("net.angle", 190.0, path)


def test_differences_have_dots_and_know_types(version, path):
    turned = version.with_value("net.angle", 62.0, path).with_value("patch.lamellas.0", 7, path)
    assert differences(version.document, turned.document) == {
        "net.angle": 62.0,
        "patch.lamellas": [7, 5],
    }
    assert differences({"a": 1}, {"a": 1.0}) == {"a": 1.0}
    assert differences({"a": {"b": 1}}, {"a": {"b": 1}, "c": {"d": 2}}) == {"c": {"d": 2}}


def test_tables_on_the_way_are_made():
    document: dict = {"a": [{"b": 1}]}
    set_value(document, "a.0.b", 2)
    set_value(document, "x.y.z", 3)
    assert document == {"a": [{"b": 2}], "x": {"y": {"z": 3}}}


def test_undo_and_redo(version, path):
    first = version
    second, third, other = (first.with_value("net.angle", a, path) for a in (60.0, 61.0, 62.0))
    history = History(first).to(second).to(third)
    assert history.undone().present is second
    assert history.undone().undone().present is first
    assert history.undone().undone().undone().present is first
    assert history.undone().redone().present is third
    assert history.redone().present is third
    branched = history.undone().to(other)
    assert (branched.present, branched.redone().present) == (other, other)
    assert branched.undone().present is second
