from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
import pytest

import gridshell as gs
from gridshell.solve import Engine, Evaluation, Pattern, Problem, Stop, Term, Weight, solve

NOTHING = np.empty(0, dtype=np.int64)
FIT = np.array([[1.0, 0.0], [1.0, 1.0], [1.0, 2.0]]), np.array([1.0, 2.0, 2.0])


@dataclass(frozen=True, eq=False)
class Rows:
    """One element over the first unknowns, from a function to (residual, Jacobian)."""

    size: int
    rows: int
    function: Callable[[Any], tuple[Any, Any]]

    def pattern(self):
        return Pattern(np.arange(self.size)[None, :], self.rows)

    def lag(self, x):
        return None

    def evaluate(self, x, lag):
        residual, jacobian = self.function(x[: self.size])
        return Evaluation(
            np.reshape(residual, (1, self.rows)),
            np.reshape(jacobian, (1, self.rows, self.size)).astype(float),
        )


def linear(matrix, right):
    a, b = np.asarray(matrix, float), np.asarray(right, float)
    return Rows(a.shape[1], len(b), lambda x: (a @ x - b, a))


def problem(constraint, *others, fixed=NOTHING, weight=None):
    goal = Term("goal", weight or Weight(1.0), constraint, goal=True)
    return Problem(constraint.size, (goal, *others), np.asarray(fixed))


ROSENBROCK = Rows(
    2, 2, lambda x: ([10.0 * (x[1] - x[0] ** 2), 1.0 - x[0]], [[-20.0 * x[0], 10.0], [-1.0, 0.0]])
)
ARCTAN = Rows(1, 1, lambda x: (np.arctan(x), 1.0 / (1.0 + x * x)))
"""From |x| > 1.39 an undamped step overshoots further than it started."""


def logarithm(x):
    with np.errstate(invalid="ignore"):
        return np.log(x), 1.0 / x


LOGARITHM = Rows(1, 1, logarithm)


# ---- linear problems ------------------------------------------------------------------------


@pytest.mark.parametrize("portable", [False, True])
def test_a_consistent_linear_problem_is_solved_to_rounding_in_two_steps(portable):
    a, b = 2.0 * np.eye(3) + 1.0, np.array([1.0, 2.0, 3.0])
    found = solve(
        problem(linear(a, b)), np.zeros(3), Stop(tolerance=1e-12, engine=Engine(portable=portable))
    )
    assert found.converged
    assert len(found.steps) <= 2
    np.testing.assert_allclose(found.x, np.linalg.solve(a, b), rtol=1e-12)


@pytest.mark.parametrize("portable", [False, True])
def test_two_steps_reach_the_least_squares_solution_to_rounding(portable):
    found = solve(
        problem(linear(*FIT)), np.zeros(2), Stop(steps=2, engine=Engine(portable=portable))
    )
    np.testing.assert_allclose(found.x, np.linalg.lstsq(*FIT, rcond=None)[0], rtol=1e-12)


def test_weights_multiply_the_squared_residuals():
    pull = Term("pull", Weight(3.0), linear([[1.0]], [4.0]))
    found = solve(problem(linear([[1.0]], [0.0]), pull), np.ones(1), Stop(steps=3))
    np.testing.assert_allclose(found.x, [3.0], rtol=1e-12)


def test_the_energy_is_the_weighted_sum_of_squares_before_the_step():
    pull = Term("pull", Weight(3.0), linear([[1.0]], [4.0]))
    found = solve(problem(linear([[1.0]], [1.0]), pull), np.zeros(1), Stop(steps=1))
    assert found.steps[0].energy == 1.0 + 3.0 * 16.0


def test_a_decaying_guide_gives_way_to_the_goal():
    guide = Term("guide", Weight(1.0, 0.1), linear([[1.0]], [4.0]))
    found = solve(problem(linear([[1.0]], [0.0]), guide), np.zeros(1) + 9.0, Stop())
    assert found.converged
    assert abs(found.x[0]) <= 1e-9


