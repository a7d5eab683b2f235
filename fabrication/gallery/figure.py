"""What a figure of the paper is here: pictures, figures beside the paper's, and conditions."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

from fabrication.export.raster import Scene
from gridshell import Spread

Number = float | int | str


@dataclass(frozen=True)
class Condition:
    """What must hold for the figure to count.

    Parameters
    ----------
    what : in words, with the unit.
    value, limit : passes where the value is no larger.
    """

    what: str
    value: float
    limit: float

    @property
    def holds(self) -> bool:
        """Whether it does; never for what is not a number."""
        return bool(self.value <= self.limit)


@dataclass(frozen=True, eq=False)
class Figure:
    """One figure.

    Parameters
    ----------
    name : as in the paper, "6" or "15".
    title : one line.
    paper, ours : numbers by their name, the paper's own and those measured here.
    conditions : all must hold.
    scenes : pictures.
    remarks : verdicts and sentences that belong to the numbers.
    columns : pictures in a row.
    """

    name: str
    title: str
    paper: Mapping[str, Number]
    ours: Mapping[str, Number]
    conditions: tuple[Condition, ...]
    scenes: tuple[Scene, ...]
    remarks: tuple[str, ...] = field(default=())
    columns: int = 3

    @property
    def holds(self) -> bool:
        """Whether all conditions do, of which there is at least one."""
        return bool(self.conditions) and all(c.holds for c in self.conditions)


def largest(spread: Spread | None) -> float:
    """The largest of measured values; infinite where none were measured, so that nothing holds."""
    return float("inf") if spread is None else spread.max


def average(spread: Spread | None) -> float:
    """The mean of measured values; infinite where none were measured."""
    return float("inf") if spread is None else spread.mean


def equal(what: str, value: float, wanted: float) -> Condition:
    """A condition that two numbers are the same."""
    return Condition(f"{what} {wanted:g}, off by", abs(value - wanted), 0.0)
