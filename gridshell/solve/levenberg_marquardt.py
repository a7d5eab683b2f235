"""Levenberg-Marquardt with one factorisation per step.

A step at weights w solves ``(J^T W J + mu I) d = -J^T W r`` and is taken when it lowers the energy
at those same weights; mu then follows the gain ratio (Nielsen 1999). Weights that guide the way
(fairness, closeness) are lowered from step to step, so the goals are reached to rounding. A step
that breaks the problem's guard (an inverted quad) is halved, and refused when that does not help.
"""

from __future__ import annotations

import time
from collections.abc import Callable, Sequence
from contextlib import nullcontext
from dataclasses import dataclass, field
from types import MappingProxyType
from typing import Any

import numpy as np

from gridshell.arrays import Floats, Indices
from gridshell.errors import SettingError, SolveError
from gridshell.solve.constraint import Evaluation
from gridshell.solve.linear import Engine, Factorisation, NormalEquations
from gridshell.solve.problem import Problem
from gridshell.solve.solution import End, Solution, State, Step
from gridshell.solve.workspace import Workspace

_HALVINGS = 4
_LARGEST_DAMPING = 1e12
_NONE = np.empty(0, dtype=np.int64)


@dataclass(frozen=True)
class Stop:
    """When to stop and how carefully to step.

    Parameters
    ----------
    steps : factorisations at most.
    tolerance : largest absolute residual of every goal, dimensionless.
    damping : first and smallest damping. The floor keeps the system definite where the goals
        leave motions free.
    engine : the linear solver.
    """

    steps: int = 30
    tolerance: float = 1e-9
    damping: float = 1e-6
    damping_floor: float = 1e-8
    engine: Engine = field(default=Engine())

    def __post_init__(self) -> None:
        if self.steps < 1:
            raise SettingError("At least one step is needed", value=f"{self.steps}", limit=">= 1")
        if not self.tolerance > 0.0:
            raise SettingError("The tolerance must be positive", value=f"{self.tolerance}")
        if not (self.damping >= 0.0 and self.damping_floor >= 0.0):
            raise SettingError(
                "Damping cannot be negative", value=f"{self.damping}, floor {self.damping_floor}"
            )


Progress = Callable[[int, Step], None]


def solve(
    problem: Problem,
    x0: Floats,
    stop: Stop,
    progress: Progress | None = None,
    *,
    resume: State | None = None,
    workspace: Workspace | None = None,
) -> Solution:
    """Minimise the weighted sum of squares of *problem* from *x0*, or from where it was left.

    With a *workspace* it goes on with the pattern and the analysis of the solve before.

    An interrupt (Ctrl-C) ends the solve after the last step taken, with its state.

    Raises
    ------
    SettingError
        When *resume* belongs to a problem of another size.
    SolveError
        When not even the first linear system can be factored.
    """
    state = resume or State(np.array(x0, dtype=np.float64), 0, stop.damping, 2.0)
    if len(state.x) != problem.size:
        raise SettingError(
            "The saved state belongs to another problem",
            where="resume",
            value=f"{len(state.x)} unknowns",
            limit=f"{problem.size}",
        )
    patterns = [term.constraint.pattern() for term in problem.terms]
    with nullcontext(workspace) if workspace else Workspace() as space:
        equations, factor = space.prepared(problem.size, patterns, problem.fixed, stop.engine)
        return _Run(problem, stop, equations, factor, state).to_its_end(progress)


