"""Values known at some vertices, carried to all others as fairly as the lines of the net allow."""

from __future__ import annotations

import numpy as np

from gridshell.arrays import Indices, Points
from gridshell.constraints import Fairness
from gridshell.mesh import ControlMesh
from gridshell.solve import Problem, Stop, Term, Weight, solve
from gridshell.terms import polyline_triples


def spread(control: ControlMesh, known: Points, at: Indices) -> Points:
    """(n, 3) values with the least second differences along the lines that are *known* at *at*."""
    triples = polyline_triples(control)
    fair = Term("fairness", Weight(1.0), Fairness(triples, np.zeros((len(triples), 3))), goal=True)
    fixed = (3 * at[:, None] + np.arange(3)).ravel()
    size = max(float(np.abs(known).max()), 1e-300)
    linear = Stop(steps=1, tolerance=1e-300)
    found = solve(Problem(known.size, (fair,), fixed), known.ravel() / size, linear)
    return found.x.reshape(-1, 3) * size
