import numpy as np
import pytest

import gridshell as gs
from gridshell.anchors import boundary_runs


def hold(anchor, control):
    return anchor.hold(control, control.vertices)


def runs(control):
    """Positions (x, y) along every run, and whether it is closed."""
    return [
        (control.vertices[run.vertices][:, :2].tolist(), run.closed)
        for run in boundary_runs(control)
    ]


def corners(control):
    return {tuple(line[end]) for line, closed in runs(control) if not closed for end in (0, -1)}


# ---- runs of the boundary -------------------------------------------------------------------


def test_a_rectangle_has_four_runs_between_its_corners(grid):
    control = gs.as_control_mesh(grid(3, 4))
    assert [len(line) for line, _ in runs(control)] == [4, 5, 4, 5]
    assert corners(control) == {(0, 0), (3, 0), (3, 4), (0, 4)}


def test_each_run_starts_where_the_last_one_ends(grid, l_shape):
    for mesh in (grid(3, 4), l_shape(3)):
        found = boundary_runs(gs.as_control_mesh(mesh))
        ends = [run.vertices[-1] for run in found]
        assert np.roll([run.vertices[0] for run in found], -1).tolist() == ends


def test_a_reflex_corner_is_a_corner(l_shape):
    control = gs.as_control_mesh(l_shape(3))
    assert len(runs(control)) == 6
    assert corners(control) == {(0, 0), (6, 0), (6, 3), (3, 3), (3, 6), (0, 6)}


def test_a_ring_has_two_closed_runs(annulus):
    control = gs.as_control_mesh(annulus(8))
    assert [(len(line), closed) for line, closed in runs(control)] == [(8, True), (8, True)]


def test_a_closed_mesh_has_no_run(torus):
    assert boundary_runs(gs.as_control_mesh(torus(6, 6))) == ()


def test_along_a_zigzag_rim_the_runs_are_those_of_the_net(grid):
    control = gs.control_mesh(grid(6, 8))
    assert [len(line) for line, _ in runs(control)] == [3, 4, 3, 4]
    assert corners(control) == {(1, 1), (5, 1), (5, 7), (1, 7)}


def test_along_a_zigzag_ring_the_runs_are_closed(annulus):
    control = gs.control_mesh(annulus(12, 6))
    assert [(len(line), closed) for line, closed in runs(control)] == [(6, True), (6, True)]


def test_along_a_zigzag_rim_a_reflex_corner_of_the_net_is_a_corner(l_shape):
    """D1 is an L as well, with its reflex corner in (3, 3), inside the control mesh."""
    control = gs.control_mesh(l_shape(4))
    assert corners(control) == {(1, 1), (7, 1), (7, 3), (3, 3), (3, 7), (1, 7)}


@pytest.mark.parametrize("size", [(5, 5), (6, 5), (7, 6), (7, 7)])
def test_along_the_teeth_of_an_odd_grid_no_run_jumps_over_a_node(grid, size):
    """Edges of the net are 2 long, teeth in a row 2 apart, teeth around a corner 2 sqrt(2)."""
    for line, closed in runs(gs.control_mesh(grid(*size))):
        ring = [*line, line[0]] if closed else line
        assert np.linalg.norm(np.diff(ring, axis=0), axis=1).max() < 2.9


# ---- anchors --------------------------------------------------------------------------------


def test_free_holds_nothing(grid):
    found = hold(gs.Free(), gs.as_control_mesh(grid(3, 3)))
    assert (found.vertices.tolist(), found.terms) == ([], ())


def test_pinned_holds_the_named_vertices_sorted(grid):
    found = hold(gs.Pinned((5, 2)), gs.as_control_mesh(grid(3, 3)))
    assert (found.vertices.tolist(), found.terms) == ([2, 5], ())


