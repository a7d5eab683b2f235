"""One sparse positive definite matrix, factored once and solved for many right-hand sides."""

from __future__ import annotations

import numpy as np
from scipy.sparse import csc_matrix, csr_matrix, triu
from scipy.sparse.linalg import splu

from gridshell.arrays import Floats
from gridshell.errors import SolveError
from gridshell.solve.dissection import dissection_order
from gridshell.solve.linear import Engine, pardiso_solve


def solve_definite(matrix: csr_matrix, right: Floats, engine: Engine | None = None) -> Floats:
    """Solve ``matrix @ x = right`` for all columns of *right* (n, k).

    Parameters
    ----------
    matrix : (n, n) symmetric positive definite.

    Raises
    ------
    SolveError
        When the matrix is singular.
    """
    engine = engine or Engine()
    if not engine.portable:
        try:
            return pardiso_solve(csr_matrix(triu(matrix)), right, engine)
        except ImportError:
            pass
    graph = csr_matrix(matrix)
    order = dissection_order(graph)
    try:
        factor = splu(
            csc_matrix(graph[order][:, order]),
            permc_spec="NATURAL",
            diag_pivot_thresh=0.0,
            options={"SymmetricMode": True},
        )
    except RuntimeError as error:
        raise SolveError("The linear system could not be factored", value=str(error)) from error
    result = np.empty_like(right)
    result[order] = factor.solve(np.ascontiguousarray(right[order]))
    if not np.isfinite(result).all():
        raise SolveError("The linear system could not be factored", value="it is singular")
    return result
