import numpy as np
import pytest
from scipy.spatial.transform import Rotation

import gridshell as gs
from gridshell.anchors import boundary_runs
from gridshell.constraints import second_differences, smooth_curve
from gridshell.mesh import grid_quads
from gridshell.quality import star_planarity
from gridshell.solve import Stop, Weight


def deviation(found, expected):
    """Largest distance between vertices over the mean edge."""
    return np.abs(found.vertices - expected.vertices).max() / expected.mesh.mean_edge


def noisy(control, inside_only=False):
    """Vertices moved by about 5 % of an edge."""
    moves = np.random.default_rng(1).normal(size=control.vertices.shape)
    if inside_only:
        moves[control.mesh.on_boundary] = 0.0
    return control.moved(control.vertices + 0.05 * control.mesh.mean_edge * moves)


# ---- nets of a constant angle ---------------------------------------------------------------


@pytest.fixture(scope="module", params=[60.0, 75.0, 90.0])
def net(request, enneper):
    """The paper-sized control mesh at a node angle, and the angle in degrees."""
    recipe = gs.a_net(angle=np.radians(request.param))
    return gs.optimize(enneper(36), recipe, anchor=gs.Free()), request.param


def test_the_net_converges_in_thirty_steps(net):
    assert net[0].converged
    assert len(net[0].steps) <= 30


def test_its_stars_are_planar(net):
    assert net[0].quality.star_planarity.max < 1e-5


def test_its_nodes_have_the_angle(net):
    assert net[0].quality.angle_error_deg.max < 0.01


def test_its_edges_keep_their_proportions(net):
    shortest, longest = net[0].quality.edge_ratio
    assert shortest > 0.5
    assert longest < 2.0


def test_its_curvatures_have_the_ratio_the_angle_asks_for(net):
    """kappa1 / kappa2 = -tan(angle / 2)^2, estimated from the mesh alone."""
    expected = -(np.tan(np.radians(net[1]) / 2.0) ** 2)
    assert net[0].quality.curvature_ratio == pytest.approx(expected, rel=0.02)


def test_it_neither_shrinks_nor_flattens(net, enneper):
    start = enneper(36)
    assert net[0].control.mesh.mean_edge == pytest.approx(start.mesh.mean_edge, rel=0.1)
    bend, bend_at_start = (
        np.median(np.abs(gs.principal_curvatures(c.mesh)[1])) for c in (net[0].control, start)
    )
    assert bend == pytest.approx(bend_at_start, rel=0.5)


def test_its_quality_is_that_of_its_mesh(net):
    assert net[0].quality == gs.net_quality(net[0].control, angle=np.radians(net[1]))


@pytest.mark.parametrize("cells", [10, 18])
@pytest.mark.parametrize("degrees", [60.0, 75.0, 90.0, 105.0, 120.0])
def test_coarser_nets_reach_their_angle_as_well(enneper, cells, degrees):
    recipe = gs.a_net(angle=np.radians(degrees))
    found = gs.optimize(enneper(cells), recipe, anchor=gs.Free()).require().quality
    assert found.star_planarity.max < 1e-5
    assert found.angle_error_deg.max < 0.01


def test_a_net_around_a_singular_vertex(monkey_saddle):
    control = gs.as_control_mesh(monkey_saddle)
    found = gs.optimize(control, gs.a_net(angle=np.radians(90.0)), anchor=gs.Free())
    assert found.converged
    planarity = star_planarity(found.control.vertices, gs.diagonal_stars(control.mesh))
    assert planarity.max() < 1e-7
    assert found.quality.angle_error_deg.max < 1e-5


# ---- what is a net already ------------------------------------------------------------------


@pytest.mark.parametrize(
    ("surface", "patch"),
    [
        (gs.Hypar(2000.0), gs.AsymptoticPatch((-1.0, 1.0), (-0.5, 0.8), (8, 9))),
        (gs.Hypar(2000.0), gs.BisectingPatch(u=(-0.8, 0.8), v=(-0.5, 0.5), cells=12)),
        (gs.Hyperboloid(2000.0, 1500.0), gs.BisectingPatch(v=(-0.6, 0.6), cells=24)),
        (gs.Helicoid(6000.0), gs.AsymptoticPatch((-1.0, 1.0), (-1.0, 1.0), (8, 9))),
        (gs.Helicoid(6000.0), gs.BisectingPatch(u=(-0.7, 0.7), v=(-0.5, 0.5), cells=10)),
    ],
)
def test_a_net_of_straight_or_screwed_lines_is_exact_and_takes_no_step(surface, patch):
    control = gs.control_patch(surface, patch)
    found = gs.optimize(control, gs.a_net(), anchor=gs.Free())
    assert found.converged
    assert found.steps == ()
    assert found.quality.star_planarity.max < 1e-12
    assert deviation(found.control, control) < 1e-12


