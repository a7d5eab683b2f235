"""The solver: constraints and terms make a problem, Levenberg-Marquardt solves it."""

from gridshell.solve.constraint import Constraint, Evaluation, Pattern
from gridshell.solve.levenberg_marquardt import Progress, Stop, solve
from gridshell.solve.problem import Problem, Term, Weight
from gridshell.solve.solution import Solution, Step
from gridshell.solve.unknowns import columns_of

__all__ = [
    "Constraint",
    "Evaluation",
    "Pattern",
    "Problem",
    "Progress",
    "Solution",
    "Step",
    "Stop",
    "Term",
    "Weight",
    "columns_of",
    "solve",
]
