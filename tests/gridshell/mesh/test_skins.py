from math import radians

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

import gridshell as gs
from gridshell.mesh import grid_quads

RADIUS, TURN = 5000.0, 0.06


def translation(first, second, rows=12, columns=10):
    """C over a net that is swept along itself: every white quad is a parallelogram."""
    s, t = np.meshgrid(np.arange(rows + 1.0), np.arange(columns + 1.0), indexing="ij")
    points = (first(s) + second(t)).reshape(-1, 3)
    return gs.control_mesh(gs.QuadMesh(points, grid_quads(rows, columns)))


def cylinder():
    def arc(s):
        turn = TURN * (s - 6.0)
        return RADIUS * np.stack([np.sin(turn), 0.0 * s, np.cos(turn)], axis=-1)

    return translation(arc, lambda t: np.stack([0.0 * t, 400.0 * t, 0.0 * t], axis=-1))


def paraboloid():
    """z = (x^2 + y^2) / (2 R): the D2 face around (x, y) is exactly the tangent direction."""

    def along(s):
        x = 300.0 * (s - 6.0)
        return np.stack([x, 0.0 * s, x**2 / (2.0 * RADIUS)], axis=-1)

    def across(t):
        y = 300.0 * (t - 5.0)
        return np.stack([0.0 * t, y, y**2 / (2.0 * RADIUS)], axis=-1)

    return translation(along, across)


@pytest.fixture(params=[gs.Skin.D1, gs.Skin.D2])
def diagonal(request):
    return request.param


def test_the_axes_of_a_cylinder_are_radial(diagonal):
    mesh = gs.skin(cylinder(), diagonal)
    radial = mesh.vertices * [1.0, 0.0, 1.0]
    whole = ~mesh.partial
    assert whole.sum() > 5
    expected = radial / np.linalg.norm(radial, axis=1)[:, None]
    np.testing.assert_allclose(mesh.axes[whole], expected[whole], atol=1e-12)


def test_the_axes_of_a_paraboloid_are_its_normals(diagonal):
    mesh = gs.skin(paraboloid(), diagonal)
    x, y, _ = mesh.vertices.T
    normal = np.stack([-x / RADIUS, -y / RADIUS, np.ones_like(x)], axis=1)
    normal /= np.linalg.norm(normal, axis=1)[:, None]
    whole = ~mesh.partial
    np.testing.assert_allclose(mesh.axes[whole], normal[whole], atol=1e-12)


def test_an_axis_is_the_normal_of_the_other_mesh_s_face_around_it():
    control = paraboloid()
    first, second = gs.skin(control, gs.Skin.D1), gs.skin(control, gs.Skin.D2)
    matched = 0
    for face, normal in enumerate(second.normals()):
        middle = second.corner_points(face).mean(axis=0)
        nearest = int(np.argmin(np.linalg.norm(first.vertices[:, :2] - middle[:2], axis=1)))
        if not first.partial[nearest]:
            np.testing.assert_allclose(first.axes[nearest], normal, atol=1e-12)
            matched += 1
    assert matched > 10


def test_the_panels_are_the_faces_of_the_diagonal_mesh(diagonal):
    control = paraboloid()
    net = gs.diagonal_meshes(control)[0 if diagonal is gs.Skin.D1 else 1]
    mesh = gs.skin(control, diagonal)
    assert len(mesh.faces) == len(net.faces)
    for face in range(len(mesh.faces)):
        np.testing.assert_array_equal(mesh.corner_points(face), net.vertices[net.faces[face]])


def test_the_pattern_has_black_parallelograms_and_white_halves():
    control = paraboloid()
    mesh = gs.skin(control, gs.Skin.PATTERN)
    assert mesh.black.sum() == len(control.quads)
    assert len(mesh.vertices) == len(control.mesh.edges)
    for face in np.flatnonzero(mesh.black):
        a, b, c, d = mesh.corner_points(face)
        np.testing.assert_allclose(a + c, b + d, atol=1e-9)
    inner = (mesh.edge_faces >= 0).all(axis=1)
    colours = mesh.black[mesh.edge_faces[inner]]
    assert (colours[:, 0] != colours[:, 1]).all()


