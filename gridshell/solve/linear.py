"""The only door to sparse linear algebra: assemble JtJ into a kept pattern, factor, solve.

The pattern of JtJ is found once. Each step scatters the element matrices into it and refactors:
PARDISO where it is installed (its analysis is kept), SciPy's SuperLU elsewhere; same results.
"""

from __future__ import annotations

import os
import sys
from collections.abc import Sequence
from pathlib import Path
from typing import Protocol

import numpy as np
from scipy.sparse import csc_matrix, csr_matrix, triu
from scipy.sparse.linalg import splu

from gridshell.arrays import Floats, Indices
from gridshell.errors import SolveError
from gridshell.solve.constraint import Evaluation, Pattern

_ONE_THREAD_BELOW = 20_000
"""Unknowns below which a second thread costs more than it gives."""


class NormalEquations:
    """The upper triangle of ``J^T W J`` and ``J^T W r`` with a constant pattern.

    Parameters
    ----------
    size : number of unknowns.
    patterns : one per term.
    fixed : (k,) unknowns left out; their step is zero.
    """

    def __init__(self, size: int, patterns: Sequence[Pattern], fixed: Indices) -> None:
        self.size = size
        self.free = np.setdiff1d(np.arange(size), fixed)
        reduced = np.full(size, -1, dtype=np.int64)
        reduced[self.free] = np.arange(len(self.free))
        self._columns = [reduced[p.columns] for p in patterns]
        self._build_pattern()

    def _build_pattern(self) -> None:
        n = len(self.free)
        diagonal = np.arange(n) * (n + 1)
        keys = [_pair_keys(columns, n) for columns in self._columns]
        unique, inverse = np.unique(
            np.concatenate([diagonal, *(k.ravel() for k in keys)]), return_inverse=True
        )
        trash = unique[0] == -1
        if trash:
            unique, inverse = unique[1:], inverse - 1
        self.nonzeros = len(unique)
        inverse = np.where(inverse < 0, self.nonzeros, inverse).astype(np.int32)
        self._diagonal = inverse[:n]
        stops = n + np.cumsum([k.size for k in keys])
        self._targets = np.split(inverse[n:], stops[:-1] - n) if keys else []
        self.indices = (unique % n).astype(np.int32)
        self.indptr = np.searchsorted(unique, np.arange(n + 1) * n).astype(np.int32)

    def assemble(
        self, evaluations: Sequence[Evaluation], weights: Sequence[float]
    ) -> tuple[Floats, Floats]:
        """Entries of the upper triangle, (nonzeros,), and the gradient, (free,)."""
        data = np.zeros(self.nonzeros + 1)
        gradient = np.zeros(len(self.free) + 1)
        for e, w, columns, targets in zip(
            evaluations, weights, self._columns, self._targets, strict=True
        ):
            i, j = np.triu_indices(columns.shape[1])
            products = np.einsum("mri,mri->mi", e.values[:, :, i], e.values[:, :, j])
            data += np.bincount(targets, products.ravel() * w, minlength=len(data))
            pull = np.einsum("mrk,mr->mk", e.values, e.residual)
            gradient += np.bincount(
                np.where(columns < 0, len(self.free), columns).ravel(),
                pull.ravel() * w,
                minlength=len(gradient),
            )
        return data[:-1], gradient[:-1]

    def damped(self, data: Floats, damping: float) -> Floats:
        """*data* with *damping* added to the diagonal."""
        result = data.copy()
        result[self._diagonal] += damping
        return result

    def expand(self, step: Floats) -> Floats:
        """A step of the free unknowns as a step of all, (size,)."""
        full = np.zeros(self.size)
        full[self.free] = step
        return full


def _pair_keys(columns: Indices, n: int) -> Indices:
    i, j = np.triu_indices(columns.shape[1])
    a, b = columns[:, i], columns[:, j]
    keys = np.minimum(a, b) * n + np.maximum(a, b)
    return np.where((a < 0) | (b < 0), -1, keys)


class Factorisation(Protocol):
    """A symmetric positive definite solver whose pattern never changes."""

    def solve(self, data: Floats, right: Floats) -> Floats:
        """Factor the matrix with entries *data* and solve for *right*."""

    def close(self) -> None:
        """Give back the memory."""


def factorisation(equations: NormalEquations, *, portable: bool = False) -> Factorisation:
    """PARDISO where it is installed, SuperLU elsewhere or when *portable* is asked for."""
    if not portable and len(equations.free):
        try:
            return _Pardiso(equations)
        except ImportError:
            pass
    return _SuperLU(equations)


class _Pardiso:
    """MKL PARDISO, symmetric positive definite, analysis kept between factorisations."""

    def __init__(self, equations: NormalEquations) -> None:
        _point_to_mkl()
        from pypardiso import PyPardisoSolver

        self._solver = PyPardisoSolver(mtype=2)
        n = len(equations.free)
        self._matrix = csr_matrix(
            (np.ones(equations.nonzeros), equations.indices, equations.indptr), shape=(n, n)
        )
        self._analysed = False

    def solve(self, data: Floats, right: Floats) -> Floats:
        from pypardiso.pardiso_wrapper import PyPardisoError

        self._matrix.data[:] = data
        phases = (22, 33) if self._analysed else (11, 22, 33)
        result = right
        library = self._solver.libmkl
        before = library.MKL_Set_Num_Threads_Local(1) if len(right) < _ONE_THREAD_BELOW else None
        try:
            for phase in phases:
                self._solver.set_phase(phase)
                result = self._solver._call_pardiso(self._matrix, right)
        except PyPardisoError as error:
            raise SolveError("The linear system could not be factored", value=str(error)) from error
        finally:
            if before is not None:
                library.MKL_Set_Num_Threads_Local(before)
        self._analysed = True
        return np.asarray(result)

    def close(self) -> None:
        self._solver.free_memory(everything=True)


def _point_to_mkl() -> None:
    """Tell pypardiso where MKL lies: its own search walks the whole environment (0.4 s)."""
    if "PYPARDISO_MKL_RT" not in os.environ:
        for folder in ("lib", "Library/bin"):
            for library in sorted(Path(sys.prefix, folder).glob("*mkl_rt*")):
                os.environ["PYPARDISO_MKL_RT"] = str(library)
                return


class _SuperLU:
    """SciPy's SuperLU in symmetric mode on the full matrix."""

    def __init__(self, equations: NormalEquations) -> None:
        n = len(equations.free)
        order = np.arange(equations.nonzeros, dtype=np.float64)
        upper = csr_matrix((order + 1.0, equations.indices, equations.indptr), shape=(n, n))
        self._full = csc_matrix(upper + triu(upper, k=1).T)
        self._source = self._full.data.astype(np.int64) - 1

    def solve(self, data: Floats, right: Floats) -> Floats:
        self._full.data = data[self._source]
        try:
            factor = splu(
                self._full,
                permc_spec="MMD_AT_PLUS_A",
                diag_pivot_thresh=0.0,
                options={"SymmetricMode": True},
            )
        except RuntimeError as error:
            raise SolveError("The linear system could not be factored", value=str(error)) from error
        return np.asarray(factor.solve(right))

    def close(self) -> None:
        """SuperLU keeps nothing."""
