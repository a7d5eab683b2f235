from itertools import pairwise

import numpy as np
import pytest

import gridshell as gs

MESHES = ["grid", "ring", "torus", "saddle", "corner"]


@pytest.fixture(params=MESHES)
def control(request, grid, annulus, torus, monkey_saddle, l_shape):
    meshes = {
        "grid": grid(3, 4),
        "ring": annulus(6, 3),
        "torus": torus(6, 8),
        "saddle": monkey_saddle,
        "corner": l_shape(3),
    }
    return gs.as_control_mesh(meshes[request.param])


def pairs(edges):
    return sorted(tuple(sorted(e)) for e in np.asarray(edges).tolist())


def test_every_quad_gives_one_edge_to_either_net(control):
    first, second = gs.diagonal_meshes(control)
    assert len(first.edges) == len(second.edges) == len(control.quads)


def test_the_edges_are_the_diagonals(control):
    drawn = [net.control_vertices[net.edges] for net in gs.diagonal_meshes(control)]
    quads = control.quads
    assert pairs(np.vstack(drawn)) == pairs(np.vstack([quads[:, [0, 2]], quads[:, [1, 3]]]))


def test_family_one_is_the_diagonal_of_the_first_corner(control):
    quads = control.quads
    for net in gs.diagonal_meshes(control):
        ends = net.control_vertices[net.edges]
        for family, corners in ((1, [0, 2]), (2, [1, 3])):
            chosen = net.family == family
            np.testing.assert_array_equal(ends[chosen], quads[chosen][:, corners])


def test_family_and_net_are_independent_labels(control):
    for net in gs.diagonal_meshes(control):
        assert set(net.family.tolist()) == {1, 2}


def test_each_net_holds_the_vertices_of_one_colour(control):
    for colour, net in enumerate(gs.diagonal_meshes(control)):
        np.testing.assert_array_equal(
            net.control_vertices, np.flatnonzero(control.colour == colour)
        )
        np.testing.assert_array_equal(net.vertices, control.vertices[net.control_vertices])


def test_stars_hold_the_ends_of_the_edges(control):
    for net in gs.diagonal_meshes(control):
        spokes = [(v, b) for v, row in enumerate(net.stars.spokes) for b in row[row >= 0]]
        assert pairs(spokes) == sorted(pairs(net.edges) * 2)
        np.testing.assert_array_equal((net.stars.spokes >= 0).sum(axis=1), net.stars.count)


def test_families_alternate_around_every_star(control):
    for net in gs.diagonal_meshes(control):
        drawn = zip(net.edges.tolist(), net.family.tolist(), strict=True)
        family = {tuple(sorted(edge)): label for edge, label in drawn}
        for v, row in enumerate(net.stars.spokes.tolist()):
            around = [family[tuple(sorted((v, b)))] for b in row if b >= 0]
            assert all(a != b for a, b in pairwise(around))


def test_faces_are_rings_of_edges_around_the_inner_vertices_of_the_other_net(control):
    nets = gs.diagonal_meshes(control)
    for net, other in (nets, nets[::-1]):
        edges = set(pairs(net.edges))
        inner = other.stars.closed
        assert len(net.faces) == np.count_nonzero(inner)
        for ring, valence in zip(net.faces, other.stars.count[inner], strict=True):
            corners = ring[ring >= 0]
            assert len(corners) == valence
            assert set(pairs(np.stack([corners, np.roll(corners, -1)], axis=1))) <= edges


def test_faces_are_counter_clockwise(grid, sectors):
    for mesh in (grid(4, 4), sectors(6)):
        for net in gs.diagonal_meshes(gs.as_control_mesh(mesh)):
            for ring in net.faces:
                x, y, _ = net.vertices[ring[ring >= 0]].T
                assert np.sum(x * np.roll(y, -1) - y * np.roll(x, -1)) > 0.0


def test_the_net_of_a_unit_grid_has_edges_of_root_two(grid):
    for net in gs.diagonal_meshes(gs.as_control_mesh(grid(3, 4))):
        assert net.mean_edge == pytest.approx(np.sqrt(2.0), rel=1e-15)


def test_an_unused_vertex_is_in_neither_net(grid):
    mesh = grid(2, 2)
    widened = gs.QuadMesh(np.vstack([mesh.vertices, [9.0, 9.0, 9.0]]), mesh.quads)
    first, second = gs.diagonal_meshes(gs.as_control_mesh(widened))
    assert sorted([*first.control_vertices, *second.control_vertices]) == list(range(9))
