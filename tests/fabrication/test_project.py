import json
import re
import tomllib
from copy import deepcopy
from datetime import date
from pathlib import Path
from typing import get_args

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import fabrication as fab
from fabrication.errors import ProjectError
from fabrication.project import project_text, read_project
from fabrication.sections import Project

EXAMPLES = Path(__file__).parents[2] / "examples"

HYPAR = {
    "name": "hypar",
    "surface": {"kind": "hypar", "scale": 6000.0},
    "patch": {"layout": "asymptotic", "p": [-0.6, 0.6], "q": [-0.6, 0.6], "lamellas": [9, 9]},
    "net": {"anchor": "free"},
    "profile": {"width": 80.0, "thickness": 2.0, "material": "S235"},
    "joint": {"kind": "slot", "clearance": 0.2},
    "sheet": {"length": 8000.0, "width": 1500.0},
}
MESH = {"file": "roof.obj", "unit": "m", "lamellas_along": "edges"}
OWN = {"name": "corten", "modulus": 210e3, "strength": 355.0, "density": 7850.0}
REMESH = {"directions": "asymptotic", "quads": 200}
GONE = object()
IMPORTED = {
    "surface": {"file": "roof.step"},
    "patch": GONE,
    "remesh": REMESH,
}


@pytest.fixture(scope="module")
def read(tmp_path_factory):
    """Read a project from its text, or from HYPAR with some dotted keys changed or GONE."""
    path = tmp_path_factory.mktemp("project") / "project.toml"

    def build(changes=None, *, text=None):
        path.write_text(dump(changed(changes or {})) if text is None else text, encoding="utf-8")
        return fab.read_project(path)

    build.folder = path.parent
    return build


@pytest.fixture
def beside(read):
    """Put an empty file beside the project."""
    made = []

    def build(name):
        made.append(read.folder / name)
        made[-1].touch()

    yield build
    for path in made:
        path.unlink()


@pytest.fixture
def refused(read):
    """The error of a project that must be refused."""

    def build(changes=None, *, text=None):
        with pytest.raises(ProjectError) as info:
            read(changes, text=text)
        return info.value

    return build


# ---- good projects --------------------------------------------------------------------------


@pytest.mark.parametrize("path", sorted(EXAMPLES.glob("*.toml")), ids=lambda path: path.stem)
def test_every_example_validates(path):
    assert fab.read_project(path).name


def test_a_project_is_read_as_it_is_written(read):
    project = read()
    assert project.name == "hypar"
    assert project.surface.scale == 6000.0
    assert project.patch.lamellas == (9, 9)
    assert project.profile.material == "S235"


def test_what_is_left_out_has_its_usual_value(read):
    project = read({"joint.clearance": GONE})
    assert (project.joint.clearance, project.joint.depth_clearance) == (0.3, 0.5)
    assert (project.sheet.margin, project.sheet.gap) == (10.0, 10.0)
    assert (project.net.angle, project.net.keep_to_surface, project.net.skin) == (None, True, "D1")
    assert (project.net.steps, project.net.tolerance) == (30, 1e-9)
    assert project.profile.overhang is None


def test_a_whole_number_is_a_length(read):
    assert read({"profile.width": 80}).profile.width == 80.0


def test_a_material_of_one_s_own_is_accepted(read):
    assert read({"profile.material": OWN}).profile.material.strength == 355.0


def test_a_mesh_is_a_source(read, beside):
    beside("roof.obj")
    project = read({"surface": GONE, "patch": GONE, "mesh": MESH})
    assert project.source.file == "roof.obj"


def test_a_surface_with_its_patch_is_a_source(read):
    source = read().source
    assert (source.surface.kind, source.patch.layout) == ("hypar", "asymptotic")


@pytest.mark.parametrize(
    ("kind", "sizes"),
    [
        ("enneper", {"scale": 1.0}),
        ("catenoid", {"radius": 1.0}),
        ("helicoid", {"pitch": 1.0}),
        ("hyperboloid", {"radius": 1.0, "height": 2.0}),
        ("scherk", {"scale": 1.0}),
        ("torus", {"major": 3.0, "minor": 1.0}),
    ],
)
def test_every_surface_has_a_name_and_sizes(read, kind, sizes):
    assert read({"surface": {"kind": kind, **sizes}}).surface.kind == kind


