import numpy as np
import pytest

import gridshell as gs
from gridshell.pose import pose


@pytest.fixture
def posed(enneper):
    return pose(enneper(10), gs.Free())


def residual(term, posed):
    return term.constraint.evaluate(posed.start, None).residual


def test_edge_lengths_are_given_in_mm_and_measured_at_unit_mean_edge(posed):
    edges = posed.net.mesh.edges[:5]
    lengths = posed.net.mesh.edge_lengths[:5]
    found = residual(gs.EdgeLengths(edges, lengths - 10.0).term(posed), posed)
    np.testing.assert_allclose(found[:, 0], 10.0 / posed.scale, rtol=1e-9)


def test_prescribed_lengths_are_reached_with_the_net(enneper):
    control = enneper(10)
    row = np.stack([np.arange(0, 5), np.arange(1, 6)], axis=1)
    wanted = np.full(5, 0.9 * control.mesh.mean_edge)
    recipe = gs.a_net(angle=np.radians(80.0), conditions=(gs.EdgeLengths(row, wanted),))
    found = gs.optimize(control, recipe, anchor=gs.Free()).require()
    a, b = found.control.vertices[row.T]
    np.testing.assert_allclose(np.linalg.norm(a - b, axis=1), wanted, rtol=1e-7)
    assert found.quality.angle_error_deg.max < 1e-5


def test_each_pair_needs_a_length():
    with pytest.raises(gs.SettingError, match="needs a length") as info:
        gs.EdgeLengths([[0, 1], [1, 2]], [1.0])
    assert (info.value.value, info.value.limit) == ("shape (1,)", "(2,)")


@pytest.mark.parametrize("length", [0.0, -3.0, np.nan])
def test_a_length_must_be_positive(length):
    with pytest.raises(gs.SettingError, match="positive") as info:
        gs.EdgeLengths([[0, 1], [1, 2]], [1.0, length])
    assert info.value.where == "lengths 1"


def test_a_vertex_that_does_not_exist_is_refused(posed):
    with pytest.raises(gs.SettingError, match="does not exist") as info:
        gs.EdgeLengths([[0, 10**6]], [1.0]).term(posed)
    assert (info.value.where, info.value.value) == ("edges", "1000000")


def test_a_symmetric_mesh_finds_its_pairs(posed):
    """Enneper's surface is mirrored by the plane x = 0 (and y = 0)."""
    for normal in ([2.0, 0.0, 0.0], [0.0, 1.0, 0.0]):
        term = gs.MirrorPlane([0.0, 0.0, 0.0], normal).term(posed)
        pairs = term.constraint.pairs
        assert np.unique(pairs).tolist() == list(range(len(posed.net.vertices)))
        assert np.abs(residual(term, posed)).max() < 1e-12


def test_a_noisy_start_ends_symmetric(enneper):
    start = enneper(10)
    noise = np.random.default_rng(1).normal(size=start.vertices.shape) * 0.03
    noisy = start.moved(start.vertices + noise * start.mesh.mean_edge)
    plane = gs.MirrorPlane([0.0, 0.0, 0.0], [1.0, 0.0, 0.0])
    recipe = gs.a_net(angle=np.radians(90.0), keep_shape=False, conditions=(plane,))
    found = gs.optimize(noisy, recipe, anchor=gs.Free()).require()
    pairs = plane.term(pose(found.control, gs.Free())).constraint.pairs
    a, b = found.control.vertices[pairs.T]
    np.testing.assert_allclose(a * [-1.0, 1.0, 1.0], b, atol=1e-6 * start.mesh.mean_edge)


def test_a_vertex_without_a_mirror_image_is_named(posed):
    with pytest.raises(gs.SettingError, match="no mirror image") as info:
        gs.MirrorPlane([5000.0, 0.0, 0.0], [1.0, 0.0, 0.0]).term(posed)
    assert info.value.where.startswith("vertex 0 (")
    assert info.value.value.endswith("mm to the nearest vertex")


def test_a_normal_needs_a_direction():
    with pytest.raises(gs.SettingError, match="direction"):
        gs.MirrorPlane([0.0, 0.0, 0.0], [0.0, 0.0, 0.0])


# ---- a flat rim -------------------------------------------------------------------------------


def ragged(control):
    """The control mesh without one corner of its rectangle: a node there has three quads."""
    centre = control.vertices[control.quads].mean(axis=1)
    low, high = centre.min(axis=0), centre.max(axis=0)
    kept = (centre[:, :2] < high[:2] - 0.4 * (high - low)[:2]).any(axis=1)
    return gs.as_control_mesh(gs.QuadMesh(control.vertices, control.quads[kept]))


def test_plates_are_flat_at_a_ragged_rim_too():
    patch = gs.ConjugatePatch(u=(-0.5, 0.4), v=(-0.35, 0.5), panels=(6, 6))
    control = ragged(gs.control_patch(gs.Enneper(5000.0), patch))
    off = []
    for conditions in ((), (gs.FlatRim(),)):
        recipe = gs.pq_net(angle=np.pi / 2.0, conditions=conditions)
        found = gs.optimize(control, recipe, anchor=gs.Free()).require()
        mesh = gs.skin(found.control, gs.Skin.D1)
        i, j = mesh.edges.T
        run = (mesh.vertices[j] - mesh.vertices[i]) / mesh.edge_lengths[:, None]
        volume = np.einsum("mc,mc->m", run, np.cross(mesh.axes[i], mesh.axes[j]))
        off.append(np.abs(volume).max())
    assert off[0] > 1e-7
    assert off[1] < 1e-9


def test_a_rim_without_such_a_node_has_nothing_to_flatten(posed):
    assert len(residual(gs.FlatRim().term(posed), posed)) == 0


def test_bounds_hold_and_leave_angles_free_between_them(enneper):
    low, high = np.radians((86.0, 89.0))
    recipe = gs.a_net(conditions=(gs.AngleBetween(low, high),))
    control = enneper(14)
    before = gs.node_angles(control)
    assert before.max() > high
    found = gs.optimize(control, recipe, anchor=gs.Free()).require()
    angles = gs.node_angles(found.control)
    assert angles.min() > low - 1e-8
    assert angles.max() < high + 1e-8
    assert found.quality.star_planarity.max < 1e-8


def test_a_net_within_its_bounds_is_left_alone(enneper):
    exact = gs.optimize(enneper(10), gs.a_net(), anchor=gs.Free()).require().control
    bounds = gs.AngleBetween(*np.radians((60.0, 120.0)))
    found = gs.optimize(exact, gs.a_net(conditions=(bounds,)), anchor=gs.Free()).require()
    assert np.abs(found.control.vertices - exact.vertices).max() < 1e-6 * exact.mesh.mean_edge


@pytest.mark.parametrize("bounds", [(90.0, 60.0), (0.0, 90.0), (60.0, 180.0), (np.nan, 90.0)])
def test_bounds_that_leave_nothing_are_refused(bounds):
    with pytest.raises(gs.SettingError, match="nothing between") as info:
        gs.AngleBetween(*np.radians(bounds))
    assert info.value.where == "angle_between"


def test_near_rhombi_bring_diagonals_closer_without_giving_up_the_net(enneper):
    control = enneper(14)
    errors = []
    for conditions in ((), (gs.NearRhombi(),)):
        recipe = gs.a_net(angle=np.radians(70.0), conditions=conditions)
        found = gs.optimize(control, recipe, anchor=gs.Free()).require()
        assert found.quality.angle_error_deg.max < 1e-5
        errors.append(gs.net_quality(found.control, rhombus=True).rhombus_error.mean)
    assert errors[1] < 0.9 * errors[0]
