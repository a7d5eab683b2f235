import numpy as np
import pytest

import gridshell as gs
from gridshell.angles import edge_crossings


def test_every_second_line_is_kept(grid):
    control = gs.as_control_mesh(grid(6, 8))
    level = gs.coarser(control)
    assert len(level.control.quads) == 12
    i, j = np.divmod(level.vertices, 9)
    assert set(i) == {0, 2, 4, 6}
    assert set(j) == {0, 2, 4, 6, 8}
    np.testing.assert_array_equal(level.control.vertices, control.vertices[level.vertices])


def test_a_coarse_diagonal_runs_along_the_fine_ones_of_its_family(enneper):
    control = enneper(16)
    level = gs.coarser(control)
    corners = level.control.vertices[level.control.quads]
    middle = control.vertices[level.centres]
    fine = {frozenset(q[[0, 2]].tolist()) for q in control.quads}
    pairs = np.stack([level.vertices[level.control.quads[:, 0]], level.centres], axis=1)
    assert all(frozenset(pair) in fine for pair in pairs.tolist())
    assert (
        np.linalg.norm(corners.mean(axis=1) - middle, axis=1).max()
        < 0.1 * level.control.mesh.mean_edge
    )


@pytest.mark.parametrize("size", [(5, 6), (7, 7)])
def test_odd_numbers_of_quads_cannot_be_halved(grid, size):
    assert gs.coarser(gs.as_control_mesh(grid(*size))) is None


def test_a_singular_vertex_is_kept(sectors):
    level = gs.coarser(gs.as_control_mesh(sectors(6, 4)))
    assert 0 in level.vertices
    assert len(level.control.quads) == 24
    assert gs.coarser(gs.as_control_mesh(sectors(6, 3))) is None


def test_a_ring_stays_a_ring(annulus):
    level = gs.coarser(gs.as_control_mesh(annulus(16, 4)))
    assert level.control.mesh.euler_characteristic == 0
    assert len(level.control.quads) == 16


@pytest.mark.parametrize("cells", [6, 9])
def test_a_finer_net_keeps_its_vertices_and_families(enneper, cells):
    control = enneper(cells)
    fine = gs.finer(control)
    n = len(control.vertices)
    assert len(fine.quads) == 4 * len(control.quads)
    np.testing.assert_allclose(fine.vertices[:n], control.vertices, atol=1e-9)
    level = gs.coarser(fine)
    assert len(level.control.quads) == len(control.quads)
    coarse, finer = np.median(gs.node_angles(control)), np.median(gs.node_angles(fine))
    assert finer == pytest.approx(coarse, abs=0.02)


def test_new_vertices_lie_on_the_surface_far_better_than_midpoints(enneper):
    surface, control = gs.Enneper(4000.0), enneper(10)
    fine = gs.finer(control)
    a, b = control.vertices[control.mesh.edges.T]
    n = len(control.vertices)
    inner = np.arange(n, n + len(a))[~fine.mesh.on_boundary[n : n + len(a)]]

    def away(points):
        return np.linalg.norm(surface.closest(points).points - points, axis=1).mean()

    assert away(fine.vertices[inner]) < 0.35 * away(((a + b) / 2.0)[inner - n])


def test_families_of_a_finer_net_cross_at_the_same_angle(grid):
    mesh = grid(4, 4)
    x, y, z = mesh.vertices.T
    control = gs.as_control_mesh(mesh.moved(np.stack([x + 0.3 * y, y, z], axis=1)))
    np.testing.assert_allclose(gs.node_angles(gs.finer(control)), gs.node_angles(control)[0])
    assert len(edge_crossings(gs.finer(control))) == 49


@pytest.fixture(scope="module")
def both(enneper):
    """A net of 1,440 quads found directly and by way of 360."""
    heard = []
    recipe = gs.a_net(angle=np.radians(60.0))
    direct = gs.optimize(enneper(36), recipe, anchor=gs.Free())
    levels = gs.optimize_coarse_to_fine(
        enneper(36), recipe, anchor=gs.Free(), progress=lambda *step: heard.append(step)
    )
    return direct, levels, heard


def test_it_goes_by_way_of_a_coarser_net(both):
    _, levels, heard = both
    assert [quads for quads, number, _ in heard if number == 1] == [360, 1440]
    assert len(levels.steps) == sum(quads == 1440 for quads, _, _ in heard)


def test_both_ways_lead_to_exact_nets_of_one_size(both):
    direct, levels, _ = both
    for found in (direct, levels):
        assert found.converged
        assert found.quality.star_planarity.max < 1e-8
        assert found.quality.angle_error_deg.max < 1e-6
    assert levels.control.mesh.mean_edge == pytest.approx(direct.control.mesh.mean_edge, rel=0.15)
    np.testing.assert_array_equal(levels.control.quads, direct.control.quads)


@pytest.mark.parametrize(
    "anchor", [gs.BoundaryPinned(), gs.Pinned((0, 20, 40)), gs.BoundaryGlide()]
)
def test_what_is_held_on_the_fine_net_stays(enneper, anchor):
    control = enneper(36)
    recipe = gs.a_net(angle=np.radians(88.0), steps=3)
    found = gs.optimize_coarse_to_fine(control, recipe, anchor=anchor)
    held = anchor.hold(control, control.vertices).vertices
    assert len(held)
    np.testing.assert_allclose(
        found.control.vertices[held], control.vertices[held], rtol=0.0, atol=1e-7
    )


def test_a_field_of_angles_is_met_where_the_net_ends(enneper):
    control = enneper(36)
    field = gs.RadialAngle((0.0, 0.0, 0.0), (0.0, 6000.0), (1.5, 1.3))
    found = gs.optimize_coarse_to_fine(control, gs.a_net(angle=field), anchor=gs.Free())
    assert found.converged
    wanted = field(found.control.vertices[control.quads].mean(axis=1))
    np.testing.assert_allclose(gs.node_angles(found.control), wanted, atol=1e-7)


def test_an_angle_between_edges_is_carried_to_the_coarse_crossings(grid):
    mesh = grid(40, 40, lambda x, y: (x - 20.0) * (y - 20.0) / 60.0)
    control = gs.as_control_mesh(mesh)
    recipe = gs.a_net(planarity=gs.Planarity.EDGE_STARS, angle=np.radians(85.0))
    heard = []
    found = gs.optimize_coarse_to_fine(
        control, recipe, anchor=gs.Free(), progress=lambda *step: heard.append(step)
    )
    assert found.converged
    assert {quads for quads, _, _ in heard} == {400, 1600}
