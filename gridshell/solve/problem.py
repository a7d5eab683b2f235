"""A problem is a list of weighted terms; weights live here only."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Protocol

import numpy as np

from gridshell.arrays import Floats, Indices
from gridshell.errors import SettingError
from gridshell.solve.constraint import Constraint


@dataclass(frozen=True)
class Weight:
    """The weight of a squared residual, lowered from step to step.

    Parameters
    ----------
    start : weight of the first step.
    decay : factor per step, in (0, 1].
    floor : the weight never falls below this.

    Raises
    ------
    SettingError
        For a weight that is not positive or a decay outside (0, 1].
    """

    start: float
    decay: float = 1.0
    floor: float = 0.0

    def __post_init__(self) -> None:
        if not (np.isfinite(self.start) and self.start > 0.0):
            raise SettingError("A weight must be positive", value=f"{self.start}", limit="> 0")
        if not 0.0 < self.decay <= 1.0:
            raise SettingError("A decay must lie in (0, 1]", value=f"{self.decay}")
        if not 0.0 <= self.floor <= self.start:
            raise SettingError(
                "A weight's floor must lie between 0 and its start", value=f"{self.floor}"
            )

    def at(self, step: int) -> float:
        """The weight at *step* (0 is the first)."""
        return max(self.start * self.decay**step, self.floor)


@dataclass(frozen=True, eq=False)
class Term:
    """One weighted condition.

    Parameters
    ----------
    name : how the history and the report call it.
    weight : on the squared residuals.
    constraint : the condition.
    goal : the net is judged by it: it must reach the tolerance. Terms that only guide the way
        (fairness, closeness) are not goals.
    """

    name: str
    weight: Weight
    constraint: Constraint
    goal: bool = False


class Guard(Protocol):
    """What no step may break, whatever the energy says."""

    def broken(self, x: Floats) -> Indices:
        """Elements (quads) that *x* (size,) breaks; empty when it is admissible."""


@dataclass(frozen=True, eq=False)
class Problem:
    """All terms over one unknown vector.

    Parameters
    ----------
    size : number of unknowns.
    terms : at least one.
    fixed : (k,) unknowns that keep their value.
    guard : refuses steps; None lets every step pass that lowers the energy.
    """

    size: int
    terms: tuple[Term, ...]
    fixed: Indices
    guard: Guard | None = None
