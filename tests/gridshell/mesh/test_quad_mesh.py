import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

import gridshell as gs
from gridshell.mesh import position
from gridshell.mesh.quad_mesh import next_in_quad, previous_in_quad

SQUARE = np.array([[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.0]])
BUILDERS = [gs.QuadMesh, gs.oriented]


def normals_up(mesh):
    corners = mesh.vertices[mesh.quads]
    cross = np.cross(corners[:, 2] - corners[:, 0], corners[:, 3] - corners[:, 1])
    return cross[:, 2] > 0.0


def raised(error, build, vertices, quads):
    with pytest.raises(error) as info:
        build(vertices, quads)
    assert type(info.value) is error
    return info.value


# ---- topology -------------------------------------------------------------------------------


def test_a_disk_has_euler_characteristic_one(grid, monkey_saddle, l_shape):
    meshes = (grid(1, 1), grid(3, 5), l_shape(3), monkey_saddle)
    assert [m.euler_characteristic for m in meshes] == [1, 1, 1, 1]


def test_a_ring_and_a_torus_have_euler_characteristic_zero(annulus, torus):
    assert annulus(7).euler_characteristic == torus(6, 8).euler_characteristic == 0


def test_a_sphere_has_euler_characteristic_two(cube):
    assert cube.euler_characteristic == 2


def test_an_unused_vertex_does_not_count_in_the_euler_characteristic():
    mesh = gs.QuadMesh(np.vstack([SQUARE, [9.0, 9.0, 9.0]]), [[0, 1, 2, 3]])
    assert mesh.euler_characteristic == 1


def test_edges_of_a_grid_are_counted_once(grid):
    assert len(grid(3, 5).edges) == 3 * 6 + 5 * 4


def test_edges_are_sorted_pairs_with_the_smaller_index_first(monkey_saddle):
    edges = monkey_saddle.edges
    assert (edges[:, 0] < edges[:, 1]).all()
    assert edges.tolist() == sorted(edges.tolist())


def test_a_twin_runs_the_other_way_along_the_same_edge(monkey_saddle):
    m = monkey_saddle
    inner = np.flatnonzero(m.twin >= 0)
    np.testing.assert_array_equal(m.twin[m.twin[inner]], inner)
    np.testing.assert_array_equal(m.origin[m.twin[inner]], m.target[inner])
    np.testing.assert_array_equal(m.target[m.twin[inner]], m.origin[inner])


def test_half_edges_without_a_twin_are_the_rim(grid):
    assert np.count_nonzero(grid(3, 5).twin < 0) == 2 * (3 + 5)


def test_next_and_previous_stay_in_the_quad_and_undo_each_other():
    halfedges = np.arange(12)
    np.testing.assert_array_equal(next_in_quad(previous_in_quad(halfedges)), halfedges)
    assert next_in_quad(halfedges)[4:8].tolist() == [5, 6, 7, 4]


def test_valence_counts_quads(grid):
    assert grid(2, 2).valence.tolist() == [1, 2, 1, 2, 4, 2, 1, 2, 1]


def test_valence_of_singular_and_unused_vertices(sectors):
    mesh = sectors(5, 2)
    widened = gs.QuadMesh(np.vstack([mesh.vertices, [0.0, 0.0, 9.0]]), mesh.quads)
    assert (widened.valence[0], widened.valence[-1]) == (5, 0)


def test_on_boundary_marks_the_rim_only(grid):
    mask = grid(3, 4).on_boundary.reshape(4, 5)
    assert not mask[1:-1, 1:-1].any()
    assert mask.sum() == 2 * (3 + 4)


# ---- fans -----------------------------------------------------------------------------------


def turns(mesh, vertex):
    """Angles from each spoke to the next, radians in (-pi, pi]."""
    fan = mesh.fans[vertex]
    ends = mesh.vertices[mesh.target[fan[fan >= 0]]] - mesh.vertices[vertex]
    heading = np.arctan2(ends[:, 1], ends[:, 0])
    return np.angle(np.exp(1j * np.diff(heading)))