def test_a_constant_guide_does_not():
    guide = Term("guide", Weight(1.0), linear([[1.0]], [4.0]))
    found = solve(problem(linear([[1.0]], [0.0]), guide), np.zeros(1) + 9.0, Stop())
    assert not found.converged
    np.testing.assert_allclose(found.x, [2.0], rtol=1e-9)


def test_fixed_unknowns_keep_their_bits_and_the_others_do_the_best_they_can():
    start = np.array([0.1, 0.0])
    found = solve(problem(linear(*FIT), fixed=[0]), start, Stop(steps=3))
    assert found.x[0] == 0.1
    np.testing.assert_allclose(found.x[1], (FIT[0][:, 1] @ (FIT[1] - 0.1)) / 5.0, rtol=1e-12)


@pytest.mark.parametrize("portable", [False, True])
def test_with_every_unknown_fixed_nothing_moves(portable):
    start = np.array([0.1, 0.2])
    found = solve(
        problem(linear(*FIT), fixed=[0, 1]), start, Stop(steps=2, engine=Engine(portable=portable))
    )
    np.testing.assert_array_equal(found.x, start)
    assert not found.converged


def test_unknowns_no_term_sees_stay():
    wide = Problem(4, (Term("goal", Weight(1.0), linear(*FIT), goal=True),), NOTHING)
    found = solve(wide, np.array([0.0, 0.0, 0.3, 0.7]), Stop(steps=3))
    assert found.x[2:].tolist() == [0.3, 0.7]


def test_the_start_is_not_changed():
    start = np.zeros(2)
    solve(problem(linear(*FIT)), start, Stop(steps=2))
    assert start.tolist() == [0.0, 0.0]


# ---- nonlinear problems ---------------------------------------------------------------------


@pytest.mark.parametrize("portable", [False, True])
def test_the_rosenbrock_valley_is_followed_to_its_end(portable):
    found = solve(
        problem(ROSENBROCK), np.array([-1.2, 1.0]), Stop(steps=60, engine=Engine(portable=portable))
    )
    assert found.converged
    np.testing.assert_allclose(found.x, [1.0, 1.0], atol=1e-8)


def test_the_energy_never_rises_at_equal_weights():
    found = solve(problem(ROSENBROCK), np.array([-1.2, 1.0]), Stop(steps=60))
    energies = np.array([step.energy for step in found.steps])
    accepted = np.array([step.accepted for step in found.steps[:-1]])
    assert (~accepted).any()
    assert (np.diff(energies)[accepted] < 0.0).all()
    assert (np.diff(energies)[~accepted] == 0.0).all()


def test_a_refused_step_leaves_the_unknowns_unchanged():
    found = solve(problem(ARCTAN), np.array([3.0]), Stop(steps=1))
    assert not found.steps[0].accepted
    assert found.x.tolist() == [3.0]


def test_the_residuals_of_a_refused_step_are_those_before_it():
    found = solve(problem(ARCTAN), np.array([3.0]), Stop(steps=1))
    assert found.steps[0].residuals == {"goal": np.arctan(3.0)}


def test_the_residuals_of_an_accepted_step_are_those_after_it():
    found = solve(problem(ROSENBROCK), np.array([1.1, 1.2]), Stop(steps=1))
    assert found.steps[0].accepted
    residual, _ = ROSENBROCK.function(found.x)
    assert found.steps[0].residuals == {"goal": np.abs(residual).max()}


def test_damping_grows_faster_and_faster_while_steps_are_refused():
    found = solve(problem(ARCTAN), np.array([3.0]), Stop(steps=4))
    assert [step.accepted for step in found.steps] == [False] * 4
    damping = np.array([step.damping for step in found.steps])
    np.testing.assert_allclose(damping / 1e-6, [1.0, 2.0, 8.0, 64.0])


def test_damping_falls_to_a_third_after_a_step_as_good_as_predicted():
    found = solve(problem(linear(*FIT)), np.zeros(2), Stop(steps=2, damping=1.0))
    np.testing.assert_allclose(found.steps[1].damping, 1.0 / 3.0, rtol=1e-6)