def test_pinning_a_vertex_twice_is_refused_by_its_index(grid):
    with pytest.raises(gs.SettingError, match="pinned twice") as info:
        hold(gs.Pinned((5, 2, 5)), gs.as_control_mesh(grid(3, 3)))
    assert info.value.where == "vertices, vertex 5"


def test_on_a_coarser_mesh_pins_follow_their_vertices():
    assert gs.Pinned((8, 2)).restricted(np.array([0, 2, 4, 8])).vertices == (1, 3)
    assert gs.BoundaryGlide().restricted(np.array([0, 2])) == gs.BoundaryGlide()


def test_pinning_no_vertex_is_free(grid):
    assert hold(gs.Pinned(()), gs.as_control_mesh(grid(3, 3))).vertices.tolist() == []


@pytest.mark.parametrize("vertex", [-1, 16, 1000])
def test_pinning_a_vertex_that_does_not_exist_is_refused_by_its_index(grid, vertex):
    with pytest.raises(gs.SettingError, match="does not exist") as info:
        hold(gs.Pinned((0, vertex)), gs.as_control_mesh(grid(3, 3)))
    assert (info.value.value, info.value.limit) == (str(vertex), "0 .. 15")


def test_boundary_pinned_holds_every_boundary_vertex(monkey_saddle, annulus):
    for mesh in (monkey_saddle, annulus(8)):
        found = hold(gs.BoundaryPinned(), gs.as_control_mesh(mesh))
        np.testing.assert_array_equal(found.vertices, np.flatnonzero(mesh.on_boundary))


def test_boundary_pinned_holds_the_boundary_of_a_net_with_zigzag_rim(grid):
    control = gs.control_mesh(grid(6, 8))
    held = control.vertices[hold(gs.BoundaryPinned(), control).vertices][:, :2]
    rim = [[x, y] for x in (1, 3, 5) for y in (1, 3, 5, 7) if x in (1, 5) or y in (1, 7)]
    assert sorted(held.tolist()) == rim


@pytest.mark.parametrize("anchor", [gs.BoundaryPinned(), gs.BoundaryGlide()])
def test_a_closed_mesh_has_no_boundary_to_hold(torus, anchor):
    found = hold(anchor, gs.as_control_mesh(torus(6, 6)))
    assert (found.vertices.tolist(), found.terms) == ([], ())


def test_boundary_glide_holds_the_corners_and_lets_the_others_glide(grid):
    control = gs.as_control_mesh(grid(3, 4))
    found = hold(gs.BoundaryGlide(), control)
    np.testing.assert_array_equal(found.vertices, np.flatnonzero(control.mesh.valence == 1))
    gliding = np.concatenate([term.constraint.vertices for term in found.terms])
    rim = np.flatnonzero(control.mesh.on_boundary)
    assert sorted([*gliding, *found.vertices]) == rim.tolist()


def test_boundary_glide_asks_nothing_at_the_start(monkey_saddle):
    control = gs.as_control_mesh(monkey_saddle)
    x = control.vertices.ravel()
    for term in hold(gs.BoundaryGlide(), control).terms:
        found = term.constraint.evaluate(x, term.constraint.lag(x)).residual
        assert np.abs(found).max() < 1e-12


def test_on_a_ring_all_boundary_vertices_glide(annulus):
    control = gs.as_control_mesh(annulus(8))
    found = hold(gs.BoundaryGlide(), control)
    assert len(found.vertices) == 0
    assert [len(term.constraint.vertices) for term in found.terms] == [8, 8]


def test_a_run_of_one_edge_has_nothing_that_glides(grid):
    found = hold(gs.BoundaryGlide(), gs.as_control_mesh(grid(1, 4)))
    assert [len(term.constraint.vertices) for term in found.terms] == [3, 3]


def test_gliding_is_no_goal(grid):
    terms = hold(gs.BoundaryGlide(), gs.as_control_mesh(grid(3, 4))).terms
    assert not any(term.goal for term in terms)
    assert len({term.name for term in terms}) == 4
