"""What solves of equal pattern share: those of a slider, or of a sweep over angles."""

from __future__ import annotations

from collections.abc import Sequence
from types import TracebackType

import numpy as np

from gridshell.arrays import Indices
from gridshell.solve.constraint import Pattern
from gridshell.solve.linear import Engine, Factorisation, NormalEquations, factorisation


class Workspace:
    """Keeps the pattern and the analysis of the last solve for the next one.

    A solve whose terms see the same unknowns goes on with them; another one replaces them. What is
    found is the same to the last bit either way. One solve at a time: not for two threads at once.
    As a context manager it gives its memory back at the end.

    Examples
    --------
    >>> with Workspace() as kept:  # doctest: +SKIP
    ...     nets = [optimize(start, a_net(angle=a), anchor=Free(), workspace=kept) for a in angles]
    """

    def __init__(self) -> None:
        self._key: tuple[int, Engine] | None = None
        self._columns: list[Indices] = []
        self._kept: tuple[NormalEquations, Factorisation] | None = None

    def prepared(
        self, size: int, patterns: Sequence[Pattern], fixed: Indices, engine: Engine
    ) -> tuple[NormalEquations, Factorisation]:
        """Equations and factorisation for *patterns*, kept ones where these are the same.

        Parameters
        ----------
        size : number of unknowns.
        patterns : one per term.
        fixed : (k,) unknowns left out.
        """
        columns = [*(p.columns for p in patterns), fixed]
        key = (size, engine)
        if self._kept is None or key != self._key or not _equal(columns, self._columns):
            self.close()
            equations = NormalEquations(size, patterns, fixed)
            self._kept = (equations, factorisation(equations, engine))
            self._key, self._columns = key, [own.copy() for own in columns]
        return self._kept

    def close(self) -> None:
        """Give back the memory."""
        if self._kept is not None:
            self._kept[1].close()
            self._kept = None

    def __enter__(self) -> Workspace:
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        self.close()


def _equal(columns: Sequence[Indices], kept: Sequence[Indices]) -> bool:
    return len(columns) == len(kept) and all(map(np.array_equal, columns, kept))