def test_damping_never_falls_below_its_floor():
    stop = Stop(steps=30, damping=1e-2, damping_floor=1e-3)
    guide = Term("guide", Weight(1.0, 0.5), linear([[1.0]], [4.0]))
    found = solve(problem(linear([[1.0]], [0.0]), guide), np.array([9.0]), stop)
    assert min(step.damping for step in found.steps) == 1e-3


def test_refused_steps_lead_to_a_shorter_one_and_the_solution():
    found = solve(problem(ARCTAN), np.array([3.0]), Stop(steps=60))
    assert found.converged
    assert any(not step.accepted for step in found.steps)
    assert abs(found.x[0]) <= 1e-8


def test_a_step_to_where_the_residual_is_no_number_is_refused():
    found = solve(problem(LOGARITHM), np.array([10.0]), Stop(steps=60))
    assert not found.steps[0].accepted
    np.testing.assert_allclose(found.x, [1.0], rtol=1e-8)


# ---- lag ------------------------------------------------------------------------------------


@dataclass(frozen=True, eq=False)
class HalfOfTheLast(Rows):
    """``x - lag / 2 = 0`` with the last accepted x held still: halves x every step."""

    def lag(self, x):
        return x.copy()

    def evaluate(self, x, lag):
        return Evaluation((x - lag / 2.0)[None], np.eye(self.size)[None])


def test_what_is_held_still_is_renewed_after_every_accepted_step():
    constraint = HalfOfTheLast(1, 1, None)
    found = solve(problem(constraint), np.array([1.0]), Stop(steps=10))
    np.testing.assert_allclose(found.x, [0.5**10], rtol=1e-4)


def test_goals_are_judged_with_what_is_held_still_renewed():
    """At x the residual is x / 2 once the lag is renewed; within the step it is zero."""
    found = solve(problem(HalfOfTheLast(1, 1, None)), np.array([1.0]), Stop(steps=1))
    assert found.steps[0].residuals["goal"] < 1e-5
    assert not found.converged


# ---- when it ends ---------------------------------------------------------------------------


def test_a_start_that_meets_the_goals_takes_no_step():
    found = solve(problem(linear(*np.array([[[1.0]], [[2.0]]]))), np.array([2.0]), Stop())
    assert found.converged
    assert found.steps == ()
    assert found.status == "Converged in 0 steps: largest residuals goal 0.0e+00."


def test_only_goals_decide_whether_it_converged():
    guide = Term("guide", Weight(1e-6), linear([[1.0]], [4.0]))
    found = solve(problem(linear([[1.0]], [2.0]), guide), np.array([2.0]), Stop())
    assert found.converged


def test_the_tolerance_is_on_the_largest_residual():
    wide = linear(np.eye(4), np.zeros(4))
    start = np.full(4, 0.9e-3)
    assert solve(problem(wide), start, Stop(tolerance=1e-3)).steps == ()
    assert len(solve(problem(wide), start, Stop(tolerance=0.8e-3)).steps) == 1


def test_the_status_of_a_success_names_steps_and_residuals():
    found = solve(problem(linear([[1.0]], [2.0])), np.array([0.0]), Stop(tolerance=1e-4))
    assert found.status.startswith("Converged in 1 steps: largest residuals goal 2.0e-06")


def test_the_status_of_a_failure_counts_refused_steps():
    found = solve(problem(ARCTAN), np.array([3.0]), Stop(steps=4))
    assert found.status == (
        "Not converged after 4 steps (4 refused): largest residuals goal 1.2e+00."
    )


def test_the_status_of_a_problem_without_goals_is_a_sentence():
    found = solve(Problem(2, (), NOTHING), np.zeros(2), Stop())
    assert "residuals ." not in found.status


def test_require_raises_what_the_status_says():
    found = solve(problem(ARCTAN), np.array([3.0]), Stop(steps=4))
    with pytest.raises(gs.SolveError) as info:
        found.require()
    assert str(info.value) == found.status


