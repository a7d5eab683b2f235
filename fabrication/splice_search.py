"""The search for splices: which pieces of which strips fill a bar best.

See ``splice_plan`` for what it is used for. A strip is a row of places where it may be spliced; a
piece runs from one to a later one. For one bar the best set of next pieces, at most one per strip,
is a knapsack over lengths.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from fabrication.bars import ROUNDING, Bar
from fabrication.errors import StockError
from gridshell.arrays import Floats, Indices, Mask

Bay = tuple[int, int]

_STEP = 5.0
"""Of the lengths while positions are chosen, mm."""

_CANDIDATES = 60
"""Strips that are considered for one bar."""

_FULL = 0.997
"""A bar filled by so much is full: no further strip is tried."""

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


# ---- ways to cut a strip ------------------------------------------------------------------------


@dataclass(frozen=True, eq=False)
class Way:
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


def ways_to_cut(run: Run, bar: Bar, gap: float, shortest: float) -> Way:
    """How *run* can be cut.

    Raises
    ------
    StockError
        When no choice of places leaves pieces that fit the bar.
    """
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


def _graph(run: Run, bar: Bar, gap: float, shortest: float) -> Way:
    x = np.r_[0.0, [place.x for place in run.places], run.length]
    last = len(x) - 1
    inner = (np.arange(last + 1) > 0) & (np.arange(last + 1) < last)
    size = x[None, :] - x[:, None] - gap / 2.0 * (inner[None, :] + inner[:, None].astype(float))
    fits = (size > 0.0) & (size <= bar.room + ROUNDING) & (size >= min(shortest, run.length))
    fewest = np.full(last + 1, np.inf)
    fewest[last] = 0.0
    for k in range(last - 1, -1, -1):
        fewest[k] = 1.0 + np.min(np.where(fits[k], fewest, np.inf))
    return Way(run, x, fits, fewest)


# ---- bar by bar ---------------------------------------------------------------------------------


@dataclass(frozen=True)
class Chosen:
    """Places of the splices of every strip, and a plan for the pieces, if there is one."""

    places: Mapping[str, tuple[Place, ...]]
    bars: tuple[tuple[str, ...], ...] = ()


@dataclass(frozen=True, eq=False)
class _Options:
    """Next pieces of one strip: where they end, steps of length they take, what they are worth."""

    strip: int
    ends: Indices
    steps: Indices
    values: Floats


def bar_by_bar(ways: Sequence[Way], bar: Bar, price: float) -> Chosen:
    """Places of all splices, and a plan for the bars."""
    at = [0] * len(ways)
    places: dict[str, list[Place]] = {way.run.mark: [] for way in ways}
    bars: list[tuple[str, ...]] = []
    whole = range(len(ways))
    while open_ := [i for i in whole if at[i] < len(ways[i].x) - 1]:
        cut = []
        for i, end in _filled(ways, open_, at, places, bar, price):
            mark, whole_strip = ways[i].run.mark, at[i] == 0 and end == len(ways[i].x) - 1
            cut.append(mark if whole_strip else f"{mark}.{len(places[mark]) + 1}")
            at[i] = end
            if end < len(ways[i].x) - 1:
                places[mark].append(ways[i].run.places[end - 1])
        bars.append(tuple(cut))
    return Chosen({mark: tuple(here) for mark, here in places.items()}, tuple(bars))


def strip_by_strip(ways: Sequence[Way]) -> Chosen:
    """Strip by strip, every piece as long as it can be with the fewest splices."""
    places: dict[str, list[Place]] = {way.run.mark: [] for way in ways}
    for way in ways:
        at, last = 0, len(way.x) - 1
        while at != last:
            ends = _free(way, at, {mark: {p.bay for p in here} for mark, here in places.items()})
            fewest = way.fewest[ends]
            at = int(ends[fewest == fewest.min()].max())
            if at != last:
                places[way.run.mark].append(way.run.places[at - 1])
    return Chosen({mark: tuple(here) for mark, here in places.items()})


def _filled(
    ways: Sequence[Way],
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
    way: Way, strip: int, at: int, taken: Mapping[str, set[Bay]], bar: Bar, price: float
) -> _Options:
    ends = _free(way, at, taken)
    extra = 1.0 + way.fewest[ends] - way.fewest[at]
    least = extra == extra.min()
    if not np.isfinite(price):
        ends, extra = ends[least], extra[least]
    size = way.sizes(at, ends, 0.0)
    most = int((bar.room + bar.kerf + ROUNDING) // _STEP)
    steps = np.minimum(np.ceil((size + bar.kerf) / _STEP).astype(np.int64), most)
    cost = np.where(extra > 0.0, extra * price, 0.0) if np.isfinite(price) else 0.0 * extra
    return _Options(strip, ends, steps, size - cost - _PER_PIECE)


def _free(way: Way, at: int, taken: Mapping[str, set[Bay]]) -> Indices:
    """Where a piece may end, without the bays of its neighbours' splices if others are left."""
    ends = way.options(at)
    blocked = set().union(*(taken.get(mark, set()) for mark in way.run.neighbours))
    bays = [place.bay for place in way.run.places]
    free = np.array([end == len(bays) + 1 or bays[end - 1] not in blocked for end in ends.tolist()])
    return ends[free] if free.any() else ends


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


def _clash(ways: Sequence[Way], found: Sequence[tuple[int, int]]) -> tuple[int, int] | None:
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
