"""What hangs together."""

import numpy as np

from gridshell.mesh import QuadMesh, grid_quads, main_piece


def test_a_whole_grid_is_kept():
    assert main_piece(grid_quads(3, 4)).all()


def test_the_smaller_of_two_pieces_is_left_out():
    large, small = grid_quads(3, 4), grid_quads(1, 2) + 100
    assert main_piece(np.concatenate([small, large])).tolist() == [False] * 2 + [True] * 12


def test_a_quad_that_touches_in_a_vertex_only_is_left_out():
    grid = grid_quads(2, 2)  # vertices 0 .. 8, 8 in the corner
    hinged = np.array([[8, 20, 21, 22]])
    assert main_piece(np.concatenate([grid, hinged])).tolist() == [True] * 4 + [False]


def test_a_piece_hinged_in_a_vertex_of_the_same_piece_is_opened():
    """A chain of quads that comes back to a vertex of the grid: one of both fans goes."""
    grid = grid_quads(3, 3)  # 0 .. 15
    chain = np.array([[3, 7, 41, 40], [40, 41, 43, 42], [42, 43, 45, 14]])
    kept = main_piece(np.concatenate([grid, chain]))
    assert kept[:9].all()
    quads = np.concatenate([grid, chain])[kept]
    used, compact = np.unique(quads, return_inverse=True)
    QuadMesh(np.arange(3.0 * len(used)).reshape(-1, 3), compact.reshape(-1, 4))  # manifold


def test_nothing_stays_nothing():
    assert len(main_piece(np.zeros((0, 4), dtype=np.int64))) == 0


def test_what_is_left_is_manifold_whatever_is_taken_away():
    grid = grid_quads(9, 9)
    for seed in range(40):
        rng = np.random.default_rng(seed)
        some = grid[rng.random(len(grid)) < 0.6]
        left = some[main_piece(some)]
        used, compact = np.unique(left, return_inverse=True)
        QuadMesh(rng.random((len(used), 3)), compact.reshape(-1, 4))
        assert len(left) > 0
