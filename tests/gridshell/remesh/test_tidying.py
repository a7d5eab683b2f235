"""One sound mesh, or a named error."""

import numpy as np
import pytest
from charts_by_hand import ring

from gridshell.errors import TargetTooCoarseError
from gridshell.mesh import grid_quads
from gridshell.remesh.extent import Cells
from gridshell.remesh.extraction import extract
from gridshell.remesh.tidying import require_around, tidy


def cells_at(quads):
    rng = np.random.default_rng(0)
    return Cells(rng.random((int(quads.max()) + 1, 3)), quads, len(quads))


def test_a_grid_stays_as_it_is():
    mesh = tidy(cells_at(grid_quads(3, 4)), 1.0)
    assert len(mesh.quads) == 12
    assert len(mesh.vertices) == 20


def test_no_cell_at_all_is_a_named_error():
    nothing = Cells(np.ones((3, 3)), np.zeros((0, 4), dtype=np.int64), 0)
    with pytest.raises(TargetTooCoarseError, match=r"No quad fits.*\(1, 1, 1\).*edges of 50 mm"):
        tidy(nothing, 100.0)


def test_a_cell_on_a_side_that_is_taken_is_left_out():
    grid = grid_quads(2, 2)
    doubled = np.array([[0, 3, 10, 9]])  # its first side is the first quad's
    assert len(tidy(cells_at(np.concatenate([grid, doubled])), 1.0).quads) == 4


def test_cells_without_four_corners_are_left_out():
    none = np.array([[0, 0, 1, 1], [0, 4, 0, 4]])
    assert len(tidy(cells_at(np.concatenate([none, grid_quads(3, 3)])), 1.0).quads) == 9


@pytest.mark.parametrize("around", [1, 2])
def test_a_ring_of_one_or_two_cells_is_refused(around):
    for seed in range(8):
        try:
            found = extract(ring(np.random.default_rng(seed), around, 3, count=200))
        except ValueError:
            continue  # triangles that go around the ring themselves
        positions = np.random.default_rng(0).random((len(found.faces), 3))
        with pytest.raises(TargetTooCoarseError, match=r"at \(.*edges of 100 mm.*three.*of 50 mm"):
            require_around(found, positions, 100.0)
        return
    pytest.fail("no ring could be triangulated")


def test_a_ring_of_three_cells_is_accepted():
    found = extract(ring(np.random.default_rng(1), 3, 3, count=200))
    require_around(found, np.random.default_rng(0).random((len(found.faces), 3)), 100.0)