def test_a_catenoid_is_only_almost_a_net_and_takes_some():
    control = gs.control_patch(gs.Catenoid(900.0), gs.BisectingPatch(v=(-0.6, 0.6), cells=24))
    found = gs.optimize(control, gs.a_net(), anchor=gs.Free())
    assert gs.net_quality(control).star_planarity.max > 1e-6
    assert found.converged
    assert found.quality.star_planarity.max < 1e-8


# ---- motions, size, mirror ------------------------------------------------------------------


@pytest.fixture(scope="module")
def at_75(enneper):
    """A start, the recipe and its net."""
    start, recipe = enneper(12), gs.a_net(angle=np.radians(75.0))
    return start, recipe, gs.optimize(start, recipe, anchor=gs.Free()).require().control


@pytest.mark.parametrize("scale", [1.0, 1000.0, 1e-3])
def test_the_result_moves_and_grows_with_the_input(at_75, scale):
    start, recipe, net = at_75
    rotation = Rotation.from_rotvec([0.3, -1.1, 0.7]).as_matrix()
    offset = np.array([1e6, -5e5, 3e5]) * min(scale, 1.0)

    def carried(control):
        return control.moved(scale * control.vertices @ rotation.T + offset)

    found = gs.optimize(carried(start), recipe, anchor=gs.Free())
    assert found.converged
    assert deviation(found.control, carried(net)) < 1e-6


MIRROR = np.array([1.0, 1.0, -1.0])


def test_a_mirrored_input_gives_the_mirrored_result(at_75):
    """The angle runs counter-clockwise from family 1 to family 2.

    A mirror turns the quads over, and reading their corners backwards from the last one swaps
    the families at the same time: both reversals cancel and the angle stays the same.
    """
    start, recipe, net = at_75
    mesh = gs.QuadMesh(start.vertices * MIRROR, start.quads[:, ::-1])
    found = gs.optimize(gs.as_control_mesh(mesh), recipe, anchor=gs.Free())
    assert deviation(found.control, net.moved(net.vertices * MIRROR)) < 1e-6


def test_a_mirrored_input_that_keeps_its_families_needs_the_supplementary_angle(at_75):
    """Corner 0 stays first: family 1 stays family 1, but the sense of rotation is reversed."""
    start, _, net = at_75
    mesh = gs.QuadMesh(start.vertices * MIRROR, start.quads[:, [0, 3, 2, 1]])
    recipe = gs.a_net(angle=np.radians(105.0))
    found = gs.optimize(gs.as_control_mesh(mesh), recipe, anchor=gs.Free())
    assert deviation(found.control, net.moved(net.vertices * MIRROR)) < 1e-6


def test_swapping_the_families_needs_the_supplementary_angle(at_75):
    start, _, net = at_75
    mesh = gs.QuadMesh(start.vertices, np.roll(start.quads, 1, axis=1))
    recipe = gs.a_net(angle=np.radians(105.0))
    found = gs.optimize(gs.as_control_mesh(mesh), recipe, anchor=gs.Free())
    assert deviation(found.control, net) < 1e-6


def test_renumbering_the_vertices_does_not_change_the_net(at_75):
    start, recipe, net = at_75
    order = np.random.default_rng(5).permutation(len(start.vertices))
    place = np.argsort(order)
    found = gs.optimize(
        gs.as_control_mesh(gs.QuadMesh(start.vertices[order], place[start.quads])),
        recipe,
        anchor=gs.Free(),
    )
    assert deviation(found.control.moved(found.control.vertices[place]), net) < 1e-6


# ---- anchors --------------------------------------------------------------------------------