@pytest.mark.parametrize("valence", [3, 4, 6])
def test_fans_turn_counter_clockwise(sectors, valence):
    mesh = sectors(valence)
    used = [v for v in range(len(mesh.vertices)) if mesh.valence[v] > 1]
    assert all((turns(mesh, v) > 0.0).all() for v in used)


def test_a_closed_fan_holds_every_quad_around_its_vertex(monkey_saddle):
    fan = monkey_saddle.fans[0]
    assert sorted(fan // 4) == np.flatnonzero((monkey_saddle.quads == 0).any(axis=1)).tolist()


def test_every_spoke_of_a_fan_leaves_its_vertex(monkey_saddle):
    fans = monkey_saddle.fans
    owner = np.repeat(np.arange(len(fans)), (fans >= 0).sum(axis=1))
    np.testing.assert_array_equal(monkey_saddle.origin[fans[fans >= 0]], owner)


def test_an_open_fan_starts_on_the_boundary(l_shape):
    mesh = l_shape(2)
    rim = np.flatnonzero(mesh.on_boundary)
    assert (mesh.twin[mesh.fans[rim, 0]] < 0).all()


def test_the_next_spoke_past_the_boundary_is_minus_one(grid):
    mesh = grid(2, 2)
    assert mesh.next_spoke(mesh.fans[0, :1]).tolist() == [-1]


def test_past_the_end_of_a_fan_there_is_no_spoke(torus):
    assert torus(6, 6).next_spoke(np.array([-1])).tolist() == [-1]


def test_a_closed_fan_starts_with_its_smallest_half_edge(grid):
    mesh = grid(2, 2)
    assert mesh.fans[4, 0] == np.flatnonzero(mesh.origin == 4).min()


def test_an_unused_vertex_has_no_fan():
    mesh = gs.QuadMesh(np.vstack([SQUARE, SQUARE[:1]]), [[0, 1, 2, 3]])
    assert mesh.fans[4].tolist() == [-1]
    assert mesh.first_spoke[4] == -1


# ---- boundary -------------------------------------------------------------------------------


def signed_area(mesh, loop):
    x, y, _ = mesh.vertices[loop].T
    return float(np.sum(x * np.roll(y, -1) - y * np.roll(x, -1)) / 2.0)


def test_the_boundary_of_a_grid_is_one_loop_with_the_surface_on_its_left(grid):
    mesh = grid(3, 5)
    (loop,) = mesh.boundary_loops
    assert len(loop) == 16
    assert signed_area(mesh, loop) == 15.0


def test_the_hole_of_a_ring_is_a_loop_the_other_way_round(annulus):
    mesh = annulus(8)
    inner, outer = mesh.boundary_loops
    assert signed_area(mesh, inner) < 0.0 < signed_area(mesh, outer)


def test_a_loop_starts_with_its_smallest_vertex(annulus):
    assert all(loop[0] == loop.min() for loop in annulus(6).boundary_loops)


def test_a_closed_mesh_has_no_boundary(torus):
    assert torus(6, 6).boundary_loops == ()


# ---- measures and immutability --------------------------------------------------------------


def test_edge_lengths_follow_the_order_of_the_edges():
    mesh = gs.QuadMesh(SQUARE * [3.0, 2.0, 1.0], [[0, 1, 2, 3]])
    assert mesh.edges.tolist() == [[0, 1], [0, 3], [1, 2], [2, 3]]
    assert mesh.edge_lengths.tolist() == [3.0, 2.0, 2.0, 3.0]
    assert mesh.mean_edge == 2.5


def test_moved_keeps_the_quads_and_leaves_the_original_alone(grid):
    mesh = grid(2, 2)
    other = mesh.moved(2.0 * mesh.vertices)
    np.testing.assert_array_equal(other.quads, mesh.quads)
    assert (mesh.mean_edge, other.mean_edge) == (1.0, 2.0)


def test_the_arrays_are_read_only_copies():
    vertices, quads = SQUARE.copy(), np.array([[0, 1, 2, 3]])
    mesh = gs.QuadMesh(vertices, quads)
    vertices[0], quads[0] = 7.0, 0
    np.testing.assert_array_equal(mesh.vertices, SQUARE)
    assert not any(a.flags.writeable for a in (mesh.vertices, mesh.quads, mesh.twin, mesh.edges))


def test_a_position_reads_as_coordinates_in_mm():
    assert position(np.array([1.0, -2.5, 1234567.0])) == "(1, -2.5, 1.23457e+06) mm"


# ---- what is refused ------------------------------------------------------------------------


@pytest.mark.parametrize("build", BUILDERS)
@pytest.mark.parametrize("shape", [(4, 2), (12,), (2, 2, 3), (0,)])
def test_vertices_of_another_shape_are_refused(build, shape):
    error = raised(gs.MeshError, build, np.zeros(shape), [[0, 1, 2, 3]])
    assert error.value == str(shape)
    assert "(n, 3)" in error.what


@pytest.mark.parametrize("build", BUILDERS)
@pytest.mark.parametrize("shape", [(1, 3), (4,), (0, 4), (1, 5), (0,)])
def test_quads_of_another_shape_are_refused(build, shape):
    error = raised(gs.MeshError, build, SQUARE, np.zeros(shape, dtype=int))
    assert error.value == str(shape)
    assert "(f, 4)" in error.what


@pytest.mark.parametrize("build", BUILDERS)
@pytest.mark.parametrize("bad", [np.nan, np.inf, -np.inf])
def test_a_coordinate_that_is_not_finite_is_refused_by_its_vertex(build, bad):
    vertices = SQUARE.copy()
    vertices[2, 1] = bad
    assert raised(gs.MeshError, build, vertices, [[0, 1, 2, 3]]).where == "vertex 2"


@pytest.mark.parametrize("build", BUILDERS)
@pytest.mark.parametrize("index", [-1, 6])
def test_an_index_out_of_range_is_refused_by_its_quad(grid, build, index):
    vertices = grid(1, 2).vertices
    error = raised(gs.MeshError, build, vertices, [[0, 3, 4, 1], [1, 4, 5, index]])
    assert (error.where, error.limit) == ("quad 1", "0 .. 5")
    assert str(index) in error.value


@pytest.mark.parametrize("build", BUILDERS)
def test_a_repeated_corner_is_refused_by_its_quad_and_position(grid, build):
    vertices = grid(1, 2).vertices
    error = raised(gs.MeshError, build, vertices, [[0, 3, 4, 1], [1, 4, 5, 4]])
    assert error.where == "quad 1 (0.75, 1.25, 0) mm"
    assert error.value == "[1, 4, 5, 4]"


@pytest.mark.parametrize("build", BUILDERS)
def test_an_edge_of_three_quads_is_refused_by_its_ends_position_and_quads(build):
    wings = [[0, 1, 0], [2, 1, 0], [0, -1, 0], [2, -1, 0], [0, 0, 1], [2, 0, 1]]
    vertices = np.array([[0, 0, 0], [2, 0, 0], *wings], dtype=float)
    quads = [[0, 1, 3, 2], [1, 0, 4, 5], [0, 1, 7, 6]]
    error = raised(gs.NonManifoldError, build, vertices, quads)
    assert error.where == "edge 0-1 (1, 0, 0) mm, quads [0, 1, 2]"
    assert error.value == "3 quads"


@pytest.mark.parametrize("build", BUILDERS)
def test_two_fans_in_one_vertex_are_refused_by_the_vertex_and_its_position(grid, build):
    mesh = grid(2, 2)
    error = raised(gs.NonManifoldError, build, mesh.vertices, mesh.quads[[0, 3]])
    assert error.where == "vertex 4 (1, 1, 0) mm"
    assert error.value.startswith("2 quads")


def test_a_closed_fan_and_another_one_in_the_same_vertex_are_refused(cube):
    vertices = np.vstack([cube.vertices, -cube.vertices[1:]])
    second = np.where(cube.quads == 0, 0, cube.quads + 7)
    error = raised(gs.NonManifoldError, gs.QuadMesh, vertices, np.vstack([cube.quads, second]))
    assert error.where == "vertex 0 (0, 0, 0) mm"


def test_opposite_orientations_are_refused_by_both_quads_and_the_position(grid):
    mesh = grid(1, 3)
    quads = mesh.quads.copy()
    quads[2] = quads[2, ::-1]
    error = raised(gs.OrientationError, gs.QuadMesh, mesh.vertices, quads)
    assert error.where == "quads 1 and 2 (0.5, 1.5, 0) mm"
    assert "oriented" in error.advice


# ---- oriented -------------------------------------------------------------------------------


@st.composite
def shuffled_quads(draw, count):
    """Which quads to turn over, and the first corner of each."""
    flips = draw(st.lists(st.booleans(), min_size=count, max_size=count))
    rolls = draw(st.lists(st.integers(0, 3), min_size=count, max_size=count))
    return np.array(flips), rolls


def shuffled(quads, flips, rolls):
    turned = [q[::-1] if flip else q for q, flip in zip(quads, flips, strict=True)]
    return np.array([np.roll(q, roll) for q, roll in zip(turned, rolls, strict=True)])


@given(data=st.data(), rows=st.integers(1, 4), columns=st.integers(1, 4))
def test_oriented_turns_every_quad_of_a_grid_like_the_first(grid, data, rows, columns):
    mesh = grid(rows, columns)
    flips, rolls = data.draw(shuffled_quads(len(mesh.quads)))
    mended = gs.oriented(mesh.vertices, shuffled(mesh.quads, flips, rolls))
    assert (normals_up(mended) == (not flips[0])).all()


@given(data=st.data())
def test_oriented_mends_a_closed_surface(cube, data):
    flips, rolls = data.draw(shuffled_quads(6))
    mended = gs.oriented(cube.vertices, shuffled(cube.quads, flips, rolls))
    corners = mended.vertices[mended.quads]
    normals = np.cross(corners[:, 2] - corners[:, 0], corners[:, 3] - corners[:, 1])
    outward = np.einsum("fc,fc->f", normals, corners.mean(axis=1) - 0.5)
    assert len(set(np.sign(outward))) == 1


@given(data=st.data())
def test_oriented_keeps_the_order_and_the_corners_of_the_quads(annulus, data):
    mesh = annulus(5, 2)
    given_quads = shuffled(mesh.quads, *data.draw(shuffled_quads(10)))
    mended = gs.oriented(mesh.vertices, given_quads)
    np.testing.assert_array_equal(np.sort(mended.quads, axis=1), np.sort(mesh.quads, axis=1))


def test_oriented_keeps_the_first_quad_of_every_component(grid):
    mesh = grid(1, 2)
    vertices = np.vstack([mesh.vertices, mesh.vertices + np.array([0.0, 9.0, 0.0])])
    quads = np.vstack([mesh.quads, mesh.quads[:, ::-1] + 6])
    np.testing.assert_array_equal(gs.oriented(vertices, quads).quads, quads)


def test_oriented_does_not_touch_its_input(grid):
    mesh = grid(1, 2)
    quads = mesh.quads.copy()
    quads[1] = quads[1, ::-1]
    before = quads.copy()
    gs.oriented(mesh.vertices, quads)
    np.testing.assert_array_equal(quads, before)


def test_a_moebius_strip_cannot_be_oriented_and_a_quad_of_it_is_named(moebius):
    vertices, quads = moebius
    error = raised(gs.OrientationError, gs.oriented, vertices, quads)
    number = int(error.where.split()[1])
    assert error.where == f"quad {number} {position(vertices[quads[number]].mean(axis=0))}"
    assert error.limit == "a two-sided surface"


def test_a_moebius_strip_is_no_quad_mesh_either(moebius):
    raised(gs.OrientationError, gs.QuadMesh, *moebius)


def test_fractional_indices_are_refused():
    vertices = np.array([[0.0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]])
    with pytest.raises(gs.MeshError, match="whole numbers"):
        gs.QuadMesh(vertices, np.array([[0.0, 1.0, 2.7, 3.0]]))
