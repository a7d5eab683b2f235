"""What a solve returns: the point, a sentence, the history, and where to go on from.

Three questions, three answers: ``status`` is the brief one, :meth:`Solution.report` the full one,
``converged`` says whether the point is usable.
"""

from __future__ import annotations

from dataclasses import dataclass
from enum import Enum
from types import MappingProxyType

from gridshell.arrays import Floats, Indices
from gridshell.errors import SolveError


class End(Enum):
    """Why a solve ended; the value completes the sentence of its status."""

    CONVERGED = "Converged"
    STEPS = "Not converged"
    STALLED = "Stalled"
    INTERRUPTED = "Interrupted"
    UNSOLVABLE = "Stopped where the linear system could not be factored"


@dataclass(frozen=True)
class Step:
    """One factorisation.

    Parameters
    ----------
    energy : weighted sum of squares before the step, at this step's weights.
    energies : the same by term.
    residuals : largest absolute residual of each term after the step.
    unmet : largest absolute residual of any goal after the step; 0 without goals.
    damping : added to the diagonal.
    accepted : whether the step lowered the energy and was taken.
    length : share of the step that was tried last; below 1 where the whole would break the guard.
    seconds : spent on it.
    """

    energy: float
    residuals: MappingProxyType[str, float]
    unmet: float
    damping: float
    accepted: bool
    energies: MappingProxyType[str, float]
    length: float
    seconds: float


@dataclass(frozen=True, eq=False)
class State:
    """Where a solve can be taken up again; with the same problem it goes on to the same end.

    Parameters
    ----------
    x : (size,) unknowns.
    steps : factorisations so far; weights go on falling from there.
    damping, growth : of the next step.
    """

    x: Floats
    steps: int
    damping: float
    growth: float


@dataclass(frozen=True, eq=False)
class Solution:
    """The end of a solve.

    Parameters
    ----------
    x : (size,) unknowns: those of the last step taken, whatever came after.
    end : why it ended.
    status : one sentence for people.
    steps : one entry per factorisation.
    state : to go on from.
    blocked : elements the guard refused in the last step, empty where it did not.
    memory : largest memory of a factorisation, MiB.
    """

    x: Floats
    end: End
    status: str
    steps: tuple[Step, ...]
    state: State
    blocked: Indices
    memory: float = 0.0

    @property
    def converged(self) -> bool:
        """Whether every goal reached the tolerance."""
        return self.end is End.CONVERGED

    def require(self) -> Solution:
        """Itself, or SolveError with the status sentence when it did not converge."""
        if not self.converged:
            raise SolveError(self.status.rstrip("."))
        return self

    def report(self) -> str:
        """The full history as a table: a line per step, energies by term."""
        return history(self.status, self.steps)


def history(status: str, steps: tuple[Step, ...]) -> str:
    """The status, then a line per step: energy, its parts by term, damping, length, seconds."""
    names = list(steps[0].energies) if steps else []
    titles = ["step", "energy", *names, "damping", "length", "s"]
    rows = [
        [
            f"{number}{'' if step.accepted else ' refused'}",
            f"{step.energy:.3e}",
            *(f"{step.energies[name]:.3e}" for name in names),
            f"{step.damping:.1e}",
            f"{step.length:g}",
            f"{step.seconds:.3f}",
        ]
        for number, step in enumerate(steps, start=1)
    ]
    widths = [max(map(len, column)) for column in zip(titles, *rows, strict=True)]
    lines = ["  ".join(c.rjust(w) for c, w in zip(r, widths, strict=True)) for r in (titles, *rows)]
    return "\n".join([status, *lines]) if steps else status