@pytest.mark.parametrize("recipe", [gs.a_net(keep_shape=False), gs.paper_a_net()])
def test_a_pinned_boundary_stays_where_it_is(enneper, recipe):
    start = noisy(enneper(10))
    rim = start.mesh.on_boundary
    found = gs.optimize(start, recipe, anchor=gs.BoundaryPinned()).control
    np.testing.assert_allclose(found.vertices[rim], start.vertices[rim], rtol=0.0, atol=1e-9)
    assert np.abs(found.vertices - start.vertices)[~rim].max() > 1.0


def test_pinned_vertices_stay_where_they_are(enneper):
    start = enneper(10)
    pinned = (0, 17, 60)
    recipe = gs.a_net(angle=np.radians(80.0))
    found = gs.optimize(start, recipe, anchor=gs.Pinned(pinned)).control
    np.testing.assert_allclose(
        found.vertices[list(pinned)], start.vertices[list(pinned)], rtol=0.0, atol=1e-9
    )
    assert np.abs(found.vertices - start.vertices).max() > 1.0


def test_pinning_a_vertex_that_does_not_exist_is_refused(enneper):
    start = enneper(10)
    with pytest.raises(gs.SettingError, match="pinned vertex does not exist"):
        gs.optimize(start, gs.a_net(), anchor=gs.Pinned((len(start.vertices),)))


def test_with_every_vertex_pinned_nothing_moves_and_it_does_not_converge(enneper):
    start = noisy(enneper(10))
    every = gs.Pinned(tuple(range(len(start.vertices))))
    found = gs.optimize(start, gs.a_net(steps=2), anchor=every)
    assert not found.converged
    assert deviation(found.control, start) < 1e-14


@pytest.fixture(scope="module")
def glided(enneper):
    start = noisy(enneper(18), inside_only=True)
    return start, gs.optimize(start, gs.a_net(keep_shape=False), anchor=gs.BoundaryGlide())


def test_a_gliding_boundary_stays_on_its_curves(glided):
    start, found = glided
    assert found.converged
    for run in boundary_runs(start):
        curve = smooth_curve(start.vertices[run.vertices], closed=run.closed)
        points = found.control.vertices[run.vertices]
        feet, _ = curve.closest(points)
        distance = np.linalg.norm(points - feet, axis=1).max()
        assert distance < 1e-6 * start.mesh.mean_edge


def test_a_gliding_boundary_moves_along_them(glided):
    start, found = glided
    rim = start.mesh.on_boundary
    moved = np.linalg.norm(found.control.vertices - start.vertices, axis=1)[rim].max()
    assert moved > 0.01 * start.mesh.mean_edge


def test_the_corners_of_a_gliding_boundary_stay(glided):
    start, found = glided
    corner = start.mesh.valence == 1
    np.testing.assert_allclose(
        found.control.vertices[corner], start.vertices[corner], rtol=0.0, atol=1e-9
    )


def test_a_gliding_ring_may_turn_but_stays_on_its_circles():
    surface, patch = gs.Catenoid(900.0), gs.BisectingPatch(v=(-0.6, 0.6), cells=24)
    start = noisy(gs.control_patch(surface, patch), inside_only=True)
    found = gs.optimize(start, gs.a_net(keep_shape=False), anchor=gs.BoundaryGlide())
    assert found.converged
    before, after = (c.vertices[start.mesh.on_boundary] for c in (start, found.control))
    np.testing.assert_allclose(after[:, 2], before[:, 2], atol=1e-3)
    radius = [np.hypot(*c[:, :2].T) for c in (before, after)]
    np.testing.assert_allclose(radius[1], radius[0], rtol=1e-4)


# ---- noise and references -------------------------------------------------------------------


@pytest.fixture(scope="module")
def noisy_start(enneper):
    return noisy(enneper(14))


def roughness(control, smooth):
    """Root mean square of the second differences that *smooth* does not have."""
    triples = np.concatenate(
        [make(control.mesh).continuations() for make in (gs.diagonal_stars, gs.edge_stars)]
    )
    return np.sqrt(np.mean(second_differences(control.vertices - smooth.vertices, triples) ** 2))


def mean_distance(control):
    return gs.net_quality(control, reference=gs.Enneper(4000.0)).surface_distance_mm.mean


def test_a_noisy_start_is_smoothed(noisy_start, enneper):
    found = gs.optimize(noisy_start, gs.a_net(keep_shape=False), anchor=gs.Free())
    assert found.converged
    assert roughness(found.control, enneper(14)) < 0.2 * roughness(noisy_start, enneper(14))