def test_progress_is_called_after_every_step_with_its_number():
    heard = []
    found = solve(
        problem(ROSENBROCK),
        np.array([-1.2, 1.0]),
        Stop(steps=5),
        lambda number, step: heard.append((number, step)),
    )
    assert heard == list(enumerate(found.steps, start=1))


def test_the_number_of_steps_is_the_number_of_factorisations():
    found = solve(problem(ROSENBROCK), np.array([-1.2, 1.0]), Stop(steps=7))
    assert len(found.steps) == 7


@pytest.mark.parametrize("portable", [False, True])
def test_a_singular_system_raises_a_solve_error(portable):
    blind = Problem(
        3, (Term("goal", Weight(1.0), linear([[1.0, 0.0]], [1.0]), goal=True),), NOTHING
    )
    undamped = Stop(damping=0.0, damping_floor=0.0, engine=Engine(portable=portable))
    with pytest.raises(gs.SolveError, match="could not be factored") as info:
        solve(blind, np.zeros(3), undamped)
    assert info.value.__cause__ is not None


@pytest.mark.parametrize("steps", [0, -3])
def test_at_least_one_step_is_needed(steps):
    with pytest.raises(gs.SettingError, match="At least one step") as info:
        Stop(steps=steps)
    assert info.value.value == str(steps)


@pytest.mark.parametrize("tolerance", [0.0, -1e-9, np.nan])
def test_the_tolerance_must_be_positive(tolerance):
    with pytest.raises(gs.SettingError, match="tolerance must be positive") as info:
        Stop(tolerance=tolerance)
    assert info.value.value == str(tolerance)


# ---- both solvers on a net ------------------------------------------------------------------


def test_pardiso_and_the_portable_solver_agree_on_a_net(enneper):
    pytest.importorskip("pypardiso")
    control = enneper(12)
    nets = [
        gs.optimize(
            control,
            gs.NetRecipe(angle=np.radians(75.0), stop=Stop(engine=Engine(portable=portable))),
            anchor=gs.Free(),
        )
        for portable in (False, True)
    ]
    assert nets[0].converged
    assert nets[1].converged
    move = np.abs(nets[0].control.vertices - nets[1].control.vertices).max()
    assert move <= 1e-8 * control.mesh.mean_edge


# ---- guard, interrupt, resume ---------------------------------------------------------------


@dataclass(frozen=True)
class Fence:
    """Refuses an unknown above the limit."""

    limit: float

    def broken(self, x):
        return np.flatnonzero(x > self.limit)


def fenced(limit, constraint=None):
    constraint = constraint or linear([[1.0]], [4.0])
    return Problem(1, (Term("goal", Weight(1.0), constraint, goal=True),), NOTHING, Fence(limit))


def test_a_step_over_the_fence_is_halved():
    found = solve(fenced(2.5), np.array([0.0]), Stop(steps=1))
    assert found.steps[0].accepted
    assert found.steps[0].length == 0.5
    np.testing.assert_allclose(found.x, [2.0], rtol=1e-5)


def test_a_step_that_no_halving_brings_inside_is_refused_and_named():
    found = solve(fenced(0.1), np.array([0.0]), Stop(steps=1))
    assert not found.steps[0].accepted
    assert found.x.tolist() == [0.0]
    assert found.blocked.tolist() == [0]


def test_the_fence_holds_to_the_end():
    found = solve(fenced(3.0), np.array([0.0]), Stop(steps=60))
    assert not found.converged
    assert found.x[0] <= 3.0
    assert found.x[0] > 2.9


def test_damping_that_grows_out_of_bounds_ends_it_as_stalled():
    found = solve(fenced(0.0), np.array([0.0]), Stop(steps=200))
    assert found.end is gs.End.STALLED
    assert found.status.startswith("Stalled after")


def interrupt_after(steps):
    def progress(number, step):
        if number == steps:
            raise KeyboardInterrupt

    return progress


