"""Levenberg-Marquardt with one factorisation per step.

A step at weights w solves ``(J^T W J + mu I) d = -J^T W r`` and is taken when it lowers the energy
at those same weights; mu then follows the gain ratio (Nielsen 1999). Weights that guide the way
(fairness, closeness) are lowered from step to step, so the goals are reached to rounding.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from types import MappingProxyType
from typing import Any

import numpy as np

from gridshell.arrays import Floats
from gridshell.errors import SettingError
from gridshell.solve.constraint import Evaluation
from gridshell.solve.linear import Factorisation, NormalEquations, factorisation
from gridshell.solve.problem import Problem
from gridshell.solve.solution import Solution, Step


@dataclass(frozen=True)
class Stop:
    """When to stop and how carefully to step.

    Parameters
    ----------
    steps : factorisations at most.
    tolerance : largest absolute residual of every goal, dimensionless.
    damping : first and smallest damping. The floor keeps the system definite where the goals
        leave motions free.
    portable : use SciPy alone even where PARDISO is installed.
    """

    steps: int = 30
    tolerance: float = 1e-9
    damping: float = 1e-6
    damping_floor: float = 1e-8
    portable: bool = False

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


def solve(problem: Problem, x0: Floats, stop: Stop, progress: Progress | None = None) -> Solution:
    """Minimise the weighted sum of squares of *problem* from *x0*.

    Raises
    ------
    SolveError
        When the linear system cannot be factored.
    """
    patterns = [term.constraint.pattern() for term in problem.terms]
    equations = NormalEquations(problem.size, patterns, problem.fixed)
    factor = factorisation(equations, portable=stop.portable)
    try:
        return _iterate(problem, x0, stop, equations, factor, progress)
    finally:
        factor.close()


def _iterate(
    problem: Problem,
    x0: Floats,
    stop: Stop,
    equations: NormalEquations,
    factor: Factorisation,
    progress: Progress | None,
) -> Solution:
    x, damping, growth = np.array(x0, dtype=np.float64), stop.damping, 2.0
    steps: list[Step] = []
    lags = _lags(problem, x)
    now = _evaluate(problem, x, lags)
    budget = stop.steps if len(equations.free) else 0
    while not (converged := _goals_met(problem, now, stop.tolerance)) and len(steps) < budget:
        weights = [term.weight.at(len(steps)) for term in problem.terms]
        data, gradient = equations.assemble(now, weights)
        d = equations.expand(factor.solve(equations.damped(data, damping), -gradient))
        then = _evaluate(problem, x + d, lags)
        before, after = _energy(now, weights), _energy(then, weights)
        predicted = float(d[equations.free] @ (damping * d[equations.free] - gradient))
        gain = (before - after) / max(predicted, 1e-300)
        accepted = bool(np.isfinite(after)) and gain > 0.0
        step = Step(before, _largest(problem, then if accepted else now), damping, accepted)
        if accepted:
            x, growth = x + d, 2.0
            damping = max(
                damping * max(1.0 / 3.0, 1.0 - (2.0 * gain - 1.0) ** 3), stop.damping_floor
            )
            lags = _lags(problem, x)
            now = _refresh(problem, x, lags, then)
        else:
            damping, growth = damping * growth, growth * 2.0
        steps.append(step)
        if progress is not None:
            progress(len(steps), step)
    return Solution(x, converged, _status(problem, now, steps, converged), tuple(steps))


def _lags(problem: Problem, x: Floats) -> list[Any]:
    return [term.constraint.lag(x) for term in problem.terms]


def _evaluate(problem: Problem, x: Floats, lags: Sequence[Any]) -> list[Evaluation]:
    return [t.constraint.evaluate(x, lag) for t, lag in zip(problem.terms, lags, strict=True)]


def _refresh(
    problem: Problem, x: Floats, lags: Sequence[Any], known: Sequence[Evaluation]
) -> list[Evaluation]:
    """Evaluate again only where something was held still during the step."""
    return [
        old if lag is None else term.constraint.evaluate(x, lag)
        for term, lag, old in zip(problem.terms, lags, known, strict=True)
    ]


def _energy(evaluations: Sequence[Evaluation], weights: Sequence[float]) -> float:
    return sum(
        w * float(np.vdot(e.residual, e.residual))
        for e, w in zip(evaluations, weights, strict=True)
    )


def _largest(problem: Problem, evaluations: Sequence[Evaluation]) -> MappingProxyType[str, float]:
    return MappingProxyType(
        {
            term.name: float(np.abs(e.residual).max(initial=0.0))
            for term, e in zip(problem.terms, evaluations, strict=True)
        }
    )


def _goals_met(problem: Problem, now: Sequence[Evaluation], tolerance: float) -> bool:
    return all(
        float(np.abs(e.residual).max(initial=0.0)) <= tolerance
        for term, e in zip(problem.terms, now, strict=True)
        if term.goal
    )


def _status(
    problem: Problem, now: Sequence[Evaluation], steps: Sequence[Step], converged: bool
) -> str:
    worst = _largest(problem, now)
    goals = ", ".join(f"{t.name} {worst[t.name]:.1e}" for t in problem.terms if t.goal)
    reached = f": largest residuals {goals}" if goals else ", with no goal to reach"
    if converged:
        return f"Converged in {len(steps)} steps{reached}."
    refused = sum(not step.accepted for step in steps)
    return f"Not converged after {len(steps)} steps ({refused} refused){reached}."
