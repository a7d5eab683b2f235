"""Values counted in bars of a round width, for every histogram that is drawn."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from gridshell.arrays import Floats, Indices

_FEWEST, _MOST_TICKS = 14, 6
"""Bars over the range of the values at least; figures along an axis at most."""

_STEPS = (1.0, 2.0, 5.0, 10.0)
_CLOSE = 3.0
"""A limit beyond so many times the largest value is told, and not drawn."""

_FROM_NOUGHT = 0.5
"""The axis begins at nought where the smallest value is at most this share of its other end."""

_ALIKE = 1e-9
"""Values that differ by less than this share of their size are one value."""


@dataclass(frozen=True, eq=False)
class Bars:
    """A histogram, ready to be drawn.

    Parameters
    ----------
    stops : (k + 1,) where bars begin and end, in the unit of the values.
    counts : (k,) values in every bar; the last one includes its end.
    ticks : (t,) round places along the axis, within its ends.
    heights : (h,) round counts up the other axis, from 0 to at least the highest bar.
    power : of ten that the figures at the ticks are multiples of.
    decimals : of these figures.
    limit : None where there is none.
    shown : whether the limit lies on the axis.
    known, missing : how many values are numbers, and how many are not.
    mean, largest : of those that are; None without any.
    """

    stops: Floats
    counts: Indices
    ticks: Floats
    heights: Indices
    power: int
    decimals: int
    limit: float | None
    shown: bool
    known: int
    missing: int
    mean: float | None
    largest: float | None

    @property
    def low(self) -> float:
        """Left end of the axis."""
        return float(self.stops[0])

    @property
    def high(self) -> float:
        """Right end of the axis."""
        return float(self.stops[-1])

    def figures(self) -> list[str]:
        """What stands at the ticks."""
        shares = self.ticks / 10.0**self.power
        return [f"{share + 0.0:.{self.decimals}f}" for share in shares.tolist()]


def bars_of(values: npt.ArrayLike, *, limit: float | None = None) -> Bars:
    """Count *values* in some fifteen to thirty bars.

    Parameters
    ----------
    values : of any shape; what is no finite number is counted apart.
    limit : in the same unit; the axis reaches it where it is near.
    """
    found = np.asarray(values, dtype=np.float64).ravel()
    known = found[np.isfinite(found)]
    limit = limit if limit is not None and np.isfinite(limit) else None
    low, high = _range(known)
    shown = limit is not None and low - (high - low) <= limit <= max(_CLOSE * high, high)
    if limit is not None and shown:
        low, high = min(low, limit), max(high, limit)
    low = 0.0 if 0.0 <= low <= _FROM_NOUGHT * high else low
    step = round_step((high - low) / _FEWEST)
    first, last = np.floor(low / step + 1e-9), np.ceil(high / step - 1e-9)
    stops = step * np.arange(first, max(last, first + 1.0) + 1.0)
    counts = np.histogram(np.clip(known, stops[0], stops[-1]), bins=stops)[0]
    between = step * max(1, int(np.ceil((len(stops) - 1) / _MOST_TICKS)))
    between = round_step(between)
    ticks = between * np.arange(np.ceil(stops[0] / between - 1e-9), stops[-1] / between + 1e-9)
    power = _power(float(np.abs(stops).max()))
    return Bars(
        stops=stops,
        counts=np.asarray(counts, dtype=np.int64),
        ticks=ticks,
        heights=_heights(int(counts.max(initial=0))),
        power=power,
        decimals=max(0, -int(np.floor(np.log10(between / 10.0**power) + 1e-9))),
        limit=limit,
        shown=bool(shown),
        known=len(known),
        missing=len(found) - len(known),
        mean=float(known.mean()) if len(known) else None,
        largest=float(known.max()) if len(known) else None,
    )


def round_step(least: float) -> float:
    """The smallest of 1, 2, 5 times a power of ten that is at least *least* > 0."""
    size = 10.0 ** np.floor(np.log10(least))
    return float(next(size * step for step in _STEPS if size * step >= least * (1.0 - 1e-9)))


def _range(known: Floats) -> tuple[float, float]:
    """Smallest and largest value, or ends around a single one."""
    if len(known) == 0 or not known.any():
        return 0.0, 1.0
    low, high = float(known.min()), float(known.max())
    size = max(abs(low), abs(high))
    if high - low <= _ALIKE * size:
        return low - 0.05 * size, high + 0.05 * size
    return low, high


def _heights(highest: int) -> Indices:
    """Round counts from 0 to the first that is at least *highest*."""
    step = max(1, int(round_step(max(highest, 1) / 4.0)))
    return np.arange(0, max(highest, 1) + step, step)[: -(-max(highest, 1) // step) + 1]


def _power(largest: float) -> int:
    if 1e-3 <= largest < 1e5:
        return 0
    return int(3 * np.floor(np.log10(max(largest, 1e-300)) / 3.0))