def test_an_interrupt_returns_the_last_step_and_where_to_go_on():
    start = np.array([-1.2, 1.0])
    whole = solve(problem(ROSENBROCK), start, Stop(steps=12))
    first = solve(problem(ROSENBROCK), start, Stop(steps=60), interrupt_after(5))
    assert first.end is gs.End.INTERRUPTED
    assert first.status.startswith("Interrupted after 5 steps")
    rest = solve(problem(ROSENBROCK), start, Stop(steps=7), resume=first.state)
    assert rest.x.tolist() == whole.x.tolist()
    assert rest.state.steps == 12


def test_guides_go_on_falling_after_a_resume():
    guide = Term("guide", Weight(1.0, 0.1), linear([[1.0]], [4.0]))
    both = problem(linear([[1.0]], [0.0]), guide)
    whole = solve(both, np.array([9.0]), Stop(steps=6, tolerance=1e-300))
    first = solve(both, np.array([9.0]), Stop(steps=3, tolerance=1e-300))
    rest = solve(both, np.array([9.0]), Stop(steps=3, tolerance=1e-300), resume=first.state)
    np.testing.assert_allclose(rest.x, whole.x, rtol=1e-12)
    assert first.steps[0].energy > 10.0 * rest.steps[0].energy


def test_a_state_of_another_problem_is_refused():
    state = gs.State(np.zeros(5), 3, 1e-6, 2.0)
    with pytest.raises(gs.SettingError, match="another problem") as info:
        solve(problem(ROSENBROCK), np.zeros(2), Stop(), resume=state)
    assert (info.value.value, info.value.limit) == ("5 unknowns", "2")


@dataclass(frozen=True, eq=False)
class OneShort(Rows):
    """The step from 3 ends at 0.5, where the derivative has gone."""

    def evaluate(self, x, lag):
        slope = 1.2 if x[0] > 1.0 else 0.0
        return Evaluation(x[None].copy(), np.full((1, 1, 1), slope))


def test_a_system_that_cannot_be_factored_later_returns_the_state_before_it():
    undamped = Stop(damping=0.0, damping_floor=0.0, steps=5)
    found = solve(problem(OneShort(1, 1, None)), np.array([3.0]), undamped)
    assert found.end is gs.End.UNSOLVABLE
    np.testing.assert_allclose(found.x, [0.5])
    assert "could not be factored" in found.status


def test_every_step_tells_the_energy_of_every_term():
    pull = Term("pull", Weight(3.0), linear([[1.0]], [4.0]))
    found = solve(problem(linear([[1.0]], [1.0]), pull), np.zeros(1), Stop(steps=2))
    assert found.steps[0].energies == {"goal": 1.0, "pull": 48.0}
    assert found.steps[0].seconds > 0.0


@pytest.mark.parametrize("threads", [1, 2])
def test_reruns_agree_to_the_last_bit(enneper, threads):
    recipe = gs.NetRecipe(
        angle=np.radians(75.0), stop=Stop(engine=Engine(threads=threads, repeatable=True))
    )
    runs = [gs.optimize(enneper(16), recipe, anchor=gs.Free()) for _ in range(2)]
    np.testing.assert_array_equal(runs[0].control.vertices, runs[1].control.vertices)


@pytest.mark.parametrize("threads", [1, 2])
def test_a_quick_engine_finds_the_same_net_but_for_rounding(enneper, threads):
    exact, quick = (
        gs.optimize(
            enneper(16),
            gs.NetRecipe(
                angle=np.radians(75.0),
                stop=Stop(engine=Engine(threads=threads, repeatable=repeatable)),
            ),
            anchor=gs.Free(),
        )
        for repeatable in (True, False)
    )
    assert quick.converged
    size = np.ptp(exact.control.vertices)
    apart = np.abs(quick.control.vertices - exact.control.vertices).max()
    assert apart < 1e-9 * size


def test_at_least_one_thread_is_needed():
    with pytest.raises(gs.SettingError, match="At least one thread"):
        Engine(threads=0)


def test_the_memory_of_the_factorisation_is_told(enneper):
    for portable in (False, True):
        recipe = gs.NetRecipe(angle=1.3, stop=Stop(engine=Engine(portable=portable)))
        found = gs.optimize(enneper(12), recipe, anchor=gs.Free())
        assert 0.1 < found.memory < 100.0
