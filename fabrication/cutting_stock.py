"""Pieces from bars, with as few bars as there can be: one-dimensional cutting stock.

Column generation (Gilmore and Gomory, Operations Research 9, 1961): a linear programme over
patterns, ways to cut a bar, to which the pattern that its prices find best is added until none is
worth more than a bar. That pattern is a knapsack, solved exactly by dynamic programming over
tenths of a millimetre. An integer programme over the patterns found gives the plan.

The bound is Farley's (Operations Research 38, 1990): with prices that no pattern exceeds by more
than a factor, their sum over that factor. There lengths are rounded down to the tenth, in patterns
they are rounded up: the plan can be cut, and the bound holds, whatever the lengths are.
"""

from __future__ import annotations

import time
from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np
from scipy.optimize import Bounds, LinearConstraint, linprog, milp
from scipy.sparse import csc_array

from fabrication.bars import ROUNDING, Bar, BarPiece, BarPlan, CutBar, require_fit
from gridshell.arrays import Floats, Indices, Mask

_PER_MM = 10.0
"""Steps of the knapsack per mm."""

_ENOUGH = 1e-7
"""A pattern must be worth more than a bar by this."""

_MANY_PATTERNS = 20_000
"""Up to so many, all are listed where those of the linear programme do not close the gap."""

_MANY_SIZES = 300
"""Beyond so many sizes the patterns are not listed."""


def cut_bars(
    pieces: Sequence[BarPiece],
    bar: Bar,
    *,
    seconds: float = 20.0,
    known: Sequence[Sequence[str]] = (),
) -> BarPlan:
    """Cut all *pieces* from as few bars as possible.

    Parameters
    ----------
    seconds : after which the best plan and the best bound so far are returned.
    known : a plan to start from, as marks of all pieces bar by bar.

    Raises
    ------
    StockError
        For a piece longer than the bar between its trims; the longest is named.
    """
    require_fit(pieces, bar)
    if not pieces:
        return BarPlan(bar, (), 0)
    deadline = time.monotonic() + seconds
    demand = _demand(pieces, bar)
    start = _first_fit(demand)
    if known and len(known) < len(start):
        start = _counted(known, pieces, demand)
    best, bound = start, _bare(demand)
    if bound < len(best):
        best = start = _better(best, _fullest(demand))
    if bound < len(best):
        generated, bound = _generated(demand, start, deadline)
        best = _better(best, _whole(demand, generated, deadline))
    if bound < len(best) and time.monotonic() < deadline:
        listed = _all_patterns(demand)
        if listed is not None:
            found, proven = _whole_with_bound(demand, listed, deadline)
            best, bound = _better(best, found), max(bound, proven)
    return BarPlan(bar, _assigned(best, demand, pieces, bar), min(bound, len(best)))


@dataclass(frozen=True, eq=False)
class _Demand:
    """Distinct lengths, the longest first, each with one kerf; how many of each are wanted."""

    sizes: Floats
    wanted: Indices
    members: tuple[tuple[int, ...], ...]
    room: float


def _demand(pieces: Sequence[BarPiece], bar: Bar) -> _Demand:
    """Pieces equal to a thousandth of a mm are one size, as long as the longest of them."""
    groups: dict[int, list[int]] = {}
    for i in sorted(range(len(pieces)), key=lambda i: (-pieces[i].length, pieces[i].mark)):
        groups.setdefault(round(pieces[i].length * 1e3), []).append(i)
    members = tuple(tuple(group) for group in groups.values())
    sizes = np.array([pieces[group[0]].length for group in members]) + bar.kerf
    wanted = np.array([len(group) for group in members])
    return _Demand(sizes, wanted, members, bar.room + bar.kerf + ROUNDING)


def _counted(
    known: Sequence[Sequence[str]], pieces: Sequence[BarPiece], demand: _Demand
) -> list[Indices]:
    """Patterns of a plan given by marks."""
    size = {pieces[i].mark: k for k, group in enumerate(demand.members) for i in group}
    kinds = len(demand.sizes)
    return [np.bincount([size[mark] for mark in marks], minlength=kinds) for marks in known]


def _bare(demand: _Demand) -> int:
    """Bars for the bare length of all pieces."""
    return int(np.ceil(demand.sizes @ demand.wanted / demand.room - ROUNDING))


def _first_fit(demand: _Demand) -> list[Indices]:
    """Patterns of first-fit decreasing, one per bar, each (k,) counts per size."""
    free: list[float] = []
    filled: list[Indices] = []
    for k, (size, wanted) in enumerate(zip(demand.sizes, demand.wanted, strict=True)):
        for _ in range(wanted):
            here = next((b for b, room in enumerate(free) if room >= size), len(free))
            if here == len(free):
                free.append(demand.room)
                filled.append(np.zeros(len(demand.sizes), dtype=np.int64))
            free[here] -= size
            filled[here][k] += 1
    return filled


def _fullest(demand: _Demand) -> list[Indices]:
    """Patterns bar by bar, each filled as far as the pieces that are left allow, to a mm."""
    left = demand.wanted.copy()
    steps = np.ceil(demand.sizes - ROUNDING).astype(np.int64)
    room = int(demand.room)
    filled: list[Indices] = []
    while left.any():
        counts = _knapsack(steps, demand.sizes * (left > 0), left, room)
        if not counts.any():
            counts = np.zeros_like(left)
            counts[np.flatnonzero(left)[0]] = 1
        left -= counts
        filled.append(counts)
    return filled