def test_an_axis_of_the_pattern_bisects_those_of_its_edge():
    control = paraboloid()
    axes, _ = gs.node_axes(control)
    mesh = gs.skin(control, gs.Skin.PATTERN)
    a, b = control.mesh.edges.T
    cosines = [np.einsum("nc,nc->n", mesh.axes, axes[end]) for end in (a, b)]
    np.testing.assert_allclose(cosines[0], cosines[1], atol=1e-12)
    across = np.einsum("nc,nc->n", mesh.axes, np.cross(axes[a], axes[b]))
    np.testing.assert_allclose(across, 0.0, atol=1e-12)


def test_axes_at_the_rim_stay_perpendicular_to_the_diagonals_that_cross_there():
    control = paraboloid()
    axes, partial = gs.node_axes(control)
    mesh = control.mesh
    assert partial.sum() == mesh.on_boundary.sum()
    for v in np.flatnonzero(partial & (mesh.valence < 3)):
        for h in mesh.fans[v][mesh.fans[v] >= 0]:
            quad, k = mesh.quads[h // 4], h % 4
            crossing = mesh.vertices[quad[(k + 3) % 4]] - mesh.vertices[quad[(k + 1) % 4]]
            assert abs(axes[v] @ crossing) < 1e-9 * np.linalg.norm(crossing)


def test_axes_lie_on_the_counter_clockwise_side_and_turn_with_the_net():
    control = paraboloid()
    turn = Rotation.from_rotvec([0.3, -1.1, 0.7])
    axes, _ = gs.node_axes(control)
    assert (axes[:, 2] > 0.5).all()
    moved = turn.apply(np.array(control.vertices)) + np.array([1e3, 2e3, -5e2])
    turned, _ = gs.node_axes(control.moved(moved))
    np.testing.assert_allclose(turned, turn.apply(axes), atol=1e-10)


def test_the_panel_around_a_vertex_of_six_has_six_corners(monkey_saddle):
    control = gs.as_control_mesh(monkey_saddle.moved(1000.0 * monkey_saddle.vertices))
    own = control.colour[0]
    mesh = gs.skin(control, gs.Skin.D2 if own == 0 else gs.Skin.D1)
    assert sorted(set(mesh.corners.tolist())) == [4, 6]
    assert np.count_nonzero(mesh.corners == 6) == 1
    inner = gs.skin(control, gs.Skin.D1 if own == 0 else gs.Skin.D2)
    centre = int(np.argmin(np.linalg.norm(inner.vertices, axis=1)))
    assert abs(inner.axes[centre, 2]) > 1.0 - 1e-9


@pytest.mark.parametrize("which", list(gs.Skin))
def test_a_mesh_too_small_for_a_panel_is_refused(grid, which):
    control = gs.as_control_mesh(grid(1, 1))
    if which is gs.Skin.PATTERN:
        assert len(gs.skin(control, which).faces) == 1
    else:
        with pytest.raises(gs.MeshError, match="too small"):
            gs.skin(control, which)


def test_a_mesh_without_families_is_refused(cube):
    with pytest.raises(gs.MeshError, match="families"):
        gs.skin(gs.without_families(cube), gs.Skin.D1)


def test_an_optimised_net_has_flat_panels_on_every_skin():
    control = paraboloid()
    found = gs.optimize(control, gs.pq_net(angle=radians(90)), anchor=gs.Free()).require()
    for which in gs.Skin:
        mesh = gs.skin(found.control, which)
        normals = mesh.normals()
        for face in range(len(mesh.faces)):
            corners = mesh.corner_points(face)
            offset = (corners - corners.mean(axis=0)) @ normals[face]
            assert np.abs(offset).max() < 1e-5
