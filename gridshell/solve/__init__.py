"""The solver: constraints and terms make a problem, Levenberg-Marquardt solves it."""

from gridshell.solve.constraint import Constraint, Evaluation, Pattern
from gridshell.solve.factor import solve_definite
from gridshell.solve.levenberg_marquardt import Progress, Stop, solve
from gridshell.solve.linear import Engine
from gridshell.solve.problem import Guard, Problem, Term, Weight
from gridshell.solve.solution import End, Solution, State, Step, history
from gridshell.solve.unknowns import columns_of
from gridshell.solve.workspace import Workspace

__all__ = [
    "Constraint",
    "End",
    "Engine",
    "Evaluation",
    "Guard",
    "Pattern",
    "Problem",
    "Progress",
    "Solution",
    "State",
    "Step",
    "Stop",
    "Term",
    "Weight",
    "Workspace",
    "columns_of",
    "history",
    "solve",
    "solve_definite",
]