# ---- linear programme ---------------------------------------------------------------------------


def _generated(demand: _Demand, start: Sequence[Indices], deadline: float) -> tuple[Indices, int]:
    """(m, k) patterns of the linear programme, and a bound for the number of bars."""
    own = np.eye(len(demand.sizes), dtype=np.int64)
    alone = np.minimum(demand.wanted, np.floor(demand.room / demand.sizes)).astype(np.int64)
    patterns = [*(own * alone[:, None]), *start]
    bound = float(_bare(demand))
    up = np.ceil(demand.sizes * _PER_MM - 1e-6).astype(np.int64)
    down = np.floor(demand.sizes * _PER_MM + 1e-9).astype(np.int64)
    room = int(np.floor(demand.room * _PER_MM))
    while time.monotonic() < deadline:
        columns = np.array(patterns)
        solved = linprog(
            np.ones(len(columns)), A_ub=-csc_array(columns.T.astype(float)), b_ub=-demand.wanted
        )
        prices = np.maximum(-solved.ineqlin.marginals, 0.0)
        found = _knapsack(up, prices, demand.wanted, room)
        if found @ prices <= 1.0 + _ENOUGH:
            loose = _knapsack(down, prices, demand.wanted, room) @ prices
            farley = prices @ demand.wanted / max(loose, 1.0)
            bound = max(bound, np.ceil(farley - 1e-6))
            break
        patterns.append(found)
    return np.unique(np.array(patterns), axis=0), int(bound)


def _knapsack(sizes: Indices, values: Floats, wanted: Indices, room: int) -> Indices:
    """(k,) counts of the most valuable pattern: sum of sizes <= room, counts <= wanted."""
    items = [k for k in np.flatnonzero(values > 1e-12).tolist() if sizes[k] <= room]
    best = np.zeros(room + 1)
    taken: list[tuple[int, Mask]] = []
    for k in items:
        size = int(sizes[k])
        for _ in range(min(int(wanted[k]), room // size)):
            raised = best[:-size] + values[k]
            better = raised > best[size:] + 1e-12
            if not better.any():
                break
            best[size:] = np.where(better, raised, best[size:])
            taken.append((k, better))
    counts = np.zeros(len(sizes), dtype=np.int64)
    free = room
    for k, better in reversed(taken):
        size = int(sizes[k])
        if free >= size and better[free - size]:
            counts[k] += 1
            free -= size
    return counts


# ---- integer programme --------------------------------------------------------------------------


def _better(best: list[Indices], found: list[Indices] | None) -> list[Indices]:
    return best if found is None or len(found) >= len(best) else found


def _whole(demand: _Demand, patterns: Indices, deadline: float) -> list[Indices] | None:
    return _whole_with_bound(demand, patterns, deadline)[0]


def _whole_with_bound(
    demand: _Demand, patterns: Indices, deadline: float
) -> tuple[list[Indices] | None, int]:
    """One pattern per bar, the best choice of *patterns*; and the bound for that choice."""
    left = max(deadline - time.monotonic(), 0.1)
    solved = milp(
        np.ones(len(patterns)),
        constraints=LinearConstraint(csc_array(patterns.T.astype(float)), lb=demand.wanted),
        integrality=np.ones(len(patterns)),
        bounds=Bounds(0.0, np.inf),
        options={"time_limit": left, "mip_rel_gap": 0.0},
    )
    bound = 0 if solved.mip_dual_bound is None else int(np.ceil(solved.mip_dual_bound - 1e-6))
    if solved.x is None:
        return None, bound
    repeats = np.round(solved.x).astype(np.int64)
    return list(np.repeat(patterns, repeats, axis=0)), bound


def _all_patterns(demand: _Demand) -> Indices | None:
    """Every pattern that no further piece fits into; None where there are too many."""
    if len(demand.sizes) > _MANY_SIZES:
        return None
    found: list[Indices] = []
    for counts in _extended(demand, 0, demand.room, np.zeros(len(demand.sizes), dtype=np.int64)):
        found.append(counts)
        if len(found) > _MANY_PATTERNS:
            return None
    return np.array(found)


def _extended(demand: _Demand, first: int, room: float, counts: Indices) -> Iterator[Indices]:
    """Patterns with *counts* of the sizes before *first*, and more of the others in *room*."""
    fits = np.flatnonzero(demand.sizes[first:] <= room) + first
    if not len(fits):
        yield counts
        return
    k = int(fits[0])
    most = min(int(demand.wanted[k]), int(room // demand.sizes[k]))
    for count in range(most, -1, -1):
        more = counts.copy()
        more[k] = count
        yield from _extended(demand, k + 1, room - count * demand.sizes[k], more)


# ---- the plan -----------------------------------------------------------------------------------


def _assigned(
    patterns: Sequence[Indices], demand: _Demand, pieces: Sequence[BarPiece], bar: Bar
) -> tuple[CutBar, ...]:
    """Hand out the pieces; what a pattern has too many of is left out."""
    waiting = [list(group) for group in demand.members]
    ordered = sorted(patterns, key=lambda counts: tuple(-counts))
    cut: list[CutBar] = []
    for counts in ordered:
        mine = []
        for k in np.flatnonzero(counts).tolist():
            mine += [waiting[k].pop(0) for _ in range(min(int(counts[k]), len(waiting[k])))]
        if mine:
            cut.append(CutBar(len(cut) + 1, bar, tuple(pieces[i] for i in mine)))
    return tuple(cut)