def test_a_project_cannot_be_edited(read):
    with pytest.raises(ValueError, match="frozen"):
        read().name = "other"


# ---- files ----------------------------------------------------------------------------------


def test_a_missing_file_is_named(tmp_path):
    with pytest.raises(ProjectError, match="cannot be read") as info:
        fab.read_project(tmp_path / "roof.toml")
    assert "roof.toml" in info.value.where


def test_a_folder_is_no_project(tmp_path):
    with pytest.raises(ProjectError, match="cannot be read"):
        fab.read_project(tmp_path)


@pytest.mark.parametrize("text", ["name = ", "{}", "[net\n", "name = 'a'\nname = 'b'"])
def test_a_file_that_is_no_toml_says_where(refused, text):
    error = refused(text=text)
    assert error.what == "The project file is not TOML"
    assert re.search(r"at (line \d+|end of document)", error.where)


def test_a_file_that_is_no_text_is_refused(tmp_path):
    (tmp_path / "project.toml").write_bytes(b"\xff\xfename")
    with pytest.raises(ProjectError, match="not TOML"):
        fab.read_project(tmp_path / "project.toml")


def test_an_empty_file_names_a_key_to_begin_with(refused):
    assert "name" in refused(text="").where


def test_a_file_may_begin_with_a_byte_order_mark(tmp_path):
    (tmp_path / "project.toml").write_text(dump(HYPAR), encoding="utf-8-sig")
    assert fab.read_project(tmp_path / "project.toml").name == "hypar"


# ---- writing --------------------------------------------------------------------------------

FULL = {
    "name": 'a "name" with ü, \\ and 😀',
    "profile.material": OWN,
    "profile.overhang": 25.0,
    "net.angle": 60.0,
    "net.tolerance": 1e-7,
    "net.keep_to_surface": False,
}
ALWAYS = ["angle_between", "fairness", "mirror", "proximity", "supports", "wall"]
RING = {
    "surface": {"kind": "catenoid", "radius": 4000.0},
    "patch": {"layout": "bisecting", "v": [-0.5, 0.5], "cells": 24},
}


@pytest.mark.parametrize(
    "changes",
    [
        *({}, FULL, RING, {"surface": GONE, "patch": GONE, "mesh": MESH}, IMPORTED),
        {**IMPORTED, "surface": {"file": "roof.obj", "unit": "m"}},
        {**IMPORTED, "remesh": {"directions": "asymptotic", "edge": 300.0, "extent": "cover"}},
    ],
)
def test_a_project_that_is_written_and_read_is_the_same(read, beside, changes):
    beside("roof.obj")
    beside("roof.step")
    project = read(changes)
    assert read(text=fab.project_text(project)) == project


@pytest.mark.parametrize(
    ("changes", "keys"),
    [
        ({}, sorted(["angle", *ALWAYS, "overhang"])),
        (RING, sorted(["angle", *ALWAYS, "overhang", "u"])),
        (FULL, ALWAYS),
    ],
)
def test_what_is_unset_is_written_as_a_comment(read, changes, keys):
    lines = fab.project_text(read(changes)).splitlines()
    unset = [line.split()[1] for line in lines if line.startswith("# ")]
    assert sorted(unset) == keys
    assert all("None" not in line for line in lines)


def test_every_setting_is_written(read):
    project = read()
    text = fab.project_text(project)
    for section in ("surface", "patch", "net", "profile", "joint", "sheet"):
        inside = text.split(f"[{section}]\n")[1].split("\n\n")[0]
        for name in type(getattr(project, section)).model_fields:
            assert re.search(rf"^(# )?{name} = ", inside, re.MULTILINE)


# ---- keys -----------------------------------------------------------------------------------