def test_keeping_the_shape_keeps_the_noise(noisy_start, enneper):
    found = gs.optimize(noisy_start, gs.a_net(), anchor=gs.Free())
    assert roughness(found.control, enneper(14)) > 0.5 * roughness(noisy_start, enneper(14))


def test_a_reference_keeps_the_net_on_it(noisy_start):
    found = gs.optimize(
        noisy_start,
        gs.a_net(keep_shape=False),
        anchor=gs.Free(),
        reference=gs.Enneper(4000.0),
    )
    assert found.converged
    assert found.quality.surface_distance_mm.mean < 0.01 * mean_distance(noisy_start)


def test_a_reference_moves_with_the_mesh_far_from_the_origin():
    """A sphere cannot carry the net, but every vertex is drawn to it."""
    radius = 1e5
    u, v = np.meshgrid(np.linspace(0.0, 0.05, 7), np.linspace(0.0, 0.05, 7), indexing="ij")
    points = 1.001 * gs.Sphere(radius).point(u.ravel(), v.ravel())
    start = gs.as_control_mesh(gs.QuadMesh(points, grid_quads(6, 6)))
    recipe = gs.NetRecipe(proximity=Weight(10.0), stop=Stop(steps=3))
    found = gs.optimize(start, recipe, anchor=gs.Free(), reference=gs.Sphere(radius))
    assert found.quality.surface_distance_mm.mean < 1.0


# ---- the solver on a net --------------------------------------------------------------------


def test_at_constant_weights_the_energy_never_rises(noisy_start):
    recipe = gs.NetRecipe(angle=1.4, fairness=Weight(1e-3), stop=Stop(steps=15))
    found = gs.optimize(noisy_start, recipe, anchor=gs.Free())
    energy = [step.energy for step in found.steps]
    assert len(energy) == 15
    assert (np.diff(energy) <= 0.0).all()


def test_progress_hears_of_every_step(enneper):
    heard = []
    found = gs.optimize(
        enneper(10),
        gs.a_net(angle=np.radians(75.0)),
        anchor=gs.Free(),
        progress=lambda number, step: heard.append((number, step)),
    )
    assert heard == list(enumerate(found.steps, start=1))


def test_require_hands_a_converged_net_through(enneper):
    found = gs.optimize(enneper(10), gs.a_net(angle=np.radians(90.0)), anchor=gs.Free())
    assert found.require() is found
    assert found.status.startswith(f"Converged in {len(found.steps)} steps")


def test_require_refuses_another_one_with_its_status_and_advice(enneper):
    recipe = gs.a_net(angle=np.radians(60.0), steps=2)
    found = gs.optimize(enneper(10), recipe, anchor=gs.Free())
    assert not found.converged
    with pytest.raises(gs.SolveError, match="Not converged after 2 steps") as info:
        found.require()
    assert info.value.what == f"{found.status} {found.verdict.message}".rstrip(".")
    assert "allow more steps" in found.verdict.message
    assert "another angle" in info.value.advice


def test_the_start_is_not_changed(enneper):
    start = enneper(10)
    before = start.vertices.copy()
    gs.optimize(start, gs.a_net(angle=1.2), anchor=gs.Free())
    np.testing.assert_array_equal(start.vertices, before)


def test_labels_and_quads_are_kept(at_75):
    start, _, net = at_75
    np.testing.assert_array_equal(net.quads, start.quads)
    np.testing.assert_array_equal(net.colour, start.colour)


def test_an_unused_vertex_stays_where_it_is_and_does_not_matter(at_75):
    start, recipe, net = at_75
    stray = np.array([[9e4, -9e4, 9e4]])
    mesh = gs.QuadMesh(np.vstack([start.vertices, stray]), start.quads)
    found = gs.optimize(gs.as_control_mesh(mesh), recipe, anchor=gs.Free()).control
    np.testing.assert_allclose(found.vertices[-1:], stray, rtol=1e-12)
    assert deviation(net.moved(found.vertices[:-1]), net) < 1e-6


@pytest.mark.parametrize("size", [(1, 1), (1, 4), (2, 2), (2, 3)])
def test_a_mesh_of_a_few_quads_is_no_exception(grid, size):
    control = gs.as_control_mesh(grid(*size, lambda x, y: 0.2 * x * y))
    found = gs.optimize(control, gs.a_net(angle=np.radians(80.0)), anchor=gs.Free())
    assert found.end is gs.End.CONVERGED
    assert found.quality.angle_error_deg.max < 1e-5


