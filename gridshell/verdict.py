"""When the wanted net is not reached: which condition, where, and what would have to give."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from gridshell.arrays import Floats, Indices
from gridshell.curvature import principal_curvatures
from gridshell.mesh import ControlMesh, position
from gridshell.solve import End, Problem, Solution, Term

_NAMED = 12
"""Places a verdict lists at most, worst first."""

_FLATTENED = 0.1
"""Share of the start's curvature below which a net counts as lost in a plane."""

_SHRUNK = 0.4
"""Share of the start's mean edge below which a net counts as collapsed."""

_BALANCED = 0.3
"""Share of a pull above which it counts as resistance."""

_SAMPLES = 2_000
"""Vertices at which curvature is compared at most."""


@dataclass(frozen=True)
class Verdict:
    """Why the result is not the net that was asked for.

    Parameters
    ----------
    condition : name of the term that is furthest from its goal, or "shape".
    value, limit : its largest residual (or the share of the shape that is left) and what passes.
    vertices : where, worst first, at most twelve elements: the first vertex of each.
    message : the whole verdict in two sentences.
    """

    condition: str
    value: float
    limit: float
    vertices: tuple[int, ...]
    message: str


def verdict(
    problem: Problem, solution: Solution, start: ControlMesh, result: ControlMesh, tolerance: float
) -> Verdict | None:
    """None for a net that is what was asked for.

    Parameters
    ----------
    start, result : the net before and after, in mm.
    """
    lost = _lost_shape(start, result)
    if lost is not None or solution.converged:
        return lost
    goals = [term for term in problem.terms if term.goal]
    if not goals:
        return None
    residuals = {term.name: _residual(term, solution.x) for term in goals}
    worst = max(goals, key=lambda term: float(residuals[term.name].max(initial=0.0)))
    found = residuals[worst.name]
    order = np.argsort(found)[::-1]
    order = order[found[order] > tolerance][:_NAMED]
    columns = worst.constraint.pattern().columns
    vertices = tuple((columns[order, 0] // 3).tolist())
    share = float(np.count_nonzero(found > tolerance) / max(len(found), 1))
    place = position(result.vertices[vertices[0]]) if vertices else "nowhere"
    message = (
        f"The {worst.name} is not reached: {found.max(initial=0.0):.2e} at vertex "
        f"{vertices[0] if vertices else '-'} {place}, {tolerance:.0e} allowed, and {share:.0%} of "
        f"its {len(found)} places fail. {_what_gives(problem, solution, result)}"
    )
    return Verdict(worst.name, float(found.max(initial=0.0)), tolerance, vertices, message)


def _residual(term: Term, x: Floats) -> Floats:
    constraint = term.constraint
    return np.asarray(np.abs(constraint.evaluate(x, constraint.lag(x)).residual).max(axis=1))


def _what_gives(problem: Problem, solution: Solution, result: ControlMesh) -> str:
    if solution.end is End.INTERRUPTED:
        return "It was interrupted: go on from the saved state."
    if len(solution.blocked):
        f = int(solution.blocked[0])
        place = position(result.vertices[result.quads[f]].mean(axis=0))
        return (
            f"{len(solution.blocked)} quads would fold, first quad {f} at {place}: "
            "give the mesh more room there, another layout, or a freer boundary."
        )
    found = {term.name: _pull(problem, term, solution) for term in problem.terms}
    pulls = {name: pull for name, (pull, _) in found.items()}
    goals = [term.name for term in problem.terms if term.goal]
    total = np.sum([pulls[name] for name in goals], axis=0)
    held = float(np.linalg.norm(total[problem.fixed]))
    guides = {n: float(np.linalg.norm(p)) for n, p in pulls.items() if n not in goals}
    free = np.delete(total, problem.fixed)
    if held > _BALANCED * float(np.linalg.norm(total)):
        return "The vertices that are held resist it: pin fewer of them, or let them glide."
    strongest = max(guides, key=lambda name: guides[name], default="")
    if strongest and guides[strongest] > _BALANCED * float(np.linalg.norm(free)):
        return f"The {strongest} resists it: lower its weight or let it fall further."
    uncancelled = float(np.linalg.norm([found[name][1] for name in goals]))
    if float(np.linalg.norm(free)) > _BALANCED * uncancelled:
        return "It is still on the way: allow more steps."
    names = " and ".join(goals)
    if len(goals) == 1:
        return f"The {names} contradicts itself near this start: begin from another mesh."
    return f"{names} contradict each other near this start: drop or change one of them."


def _pull(problem: Problem, term: Term, solution: Solution) -> tuple[Floats, float]:
    """(size,) the term's share of the gradient, and the length it has before parts cancel."""
    found = term.constraint.evaluate(solution.x, term.constraint.lag(solution.x))
    weight = term.weight.at(solution.state.steps)
    pull = weight * np.einsum("mrk,mr->mk", found.values, found.residual)
    columns: Indices = term.constraint.pattern().columns
    total = np.bincount(columns.ravel(), pull.ravel(), problem.size)
    return np.asarray(total, dtype=np.float64), float(np.linalg.norm(pull))


def _lost_shape(start: ControlMesh, result: ControlMesh) -> Verdict | None:
    """Conditions can all be met by a net that has shrunk to nothing or fallen into a plane."""
    size = result.mesh.mean_edge / start.mesh.mean_edge
    if size < _SHRUNK or size > 1.0 / _SHRUNK:
        return _lost("mean edge", size, _SHRUNK, "has lost its size")
    before, after = _bend(start), _bend(result)
    if before is None or after is None or before * start.mesh.mean_edge < 1e-6:
        return None
    left = after / before
    if left < _FLATTENED:
        return _lost("curvature", left, _FLATTENED, "has fallen into a plane")
    return None


def _lost(figure: str, value: float, limit: float, what: str) -> Verdict:
    message = (
        f"The net {what}: its {figure} is {value:.3g} times that of the start. The start does "
        "not carry this net: hold the boundary, keep to a surface, or begin from a mesh whose "
        "lines follow the wanted directions."
    )
    return Verdict("shape", value, limit, (), message)


def _bend(control: ControlMesh) -> float | None:
    """Median of the larger principal curvature, 1/mm."""
    _, kappa = principal_curvatures(control.mesh, most=_SAMPLES)
    return float(np.median(np.abs(kappa).max(axis=1))) if len(kappa) else None
