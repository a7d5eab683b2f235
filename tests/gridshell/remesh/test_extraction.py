"""Quad meshes read off charts that are known exactly."""

import numpy as np
import pytest
from charts_by_hand import cone, convex, permuted, plane, ring, scrambled

from gridshell.mesh import QuadMesh
from gridshell.remesh.extraction import barycentric, extract

SEEDS = range(12)


def flat_positions(found):
    """Crossings (c, 2) in the plane of the triangulation, which is their lattice point."""
    mesh = found.chart.mesh
    xy = np.einsum("ck,ckd->cd", found.weights, mesh.corners[found.faces])[:, :2]
    assert np.abs(xy - np.rint(xy)).max(initial=0.0) < 1e-9
    return np.rint(xy).astype(int)


def cells_of(found):
    """Lower left corners of the whole cells, sorted; every cell is checked to be a unit square."""
    corners = flat_positions(found)[found.cells]
    steps = np.roll(corners, -1, axis=1) - corners
    assert (np.abs(steps).sum(axis=2) == 1).all()
    turn = steps[:, 0, 0] * steps[:, 1, 1] - steps[:, 0, 1] * steps[:, 1, 0]
    assert (turn == 1).all()
    return sorted(map(tuple, corners.min(axis=1).tolist()))


def lattice_in(outline):
    """Lattice points in a closed convex polygon and the cells in it, by brute force."""
    outline = np.asarray(outline)
    along = np.roll(outline, -1, axis=0) - outline
    low, high = outline.min(axis=0), outline.max(axis=0)
    sides = list(zip(outline, along, strict=True))
    points = {
        (x, y)
        for x in range(int(np.floor(low[0])), int(np.ceil(high[0])) + 1)
        for y in range(int(np.floor(low[1])), int(np.ceil(high[1])) + 1)
        if all(d[0] * (y - p[1]) - d[1] * (x - p[0]) >= 0 for p, d in sides)
    }
    square = ((0, 0), (1, 0), (1, 1), (0, 1))
    cells = sorted(p for p in points if all((p[0] + i, p[1] + j) in points for i, j in square))
    return sorted(points), cells


OUTLINES = {
    "on lattice lines": [(0, 0), (5, 0), (5, 4), (0, 4)],
    "between them": [(0.25, 0.5), (5.75, 0.5), (5.75, 4.125), (0.25, 4.125)],
    "one side on a line": [(0, 0.5), (5.5, 0.5), (5.5, 4), (0, 4)],
    "turned by (3, 4)": [(0, 0), (6, 8), (2, 11), (-4, 3)],
    "turned by (5, 12)": [(0, 0), (5, 12), (-7, 17), (-12, 5)],
    "turned by 45 degrees": [(0, 0), (4, 4), (0, 8), (-4, 4)],
    "a triangle": [(0, 0), (7, 2), (1, 6)],
    "less than a cell": [(0.25, 0.25), (0.75, 0.25), (0.75, 0.75), (0.25, 0.75)],
}


@pytest.mark.parametrize("outline", OUTLINES.values(), ids=OUTLINES)
def test_a_plane_chart_gives_its_grid_however_it_is_triangulated(outline):
    points, cells = lattice_in(outline)
    for seed in SEEDS:
        rng = np.random.default_rng(seed)
        found = extract(scrambled(plane(*convex(rng, outline, count=20 * (seed % 4))), rng))
        assert sorted(map(tuple, flat_positions(found).tolist())) == points
        assert cells_of(found) == cells
        assert found.non_quads == 0
        assert (found.traced.reverse[found.cell_ports] >= 0).all()


@pytest.mark.parametrize("outline", OUTLINES.values(), ids=OUTLINES)
def test_every_edge_between_two_crossings_of_the_grid_is_traced(outline):
    points, _ = lattice_in(outline)
    inside = set(points)
    edges = sum(((x + 1, y) in inside) + ((x, y + 1) in inside) for x, y in points)
    for seed in SEEDS:
        rng = np.random.default_rng(100 + seed)
        found = extract(scrambled(plane(*convex(rng, outline)), rng))
        assert np.count_nonzero(found.traced.reverse >= 0) == 2 * edges


@pytest.mark.parametrize("shift", [0, 2, -3])
@pytest.mark.parametrize(("around", "across"), [(4, 3), (7, 2), (3, 5)])
def test_a_ring_gives_a_closed_grid(around, across, shift):
    for seed in SEEDS:
        rng = np.random.default_rng(seed)
        found = extract(scrambled(ring(rng, around, across, shift), rng))
        heights = range(-10, across + 10)
        inside = {
            (x, y)
            for x in range(around + 1)
            for y in heights
            if y * around - shift * x in range(across * around + 1)
        }
        square = ((0, 0), (1, 0), (1, 1), (0, 1))
        cells = [
            p
            for p in inside
            if p[0] < around and all((p[0] + i, p[1] + j) in inside for i, j in square)
        ]
        assert len(found.cells) == len(cells)
        assert len(found.faces) == sum(p[0] < around for p in inside)
        degree = np.bincount(found.cells.ravel(), minlength=len(found.faces))
        assert degree.max(initial=0) <= 4
        assert found.non_quads == 0


@pytest.mark.parametrize("valence", [2, 4, 6, 8])
def test_a_cone_gives_one_vertex_of_its_valence(valence):
    for seed in SEEDS:
        rng = np.random.default_rng(seed)
        found = extract(scrambled(cone(rng, valence, 3), rng))
        assert len(found.cells) == 9 * valence
        assert len(found.faces) == 1 + valence * 3 * 4
        degree = np.bincount(found.cells.ravel(), minlength=len(found.faces))
        assert np.count_nonzero(degree == valence) >= 1
        assert found.non_quads == 0
        if valence != 4:
            mesh = QuadMesh(rng.random((len(found.faces), 3)), found.cells)
            inner = ~mesh.on_boundary
            assert sorted(mesh.valence[inner & (mesh.valence != 4)]) == [valence]


def test_numbering_of_the_triangles_does_not_matter():
    for seed in SEEDS:
        rng = np.random.default_rng(seed)
        chart = plane(*convex(rng, OUTLINES["turned by (3, 4)"]))
        first = extract(chart)
        second = extract(permuted(chart, rng))
        assert cells_of(first) == cells_of(second)
        assert len(first.faces) == len(second.faces)
        assert np.count_nonzero(first.traced.exits >= 0) == np.count_nonzero(
            second.traced.exits >= 0
        )


def test_weights_are_those_of_the_crossing():
    rng = np.random.default_rng(3)
    found = extract(plane(*convex(rng, OUTLINES["on lattice lines"])))
    weights = barycentric(found.chart, found.ports.face, found.ports.at)
    assert weights.min() > -1e-12
    np.testing.assert_allclose(weights.sum(axis=1), 1.0)