# ---- the paper's own setting ----------------------------------------------------------------


@pytest.fixture(scope="module", params=[60.0, 75.0, 90.0])
def paper_and_default(request, enneper):
    angle, start = np.radians(request.param), enneper(24)
    recipes = gs.paper_a_net(angle=angle), gs.a_net(angle=angle)
    return start, *(gs.optimize(start, recipe, anchor=gs.Free()) for recipe in recipes)


def test_the_paper_takes_its_ten_steps_and_has_not_converged(paper_and_default):
    _, paper, _ = paper_and_default
    assert len(paper.steps) == 10
    assert not paper.converged
    assert paper.status.startswith("Not converged after 10 steps")
    assert "star planarity" in paper.status
    assert "node angle" in paper.status


def test_its_constant_fairness_flattens_the_net(paper_and_default):
    """The median curvature falls below two thirds; lowered fairness keeps it."""
    start, paper, default = paper_and_default

    def bend(control):
        return np.median(np.abs(gs.principal_curvatures(control.mesh)[1]))

    assert bend(paper.control) < 0.67 * bend(start)
    assert bend(default.control) > 0.8 * bend(start)


def test_its_constant_fairness_shrinks_the_net(paper_and_default):
    start, paper, default = paper_and_default
    assert paper.control.mesh.mean_edge < 0.9 * start.mesh.mean_edge
    assert default.control.mesh.mean_edge > 0.9 * start.mesh.mean_edge


def test_its_energy_falls_all_the_same(paper_and_default):
    """Falling energies are no proof of a net: quality is."""
    _, paper, _ = paper_and_default
    assert paper.steps[-1].energy < 0.5 * paper.steps[0].energy


def test_a_mesh_whose_vertices_coincide_is_refused():
    control = gs.as_control_mesh(gs.QuadMesh(np.zeros((4, 3)), np.array([[0, 1, 2, 3]])))
    with pytest.raises(gs.MeshError, match="coincide"):
        gs.optimize(control, gs.a_net(), anchor=gs.Free())


# ---- other nets than the asymptotic one on diagonals ----------------------------------------


def quads_over(height, m=14, n=16, size=1000.0):
    x, y = np.meshgrid(np.linspace(-1, 1, m + 1), np.linspace(-1, 1, n + 1), indexing="ij")
    points = np.stack([x, y * n / m, height(x, y)], axis=-1).reshape(-1, 3)
    return gs.as_control_mesh(gs.QuadMesh(size * points, grid_quads(m, n)))


TRANSLATION = quads_over(lambda x, y: 0.3 * np.sin(2.0 * x) + 0.35 * np.cos(1.7 * y))
DOME = quads_over(lambda x, y: -0.35 * x**2 - 0.25 * y**2 + 0.05 * x * y**2)


def test_a_noisy_translation_surface_gets_planar_faces():
    recipe = gs.pq_net(planarity=gs.Planarity.FACES, keep_shape=False)
    found = gs.optimize(noisy(TRANSLATION), recipe, anchor=gs.Free()).require()
    assert found.quality.face_planarity.max < 1e-8
    assert found.quality.star_planarity is None
    assert deviation(found.control, TRANSLATION) < 0.5


def of_revolution(surface):
    u, v = np.meshgrid(np.linspace(0.0, 2.0, 13), np.linspace(-0.6, 0.6, 9), indexing="ij")
    mesh = gs.QuadMesh(surface.point(u.ravel(), v.ravel()), grid_quads(12, 8))
    return gs.as_control_mesh(mesh)


@pytest.mark.parametrize(
    "control",
    [TRANSLATION, of_revolution(gs.Sphere(900.0)), of_revolution(gs.Torus(3000.0, 800.0))],
    ids=["translation surface", "sphere", "torus"],
)
def test_translation_surfaces_and_lines_of_latitude_are_exact_and_take_no_step(control):
    recipe = gs.pq_net(planarity=gs.Planarity.FACES)
    found = gs.optimize(control, recipe, anchor=gs.Free())
    assert found.converged
    assert found.steps == ()
    assert found.quality.face_planarity.max < 1e-13


