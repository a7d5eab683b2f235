"""Where strips longer than a bar are spliced: positions and bars chosen together.

Bars are filled one after the other. For each the best set of next pieces is found, at most one per
strip, by dynamic programming over lengths: what fills the bar, less a price for every splice beyond
the fewest its strip needs. The pieces so found are then cut by ``cutting_stock``. Several prices
give several plans: few splices, or few bars.

Two neighbouring strips of a family are not spliced in the same bay. Where nothing else is left,
they are, and a finding says so.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from enum import Enum
from itertools import pairwise

import numpy as np

from fabrication.bars import ROUNDING, Bar, BarPiece, BarPlan
from fabrication.cutting_stock import cut_bars
from fabrication.errors import StockError
from fabrication.finding import Finding, Severity
from gridshell.arrays import Floats, Indices, Mask

Bay = tuple[int, int]

_STEP = 5.0
"""Of the lengths while positions are chosen, mm."""

_CANDIDATES = 60
"""Strips that are considered for one bar."""

_FULL = 0.997
"""A bar filled by so much is full: no further strip is tried."""

_PRICES = (np.inf, 2000.0, 1000.0, 500.0, 200.0, 50.0, 0.0)
"""Of a splice beyond the fewest, mm of bar."""

_PER_PIECE = 1.0
"""Mm of bar a piece more in a bar costs: of two equally full bars the one with longer pieces."""


@dataclass(frozen=True)
class Place:
    """Where a strip may be spliced: *x* from its cut end, mm, in a *bay*.

    A bay is named after the two axes that bound it; the same bay of a neighbour has the same name.
    """

    x: float
    bay: Bay


@dataclass(frozen=True)
class Run:
    """A strip that is cut from bars.

    Parameters
    ----------
    mark : the strip's.
    length : mm.
    places : where it may be spliced, in order.
    neighbours : marks of strips that must not be spliced in the same bay.
    """

    mark: str
    length: float
    places: tuple[Place, ...] = ()
    neighbours: tuple[str, ...] = ()


@dataclass(frozen=True)
class SplicePlan:
    """Splices of all strips, and the bars their pieces are cut from.

    Parameters
    ----------
    splices : of every spliced strip by its mark, in order along it.
    bars : how the pieces are cut; a piece of a spliced strip has the mark "A3.1", "A3.2", ...
    floor : no choice of splices can do with fewer bars.
    gap : between the ends of two pieces, mm.
    findings : splices of neighbours in one bay.
    """

    splices: Mapping[str, tuple[Place, ...]]
    bars: BarPlan
    floor: int
    gap: float
    findings: tuple[Finding, ...] = field(default=())

    @property
    def count(self) -> int:
        """Number of splices."""
        return sum(len(places) for places in self.splices.values())


class Splices(Enum):
    """What to prefer among the plans of :func:`tradeoff`."""

    FEW = "few"
    BALANCED = "balanced"
    FEW_BARS = "few bars"


def tradeoff(
    runs: Sequence[Run], bar: Bar, *, gap: float = 1.0, shortest: float = 500.0
) -> tuple[SplicePlan, ...]:
    """Plans with ever more splices and ever fewer bars; none is beaten by another in both.

    Parameters
    ----------
    gap : between the ends of two pieces, mm.
    shortest : no piece of a spliced strip is shorter, mm, unless there is no other way.

    Raises
    ------
    StockError
        For a strip with a length between two places to splice that no bar can hold.
    """
    ways = [_ways(run, bar, gap, shortest) for run in runs]
    floor = _floor(runs, bar, gap)
    plans: list[SplicePlan] = []
    for price in _PRICES:
        chosen = _chosen(ways, bar, price)
        if not any(same == chosen for same in (dict(p.splices) for p in plans)):
            plans.append(_plan(runs, chosen, bar, gap, floor))
    plans.sort(key=lambda plan: (plan.count, plan.bars.bars))
    front: list[SplicePlan] = []
    for plan in plans:
        if not front or plan.bars.bars < front[-1].bars.bars:
            front.append(plan)
    return tuple(front)


def preferred(front: Sequence[SplicePlan], splices: Splices) -> SplicePlan:
    """One of the plans of :func:`tradeoff`.

    BALANCED is nearest to the fewest splices and the fewest bars at once, both measured by their
    ranges.
    """
    if splices is Splices.FEW:
        return front[0]
    if splices is Splices.FEW_BARS:
        return front[-1]
    counts = np.array([(plan.count, plan.bars.bars) for plan in front], dtype=float)
    span = np.maximum(np.ptp(counts, axis=0), 1.0)
    return front[int(np.argmin(np.linalg.norm((counts - counts.min(axis=0)) / span, axis=1)))]


def naive(
    runs: Sequence[Run], bar: Bar, *, gap: float = 1.0, shortest: float = 500.0
) -> SplicePlan:
    """Every piece as long as possible: what :func:`tradeoff` is compared with."""
    chosen = {}
    for way in (_ways(run, bar, gap, shortest) for run in runs):
        at, places = 0, []
        while at != len(way.x) - 1:
            at = int(way.options(at)[-1])
            places.append(at)
        chosen[way.run.mark] = tuple(way.run.places[k - 1] for k in places[:-1])
    return _plan(runs, chosen, bar, gap, _floor(runs, bar, gap))


# ---- ways to cut a strip ------------------------------------------------------------------------


@dataclass(frozen=True, eq=False)
class _Way:
    """Ends and places of a run: *x* (k,), and *fewest* (k,) pieces from each to the end."""

    run: Run
    x: Floats
    fits: Mask
    fewest: Floats

    def options(self, at: int) -> Indices:
        """Where a piece that begins at *at* may end, so that the rest can be cut, too."""
        return np.flatnonzero(self.fits[at] & np.isfinite(self.fewest))

    def sizes(self, at: int, ends: Indices, gap: float) -> Floats:
        """Lengths of these pieces, mm."""
        cut = (at > 0) + (ends < len(self.x) - 1).astype(float)
        return np.asarray(self.x[ends] - self.x[at] - cut * gap / 2.0)


def _ways(run: Run, bar: Bar, gap: float, shortest: float) -> _Way:
    for least in (shortest, 0.0):
        way = _graph(run, bar, gap, least)
        if np.isfinite(way.fewest[0]):
            return way
    span = np.diff(way.x)
    k = int(np.argmax(span))
    raise StockError(
        "A strip cannot be spliced so that its pieces fit the stock",
        where=f"{run.mark}, from {way.x[k]:.0f} to {way.x[k + 1]:.0f} mm",
        value=f"{span[k]:.1f} mm without a place for a splice",
        limit=f"{bar.room:.1f} mm between the trims of a bar of {bar.length:g} mm",
        advice="a longer bar or coil, or a shorter splice plate",
    )


def _graph(run: Run, bar: Bar, gap: float, shortest: float) -> _Way:
    x = np.r_[0.0, [place.x for place in run.places], run.length]
    last = len(x) - 1
    inner = (np.arange(last + 1) > 0) & (np.arange(last + 1) < last)
    size = x[None, :] - x[:, None] - gap / 2.0 * (inner[None, :] + inner[:, None].astype(float))
    fits = (size > 0.0) & (size <= bar.room + ROUNDING) & (size >= min(shortest, run.length))
    fewest = np.full(last + 1, np.inf)
    fewest[last] = 0.0
    for k in range(last - 1, -1, -1):
        fewest[k] = 1.0 + np.min(np.where(fits[k], fewest, np.inf))
    return _Way(run, x, fits, fewest)


def _floor(runs: Sequence[Run], bar: Bar, gap: float) -> int:
    """Bars for the bare length of all strips, each with at least one cut."""
    saved = max(gap - bar.kerf, 0.0)
    whole = sum(run.length + bar.kerf - saved * len(run.places) for run in runs)
    return int(np.ceil(whole / (bar.room + bar.kerf) - ROUNDING))


# ---- bar by bar ---------------------------------------------------------------------------------


@dataclass(frozen=True, eq=False)
class _Options:
    """Next pieces of one strip: where they end, steps of length they take, what they are worth."""

    strip: int
    ends: Indices
    steps: Indices
    values: Floats


def _chosen(ways: Sequence[_Way], bar: Bar, price: float) -> dict[str, tuple[Place, ...]]:
    """Places of the splices of every spliced strip."""
    at = [0] * len(ways)
    places: dict[str, list[Place]] = {}
    whole = range(len(ways))
    while open_ := [i for i in whole if at[i] < len(ways[i].x) - 1]:
        for i, end in _filled(ways, open_, at, places, bar, price):
            at[i] = end
            if end < len(ways[i].x) - 1:
                places.setdefault(ways[i].run.mark, []).append(ways[i].run.places[end - 1])
    return {way.run.mark: tuple(places.get(way.run.mark, ())) for way in ways}


def _filled(
    ways: Sequence[_Way],
    open_: Sequence[int],
    at: Sequence[int],
    places: Mapping[str, Sequence[Place]],
    bar: Bar,
    price: float,
) -> list[tuple[int, int]]:
    """Strips and where their next pieces end, for one bar."""
    some = sorted(open_, key=lambda i: (ways[i].x[at[i]] - ways[i].run.length, ways[i].run.mark))
    if len(some) > _CANDIDATES:
        some = some[: _CANDIDATES // 2] + some[-(_CANDIDATES // 2) :]
    taken = {mark: {place.bay for place in here} for mark, here in places.items()}
    groups = [_options(ways[i], i, at[i], taken, bar, price) for i in some]
    while True:
        found = _best_set(groups, int((bar.room + bar.kerf + ROUNDING) // _STEP))
        clash = _clash(ways, found)
        if clash is None:
            return found
        groups = [group for group in (_without(g, clash) for g in groups) if len(group.ends)]


def _options(
    way: _Way, strip: int, at: int, taken: Mapping[str, set[Bay]], bar: Bar, price: float
) -> _Options:
    ends = way.options(at)
    blocked = set().union(*(taken.get(mark, set()) for mark in way.run.neighbours))
    last = len(way.x) - 1
    free = [end for end in ends.tolist() if end == last or way.run.places[end - 1].bay not in blocked]
    ends = np.array(free or ends.tolist())
    extra = 1.0 + way.fewest[ends] - way.fewest[at]
    least = extra == extra.min()
    if not np.isfinite(price):
        ends, extra = ends[least], extra[least]
    size = way.sizes(at, ends, 0.0)
    most = int((bar.room + bar.kerf + ROUNDING) // _STEP)
    steps = np.minimum(np.ceil((size + bar.kerf) / _STEP).astype(np.int64), most)
    cost = np.where(extra > 0.0, extra * price, 0.0) if np.isfinite(price) else 0.0 * extra
    return _Options(strip, ends, steps, size - cost - _PER_PIECE)


def _best_set(groups: Sequence[_Options], room: int) -> list[tuple[int, int]]:
    """Knapsack with at most one option of each group; at least one piece is taken."""
    best = np.zeros(room + 1)
    lengths = np.arange(room + 1)
    choices: list[Indices] = []
    for group in groups:
        if best[room] >= _FULL * room * _STEP:
            break
        before = lengths[None, :] - group.steps[:, None]
        value = np.where(before >= 0, best[np.maximum(before, 0)] + group.values[:, None], -np.inf)
        option = value.argmax(axis=0)
        raised = value[option, lengths]
        better = raised > best + 1e-9
        best = np.where(better, raised, best)
        choices.append(np.where(better, option, -1))
    found = []
    for group, choice in zip(reversed(groups[: len(choices)]), reversed(choices), strict=True):
        if (k := int(choice[room])) >= 0:
            found.append((group.strip, int(group.ends[k])))
            room -= int(group.steps[k])
    if not found:
        group = max(groups, key=lambda group: group.values.max())
        found = [(group.strip, int(group.ends[group.values.argmax()]))]
    return found


def _clash(ways: Sequence[_Way], found: Sequence[tuple[int, int]]) -> tuple[int, int] | None:
    """A strip of this bar that is spliced in the bay of its neighbour, and its place."""
    bays: dict[str, Bay] = {}
    for i, end in found:
        run = ways[i].run
        if end == len(ways[i].x) - 1:
            continue
        bay = run.places[end - 1].bay
        if any(bays.get(mark) == bay for mark in run.neighbours):
            return i, end
        bays[run.mark] = bay
    return None


def _without(group: _Options, clash: tuple[int, int]) -> _Options:
    """The options of a strip without this one; it may be left with none for this bar."""
    if group.strip != clash[0]:
        return group
    kept = group.ends != clash[1]
    return _Options(group.strip, group.ends[kept], group.steps[kept], group.values[kept])


# ---- the plan -----------------------------------------------------------------------------------


def _plan(
    runs: Sequence[Run], chosen: Mapping[str, tuple[Place, ...]], bar: Bar, gap: float, floor: int
) -> SplicePlan:
    pieces = [piece for run in runs for piece in _pieces(run, chosen[run.mark], gap)]
    splices = {mark: places for mark, places in chosen.items() if places}
    findings = tuple(_unstaggered(runs, splices))
    return SplicePlan(splices, cut_bars(pieces, bar), floor, gap, findings)


def _pieces(run: Run, places: Sequence[Place], gap: float) -> Iterator[BarPiece]:
    if not places:
        yield BarPiece(run.mark, run.length)
        return
    for number, (start, end) in enumerate(spans(run.length, places, gap), start=1):
        yield BarPiece(f"{run.mark}.{number}", end - start)


def spans(length: float, places: Sequence[Place], gap: float) -> list[tuple[float, float]]:
    """Start and end of every piece of a strip, x of the strip, mm."""
    walls = [0.0, *(w for p in places for w in (p.x - gap / 2.0, p.x + gap / 2.0)), length]
    return [wall for k, wall in enumerate(pairwise(walls)) if k % 2 == 0]


def _unstaggered(
    runs: Sequence[Run], splices: Mapping[str, Sequence[Place]]
) -> Iterator[Finding]:
    told: set[tuple[str, str]] = set()
    for run in runs:
        mine = {place.bay: place for place in splices.get(run.mark, ())}
        for mark in run.neighbours:
            same = [place for place in splices.get(mark, ()) if place.bay in mine]
            if same and (mark, run.mark) not in told:
                told.add((run.mark, mark))
                yield Finding(
                    "splice-stagger",
                    Severity.WARNING,
                    run.mark,
                    float(len(same)),
                    0.0,
                    "splices",
                    f"{run.mark} and its neighbour {mark} are spliced in the same bay, "
                    f"{same[0].x:.0f} mm from the end of {mark}. Longer bars or a shorter splice "
                    "plate leave more places to choose from.",
                )
