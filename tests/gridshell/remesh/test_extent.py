"""How far the mesh goes, where every place is known."""

import numpy as np
import pytest
from charts_by_hand import convex, plane, scrambled

from gridshell.mesh import QuadMesh
from gridshell.remesh.extent import Extent, cells
from gridshell.remesh.extraction import extract

BETWEEN = [(0.25, 0.5), (5.75, 0.5), (5.75, 4.125), (0.25, 4.125)]
OBLIQUE = [(0.25, 0.5), (6.5, 2), (5, 6.25), (-0.5, 5)]


def made(outline, extent, seed=0):
    rng = np.random.default_rng(seed)
    found = extract(scrambled(plane(*convex(rng, outline, count=60)), rng))
    positions = np.einsum("ck,ckd->cd", found.weights, found.chart.mesh.corners[found.faces])
    return found, positions, cells(found, positions, extent, onto=lambda x: x)


@pytest.mark.parametrize("seed", range(6))
def test_inside_are_the_whole_cells(seed):
    _, positions, inside = made(BETWEEN, Extent.INSIDE, seed)
    assert len(inside.quads) == inside.whole == 4 * 3
    assert (inside.positions == positions).all()


@pytest.mark.parametrize("seed", range(6))
def test_cover_continues_the_lines_to_the_next_lattice_points(seed):
    _, _, cover = made(BETWEEN, Extent.COVER, seed)
    # a ring of cells around, without the four corners of which one point only is known
    assert len(cover.quads) == 12 + 2 * (4 + 3)
    assert cover.whole == 12
    at = cover.positions[np.unique(cover.quads)]
    np.testing.assert_allclose(at, np.rint(at), atol=1e-9)
    corners = cover.positions[cover.quads]
    steps = np.roll(corners, -1, axis=1) - corners
    np.testing.assert_allclose(np.linalg.norm(steps, axis=2), 1.0, atol=1e-9)


@pytest.mark.parametrize("seed", range(6))
def test_trimmed_ends_on_the_boundary(seed):
    found, _, trimmed = made(BETWEEN, Extent.TRIMMED, seed)
    at = trimmed.positions[len(found.faces) :][:, :2]
    at = at[np.isin(np.arange(len(found.faces), len(trimmed.positions)), trimmed.quads)]
    low, high = np.array(BETWEEN[0]), np.array(BETWEEN[2])
    on = np.minimum(np.abs(at - low), np.abs(at - high)).min(axis=1)
    np.testing.assert_allclose(on, 0.0, atol=1e-9)


@pytest.mark.parametrize("seed", range(6))
def test_no_end_of_a_trimmed_line_is_short(seed):
    _, _, trimmed = made(BETWEEN, Extent.TRIMMED, seed)
    corners = trimmed.positions[trimmed.quads]
    lengths = np.linalg.norm(np.roll(corners, -1, axis=1) - corners, axis=2)
    assert lengths.min() > 0.25  # the upper rim is 0.125 from the last line
    assert len(trimmed.quads) == 12 + 2 * (4 + 3)


@pytest.mark.parametrize("extent", list(Extent))
@pytest.mark.parametrize("seed", range(6))
def test_cells_of_an_oblique_outline_make_a_mesh(extent, seed):
    _, _, found = made(OBLIQUE, extent, seed)
    used, compact = np.unique(found.quads, return_inverse=True)
    mesh = QuadMesh(found.positions[used], compact.reshape(-1, 4))
    a, b, c, d = np.moveaxis(mesh.vertices[mesh.quads], 1, 0)
    assert (np.cross(c - a, d - b)[:, 2] > 0.0).all()
    if extent is Extent.COVER:
        inside = made(OBLIQUE, Extent.INSIDE, seed)[2]
        assert len(found.quads) > len(inside.quads)


def test_the_first_side_of_every_quad_runs_along_the_first_coordinate():
    for extent in Extent:
        _, _, found = made(BETWEEN, extent, 3)
        along = found.positions[found.quads[:, 1]] - found.positions[found.quads[:, 0]]
        assert (np.abs(along[:, 0]) > np.abs(along[:, 1])).all()


def test_a_closed_surface_or_aligned_rim_needs_no_ghosts():
    for extent in Extent:
        _, positions, found = made([(0, 0), (5, 0), (5, 4), (0, 4)], extent)
        assert len(found.quads) == found.whole == 20
        assert len(found.positions) == len(positions)