@pytest.mark.parametrize(
    ("surface", "patch"),
    [
        (gs.Scherk(2000.0), gs.BisectingPatch(u=(-0.5, 0.5), v=(-0.5, 0.5), cells=14)),
        (gs.Enneper(2000.0), gs.BisectingPatch(u=(-0.5, 0.5), v=(-0.5, 0.5), cells=14)),
        (gs.Catenoid(2000.0), gs.BisectingPatch(u=(-0.5, 0.5), v=(-0.5, 0.5), cells=14)),
        (gs.Helicoid(6000.0), gs.BisectingPatch(u=(-0.5, 0.5), v=(-0.5, 0.5), cells=14)),
    ],
)
def test_nets_with_right_angles_stay_on_minimal_surfaces(surface, patch):
    """Right node angles belong to minimal surfaces: the exact net is a fraction of an edge away."""
    start = gs.control_patch(surface, patch)
    recipe = gs.a_net(angle=np.radians(90.0))
    found = gs.optimize(start, recipe, anchor=gs.Free(), reference=surface).require()
    assert found.quality.surface_distance_mm.max < 0.01 * start.mesh.mean_edge
    assert found.quality.curvature_ratio == pytest.approx(-1.0, abs=0.01)


@pytest.mark.parametrize("degrees", [60.0, 90.0, 120.0])
def test_white_faces_with_rhombi_at_an_angle(degrees):
    """Fig. 12; the ratio of curvatures is that of a conjugate net symmetric to the principal one
    only on surfaces of revolution, so none is asked for here."""
    recipe = gs.pq_net(angle=np.radians(degrees), rhombus=True)
    found = gs.optimize(DOME, recipe, anchor=gs.Free()).require().quality
    assert found.face_planarity.max < 1e-8
    assert found.rhombus_error.max < 1e-8
    assert found.angle_error_deg.max < 1e-5


@pytest.mark.parametrize("degrees", [60.0, 90.0, 120.0])
def test_a_rotational_one_has_the_ratio_of_curvatures_of_fig_7(degrees):
    """kappa1 / kappa2 = tan(angle / 2)^2, from a sphere whose meridians are cut conformally."""
    half = np.tan(np.radians(degrees) / 2.0)
    u = 2.0 * np.pi * np.arange(40) / 40
    v = (np.arange(13) - 6.0) * 2.0 * np.pi / 40 / half
    u, v = np.meshgrid(u, v, indexing="ij")
    points = np.stack([np.cos(u) / np.cosh(v), np.sin(u) / np.cosh(v), np.tanh(v)], axis=-1)
    mesh = gs.QuadMesh(1000.0 * points.reshape(-1, 3), grid_quads(40, 12, ring=True))
    recipe = gs.pq_net(angle=np.radians(degrees), rhombus=True)
    found = gs.optimize(gs.as_control_mesh(mesh), recipe, anchor=gs.Free()).require().quality
    expected = min(half**2, 1.0 / half**2)
    assert found.curvature_ratio == pytest.approx(expected, rel=0.02)


def test_squares_are_rhombi_at_right_angles():
    found = gs.optimize(DOME, gs.pq_net(square=True), anchor=gs.Free()).require().quality
    assert found.rhombus_error.max < 1e-8
    assert found.angle_error_deg.max < 1e-5


def test_squares_at_another_angle_contradict_themselves():
    with pytest.raises(gs.SettingError, match="contradict") as info:
        gs.pq_net(square=True, angle=1.0)
    assert info.value.where == "angle, square"


def test_edges_of_a_noisy_asymptotic_mesh_get_planar_stars_and_right_angles():
    surface = gs.Enneper(4000.0)
    p, q = np.meshgrid(np.linspace(-0.6, 0.6, 13), np.linspace(-0.6, 0.6, 15), indexing="ij")
    points = surface.asymptotic_point(p.ravel(), q.ravel())
    control = noisy(gs.as_control_mesh(gs.QuadMesh(points, grid_quads(12, 14))))
    recipe = gs.a_net(planarity=gs.Planarity.EDGE_STARS, angle=np.radians(90.0), keep_shape=False)
    found = gs.optimize(control, recipe, anchor=gs.Free()).require()
    assert found.quality.angle_error_deg.max < 1e-5
    planarity = star_planarity(found.control.vertices, gs.edge_stars(control.mesh))
    assert len(planarity) == 13 * 15 - 4
    assert planarity.max() < 1e-7