WRONG = {
    "profile.thickness": [-2.0, 0.0, float("nan"), float("inf"), "two", "2", [2.0]],
    "profile.width": [-1.0, {}],
    "profile.overhang": [0.0, -5.0],
    "net.angle": [0.0, 180.0, -5.0, 200.0, float("nan"), ["right"]],
    "net.anchor": ["fixed", 1],
    "net.skin": ["D3"],
    "net.kind": ["flat"],
    "net.steps": [0, 1.5, "many"],
    "net.tolerance": [0.0],
    "net.keep_to_surface": ["perhaps", 2],
    "joint.kind": ["dovetail"],
    "joint.clearance": [-0.1],
    "joint.depth_clearance": [-0.1],
    "sheet.length": [0.0],
    "sheet.margin": [-1.0],
    "surface.scale": [-1.0, "big"],
    "patch.lamellas": [9, [9], [9, 9, 9], "nine"],
    "patch.p": [[0.1], [0.1, 0.2, 0.3], 0.5],
    "name": ["", 3, "n" * 81, "  ", "two\nlines", "bell\x07"],
}
LIMITS = [
    ("profile.thickness", "two", "a number"),
    ("profile.thickness", 1e-9, ">= 0.001"),
    ("profile.width", 1e8, "<= 1e+07"),
    ("surface.scale", 1e300, "<= 1e+07"),
    ("surface.scale", 1e-300, ">= 0.001"),
    ("net.angle", 0.0, "> 0"),
    ("net.angle", 180.0, "< 180"),
    ("net.angle", float("nan"), "a finite number"),
    ("net.steps", 1.5, "a whole number"),
    ("net.steps", 10**6, "<= 10000"),
    ("net.skin", "D3", "D1, D2, P"),
    ("net.keep_to_surface", "perhaps", "true or false"),
    ("patch.p", 0.5, "a list of 2 numbers"),
    ("patch.p", [0.1], "2 numbers"),
    ("patch.p", [0.1, 0.2, 0.3], "a list of 2 numbers"),
    ("name", 3, "text in quotes"),
    ("name", "", "1 or more characters"),
    ("name", "n" * 81, "80 characters at most"),
    ("name", " ", "one line of text that is not blank"),
    ("net", 5, "a table of settings"),
]


@pytest.mark.parametrize(("key", "value", "limit"), LIMITS)
def test_what_is_allowed_is_said_in_plain_words(refused, key, value, limit):
    assert refused({key: value}).limit == limit


@pytest.mark.parametrize("at", [0, 1])
@pytest.mark.parametrize(("value", "limit"), [(1, ">= 2"), (10**20, "<= 100000")])
def test_a_number_of_lamellas_has_limits(refused, at, value, limit):
    counts = [9, 9]
    counts[at] = value
    error = refused({"patch.lamellas": counts})
    assert (error.where.split(", ")[1], error.limit) == (f"patch.lamellas.{at}", limit)


@pytest.mark.parametrize(("key", "value"), [(k, v) for k, values in WRONG.items() for v in values])
def test_a_wrong_value_is_shown_with_its_key(refused, key, value):
    error = refused({key: value})
    assert error.what.startswith("A key has a wrong value")
    assert error.where.endswith(f", {key}")
    assert error.value == repr(value)
    assert error.limit


@pytest.mark.parametrize(("key", "at"), [("patch.p", 0), ("patch.q", 1), ("patch.lamellas", 1)])
def test_a_wrong_entry_of_a_list_is_shown_with_its_place(refused, key, at):
    section, name = key.split(".")
    entries = list(HYPAR[section][name])
    entries[at] = "x"
    assert refused({key: entries}).where.endswith(f", {key}.{at}")


@pytest.mark.parametrize("key", ["profile.thickness", "net.angle", "surface.scale", "sheet.gap"])
def test_true_is_no_number(refused, key):
    assert refused({key: True}).where.endswith(f", {key}")


