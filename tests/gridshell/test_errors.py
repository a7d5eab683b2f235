import pickle

import pytest

import gridshell as gs
from gridshell import errors

TREE = {
    gs.InputError: (gs.GridshellError, ValueError),
    gs.MeshError: (gs.InputError,),
    gs.NonManifoldError: (gs.MeshError,),
    gs.OrientationError: (gs.MeshError,),
    gs.OddValenceError: (gs.MeshError,),
    gs.ColouringError: (gs.MeshError,),
    gs.SurfaceError: (gs.InputError,),
    gs.NotHyperbolicError: (gs.SurfaceError,),
    errors.DegenerateSurfaceError: (gs.SurfaceError,),
    errors.DisconnectedError: (gs.SurfaceError,),
    errors.SelfIntersectionError: (gs.SurfaceError,),
    errors.PoorTriangulationError: (gs.SurfaceError,),
    errors.NoisyInputError: (gs.SurfaceError,),
    gs.SettingError: (gs.InputError,),
    gs.FileError: (gs.InputError, OSError),
    gs.SolveError: (gs.GridshellError, RuntimeError),
}
EVERY = [gs.GridshellError, *TREE]


@pytest.mark.parametrize("error", TREE)
def test_the_tree_is_the_one_that_is_drawn(error):
    assert error.__bases__ == TREE[error]


@pytest.mark.parametrize("error", EVERY)
def test_every_error_is_drawn_in_the_docstring_of_the_module(error):
    assert error.__name__ in errors.__doc__


@pytest.mark.parametrize("error", EVERY)
def test_what_alone_makes_a_sentence(error):
    assert str(error("The net is flat")) == "The net is flat."


@pytest.mark.parametrize("error", EVERY)
def test_the_message_holds_all_five_parts(error):
    found = error("Too short", where="key", value="1 mm", limit="> 2 mm", advice="make it longer")
    assert str(found) == "Too short (at key; found 1 mm; allowed: > 2 mm). Try: make it longer."


@pytest.mark.parametrize(
    ("part", "text"),
    [
        ("where", "What (at x)."),
        ("value", "What (found x)."),
        ("limit", "What (allowed: x)."),
        ("advice", "What. Try: x."),
    ],
)
def test_each_part_may_come_alone(part, text):
    assert str(gs.InputError("What", **{part: "x"})) == text


@pytest.mark.parametrize("error", EVERY)
def test_the_parts_can_be_read_one_by_one(error):
    found = error("a", where="b", value="c", limit="d", advice="e")
    parts = (found.what, found.where, found.value, found.limit, found.advice)
    assert parts == ("a", "b", "c", "d", "e")


def test_missing_parts_are_none():
    found = gs.InputError("a")
    assert (found.where, found.value, found.limit, found.advice) == (None, None, None, None)


@pytest.mark.parametrize("error", [gs.SettingError, gs.FileError, gs.SolveError])
def test_an_error_from_another_process_says_the_same(error):
    found = error("Too short", where="key", advice="make it longer")
    again = pickle.loads(pickle.dumps(found))
    assert str(again) == str(found)
    assert again.where == "key"
