"""What a solve returns: the point, a sentence, the history."""

from __future__ import annotations

from dataclasses import dataclass
from types import MappingProxyType

from gridshell.arrays import Floats
from gridshell.errors import SolveError


@dataclass(frozen=True)
class Step:
    """One factorisation.

    Parameters
    ----------
    energy : weighted sum of squares before the step, at this step's weights.
    residuals : largest absolute residual of each term after the step.
    damping : added to the diagonal.
    accepted : whether the step lowered the energy and was taken.
    """

    energy: float
    residuals: MappingProxyType[str, float]
    damping: float
    accepted: bool


@dataclass(frozen=True, eq=False)
class Solution:
    """The end of a solve.

    Parameters
    ----------
    x : (size,) unknowns.
    converged : whether every goal reached the tolerance.
    status : one sentence for people.
    steps : one entry per factorisation.
    """

    x: Floats
    converged: bool
    status: str
    steps: tuple[Step, ...]

    def require(self) -> Solution:
        """Itself, or SolveError with the status sentence when it did not converge."""
        if not self.converged:
            raise SolveError(self.status.rstrip("."))
        return self
