import numpy as np
import pytest

import gridshell as gs
from gridshell.constraints import other_stars, regular_stars


def residual(constraint, vertices):
    return constraint.evaluate(np.asarray(vertices, dtype=float).ravel(), None).residual


def tilted(vertices):
    """The plane z = 0 turned to a general one."""
    u, v = np.array([0.8, 0.6, 0.0]), np.array([-0.36, 0.48, 0.8])
    return vertices[:, :1] * u + vertices[:, 1:2] * v + 7.0


def star(directions, heights):
    """Vertex 0 in the origin and its spokes, one quad between two neighbours."""
    ends = [[np.cos(t), np.sin(t), h] for t, h in zip(directions, heights, strict=True)]
    return np.array([[0.0, 0.0, 0.0], *ends])


def stars_of(count, closed):
    """One star around vertex 0 with spokes 1 .. count; the others have none."""
    spokes = np.full((count + 1, count), -1)
    spokes[0] = np.arange(1, count + 1)
    return gs.Stars(spokes, np.array([count] + [0] * count), np.array([closed] + [False] * count))


def turn(count, closed):
    return np.arange(count) * (2.0 * np.pi / count if closed else np.pi / (count - 1))


# ---- which stars give which rows ------------------------------------------------------------


def test_a_regular_star_gives_two_rows(grid):
    pattern = regular_stars(gs.diagonal_stars(grid(3, 3))).pattern()
    assert (len(pattern.columns), pattern.rows) == (4, 2)


def test_a_star_of_valence_six_gives_six_rows(sectors):
    constraint = other_stars(gs.diagonal_stars(sectors(6, 2)))
    centred = constraint.points[constraint.points[:, 0] == 0]
    assert len(centred) == 6
    ring = gs.diagonal_stars(sectors(6, 2)).spokes[0].tolist()
    assert centred[:, 1:].tolist() == [np.roll(ring, -k)[:3].tolist() for k in range(6)]


def test_a_boundary_star_of_three_spokes_gives_one_row(grid):
    constraint = other_stars(gs.edge_stars(grid(2, 2)))
    assert sorted(constraint.points[:, 0]) == [1, 3, 5, 7]


def test_an_open_star_of_five_spokes_gives_three_rows():
    rows = other_stars(stars_of(5, closed=False)).points
    assert rows.tolist() == [[0, 1, 2, 3], [0, 2, 3, 4], [0, 3, 4, 5]]


def test_stars_of_two_spokes_are_always_planar(grid):
    constraint = other_stars(gs.diagonal_stars(grid(3, 3)))
    assert len(constraint.pattern().columns) == 0


def test_every_star_of_three_spokes_or_more_is_in_one_of_both(monkey_saddle):
    for stars in (gs.diagonal_stars(monkey_saddle), gs.edge_stars(monkey_saddle)):
        regular, others = regular_stars(stars).points[:, 0], other_stars(stars).points[:, 0]
        assert set(regular) | set(others) == set(np.flatnonzero(stars.count >= 3))
        assert not set(regular) & set(others)


# ---- when they vanish -----------------------------------------------------------------------


@pytest.mark.parametrize("valence", [4, 6, 8])
def test_rows_vanish_on_a_flat_mesh_in_any_plane(sectors, valence):
    mesh = sectors(valence)
    for stars in (gs.diagonal_stars(mesh), gs.edge_stars(mesh)):
        for constraint in (regular_stars(stars), other_stars(stars)):
            assert np.abs(residual(constraint, tilted(mesh.vertices))).max(initial=0.0) < 1e-13


def test_rows_vanish_on_the_rulings_of_a_hyperbolic_paraboloid(grid):
    mesh = grid(4, 4, lambda x, y: 0.3 * x * y)
    stars = gs.edge_stars(mesh)
    for constraint in (regular_stars(stars), other_stars(stars)):
        assert np.abs(residual(constraint, mesh.vertices)).max() < 1e-14


@pytest.mark.parametrize(("count", "closed"), [(6, True), (8, True), (3, False), (5, False)])
@pytest.mark.parametrize("lifted", [0, 1, 2])
def test_a_spoke_out_of_the_plane_of_its_star_shows(count, closed, lifted):
    heights = np.zeros(count)
    heights[lifted] = 0.1
    vertices = star(turn(count, closed), heights)
    constraint = other_stars(stars_of(count, closed))
    if (count, closed) == (3, False):
        vertices[0] = [0.0, -0.5, 0.0]  # not on the line of the first and the last spoke
    assert np.abs(residual(constraint, vertices)).max() > 0.01


@pytest.mark.parametrize("lifted", [0, 1, 2, 3, 4])
def test_a_point_out_of_the_plane_of_a_regular_star_shows(lifted):
    vertices = star(turn(4, True), np.zeros(4))
    vertices[lifted, 2] = 0.1
    found = np.abs(residual(regular_stars(stars_of(4, True)), vertices))
    assert found.max() > 0.04


def test_a_centre_lifted_by_h_is_h_from_the_plane_of_its_spokes():
    vertices = star(turn(4, True), np.zeros(4))
    vertices[0, 2] = 0.25
    found = residual(regular_stars(stars_of(4, True)), vertices)
    np.testing.assert_allclose(np.abs(found), [[0.25, 0.25]], atol=1e-15)


def test_alternating_spokes_of_a_regular_star_are_their_height_from_the_plane():
    vertices = star(turn(4, True), [0.25, -0.25, 0.25, -0.25])
    found = residual(regular_stars(stars_of(4, True)), vertices)
    np.testing.assert_allclose(np.abs(found), [[0.25, 0.25]], atol=1e-15)