@pytest.mark.parametrize(
    ("planarity", "colour"),
    [(gs.Planarity.FIRST_DIAGONAL_STARS, 0), (gs.Planarity.SECOND_DIAGONAL_STARS, 1)],
)
def test_stars_of_one_diagonal_mesh_alone(enneper, planarity, colour):
    recipe = gs.a_net(planarity=planarity, keep_shape=False)
    found = gs.optimize(noisy(enneper(12)), recipe, anchor=gs.Free()).require()
    figures = [
        star_planarity(net.vertices, net.stars).max() for net in gs.diagonal_meshes(found.control)
    ]
    assert figures[colour] < 1e-8
    assert figures[1 - colour] > 1e-4
    assert found.quality.star_planarity.max == pytest.approx(figures[colour], rel=1e-6)


def test_spherical_stars_at_a_right_angle(enneper):
    recipe = gs.principal_symmetric_net(angle=np.radians(90.0))
    found = gs.optimize(DOME, recipe, anchor=gs.Free()).require().quality
    assert found.sphericity.max < 1e-8
    assert found.angle_error_deg.max < 1e-5


def test_a_field_of_angles_is_met_where_the_net_ends(enneper):
    control = enneper(18)
    field = gs.RadialAngle((0.0, 0.0, 0.0), (0.0, 5000.0), np.radians((90.0, 70.0)))
    found = gs.optimize(control, gs.a_net(angle=field), anchor=gs.Free()).require()
    wanted = field(found.control.vertices[control.quads].mean(axis=1))
    np.testing.assert_allclose(gs.node_angles(found.control), wanted, atol=1e-7)
    assert found.quality.angle_error_deg.max < 1e-5
    assert np.ptp(np.degrees(wanted)) > 5.0
    before = field(control.vertices[control.quads].mean(axis=1))
    assert np.abs(np.degrees(wanted - before)).max() > 0.1


def test_a_mesh_with_an_odd_singularity_gets_planar_faces(sectors):
    mesh = sectors(5, 4)
    x, y, _ = mesh.vertices.T
    bowl = mesh.moved(np.stack([x, y, 0.04 * (x * x + y * y)], axis=1))
    recipe = gs.pq_net(planarity=gs.Planarity.FACES)
    found = gs.optimize(gs.without_families(bowl), recipe, anchor=gs.Free()).require()
    assert found.quality.face_planarity.max < 1e-8


def test_no_step_folds_a_quad_even_where_there_is_no_net():
    wave = quads_over(
        lambda x, y: 0.35 * np.sin(1.5 * x + 0.7 * y) * np.cos(1.1 * y) + 0.2 * x * y, 36, 40
    )
    recipe = gs.pq_net(planarity=gs.Planarity.FACES, keep_shape=False)
    found = gs.optimize(wave, recipe, anchor=gs.BoundaryPinned())
    assert not found.converged
    assert found.quality.collapsed == 0
    assert found.verdict is not None


def test_a_start_away_from_the_net_is_where_the_solve_begins(enneper):
    control, recipe = enneper(12), gs.a_net(angle=np.radians(80.0))
    net = gs.optimize(control, recipe, anchor=gs.Free()).require().control
    again = gs.optimize(control, recipe, anchor=gs.Free(), start=net.vertices)
    assert again.converged
    assert again.steps == ()


@pytest.mark.parametrize("unit", [1.0, 1000.0])
@pytest.mark.parametrize("planar", [True, False])
def test_projection_does_not_depend_on_units_or_place(enneper, unit, planar):
    start = noisy(TRANSLATION if planar else enneper(14))
    recipe = (
        gs.pq_net(planarity=gs.Planarity.FACES, keep_shape=False)
        if planar
        else gs.a_net(angle=np.radians(90.0), keep_shape=False)
    )
    here = gs.optimize(start, recipe, anchor=gs.Free()).require().control
    there = start.moved(start.vertices / unit + 1e6)
    found = gs.optimize(there, recipe, anchor=gs.Free()).require().control
    assert deviation(found.moved((found.vertices - 1e6) * unit), here) < 1e-6


def test_the_report_names_verdict_and_history(enneper):
    found = gs.optimize(enneper(10), gs.a_net(angle=np.radians(60.0), steps=2), anchor=gs.Free())
    lines = found.report().splitlines()
    assert lines[0] == found.status
    assert len(lines) == 5
    assert lines[-1] == found.verdict.message
