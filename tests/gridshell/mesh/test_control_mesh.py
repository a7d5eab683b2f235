import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import gridshell as gs
from gridshell.mesh import grid_quads

SIZES = [(2, 2), (2, 3), (3, 2), (4, 5)]


def loose_ends(control, colour):
    return np.count_nonzero((control.mesh.valence == 1) & (control.colour == colour))


# ---- the mesh itself as control mesh --------------------------------------------------------


def test_the_quads_keep_their_order_and_orientation(monkey_saddle):
    control = gs.as_control_mesh(monkey_saddle)
    for given_quad, quad in zip(monkey_saddle.quads, control.quads, strict=True):
        assert quad.tolist() in [np.roll(given_quad, k).tolist() for k in range(4)]


@given(rolls=st.lists(st.integers(0, 3), min_size=95, max_size=95))
@settings(max_examples=30)
def test_the_diagonals_do_not_depend_on_the_first_corners_of_later_quads(monkey_saddle, rolls):
    quads = [np.roll(q, k) for q, k in zip(monkey_saddle.quads, [0, *rolls], strict=True)]
    plain = gs.as_control_mesh(monkey_saddle)
    turned = gs.as_control_mesh(gs.QuadMesh(monkey_saddle.vertices, quads))
    for corners in ([0, 2], [1, 3]):
        np.testing.assert_array_equal(
            np.sort(turned.quads[:, corners]), np.sort(plain.quads[:, corners])
        )
    np.testing.assert_array_equal(turned.colour, plain.colour)


def test_both_ends_of_a_diagonal_have_one_colour(monkey_saddle, torus):
    for mesh in (monkey_saddle, torus(4, 6)):
        control = gs.as_control_mesh(mesh)
        colour = control.colour[control.quads]
        np.testing.assert_array_equal(colour[:, [0, 1]], colour[:, [2, 3]])
        assert (colour[:, 0] != colour[:, 1]).all()


@pytest.mark.parametrize(("rows", "columns"), [(2, 2), (2, 4), (4, 4)])
def test_d1_is_the_diagonal_mesh_with_fewer_loose_ends(grid, rows, columns):
    control = gs.as_control_mesh(grid(rows, columns))
    assert (loose_ends(control, 0), loose_ends(control, 1)) == (0, 4)


def test_with_equal_loose_ends_d1_holds_the_smallest_vertex(grid):
    control = gs.as_control_mesh(grid(3, 2))
    assert loose_ends(control, 0) == loose_ends(control, 1)
    assert control.colour[0] == 0


def test_an_unused_vertex_has_no_colour_even_when_colours_are_swapped(grid):
    mesh = grid(2, 2)
    widened = gs.QuadMesh(np.vstack([mesh.vertices, [9.0, 9.0, 9.0]]), mesh.quads)
    control = gs.as_control_mesh(widened)
    assert control.colour.tolist() == [1, 0, 1, 0, 1, 0, 1, 0, 1, -1]


def test_labels_are_read_only(grid):
    assert not gs.as_control_mesh(grid(2, 2)).colour.flags.writeable


def test_moved_keeps_the_labels(monkey_saddle):
    control = gs.as_control_mesh(monkey_saddle)
    moved = control.moved(2.0 * control.vertices)
    np.testing.assert_array_equal(moved.quads, control.quads)
    np.testing.assert_array_equal(moved.colour, control.colour)
    np.testing.assert_array_equal(moved.vertices, 2.0 * control.vertices)


# ---- the mesh of the red vertices -----------------------------------------------------------


@pytest.mark.parametrize(("a", "b"), SIZES)
def test_a_grid_of_2a_by_2b_quads_gives_a_net_of_a_by_b_nodes(grid, a, b):
    net, _ = gs.diagonal_meshes(gs.control_mesh(grid(2 * a, 2 * b)))
    odd = np.stack(np.meshgrid(np.arange(1, 2 * a, 2), np.arange(1, 2 * b, 2)), -1).reshape(-1, 2)
    assert sorted(net.vertices[:, :2].tolist()) == sorted(odd.tolist())
    assert len(net.edges) == a * (b - 1) + (a - 1) * b
    assert len(net.faces) == (a - 1) * (b - 1)


@pytest.mark.parametrize(("a", "b"), SIZES)
def test_the_families_of_that_net_are_the_two_directions_of_the_grid(grid, a, b):
    net, _ = gs.diagonal_meshes(gs.control_mesh(grid(2 * a, 2 * b)))
    steps = np.abs(net.vertices[net.edges[:, 1]] - net.vertices[net.edges[:, 0]])
    directions = {f: np.unique(steps[net.family == f], axis=0).tolist() for f in (1, 2)}
    assert sorted(directions.values()) == [[[0.0, 2.0, 0.0]], [[2.0, 0.0, 0.0]]]


