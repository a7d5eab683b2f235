from collections import Counter

import numpy as np
import pytest

import gridshell as gs


def nets(mesh):
    return gs.diagonal_meshes(gs.as_control_mesh(mesh))


def edges_of(line):
    following = np.roll(line.vertices, -1) if line.closed else line.vertices[1:]
    return zip(line.vertices.tolist(), following.tolist(), strict=False)


def summary(lines):
    return Counter((line.family, len(line.vertices), line.closed) for line in lines)


def places(net, line):
    return net.vertices[line.vertices][:, :2].astype(int).tolist()


@pytest.fixture(params=["grid", "net of a grid", "ring", "net of a ring", "torus", "saddle", "L"])
def net(request, grid, annulus, torus, monkey_saddle, l_shape):
    control = {
        "grid": lambda: gs.as_control_mesh(grid(3, 4)),
        "net of a grid": lambda: gs.control_mesh(grid(6, 8)),
        "ring": lambda: gs.as_control_mesh(annulus(8)),
        "net of a ring": lambda: gs.control_mesh(annulus(8, 6)),
        "torus": lambda: gs.as_control_mesh(torus(6, 8)),
        "saddle": lambda: gs.as_control_mesh(monkey_saddle),
        "L": lambda: gs.as_control_mesh(l_shape(3)),
    }[request.param]()
    return gs.diagonal_meshes(control)[0]


# ---- what holds for every net ---------------------------------------------------------------


def test_every_edge_lies_on_exactly_one_polyline_of_its_family(net):
    walked = Counter(
        (line.family, *sorted(edge)) for line in gs.polylines(net) for edge in edges_of(line)
    )
    drawn = Counter(
        (int(f), *sorted(edge)) for f, edge in zip(net.family, net.edges.tolist(), strict=True)
    )
    assert walked == drawn


def test_polylines_are_maximal(net):
    """No two ends of open polylines are continued by each other."""
    ends = Counter()
    for line in gs.polylines(net):
        if not line.closed:
            ends[(line.vertices[1], line.vertices[0])] += 1
            ends[(line.vertices[-2], line.vertices[-1])] += 1
    for before, centre, after in net.stars.continuations():
        assert (before, centre) not in ends
        assert (after, centre) not in ends


def test_family_one_comes_first_and_each_family_in_the_order_of_its_smallest_edge(net):
    number = {tuple(sorted(edge)): i for i, edge in enumerate(net.edges.tolist())}
    keys = [
        (line.family, min(number[tuple(sorted(edge))] for edge in edges_of(line)))
        for line in gs.polylines(net)
    ]
    assert keys == sorted(keys)


def test_the_same_net_gives_the_same_polylines(net):
    first, second = gs.polylines(net), gs.polylines(net)
    assert [a.vertices.tolist() for a in first] == [b.vertices.tolist() for b in second]
    assert not any(line.vertices.flags.writeable for line in first)


# ---- counts and lengths ---------------------------------------------------------------------


@pytest.mark.parametrize(("a", "b"), [(2, 2), (2, 3), (3, 4)])
def test_a_rectangular_net_has_a_lamella_per_row_and_column(grid, a, b):
    net, _ = gs.diagonal_meshes(gs.control_mesh(grid(2 * a, 2 * b)))
    found = Counter((len(line.vertices), line.closed) for line in gs.polylines(net))
    assert found == Counter({(a, False): b}) + Counter({(b, False): a})


def test_a_rectangular_net_has_one_direction_per_family(grid):
    net, _ = gs.diagonal_meshes(gs.control_mesh(grid(6, 8)))
    for line in gs.polylines(net):
        x, y = np.transpose(places(net, line))
        assert len(set(x if line.family == 2 else y)) == 1


def test_lamellas_of_a_plain_grid_cross_it_diagonally(grid):
    first, second = nets(grid(2, 2))
    assert summary(gs.polylines(first)) == {(1, 2, False): 2, (2, 2, False): 2}
    assert summary(gs.polylines(second)) == {(1, 3, False): 1, (2, 3, False): 1}


def test_a_single_quad_is_a_net_of_one_lamella(grid):
    first, second = nets(grid(1, 1))
    assert [p.vertices.tolist() for net in (first, second) for p in gs.polylines(net)] == [
        first.edges[0].tolist(),
        second.edges[0].tolist(),
    ]


@pytest.mark.parametrize("columns", [2, 5])
def test_in_a_strip_one_quad_wide_every_diagonal_is_a_lamella(grid, columns):
    for net in nets(grid(1, columns)):
        assert [len(line.vertices) for line in gs.polylines(net)] == [2] * columns


