import numpy as np
import pytest

from gridshell.folding import NoFolding, collapsed, corner_angles, corner_sines, folded_pairs

SQUARE = np.array([[0.0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]])
ONE = np.array([[0, 1, 2, 3]])


def test_corners_of_a_square_have_a_sine_of_one_and_right_angles():
    np.testing.assert_allclose(corner_sines(SQUARE, ONE), 1.0)
    np.testing.assert_allclose(corner_angles(SQUARE, ONE), np.pi / 2.0)


def test_a_reflex_corner_has_a_negative_sine():
    concave = SQUARE.copy()
    concave[2] = [0.3, 0.3, 0.0]
    assert corner_sines(concave, ONE).min() < -0.1
    assert collapsed(concave, ONE, 1.0).all()


def test_a_bow_tie_is_collapsed():
    assert collapsed(SQUARE[[0, 2, 1, 3]], ONE, 1.0).all()


@pytest.mark.parametrize(("height", "bad"), [(0.5, False), (0.021, False), (0.019, True)])
def test_a_thin_parallelogram_is_collapsed_below_the_least_sine(height, bad):
    """A rhombus of unit edges whose corners have this sine."""
    c = np.sqrt(1.0 - height**2)
    thin = np.array([[0, 0, 0], [1, 0, 0], [1 + c, height, 0], [c, height, 0]])
    assert collapsed(thin, ONE, 1.0).all() == bad


@pytest.mark.parametrize(("length", "bad"), [(0.011, False), (0.009, True)])
def test_a_short_edge_is_measured_against_the_mean(length, bad):
    assert collapsed(SQUARE * [1.0, length, 1.0], ONE, 1.0).all() == bad


def test_quads_folded_onto_each_other_are_found(grid):
    mesh = grid(1, 2)
    flat = mesh.vertices.copy()
    assert len(folded_pairs(flat, mesh)) == 0
    folded = flat.copy()
    folded[[2, 5], 1] = 0.1
    folded[[2, 5], 2] = 0.05
    assert folded_pairs(folded, mesh).tolist() == [[0, 1]]


def test_the_guard_names_the_quads_a_step_breaks(grid):
    mesh = grid(3, 3)
    guard = NoFolding(mesh)
    assert len(guard.broken(mesh.vertices.ravel())) == 0
    moved = mesh.vertices.copy()
    moved[5] += [1.6, 0.0, 0.0]
    broken = guard.broken(moved.ravel()).tolist()
    assert {3, 4} <= set(broken)
    assert not {2, 5, 6, 7, 8} & set(broken)


def test_what_is_broken_at_the_start_may_stay_so(grid):
    bent = grid(3, 3).vertices.copy()
    bent[5] += [1.6, 0.0, 0.0]
    guard = NoFolding(grid(3, 3).moved(bent))
    assert len(guard.broken(bent.ravel())) == 0


def test_unknowns_after_the_vertices_do_not_matter_to_the_guard(grid):
    mesh = grid(2, 2)
    x = np.r_[mesh.vertices.ravel(), np.full(27, 1e9)]
    assert len(NoFolding(mesh).broken(x)) == 0