def test_an_edge_of_the_net_spans_two_edges_of_the_mesh(grid):
    mesh = grid(6, 6)
    net, _ = gs.diagonal_meshes(gs.control_mesh(mesh))
    assert net.mean_edge == 2.0 * mesh.mean_edge


def test_every_control_quad_surrounds_a_regular_vertex(grid):
    mesh = grid(6, 4)
    control = gs.control_mesh(mesh)
    centres = control.vertices[control.quads].mean(axis=1)
    inner = mesh.vertices[~mesh.on_boundary]
    blue = inner[inner[:, :2].sum(axis=1) % 2 == 1]
    assert sorted(centres.tolist()) == sorted(blue.tolist())


def test_control_quads_keep_the_orientation_of_the_mesh(grid):
    control = gs.control_mesh(grid(6, 4))
    corners = control.vertices[control.quads]
    cross = np.cross(corners[:, 2] - corners[:, 0], corners[:, 3] - corners[:, 1])
    assert (cross[:, 2] > 0.0).all()


@pytest.mark.parametrize("valence", [6, 8])
def test_a_singular_vertex_stays_in_the_control_mesh_with_its_valence(sectors, valence):
    control = gs.control_mesh(sectors(valence))
    singular = control.mesh.valence > 4
    np.testing.assert_allclose(control.vertices[singular], [[0.0, 0.0, 0.0]], atol=1e-12)
    assert control.mesh.valence[singular] == [valence]


def test_a_singular_vertex_of_the_second_colour_stays_as_well(sectors):
    mesh = sectors(6)
    neighbour_first = np.r_[1, 0, np.arange(2, len(mesh.vertices))]
    renumbered = gs.QuadMesh(mesh.vertices[neighbour_first], neighbour_first[mesh.quads])
    assert gs.two_colouring(renumbered)[1] == 1
    assert renumbered.valence[1] == gs.control_mesh(renumbered).mesh.valence.max() == 6


def test_rings_stay_rings(annulus):
    assert gs.control_mesh(annulus(8, 6)).mesh.euler_characteristic == 0


@pytest.mark.parametrize(("rows", "columns"), [(1, 1), (1, 6), (2, 2)])
def test_a_mesh_without_an_interior_blue_vertex_is_too_small(grid, rows, columns):
    with pytest.raises(gs.MeshError, match="too small") as info:
        gs.control_mesh(grid(rows, columns))
    assert type(info.value) is gs.MeshError
    assert info.value.value == f"{rows * columns} quads"


def test_singular_vertices_of_both_colours_are_refused_by_vertex_position_and_valence(grid):
    """Two quads of a strip are split into pairs around inner vertices of valence two."""
    strip = grid(1, 3)
    vertices = np.vstack([strip.vertices, [0.5, 0.5, 0.0], [0.5, 1.5, 0.0]])
    split = [[0, 4, 5, 8], [0, 8, 5, 1], [1, 5, 6, 9], [1, 9, 6, 2], strip.quads[2]]
    mesh = gs.QuadMesh(vertices, split)
    assert mesh.valence[8:].tolist() == [2, 2]
    with pytest.raises(gs.MeshError, match="both colours") as info:
        gs.control_mesh(mesh)
    assert type(info.value) is gs.MeshError
    assert info.value.where == "vertex 9 (0.5, 1.5, 0) mm"
    assert info.value.value == "valence 2"


def test_a_mesh_too_narrow_for_a_control_mesh_is_refused():
    i, j = np.meshgrid(np.arange(3.0), np.arange(7.0), indexing="ij")
    vertices = np.stack([i.ravel(), j.ravel(), 0.0 * i.ravel()], axis=1)
    with pytest.raises(gs.MeshError, match="too narrow"):
        gs.control_mesh(gs.QuadMesh(vertices, grid_quads(2, 6)))


@pytest.mark.parametrize("valence", [2, 6, 8])
@pytest.mark.parametrize("size", [4, 5, 6, 7])
def test_d1_holds_the_singular_vertices_so_that_its_faces_are_quads(sectors, valence, size):
    control = gs.control_mesh(sectors(valence, size))
    inner = ~control.mesh.on_boundary & (control.mesh.valence > 0)
    singular = inner & (control.mesh.valence != 4)
    assert control.mesh.valence[singular].tolist() == [valence]
    assert (control.colour[singular] == 0).all()
    faces = gs.diagonal_meshes(control)[0].faces
    assert len(faces)
    assert ((faces >= 0).sum(axis=1) == 4).all()
