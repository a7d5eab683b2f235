from dataclasses import replace

import numpy as np
import pytest

import gridshell as gs
from gridshell.solve import Engine, Pattern
from gridshell.solve.workspace import Workspace

NOTHING = np.empty(0, dtype=np.int64)
ENGINES = [Engine(), Engine(portable=True)]


def patch(lines=12):
    return gs.control_patch(
        gs.Enneper(1000.0), gs.AsymptoticPatch((-0.5, 0.5), (-0.5, 0.5), (lines,) * 2)
    )


def net(control, angle, engine, workspace=None, **more):
    recipe = replace(gs.a_net(angle=np.radians(angle)), stop=gs.Stop(engine=engine))
    return gs.optimize(control, recipe, anchor=gs.Free(), workspace=workspace, **more)


def patterns(*columns):
    return [Pattern(np.array(own), 1) for own in columns]


@pytest.mark.parametrize("engine", ENGINES)
def test_a_kept_pattern_changes_no_bit_of_what_is_found(engine):
    control = patch()
    with Workspace() as kept:
        shared = [net(control, angle, engine, kept) for angle in (75.0, 60.0, 85.0)]
    alone = [net(control, angle, engine) for angle in (75.0, 60.0, 85.0)]
    for one, other in zip(shared, alone, strict=True):
        assert one.converged
        np.testing.assert_array_equal(one.control.vertices, other.control.vertices)
        assert [step.unmet for step in one.steps] == [step.unmet for step in other.steps]


def test_equal_patterns_go_on_with_what_was_kept():
    with Workspace() as kept:
        first = kept.prepared(4, patterns([[0, 1], [2, 3]]), NOTHING, Engine())
        again = kept.prepared(4, patterns([[0, 1], [2, 3]]), NOTHING, Engine())
    assert again[0] is first[0]
    assert again[1] is first[1]


@pytest.mark.parametrize(
    "other",
    [
        (5, patterns([[0, 1], [2, 3]]), NOTHING, Engine()),
        (4, patterns([[0, 1], [1, 3]]), NOTHING, Engine()),
        (4, patterns([[0, 1], [2, 3]], [[0]]), NOTHING, Engine()),
        (4, patterns([[0, 1], [2, 3]]), np.array([1]), Engine()),
        (4, patterns([[0, 1], [2, 3]]), NOTHING, Engine(portable=True)),
    ],
    ids=["size", "columns", "terms", "fixed", "engine"],
)
def test_another_pattern_replaces_it(other):
    with Workspace() as kept:
        first = kept.prepared(4, patterns([[0, 1], [2, 3]]), NOTHING, Engine())
        assert kept.prepared(*other)[0] is not first[0]


def test_columns_that_change_in_place_are_seen():
    columns = np.array([[0, 1], [2, 3]])
    with Workspace() as kept:
        first = kept.prepared(4, [Pattern(columns, 1)], NOTHING, Engine())
        columns[0, 0] = 3
        assert kept.prepared(4, [Pattern(columns, 1)], NOTHING, Engine())[0] is not first[0]


def test_other_nets_in_between_and_a_solve_that_was_ended_do_no_harm():
    control, other = patch(), patch(9)

    class EndedError(Exception):
        pass

    def end(number, step):
        if number == 2:
            raise EndedError

    with Workspace() as kept:
        first = net(control, 75.0, Engine(), kept)
        with pytest.raises(EndedError):
            net(control, 60.0, Engine(), kept, progress=end)
        between = net(other, 60.0, Engine(), kept)
        last = net(control, 75.0, Engine(), kept)
    np.testing.assert_array_equal(first.control.vertices, last.control.vertices)
    alone = net(other, 60.0, Engine())
    np.testing.assert_array_equal(between.control.vertices, alone.control.vertices)


def test_a_closed_workspace_can_be_used_anew():
    kept = Workspace()
    first = kept.prepared(4, patterns([[0, 1], [2, 3]]), NOTHING, Engine())
    kept.close()
    kept.close()
    assert kept.prepared(4, patterns([[0, 1], [2, 3]]), NOTHING, Engine())[0] is not first[0]
    kept.close()
