from dataclasses import FrozenInstanceError

import numpy as np
import pytest

import gridshell as gs
from gridshell.anchors import Hold
from gridshell.curvature import vertex_normals
from gridshell.pose import Pose
from gridshell.solve import Weight

NOTHING = Hold(np.empty(0, dtype=np.int64))
RECIPES = [gs.a_net, gs.paper_a_net]


@pytest.fixture(scope="module")
def control(enneper):
    start = enneper(10)
    return start.moved(start.vertices / start.mesh.mean_edge)


@pytest.fixture(scope="module")
def pose(control):
    """The problem and start of a recipe."""

    def build(recipe, hold=NOTHING, reference=None, mesh=control):
        return recipe.problem(Pose(mesh, np.zeros(3), 1.0, hold, reference))

    return build


def terms(problem):
    return {term.name: term for term in problem.terms}


def residual(term, x):
    return term.constraint.evaluate(x, term.constraint.lag(x)).residual


# ---- settings -------------------------------------------------------------------------------


@pytest.mark.parametrize("recipe", RECIPES)
@pytest.mark.parametrize("angle", [0.0, np.pi, -1.0, 60.0, np.nan])
def test_an_angle_outside_0_to_180_degrees_is_refused_in_degrees(recipe, angle):
    with pytest.raises(gs.SettingError, match="node angle") as info:
        recipe(angle=angle)
    assert info.value.where == "angle"
    assert info.value.value == f"{np.degrees(angle):g} degrees"


@pytest.mark.parametrize("recipe", RECIPES)
@pytest.mark.parametrize("angle", [None, 0.01, 1.0, 3.14])
def test_an_angle_inside_is_kept(recipe, angle):
    assert recipe(angle=angle).angle == angle


@pytest.mark.parametrize("recipe", RECIPES)
def test_settings_are_frozen(recipe):
    with pytest.raises(FrozenInstanceError):
        recipe().angle = 1.0


def test_the_caller_chooses_steps_and_tolerance():
    stop = gs.a_net(steps=7, tolerance=1e-3).stop
    assert (stop.steps, stop.tolerance) == (7, 1e-3)


def test_the_paper_takes_ten_steps_at_constant_weights():
    recipe = gs.paper_a_net()
    assert recipe.stop.steps == 10
    assert [recipe.fairness.at(step) for step in (0, 9)] == [0.1, 0.1]


def test_guides_of_the_default_are_lowered_from_step_to_step():
    for recipe in (gs.a_net(), gs.a_net(keep_shape=False)):
        assert recipe.fairness.at(5) < 0.01 * recipe.fairness.at(0)


# ---- the default problem --------------------------------------------------------------------


def test_the_unknowns_of_the_default_are_the_vertices(control, pose):
    problem, start = pose(gs.a_net())
    assert problem.size == 3 * len(control.vertices)
    np.testing.assert_array_equal(start, control.vertices.ravel())


def test_stars_and_angle_are_the_goals(pose):
    problem, _ = pose(gs.a_net(angle=1.0))
    assert [t.name for t in problem.terms if t.goal] == ["star planarity", "node angle"]
    assert [t.name for t in problem.terms if not t.goal] == ["fairness"]


def test_a_singular_vertex_adds_its_star_to_the_goals(pose, monkey_saddle):
    problem, _ = pose(gs.a_net(), mesh=gs.as_control_mesh(monkey_saddle))
    assert [t.name for t in problem.terms if t.goal] == ["star planarity", "other stars"]


def test_every_control_quad_has_the_angle_of_the_recipe(control, pose):
    problem, _ = pose(gs.a_net(angle=1.25))
    constraint = terms(problem)["node angle"].constraint
    np.testing.assert_array_equal(constraint.quads, control.quads)
    assert set(constraint.angle) == {1.25}


def test_keeping_the_shape_means_no_residual_of_fairness_at_the_start(pose):
    problem, start = pose(gs.a_net())
    assert np.abs(residual(terms(problem)["fairness"], start)).max() == 0.0


def test_not_keeping_it_straightens_edges_and_diagonals(control, pose):
    problem, start = pose(gs.a_net(keep_shape=False))
    found = residual(terms(problem)["fairness"], start).reshape(-1, 3)
    stars = gs.diagonal_stars(control.mesh), gs.edge_stars(control.mesh)
    a, v, b = np.concatenate([s.continuations() for s in stars]).T
    expected = start.reshape(-1, 3)[a] + start.reshape(-1, 3)[b] - 2.0 * start.reshape(-1, 3)[v]
    np.testing.assert_allclose(found, expected, atol=1e-14)


