"""The only door to sparse linear algebra: assemble JtJ into a kept pattern, factor, solve.

The pattern of JtJ is found once. Each step scatters the element matrices into it and refactors:
PARDISO where it is installed (its analysis is kept), SciPy's SuperLU elsewhere; same results.
:class:`Engine` says which, with how many threads, and whether reruns must agree to the last bit.
"""

from __future__ import annotations

import os
import sys
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import Protocol

import numpy as np
from scipy.sparse import csc_matrix, csr_matrix, triu
from scipy.sparse.linalg import splu

from gridshell.arrays import Floats, Indices
from gridshell.errors import SettingError, SolveError
from gridshell.solve.constraint import Evaluation, Pattern
from gridshell.solve.dissection import dissection_order

_ONE_THREAD_BELOW = 20_000
"""Unknowns below which a second thread costs more than it gives."""

_MIB = 2.0**20


@dataclass(frozen=True)
class Engine:
    """Which program factors the linear systems, and how.

    Parameters
    ----------
    portable : use SciPy alone even where PARDISO is installed.
    threads : for PARDISO; None takes one for small systems and all cores for large ones.
    repeatable : reruns on one machine agree to the last bit, with whatever number of threads; a
        little slower. SciPy's solver always does.

    Raises
    ------
    SettingError
        For fewer than one thread.
    """

    portable: bool = False
    threads: int | None = None
    repeatable: bool = True

    def __post_init__(self) -> None:
        if self.threads is not None and self.threads < 1:
            raise SettingError("At least one thread is needed", where="threads", limit=">= 1")


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
        self._pulled = [np.where(c < 0, len(self.free), c).ravel() for c in self._columns]

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
        self._targets = inverse[n:]
        self._products = np.empty(len(self._targets))
        parts = np.split(self._products, stops[:-1] - n) if keys else []
        self._parts = [part.reshape(k.shape) for part, k in zip(parts, keys, strict=True)]
        self.indices = (unique % n).astype(np.int32)
        self.indptr = np.searchsorted(unique, np.arange(n + 1) * n).astype(np.int32)

    def assemble(
        self, evaluations: Sequence[Evaluation], weights: Sequence[float]
    ) -> tuple[Floats, Floats]:
        """Entries of the upper triangle, (nonzeros,), and the gradient, (free,)."""
        gradient = np.zeros(len(self.free) + 1)
        for e, w, part, pulled in zip(evaluations, weights, self._parts, self._pulled, strict=True):
            _products(e.values, part)
            part *= w
            pull = np.einsum("mrk,mr->mk", e.values, e.residual)
            gradient += np.bincount(pulled, pull.ravel() * w, minlength=len(gradient))
        data = np.bincount(self._targets, self._products, self.nonzeros + 1)
        return np.asarray(data[:-1], dtype=np.float64), gradient[:-1]

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


def _products(values: Floats, into: Floats) -> None:
    """The upper triangle of every element's J^T J, row by row; (m, rows, k) to (m, pairs)."""
    width, at = values.shape[2], 0
    for k in range(width):
        row = into[:, at : at + width - k]
        np.einsum("mr,mri->mi", values[:, :, k], values[:, :, k:], out=row)
        at += width - k


def _pair_keys(columns: Indices, n: int) -> Indices:
    i, j = np.triu_indices(columns.shape[1])
    a, b = columns[:, i], columns[:, j]
    keys = np.minimum(a, b) * n + np.maximum(a, b)
    return np.where((a < 0) | (b < 0), -1, keys)


class Factorisation(Protocol):
    """A symmetric positive definite solver whose pattern never changes."""

    def solve(self, data: Floats, right: Floats) -> Floats:
        """Factor the matrix with entries *data* and solve for *right*."""

    @property
    def memory(self) -> float:
        """Largest memory of a factorisation so far, MiB."""

    def close(self) -> None:
        """Give back the memory."""


def factorisation(equations: NormalEquations, engine: Engine | None = None) -> Factorisation:
    """PARDISO where it is installed, SuperLU elsewhere or when the engine is to be portable."""
    engine = engine or Engine()
    if not engine.portable and len(equations.free):
        try:
            return _Pardiso(equations, engine)
        except ImportError:
            pass
    return _SuperLU(equations)