@pytest.mark.parametrize(
    "key",
    [
        *["name", "net", "profile", "joint", "sheet", "net.anchor", "joint.kind"],
        *["profile.width", "profile.thickness", "profile.material", "sheet.length", "sheet.width"],
        *["surface.scale", "patch.p", "patch.q", "patch.lamellas"],
    ],
)
def test_a_missing_key_is_named(refused, key):
    error = refused({key: GONE})
    assert error.what.startswith("A key is missing")
    assert error.where.endswith(f", {key}")
    assert error.advice == f"add {key}"


@pytest.mark.parametrize(("key", "tag"), [("surface", "kind"), ("patch", "layout")])
def test_a_missing_kind_names_the_kind(refused, key, tag):
    error = refused({f"{key}.{tag}": GONE})
    assert error.what == "A key is missing"
    assert error.where.endswith(f", {key}.{tag}")
    assert error.advice == f"add {key}.{tag}"


@pytest.mark.parametrize(
    ("key", "near"),
    [
        ("joint.clearence", "clearance"),
        ("profile.overhung", "overhang"),
        ("net.angel", "angle"),
        ("net.keep_to_surfaces", "keep_to_surface"),
        ("sheet.margins", "margin"),
        ("meshes", "mesh"),
        ("patch.lamella", "lamellas"),
        ("surface.scales", "scale"),
    ],
)
def test_an_unknown_key_gets_the_nearest_one_as_advice(refused, key, near):
    error = refused({key: 1.0})
    assert error.what.startswith("Unknown key")
    assert error.where.endswith(f", {key}")
    assert error.advice == f"'{near}'"


def test_an_unknown_key_like_no_other_gets_the_whole_list(refused):
    assert refused({"sheet.xyzzy": 1}).advice == "one of length, width, margin, gap"


@pytest.mark.parametrize("key", ["surface", "patch", "net", "profile", "joint", "sheet"])
@pytest.mark.parametrize("value", [5, "text", [1, 2]])
def test_a_section_that_is_no_table_is_named(refused, key, value):
    assert refused({key: value}).where.endswith(f", {key}")


@pytest.mark.parametrize(
    ("key", "value", "near"),
    [("surface.kind", "hyper", "hypar"), ("patch.layout", "asymptotics", "asymptotic")],
)
def test_an_unknown_kind_is_named_with_the_nearest_and_all_others(refused, key, value, near):
    error = refused({key: value})
    assert error.where.endswith(f", {key}")
    assert error.value == repr(value)
    assert error.advice == f"'{near}'"
    assert near in error.limit.split(", ")


def test_a_misspelt_key_is_told_before_the_key_it_should_be(refused):
    error = refused({"profile.thickness": GONE, "profile.thicknes": 2.0})
    assert error.where.endswith(", profile.thicknes")
    assert error.advice == "'thickness'"


def test_an_unknown_material_lists_the_known_ones(refused):
    error = refused({"profile.material": "steel"})
    assert error.where.endswith(", profile.material")
    assert error.value == "'steel'"
    assert all(name in error.limit for name in ("S235", "stainless", "birch-ply"))


@pytest.mark.parametrize("key", ["modulus", "strength", "density"])
def test_a_wrong_number_of_one_s_own_material_is_named(refused, key):
    error = refused({"profile.material": {**OWN, key: -1.0}})
    assert error.where.endswith(f", profile.material.{key}")
    assert error.value == "-1.0"


def test_a_missing_number_of_one_s_own_material_is_named(refused):
    own = {key: value for key, value in OWN.items() if key != "density"}
    assert refused({"profile.material": own}).where.endswith(", profile.material.density")


# ---- where the net comes from ---------------------------------------------------------------


@pytest.mark.parametrize(
    "changes",
    [
        {"mesh": MESH},
        {"mesh": MESH, "surface": GONE},
        {"mesh": MESH, "patch": GONE},
        {"surface": GONE},
        {"patch": GONE},
        {"surface": GONE, "patch": GONE},
    ],
)
def test_a_project_needs_exactly_one_source(refused, changes):
    error = refused(changes)
    assert error.what == "Give either [surface] with [patch] or [remesh], or [mesh], or [umbrella]"


