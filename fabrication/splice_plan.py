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
from fabrication.finding import Finding, Severity
from fabrication.splice_search import (
    Chosen,
    Place,
    Run,
    bar_by_bar,
    strip_by_strip,
    ways_to_cut,
)

_PRICES = (np.inf, 2000.0, 1400.0, 1000.0, 700.0, 500.0, 350.0, 200.0, 100.0, 50.0, 0.0)
"""Of a splice beyond the fewest, mm of bar."""

_SECONDS = 2.0
"""For the bars of one plan."""


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
    copies : how often all strips are built; splices are those of one copy, bars for all.
    """

    splices: Mapping[str, tuple[Place, ...]]
    bars: BarPlan
    floor: int
    gap: float
    findings: tuple[Finding, ...] = field(default=())
    copies: int = 1

    @property
    def count(self) -> int:
        """Number of splices."""
        return self.copies * sum(len(places) for places in self.splices.values())


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
    ways = [ways_to_cut(run, bar, gap, shortest) for run in runs]
    floor = _floor(runs, bar, gap)
    plans: list[SplicePlan] = []
    choices = [strip_by_strip(ways), *(bar_by_bar(ways, bar, price) for price in _PRICES)]
    for number, chosen in enumerate(choices):
        if chosen not in choices[:number]:
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


# ---- the plan -----------------------------------------------------------------------------------


def _plan(runs: Sequence[Run], chosen: Chosen, bar: Bar, gap: float, floor: int) -> SplicePlan:
    pieces = [piece for run in runs for piece in _pieces(run, chosen.places[run.mark], gap)]
    splices = {mark: places for mark, places in chosen.places.items() if places}
    findings = tuple(_unstaggered(runs, splices))
    bars = cut_bars(pieces, bar, seconds=_SECONDS, known=chosen.bars)
    return SplicePlan(splices, bars, floor, gap, findings)


def _floor(runs: Sequence[Run], bar: Bar, gap: float) -> int:
    """Bars for the bare length of all strips, each with at least one cut."""
    saved = max(gap - bar.kerf, 0.0)
    whole = sum(run.length + bar.kerf - saved * len(run.places) for run in runs)
    return int(np.ceil(whole / (bar.room + bar.kerf) - ROUNDING))


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


def _unstaggered(runs: Sequence[Run], splices: Mapping[str, Sequence[Place]]) -> Iterator[Finding]:
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
