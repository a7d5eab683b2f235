"""Arrays for a page: metres around a centre, single precision, as text."""

from __future__ import annotations

import base64
from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from gridshell.arrays import Floats, Indices, Points

Packed = dict[str, Any]

_KINDS = {"f4": "<f4", "u1": "u1", "u2": "<u2", "u4": "<u4"}


def packed(values: Any, kind: str) -> Packed:
    """An array of any shape as text: numbers of *kind* f4, u1, u2 or u4, row by row."""
    raw = np.ascontiguousarray(values, dtype=_KINDS[kind]).tobytes()
    return {"kind": kind, "bytes": base64.b64encode(raw).decode()}


def on_screen(points: Points, centre: Floats) -> NDArray[np.float32]:
    """*points* (n, 3) mm as metres from *centre* (3,), in single precision."""
    return np.asarray((np.asarray(points) - centre) / 1e3, dtype=np.float32)


def runs(numbers: Indices) -> Packed:
    """Numbers (m,) as runs of equal ones: which, and how long."""
    starts = np.flatnonzero(np.r_[len(numbers) > 0, np.diff(numbers) != 0])
    lengths = np.diff(np.r_[starts, len(numbers)])
    return {"numbers": numbers[starts].tolist(), "lengths": lengths.tolist()}


def runs_of_pairs(counts: Sequence[int]) -> Indices:
    """(m, 2) neighbours in lines of so many points each, one line after the other."""
    numbers = np.arange(sum(counts))
    last = np.cumsum(counts) - 1
    first = np.delete(numbers, last)
    return np.stack([first, first + 1], axis=1)