def test_lamellas_of_a_ring_run_from_rim_to_rim(annulus):
    for net in nets(annulus(8, 4)):
        assert summary(gs.polylines(net)) == {(1, 5, False): 4, (2, 5, False): 4}


@pytest.mark.parametrize("around", [6, 8, 12])
def test_the_net_along_a_ring_has_closed_lamellas(annulus, around):
    net, _ = gs.diagonal_meshes(gs.control_mesh(annulus(around, 6)))
    lengths = Counter((len(p.vertices), p.closed) for p in gs.polylines(net))
    half = around // 2
    assert lengths == Counter({(3, False): half}) + Counter({(half, True): 3})


def test_two_nodes_joined_by_two_edges_do_not_multiply_them(annulus):
    """Four quads around: each closed lamella has two nodes and two edges between them."""
    net, _ = gs.diagonal_meshes(gs.control_mesh(annulus(4, 6)))
    assert sum(len(list(edges_of(line))) for line in gs.polylines(net)) == len(net.edges)


def test_a_closed_lamella_starts_anywhere_but_repeats_nothing(annulus):
    net, _ = gs.diagonal_meshes(gs.control_mesh(annulus(12, 6)))
    for line in gs.polylines(net):
        assert len(set(line.vertices.tolist())) == len(line.vertices)


def test_all_lamellas_of_a_torus_are_closed(torus):
    """On a torus of 6 x 8 a diagonal closes after lcm(6, 8) = 24 steps; 24 edges per family."""
    for net in nets(torus(6, 8)):
        assert summary(gs.polylines(net)) == {(1, 24, True): 1, (2, 24, True): 1}


def test_a_torus_of_equal_sides_has_shorter_loops(torus):
    for net in nets(torus(6, 6)):
        assert summary(gs.polylines(net)) == {(1, 6, True): 3, (2, 6, True): 3}


# ---- boundary, reflex corners, singular vertices --------------------------------------------


def test_a_lamella_runs_along_the_boundary_of_the_net(grid):
    net, _ = gs.diagonal_meshes(gs.control_mesh(grid(6, 6)))
    assert [[1, 1], [3, 1], [5, 1]] in [sorted(places(net, p)) for p in gs.polylines(net)]


def test_a_lamella_passes_a_reflex_corner(l_shape):
    """In the L of 3 x 3 squares one diagonal grazes the reflex corner (3, 3)."""
    found = [sorted(places(net, p)) for net in nets(l_shape(3)) for p in gs.polylines(net)]
    assert [[k, 6 - k] for k in range(7)] in found


def test_a_lamella_that_meets_a_reflex_corner_head_on_ends_there(l_shape):
    found = [sorted(places(net, p)) for net in nets(l_shape(3)) for p in gs.polylines(net)]
    assert [[k, k] for k in range(4)] in found


def test_a_lamella_along_the_edge_of_the_net_passes_its_reflex_corner(l_shape):
    net, _ = gs.diagonal_meshes(gs.control_mesh(l_shape(4)))
    found = [sorted(places(net, p)) for p in gs.polylines(net)]
    assert [[1, 3], [3, 3], [5, 3], [7, 3]] in found
    assert [[3, 1], [3, 3], [3, 5], [3, 7]] in found


def test_lamellas_end_at_a_singular_vertex(monkey_saddle):
    """Three of each family leave a vertex of valence six, none passes through it."""
    control = gs.as_control_mesh(monkey_saddle)
    (net,) = (n for n in gs.diagonal_meshes(control) if 0 in n.control_vertices)
    (centre,) = np.flatnonzero(net.control_vertices == 0)
    meeting = [p for p in gs.polylines(net) if centre in p.vertices]
    assert Counter(p.family for p in meeting) == {1: 3, 2: 3}
    assert all(centre in (p.vertices[0], p.vertices[-1]) for p in meeting)
    assert {len(p.vertices) for p in meeting} == {5}


def test_lamellas_pass_a_regular_vertex(sectors):
    control = gs.as_control_mesh(sectors(4))
    (net,) = (n for n in gs.diagonal_meshes(control) if 0 in n.control_vertices)
    (centre,) = np.flatnonzero(net.control_vertices == 0)
    meeting = [p for p in gs.polylines(net) if centre in p.vertices]
    assert [(p.family, len(p.vertices)) for p in meeting] == [(1, 9), (2, 9)]
