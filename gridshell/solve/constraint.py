"""The contract between a condition and the solver: three questions.

``pattern()``        which unknowns does each element of the condition see? (asked once)
``lag(x)``           what does one step hold still? (foot points, tangent lines; None if nothing)
``evaluate(x, lag)`` the residuals and their derivatives at x.

A constraint is dimensionless at unit mean edge and carries no weight: weights live in the problem.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, Protocol

from gridshell.arrays import Floats, Indices


@dataclass(frozen=True, eq=False)
class Pattern:
    """Sparsity, constant over the solve.

    Parameters
    ----------
    columns : (m, k) unknowns seen by each of m elements.
    rows : residuals per element.
    """

    columns: Indices
    rows: int


@dataclass(frozen=True, eq=False)
class Evaluation:
    """What a constraint says at one point.

    Parameters
    ----------
    residual : (m, rows) dimensionless residuals.
    values : (m, rows, k) their derivatives by the pattern's columns.
    """

    residual: Floats
    values: Floats


class Constraint(Protocol):
    """One condition over all its elements."""

    def pattern(self) -> Pattern:
        """The constant sparsity."""

    def lag(self, x: Floats) -> Any:
        """What one step holds still; None when the derivatives are exact."""

    def evaluate(self, x: Floats, lag: Any) -> Evaluation:
        """Residuals and derivatives at *x* (size,)."""
