import numpy as np
import pytest

from gridshell.mesh import QuadMesh, grid_quads


def test_quads_of_an_open_grid_by_hand():
    assert grid_quads(1, 2).tolist() == [[0, 3, 4, 1], [1, 4, 5, 2]]


def test_a_ring_joins_the_last_row_to_the_first():
    assert grid_quads(3, 1, ring=True).tolist() == [[0, 2, 3, 1], [2, 4, 5, 3], [4, 0, 1, 5]]


@pytest.mark.parametrize(("rows", "columns"), [(1, 1), (3, 5), (5, 3)])
def test_quads_are_counter_clockwise_for_i_right_and_j_up(grid, rows, columns):
    corners = grid(rows, columns).vertices[grid_quads(rows, columns)]
    first, second = corners[:, 1] - corners[:, 0], corners[:, 3] - corners[:, 0]
    np.testing.assert_array_equal(np.cross(first, second), [[0.0, 0.0, 1.0]] * (rows * columns))


@pytest.mark.parametrize(("ring", "vertices"), [(False, 5 * 4), (True, 4 * 4)])
def test_every_vertex_is_used(ring, vertices):
    assert np.unique(grid_quads(4, 3, ring=ring)).tolist() == list(range(vertices))


def test_a_ring_is_a_manifold():
    assert QuadMesh(np.zeros((12, 3)), grid_quads(4, 2, ring=True)).euler_characteristic == 0