class _Pardiso:
    """MKL PARDISO, symmetric positive definite, analysis kept between factorisations."""

    def __init__(self, equations: NormalEquations, engine: Engine) -> None:
        _prepare_mkl()
        from pypardiso import PyPardisoSolver

        self._solver = PyPardisoSolver(mtype=2)
        n = len(equations.free)
        threads = engine.threads or (1 if n < _ONE_THREAD_BELOW else os.cpu_count() or 1)
        self._threads = threads
        for place, value in _pardiso_settings(threads, engine).items():
            self._solver.set_iparm(place, value)
        self._matrix = csr_matrix(
            (np.ones(equations.nonzeros), equations.indices, equations.indptr), shape=(n, n)
        )
        self._analysed = False

    def solve(self, data: Floats, right: Floats) -> Floats:
        from pypardiso.pardiso_wrapper import PyPardisoError

        self._matrix.data[:] = data
        phases = (22, 33) if self._analysed else (11, 22, 33)
        result = right
        try:
            with self._limited():
                for phase in phases:
                    self._solver.set_phase(phase)
                    result = self._solver._call_pardiso(self._matrix, right)
                    self._analysed = True
        except PyPardisoError as error:
            raise SolveError("The linear system could not be factored", value=str(error)) from error
        return np.asarray(result)

    @contextmanager
    def _limited(self) -> Iterator[None]:
        """The library's threads in this Python thread, put back afterwards."""
        library = self._solver.libmkl
        before = library.MKL_Set_Num_Threads_Local(self._threads)
        try:
            yield
        finally:
            library.MKL_Set_Num_Threads_Local(before)

    @property
    def memory(self) -> float:
        analysis, kept, factor = self._solver.iparm[14:17].tolist()
        return float(max(analysis, kept + factor)) * 1024.0 / _MIB

    def close(self) -> None:
        self._solver.free_memory(everything=True)


def pardiso_solve(upper: csr_matrix, right: Floats, engine: Engine) -> Floats:
    """Solve for all columns of *right* (n, k) with the upper triangle of a definite matrix.

    Raises
    ------
    ImportError
        Where PARDISO is not installed.
    SolveError
        When the matrix cannot be factored.
    """
    _prepare_mkl()
    from pypardiso import PyPardisoSolver
    from pypardiso.pardiso_wrapper import PyPardisoError

    solver = PyPardisoSolver(mtype=2)
    threads = engine.threads or os.cpu_count() or 1
    for place, value in _pardiso_settings(threads, engine).items():
        solver.set_iparm(place, value)
    solver.set_phase(13)
    upper.sort_indices()
    try:
        result = solver._call_pardiso(upper, np.asfortranarray(right))
    except PyPardisoError as error:
        raise SolveError("The linear system could not be factored", value=str(error)) from error
    finally:
        solver.free_memory(everything=True)
    return np.asarray(result)


def _pardiso_settings(threads: int, engine: Engine) -> dict[int, int]:
    """Parameters by their number in MKL's manual (from one), zero-based column indices."""
    quick = threads > 1 and not engine.repeatable  # with one thread the other way is the faster one
    return {
        1: 1,  # none of the others is a default
        2: 2,  # nested dissection; the parallel one is not repeatable
        18: -1,  # report the size of the factor
        24: 10 if quick else 0,
        34: 0 if quick else threads,
        35: 0,
    }


def _prepare_mkl() -> None:
    """Tell pypardiso where MKL lies, and MKL's threads to sleep between two factorisations.

    Its own search walks the whole environment (0.4 s); threads that spin take a core from all that
    runs meanwhile, a browser that draws the net among it.
    """
    os.environ.setdefault("KMP_BLOCKTIME", "0")
    if "PYPARDISO_MKL_RT" not in os.environ:
        for folder in ("lib", "Library/bin"):
            for library in sorted(Path(sys.prefix, folder).glob("*mkl_rt*")):
                os.environ["PYPARDISO_MKL_RT"] = str(library)
                return


class _SuperLU:
    """SciPy's SuperLU in symmetric mode on the full matrix, in an order of nested dissection."""

    def __init__(self, equations: NormalEquations) -> None:
        n = len(equations.free)
        order = np.arange(equations.nonzeros, dtype=np.float64)
        upper = csr_matrix((order + 1.0, equations.indices, equations.indptr), shape=(n, n))
        full = csr_matrix(upper + triu(upper, k=1).T)
        self._order = _elimination_order(full, equations.free // 3)
        self._full = csc_matrix(full[self._order][:, self._order])
        self._source = self._full.data.astype(np.int64) - 1
        self._memory = 0.0

    def solve(self, data: Floats, right: Floats) -> Floats:
        self._full.data = data[self._source]
        try:
            factor = splu(
                self._full,
                permc_spec="NATURAL",
                diag_pivot_thresh=0.0,
                options={"SymmetricMode": True},
            )
        except RuntimeError as error:
            raise SolveError("The linear system could not be factored", value=str(error)) from error
        self._memory = max(self._memory, factor.nnz * 12.0 / _MIB)
        result = np.empty_like(right)
        result[self._order] = factor.solve(right[self._order])
        return result

    @property
    def memory(self) -> float:
        return self._memory

    def close(self) -> None:
        """SuperLU keeps nothing."""


def _elimination_order(matrix: csr_matrix, points: Indices) -> Indices:
    """An order of the unknowns that keeps the coordinates of a point together.

    Parameters
    ----------
    matrix : (n, n), symmetric.
    points : (n,) the point each unknown belongs to, rising.
    """
    _, block = np.unique(points, return_inverse=True)
    rows = np.repeat(block, np.diff(matrix.indptr))
    size = int(block.max(initial=-1)) + 1
    ones = np.ones(matrix.nnz, dtype=np.int8)
    graph = csr_matrix((ones, (rows, block[matrix.indices])), shape=(size, size))
    rank = np.empty(size, dtype=np.int64)
    rank[dissection_order(graph)] = np.arange(size)
    return np.argsort(rank[block], kind="stable")
