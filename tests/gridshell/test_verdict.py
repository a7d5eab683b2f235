import numpy as np
import pytest

import gridshell as gs


@pytest.fixture(scope="module")
def saddle(grid):
    """Edges are asymptotic, diagonals are not: no net near it, and a free one falls flat."""
    mesh = grid(12, 12, lambda x, y: (x - 6.0) * (y - 6.0) / 12.0)
    return gs.as_control_mesh(mesh.moved(700.0 * mesh.vertices))


def test_a_net_has_no_verdict(enneper):
    found = gs.optimize(enneper(10), gs.a_net(angle=np.radians(80.0)), anchor=gs.Free())
    assert found.verdict is None
    assert found.converged


def test_a_net_that_falls_into_a_plane_is_no_net(saddle):
    found = gs.optimize(saddle, gs.a_net(), anchor=gs.Free())
    assert not found.converged
    assert found.verdict.condition == "shape"
    assert found.verdict.value < found.verdict.limit
    with pytest.raises(gs.SolveError, match="start does not carry this net"):
        found.require()


def test_held_vertices_that_resist_are_named(saddle):
    found = gs.optimize(saddle, gs.a_net(steps=40), anchor=gs.BoundaryPinned())
    assert not found.converged
    assert found.verdict.condition in ("star planarity", "other stars")
    assert "vertices that are held" in found.verdict.message or "fold" in found.verdict.message


def test_the_worst_places_come_first_and_are_few(saddle):
    found = gs.optimize(saddle, gs.a_net(steps=1), anchor=gs.BoundaryPinned())
    verdict = found.verdict
    assert 1 <= len(verdict.vertices) <= 12
    assert f"at vertex {verdict.vertices[0]} (" in verdict.message
    assert verdict.value > verdict.limit


def test_too_few_steps_are_said_to_be_too_few(enneper):
    found = gs.optimize(enneper(10), gs.a_net(angle=np.radians(60.0), steps=2), anchor=gs.Free())
    assert "allow more steps" in found.verdict.message


def test_a_guide_that_resists_is_named(enneper):
    recipe = gs.NetRecipe(angle=np.radians(60.0), closeness=gs.Weight(1.0), stop=gs.Stop(steps=30))
    found = gs.optimize(enneper(10), recipe, anchor=gs.Free())
    assert "The closeness resists it" in found.verdict.message


def test_goals_that_contradict_each_other_are_named(enneper):
    """All edges at the angle shall be right, and two of them much too long."""
    control = enneper(10)
    lengths = gs.EdgeLengths(
        [[0, 1], [1, 2], [0, 2]], np.array([1.0, 1.0, 5.0]) * control.mesh.mean_edge
    )
    recipe = gs.a_net(conditions=(lengths,), steps=40)
    found = gs.optimize(control, recipe, anchor=gs.Free())
    assert found.verdict.condition == "edge length"
    assert "contradict each other" in found.verdict.message or "fold" in found.verdict.message
