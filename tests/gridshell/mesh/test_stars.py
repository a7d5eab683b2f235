import numpy as np
import pytest

import gridshell as gs

# vertices of the 2 x 2 grid:   2 5 8
#                               1 4 7
#                               0 3 6


def spokes(stars, vertex):
    return stars.spokes[vertex][: stars.count[vertex]].tolist()


def rotations(ring):
    return [np.roll(ring, k).tolist() for k in range(len(ring))]


def test_diagonal_stars_of_a_grid_by_hand(grid):
    stars = gs.diagonal_stars(grid(2, 2))
    assert spokes(stars, 4) in rotations([8, 2, 0, 6])
    assert spokes(stars, 3) == [7, 1]
    assert spokes(stars, 0) == [4]


def test_edge_stars_of_a_grid_by_hand(grid):
    stars = gs.edge_stars(grid(2, 2))
    assert spokes(stars, 4) in rotations([7, 5, 1, 3])
    assert spokes(stars, 3) == [6, 4, 0]
    assert spokes(stars, 0) == [3, 1]


def test_an_edge_star_on_the_boundary_has_one_spoke_more_than_quads(monkey_saddle):
    stars = gs.edge_stars(monkey_saddle)
    surplus = stars.count - monkey_saddle.valence
    np.testing.assert_array_equal(surplus, monkey_saddle.on_boundary.astype(int))


@pytest.mark.parametrize("make", [gs.diagonal_stars, gs.edge_stars])
def test_spokes_turn_counter_clockwise(sectors, make):
    mesh = sectors(6)
    stars = make(mesh)
    for v in range(len(mesh.vertices)):
        x, y, _ = (mesh.vertices[spokes(stars, v)] - mesh.vertices[v]).T
        turn = np.angle(np.exp(1j * np.diff(np.arctan2(y, x))))
        assert (turn > 0.0).all()


@pytest.mark.parametrize("make", [gs.diagonal_stars, gs.edge_stars])
def test_stars_are_closed_inside_and_padded_with_minus_one(monkey_saddle, make):
    stars = make(monkey_saddle)
    np.testing.assert_array_equal(stars.closed, ~monkey_saddle.on_boundary)
    np.testing.assert_array_equal((stars.spokes >= 0).sum(axis=1), stars.count)


@pytest.mark.parametrize("make", [gs.diagonal_stars, gs.edge_stars])
def test_an_unused_vertex_has_an_empty_open_star(grid, make):
    mesh = grid(1, 1)
    stars = make(gs.QuadMesh(np.vstack([mesh.vertices, [5.0, 5.0, 5.0]]), mesh.quads))
    assert stars.count[4] == 0
    assert not stars.closed[4]


def test_regular_stars_are_those_of_four_spokes(sectors):
    mesh = sectors(6, 2)
    np.testing.assert_array_equal(
        gs.diagonal_stars(mesh).regular(), np.flatnonzero(mesh.valence == 4)
    )


def test_a_regular_star_continues_its_two_pairs_of_opposite_spokes(grid):
    continued = gs.diagonal_stars(grid(2, 2)).continuations()
    assert continued[:, 1].tolist() == [4, 4]
    assert sorted(sorted(pair) for pair in continued[:, [0, 2]].tolist()) == [[0, 8], [2, 6]]


def test_a_boundary_star_of_three_continues_along_the_boundary(grid):
    continued = gs.edge_stars(grid(2, 2)).continuations().tolist()
    assert [6, 3, 0] in continued
    assert len(continued) == 2 + 4


def test_polylines_end_in_a_singular_vertex(monkey_saddle):
    for make in (gs.diagonal_stars, gs.edge_stars):
        assert 0 not in make(monkey_saddle).continuations()[:, 1]


def test_polylines_end_in_a_corner(grid):
    mesh = grid(3, 3)
    corners = np.flatnonzero(mesh.valence == 1)
    for make in (gs.diagonal_stars, gs.edge_stars):
        assert not np.isin(make(mesh).continuations()[:, 1], corners).any()


def test_a_reflex_corner_continues_its_outer_diagonals(l_shape):
    mesh = l_shape(2)
    (reflex,) = np.flatnonzero(mesh.valence == 3)
    before, _, after = next(t for t in gs.diagonal_stars(mesh).continuations() if t[1] == reflex)
    ends = mesh.vertices[[before, after]] - mesh.vertices[reflex]
    np.testing.assert_array_equal(ends.sum(axis=0), [0.0, 0.0, 0.0])


def test_continuations_are_straight_on_a_flat_grid(grid):
    mesh = grid(4, 3)
    for make in (gs.diagonal_stars, gs.edge_stars):
        before, centre, after = make(mesh).continuations().T
        bend = mesh.vertices[before] + mesh.vertices[after] - 2.0 * mesh.vertices[centre]
        np.testing.assert_array_equal(bend, np.zeros_like(bend))


@pytest.mark.parametrize("columns", [1, 2, 5])
def test_a_strip_one_quad_wide_has_no_diagonals_to_continue(grid, columns):
    assert len(gs.diagonal_stars(grid(1, columns)).continuations()) == 0