@pytest.mark.parametrize(
    ("key", "value"), [("unit", "km"), ("lamellas_along", "sideways"), ("file", 3)]
)
def test_a_wrong_mesh_section_is_named(refused, key, value):
    changes = {"surface": GONE, "patch": GONE, "mesh": {**MESH, key: value}}
    assert refused(changes).where.endswith(f", mesh.{key}")


@pytest.mark.parametrize(
    ("changes", "words"),
    [
        ({**IMPORTED, "remesh": GONE}, "needs [remesh]; a quad mesh is named by [mesh]"),
        ({**IMPORTED, "patch": HYPAR["patch"]}, "goes with [remesh], not with [patch]"),
        ({"remesh": REMESH}, "[remesh] needs a [surface] with a file"),
    ],
)
def test_sections_that_do_not_go_together_are_told(refused, changes, words):
    assert words in refused(changes).what


def test_a_surface_that_names_a_file_needs_no_kind(read, beside):
    beside("roof.step")
    source = read(IMPORTED).source
    assert source.surface.file == "roof.step"
    assert (source.remesh.directions, source.remesh.extent) == ("asymptotic", "inside")
    assert read(IMPORTED).net.keep_to_surface


@pytest.mark.parametrize(
    ("key", "value", "words"),
    [
        ("directions", "sideways", "remesh.directions; found 'sideways'; allowed: asymptotic, "),
        ("quads", 0, "remesh.quads; found 0; allowed: >= 1"),
        ("quads", 100_001, "remesh.quads; found 100001; allowed: <= 100000"),
        ("quads", 1.5, "remesh.quads; found 1.5; allowed: a whole number"),
        ("edge", 0.0, "remesh.edge; found 0.0; allowed: >= 0.001"),
        ("angle", 180.0, "remesh.angle; found 180.0; allowed: < 180"),
        ("hand", "both", "remesh.hand; found 'both'; allowed: left, right"),
        ("infeasible", "no", "remesh.infeasible"),
        ("extent", "all", "remesh.extent"),
        ("guides", "g.csv", "remesh.guides; found 'g.csv'; allowed: a list of tables"),
        ("guides", [{"file": "g.csv", "family": 3}], "remesh.guides.0.family; found 3"),
        ("guides", [{"family": 1}], "remesh.guides.0.file"),
        ("guides", [{"file": "g.csv", "famly": 1}], "Try: 'family'"),
        ("quad", 3, "Unknown key"),
    ],
)
def test_a_wrong_remesh_section_is_named(refused, beside, key, value, words):
    beside("roof.step")
    assert words in str(refused({**IMPORTED, "remesh": {**REMESH, key: value}}))


# ---- what it could have, too ----------------------------------------------------------------


@pytest.mark.parametrize(
    ("example", "sections"),
    [
        ("01_enneper_60", {"bars", "shop", "flat", "papers", "segments", "export", "facade"}),
        ("12_glazed_enneper", {"bars", "shop", "flat", "papers", "segments", "export"}),
        ("09_tower_panels", {"beams", "moulds", "export"}),
        ("18_umbrella", {"shop", "papers", "export"}),
    ],
)
def test_sections_it_could_have_are_told_with_all_their_keys(example, sections):
    known = read_project(EXAMPLES / f"{example}.toml")
    text = project_text(known, explained=True)
    own, more = text.split("# Sections that it could have, too:\n")
    assert set(re.findall(r"^# \[(\w+)\]", more, re.MULTILINE)) == sections
    for part in re.split(r"^# \[", more, flags=re.MULTILINE)[1:]:
        name = part.split("]")[0]
        (kind,) = [
            k for k in get_args(Project.model_fields[name].annotation) if k is not type(None)
        ]
        assert re.findall(r"^#   (\w+) = ", part, re.MULTILINE) == list(kind.model_fields)
        assert all(line.count("  # ") == 1 for line in part.splitlines()[1:])
    assert tomllib.loads(text) == tomllib.loads(own)
    assert "could have" not in project_text(known)


# ---- several mistakes -----------------------------------------------------------------------


