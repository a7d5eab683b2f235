import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import gridshell as gs
from gridshell.mesh import corner_parity, position

BUILDERS = [corner_parity, gs.as_control_mesh, gs.control_mesh]


def rolled(mesh, rolls):
    quads = [np.roll(q, roll) for q, roll in zip(mesh.quads, rolls, strict=True)]
    return gs.QuadMesh(mesh.vertices, quads)


# ---- vertices -------------------------------------------------------------------------------


def test_a_grid_is_coloured_like_a_chessboard(grid):
    colour = gs.two_colouring(grid(3, 4)).reshape(4, 5)
    np.testing.assert_array_equal(colour, np.indices((4, 5)).sum(axis=0) % 2)


def test_no_edge_joins_two_vertices_of_one_colour(monkey_saddle, torus, annulus):
    for mesh in (monkey_saddle, torus(4, 6), annulus(8)):
        a, b = gs.two_colouring(mesh)[mesh.edges].T
        assert (a + b == 1).all()


def test_an_odd_valence_does_not_hinder_the_colouring_of_vertices(cube):
    colour = gs.two_colouring(cube)
    np.testing.assert_array_equal(colour, cube.vertices.sum(axis=1) % 2)


def test_the_smallest_vertex_of_every_component_gets_colour_zero(grid):
    mesh = grid(2, 2)
    two = gs.QuadMesh(np.vstack([mesh.vertices] * 2), np.vstack([mesh.quads, mesh.quads + 9]))
    assert gs.two_colouring(two)[[0, 9]].tolist() == [0, 0]


def test_an_unused_vertex_has_no_colour(grid):
    mesh = grid(1, 1)
    widened = gs.QuadMesh(np.vstack([[5.0, 5.0, 5.0], mesh.vertices]), mesh.quads + 1)
    assert gs.two_colouring(widened).tolist() == [-1, 0, 1, 1, 0]


@pytest.mark.parametrize("build", [gs.two_colouring, gs.as_control_mesh, gs.control_mesh])
@pytest.mark.parametrize("around", [3, 5, 9])
def test_an_odd_ring_is_refused_by_one_of_its_edges_and_the_position(annulus, build, around):
    mesh = annulus(around)
    with pytest.raises(gs.ColouringError) as info:
        build(mesh)
    a, b = (int(v) for v in info.value.where.split()[1].split("-"))
    assert [a, b] in mesh.edges.tolist()
    middle = mesh.vertices[[a, b]].mean(axis=0)
    assert info.value.where == f"edge {a}-{b} {position(middle)}"
    assert "one quad" in info.value.advice


# ---- corners --------------------------------------------------------------------------------


def families_around(mesh, shift, vertex):
    """Family of the diagonal that leaves *vertex* in each quad of its fan."""
    fan = mesh.fans[vertex]
    fan = fan[fan >= 0]
    return (fan % 4 - shift[fan // 4]) % 2 + 1


@given(rolls=st.lists(st.integers(0, 3), min_size=96, max_size=96))
@settings(max_examples=30)
def test_families_alternate_around_every_vertex_whatever_the_first_corners(monkey_saddle, rolls):
    mesh = rolled(monkey_saddle, rolls)
    shift = corner_parity(mesh)
    for vertex in range(len(mesh.vertices)):
        family = families_around(mesh, shift, vertex)
        assert (np.diff(family) != 0).all()
        if not mesh.on_boundary[vertex]:
            assert family[0] != family[-1]


def test_the_first_quad_keeps_its_first_corner(monkey_saddle):
    assert corner_parity(monkey_saddle)[0] == 0


def test_on_a_grid_family_one_is_the_same_diagonal_everywhere(grid):
    mesh = rolled(grid(3, 3), [0, 1, 2, 3, 1, 1, 0, 2, 3])
    corners = (np.arange(4) + corner_parity(mesh)[:, None]) % 4
    quads = np.take_along_axis(mesh.quads, corners, axis=1)
    along = np.abs(mesh.vertices[quads[:, 2]] - mesh.vertices[quads[:, 0]])
    slope = (mesh.vertices[quads[:, 2]] - mesh.vertices[quads[:, 0]])[:, :2].prod(axis=1)
    np.testing.assert_array_equal(along, np.tile([1.0, 1.0, 0.0], (9, 1)))
    np.testing.assert_array_equal(slope, np.ones(9))


@pytest.mark.parametrize("build", BUILDERS)
@pytest.mark.parametrize("valence", [3, 5, 7])
def test_an_odd_valence_is_refused_by_its_vertex_position_and_valence(sectors, build, valence):
    mesh = sectors(valence, 2)
    with pytest.raises(gs.OddValenceError) as info:
        build(mesh.moved(mesh.vertices + np.array([10.0, 20.0, 30.0])))
    assert info.value.where == "vertex 0 (10, 20, 30) mm"
    assert info.value.value == f"valence {valence}"
    assert "even" in info.value.limit


@pytest.mark.parametrize("build", BUILDERS)
def test_of_several_odd_valences_the_first_is_named(cube, build):
    with pytest.raises(gs.OddValenceError, match=r"vertex 0 \(0, 0, 0\) mm.*valence 3"):
        build(cube)


def test_an_odd_valence_on_the_boundary_is_allowed(l_shape):
    mesh = l_shape(2)
    reflex = np.flatnonzero((mesh.vertices == [2.0, 2.0, 0.0]).all(axis=1))
    assert mesh.valence[reflex] == 3
    assert set(corner_parity(mesh)) == {0}


@pytest.mark.parametrize("build", BUILDERS)
def test_a_hole_that_swaps_the_families_is_refused_by_a_quad_and_its_position(sectors, build):
    mesh = sectors(5, 3)
    holed = gs.QuadMesh(mesh.vertices, mesh.quads[(mesh.quads != 0).all(axis=1)])
    with pytest.raises(gs.ColouringError, match="change places") as info:
        build(holed)
    number = int(info.value.where.split()[1])
    centre = holed.vertices[holed.quads[number]].mean(axis=0)
    assert info.value.where == f"quad {number} {position(centre)}"
