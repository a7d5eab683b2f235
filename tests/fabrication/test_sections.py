import pytest
from pydantic import ValidationError

import fabrication as fab
from fabrication.source_sections import MeshSection, SurfaceSource

REST = {
    "name": "roof",
    "net": {"anchor": "free"},
    "profile": {"width": 80.0, "thickness": 2.0, "material": "S235"},
    "joint": {"kind": "slot"},
    "sheet": {"length": 8000.0, "width": 1500.0},
}
SURFACE = {
    "surface": {"kind": "hypar", "scale": 6000.0},
    "patch": {"layout": "asymptotic", "p": (-0.6, 0.6), "q": (-0.6, 0.6), "lamellas": (9, 9)},
}
MESH = {"mesh": {"file": "roof.obj", "unit": "m", "lamellas_along": "edges"}}


def made(**changes):
    return fab.Project.model_validate({**REST, **SURFACE, **changes})


@pytest.mark.parametrize(("given", "kind"), [(SURFACE, SurfaceSource), (MESH, MeshSection)])
def test_a_project_has_one_source(given, kind):
    assert isinstance(fab.Project.model_validate({**REST, **given}).source, kind)


@pytest.mark.parametrize("given", [{}, {**SURFACE, **MESH}])
def test_no_source_and_two_sources_are_refused(given):
    with pytest.raises(ValidationError, match=r"give either \[surface\] with \[patch\]"):
        fab.Project.model_validate({**REST, **given})


@pytest.mark.parametrize("value", [1e-3, 1e7])
def test_sizes_reach_from_a_micrometre_to_ten_kilometres(value):
    assert made(sheet={"length": value, "width": value}).sheet.length == value


@pytest.mark.parametrize("value", [0.99e-3, 1.01e7])
@pytest.mark.parametrize("key", ["width", "thickness", "overhang"])
def test_sizes_beyond_their_limits_are_refused(key, value):
    with pytest.raises(ValidationError, match=key):
        made(profile={**REST["profile"], key: value})


@pytest.mark.parametrize("value", [1e3, -1e3])
def test_parameters_are_pure_numbers_of_modest_size(value):
    assert value in made(patch={**SURFACE["patch"], "p": (value, value)}).patch.p
    with pytest.raises(ValidationError, match=r"patch\.asymptotic\.p"):
        made(patch={**SURFACE["patch"], "p": (1.01 * value, value)})


@pytest.mark.parametrize("name", ["Dach über Hof 😀", "a" * 80])
def test_a_name_is_any_line_of_text(name):
    assert made(name=name).name == name