class _Run:
    """One solve under way."""

    def __init__(
        self,
        problem: Problem,
        stop: Stop,
        equations: NormalEquations,
        factor: Factorisation,
        state: State,
    ) -> None:
        self.problem, self.stop, self.equations, self.factor = problem, stop, equations, factor
        self.state, self.blocked = state, _NONE
        self.steps: list[Step] = []
        self.lags = self._lag(state.x)
        self.now = self._evaluate(state.x)

    def to_its_end(self, progress: Progress | None) -> Solution:
        budget = self.stop.steps if len(self.equations.free) else 0
        end = End.STEPS
        try:
            while not (met := self._goals_met()) and len(self.steps) < budget:
                if self.state.damping > _LARGEST_DAMPING:
                    end = End.STALLED
                    break
                self._step()
                if progress is not None:
                    progress(len(self.steps), self.steps[-1])
            end = End.CONVERGED if met else end
        except KeyboardInterrupt:
            end = End.INTERRUPTED
        except SolveError:
            if not self.steps:
                raise
            end = End.UNSOLVABLE
        return Solution(
            self.state.x,
            end,
            self._status(end),
            tuple(self.steps),
            self.state,
            self.blocked,
            self.factor.memory,
        )

    def _step(self) -> None:
        """Factor once, try the step, and take it or leave it."""
        start = time.perf_counter()
        state, problem = self.state, self.problem
        weights = [term.weight.at(state.steps) for term in problem.terms]
        data, gradient = self.equations.assemble(self.now, weights)
        damped = self.equations.damped(data, state.damping)
        d = self.equations.expand(self.factor.solve(damped, -gradient))
        length, self.blocked = self._admissible(state.x, d)
        before = _energies(self.now, weights)
        then, after, gain = self.now, float("inf"), -1.0
        if len(self.blocked) == 0:
            then = self._evaluate(state.x + length * d)
            after = sum(_energies(then, weights))
            free = d[self.equations.free]
            slope, square = float(free @ gradient), float(free @ free)
            predicted = length**2 * (slope + state.damping * square) - 2.0 * length * slope
            gain = (sum(before) - after) / max(predicted, 1e-300)
        accepted = bool(np.isfinite(after)) and gain > 0.0
        largest = _largest(problem, then if accepted else self.now)
        if accepted:
            self._take(state.x + length * d, gain, then)
        else:
            growth = state.growth
            self.state = State(state.x, state.steps + 1, state.damping * growth, growth * 2.0)
        energies = MappingProxyType(
            {term.name: e for term, e in zip(problem.terms, before, strict=True)}
        )
        unmet = max((largest[t.name] for t in problem.terms if t.goal), default=0.0)
        seconds = time.perf_counter() - start
        self.steps.append(
            Step(sum(before), largest, unmet, state.damping, accepted, energies, length, seconds)
        )

    def _take(self, x: Floats, gain: float, known: Sequence[Evaluation]) -> None:
        """Move to *x*; evaluate again only where something was held still during the step."""
        shrink = max(1.0 / 3.0, 1.0 - (2.0 * gain - 1.0) ** 3)
        damping = max(self.state.damping * shrink, self.stop.damping_floor)
        self.lags = self._lag(x)
        self.now = [
            old if lag is None else term.constraint.evaluate(x, lag)
            for term, lag, old in zip(self.problem.terms, self.lags, known, strict=True)
        ]
        self.state = State(x, self.state.steps + 1, damping, 2.0)

    def _admissible(self, x: Floats, d: Floats) -> tuple[float, Indices]:
        """The longest share of *d* tried that the guard lets pass, and what it still refuses."""
        guard, length = self.problem.guard, 1.0
        if guard is None:
            return length, _NONE
        for halving in range(_HALVINGS + 1):
            length = 0.5**halving
            broken = guard.broken(x + length * d)
            if len(broken) == 0:
                break
        return length, broken

    def _lag(self, x: Floats) -> list[Any]:
        return [term.constraint.lag(x) for term in self.problem.terms]

    def _evaluate(self, x: Floats) -> list[Evaluation]:
        terms = zip(self.problem.terms, self.lags, strict=True)
        return [term.constraint.evaluate(x, lag) for term, lag in terms]

    def _goals_met(self) -> bool:
        largest = _largest(self.problem, self.now)
        return all(largest[t.name] <= self.stop.tolerance for t in self.problem.terms if t.goal)

    def _status(self, end: End) -> str:
        worst = _largest(self.problem, self.now)
        goals = ", ".join(f"{t.name} {worst[t.name]:.1e}" for t in self.problem.terms if t.goal)
        reached = f": largest residuals {goals}" if goals else ", with no goal to reach"
        count = len(self.steps)
        if end is End.CONVERGED:
            return f"{end.value} in {count} steps{reached}."
        refused = sum(not step.accepted for step in self.steps)
        return f"{end.value} after {count} steps ({refused} refused){reached}."


def _energies(evaluations: Sequence[Evaluation], weights: Sequence[float]) -> list[float]:
    # einsum, not vdot: BLAS threads would wait for those of the factorisation
    return [
        w * float(np.einsum("mr,mr->", e.residual, e.residual))
        for e, w in zip(evaluations, weights, strict=True)
    ]


def _largest(problem: Problem, evaluations: Sequence[Evaluation]) -> MappingProxyType[str, float]:
    return MappingProxyType(
        {
            term.name: float(np.abs(e.residual).max(initial=0.0))
            for term, e in zip(problem.terms, evaluations, strict=True)
        }
    )