def test_a_noisy_start_stays_close_to_where_it_is(pose):
    assert "closeness" not in terms(pose(gs.a_net())[0])
    problem, start = pose(gs.a_net(keep_shape=False))
    assert np.abs(residual(terms(problem)["closeness"], start)).max() == 0.0


@pytest.mark.parametrize("recipe", RECIPES)
def test_a_reference_adds_the_distance_of_every_used_vertex(control, pose, recipe):
    assert "proximity" not in terms(pose(recipe())[0])
    problem, start = pose(recipe(), reference=gs.Sphere(1.0))
    found = residual(terms(problem)["proximity"], start)
    np.testing.assert_allclose(
        found.ravel(), np.linalg.norm(control.vertices, axis=1) - 1.0, atol=1e-12
    )


@pytest.mark.parametrize("recipe", RECIPES)
def test_held_vertices_are_fixed_in_all_three_coordinates(pose, recipe):
    problem, _ = pose(recipe(), Hold(np.array([2, 5])))
    assert problem.fixed.tolist() == [6, 7, 8, 15, 16, 17]


def test_terms_of_the_anchor_come_along(control, pose):
    hold = gs.BoundaryGlide().hold(control, control.vertices)
    problem, _ = pose(gs.a_net(), hold)
    assert [n for n in terms(problem) if n.startswith("glide")] == [f"glide {k}" for k in range(4)]


@pytest.mark.parametrize("recipe", RECIPES)
def test_terms_without_elements_are_left_out(pose, grid, recipe):
    problem, _ = pose(recipe(), mesh=gs.as_control_mesh(grid(2, 2)))
    assert "other stars" not in terms(problem)
    assert all(len(t.constraint.pattern().columns) for t in problem.terms)


def test_weights_can_be_chosen(pose):
    problem, _ = pose(gs.NetRecipe(fairness=Weight(0.5)))
    assert terms(problem)["fairness"].weight == Weight(0.5)


# ---- the paper's problem --------------------------------------------------------------------


def test_the_paper_has_a_unit_normal_per_vertex_among_its_unknowns(control, pose):
    problem, start = pose(gs.paper_a_net())
    n = len(control.vertices)
    assert problem.size == 6 * n
    np.testing.assert_array_equal(start[3 * n :], vertex_normals(control.mesh).ravel())
    assert np.abs(residual(terms(problem)["unit normals"], start)).max() < 1e-15


def test_each_star_of_the_paper_refers_to_its_own_normal(control, pose):
    points = terms(pose(gs.paper_a_net())[0])["star planarity"].constraint.points
    np.testing.assert_array_equal(points[:, -1] - points[:, 0], len(control.vertices))


def test_the_paper_holds_the_lengths_of_the_diagonals_still(pose):
    problem, start = pose(gs.paper_a_net(angle=1.0))
    assert terms(problem)["node angle"].constraint.lag(start) is not None
    problem, start = pose(gs.a_net(angle=1.0))
    assert terms(problem)["node angle"].constraint.lag(start) is None


def test_the_paper_straightens_its_polylines(pose):
    problem, start = pose(gs.paper_a_net())
    assert np.abs(residual(terms(problem)["fairness"], start)).max() > 1e-3


# ---- settings that do not go together -------------------------------------------------------


def test_an_asymptotic_net_has_no_planar_faces():
    with pytest.raises(gs.SettingError, match="planar vertex stars") as info:
        gs.a_net(planarity=gs.Planarity.FACES)
    assert (info.value.where, info.value.value) == ("planarity", "faces")


def test_a_planar_quad_net_has_no_planar_stars():
    with pytest.raises(gs.SettingError, match="planar faces") as info:
        gs.pq_net(planarity=gs.Planarity.EDGE_STARS)
    assert info.value.value == "vertex stars of the edges"


def test_the_paper_has_equations_for_two_kinds_of_planarity():
    with pytest.raises(gs.SettingError, match="no equation") as info:
        gs.PaperRecipe(planarity=gs.Planarity.SPHERICAL_STARS)
    assert info.value.where == "planarity"


def test_the_paper_s_planar_quads_have_a_normal_for_every_white_quad(control, pose):
    problem, _ = pose(gs.paper_pq_net(angle=1.0, rhombus=True, fairness=0.01))
    names = [term.name for term in problem.terms if term.goal]
    assert sorted(names) == ["equal diagonals", "node angle", "white faces"]
    inner = np.count_nonzero(~control.mesh.on_boundary)
    assert len(terms(problem)["white faces"].constraint.points) == inner
    assert terms(problem)["fairness"].weight == Weight(0.01)