def test_one_mistake_is_one_mistake(refused):
    assert "to mend, too" not in str(refused({"profile.material": "steel"}))


def test_other_mistakes_are_named(refused):
    error = refused({"profile.thickness": -1.0, "sheet.length": -1.0, "sheet.width": -1.0})
    assert "(to mend, too: sheet.length, sheet.width)" in error.what


def test_a_needed_key_that_is_misspelt_is_one_mistake(refused):
    error = refused({"sheet.length": GONE, "sheet.lenght": 8000.0})
    assert error.what == "Unknown key"
    assert error.advice == "'length'"


def test_of_many_mistakes_some_are_named(refused):
    wrong = {f"profile.{letter}": 1.0 for letter in "abcdefg"}
    told = "profile.b, profile.c, profile.d, profile.e ..."
    assert refused(wrong).what == f"Unknown key (to mend, too: {told})"


# ---- anything at all ------------------------------------------------------------------------

SECTIONS = {section: list(keys) for section, keys in HYPAR.items() if isinstance(keys, dict)}
KEYS = [*HYPAR, *(f"{section}.{key}" for section, keys in SECTIONS.items() for key in keys)]
SCALARS = st.one_of(
    st.booleans(),
    st.integers(-(2**63), 2**63 - 1),
    st.floats(),
    st.dates(),
    st.text(st.characters(min_codepoint=32, max_codepoint=126), max_size=12),
    st.just(""),
)
GARBAGE = st.one_of(
    SCALARS,
    st.lists(SCALARS, max_size=3),
    st.dictionaries(st.text("abkind", min_size=1, max_size=5), SCALARS, max_size=2),
)


def outcome(read, changes):
    try:
        return read(changes)
    except ProjectError as error:
        return str(error)


@given(st.dictionaries(st.sampled_from(KEYS), GARBAGE, min_size=1, max_size=4))
def test_whatever_a_key_holds_it_is_accepted_or_told_in_one_line(read, changes):
    found = outcome(read, changes)
    assert isinstance(found, fab.Project) or not re.search("\n|pydantic|[Ii]nput should", found)


REMESH_KEYS = [
    *("surface.file", "surface.unit", "surface.kind", "remesh", "patch"),
    *(f"remesh.{key}" for key in ("directions", "angle", "hand", "quads", "edge", "guides")),
]


@given(st.dictionaries(st.sampled_from(REMESH_KEYS), GARBAGE, min_size=1, max_size=3))
def test_whatever_a_remesh_holds_it_is_accepted_or_told_in_one_line(read, changes):
    base = {"surface": {"file": "roof.step"}, "patch": GONE, "remesh": dict(REMESH)}
    found = outcome(read, {**base, **changes})
    assert isinstance(found, fab.Project) or not re.search("\n|pydantic|[Ii]nput should", found)


@settings(max_examples=40)
@given(st.text(max_size=60))
def test_whatever_a_file_says_it_is_accepted_or_refused(read, text):
    with pytest.raises(ProjectError):
        read(text=text)


# ---- writing TOML ---------------------------------------------------------------------------


def changed(changes):
    document = deepcopy(HYPAR)
    for key, value in changes.items():
        *sections, name = key.split(".")
        inside = document
        for section in sections:
            inside = inside.setdefault(section, {})
            if not isinstance(inside, dict):
                break
        else:
            inside.pop(name, None)
            if value is not GONE:
                inside[name] = value
    return document


def dump(document):
    return "".join(f"{json.dumps(key)} = {toml(value)}\n" for key, value in document.items())


def toml(value):
    if isinstance(value, dict):
        return "{" + ", ".join(f"{json.dumps(k)} = {toml(v)}" for k, v in value.items()) + "}"
    if isinstance(value, list):
        return "[" + ", ".join(toml(entry) for entry in value) + "]"
    if isinstance(value, date):
        return value.isoformat()
    text = json.dumps(value, ensure_ascii=False)
    return {"NaN": "nan", "Infinity": "inf", "-Infinity": "-inf"}.get(text, text)
