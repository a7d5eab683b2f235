"""Bars of raw material, and what is cut from each of them. Lengths in mm."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from fabrication.errors import StockError
from fabrication.stock import require_distance, require_positive
from gridshell import SettingError

ROUNDING = 1e-6
"""By how much pieces may fill a bar beyond its room, mm: rounding of sums."""


@dataclass(frozen=True)
class Bar:
    """Bars as they are delivered.

    Parameters
    ----------
    length : of a whole bar, mm.
    kerf : what one cut between two pieces takes, mm.
    trim : cut off at either end before the first and after the last piece, with its cut, mm.

    Raises
    ------
    SettingError
        For a length that is not positive, a negative kerf or trim, or one that leaves nothing.
    """

    length: float
    kerf: float = 3.0
    trim: float = 10.0

    def __post_init__(self) -> None:
        require_positive("bar.length", self.length)
        require_distance("bar.kerf", self.kerf)
        require_distance("bar.trim", self.trim)
        if not self.room > self.kerf:
            raise SettingError(
                "The trims leave nothing of the bar",
                where="bar.trim",
                value=f"{self.trim:g} mm",
                limit=f"below {(self.length - self.kerf) / 2.0:g} mm",
                advice="10 mm",
            )

    @property
    def room(self) -> float:
        """Length between the two trims: of the longest piece, mm."""
        return self.length - 2.0 * self.trim

    def filled(self, lengths: Sequence[float]) -> float:
        """What *lengths* take of the room, with the cuts between them, mm."""
        return sum(lengths) + self.kerf * max(len(lengths) - 1, 0)


@dataclass(frozen=True)
class BarPiece:
    """A piece to be cut: its mark and its length, mm."""

    mark: str
    length: float


@dataclass(frozen=True)
class CutBar:
    """One bar and its pieces, in the order they are cut."""

    number: int
    bar: Bar
    pieces: tuple[BarPiece, ...]

    @property
    def offcut(self) -> float:
        """What is left of the room after the last piece and its cut, mm."""
        rest = self.bar.room - self.bar.filled([piece.length for piece in self.pieces])
        return max(rest - self.bar.kerf, 0.0)

    @property
    def positions(self) -> tuple[float, ...]:
        """Where each piece begins, from the end of the bar, mm."""
        at, starts = self.bar.trim, []
        for piece in self.pieces:
            starts.append(at)
            at += piece.length + self.bar.kerf
        return tuple(starts)


@dataclass(frozen=True)
class Pattern:
    """One way to cut a bar, *bars* times: lengths of its pieces, the longest first, mm."""

    lengths: tuple[float, ...]
    bars: int


@dataclass(frozen=True)
class BarPlan:
    """Which piece is cut from which bar.

    Parameters
    ----------
    bar : the stock.
    cut : the bars with their pieces.
    bound : no plan for these pieces can do with fewer bars.
    """

    bar: Bar
    cut: tuple[CutBar, ...]
    bound: int

    @property
    def bars(self) -> int:
        """Number of bars."""
        return len(self.cut)

    @property
    def proven(self) -> bool:
        """Whether no plan can be better."""
        return self.bars == self.bound

    @property
    def patterns(self) -> tuple[Pattern, ...]:
        """Ways of cutting, those of most bars first; lengths to a hundredth of a mm."""
        counts: dict[tuple[float, ...], int] = {}
        for cut in self.cut:
            key = tuple(sorted((round(p.length, 2) for p in cut.pieces), reverse=True))
            counts[key] = counts.get(key, 0) + 1
        ordered = sorted(counts.items(), key=lambda entry: (-entry[1], entry[0]))
        return tuple(Pattern(lengths, bars) for lengths, bars in ordered)

    @property
    def used(self) -> float:
        """Yield: length of all pieces over length of all bars; 1 where there are none."""
        whole = self.bar.length * self.bars
        return self._pieces / whole if whole else 1.0

    @property
    def waste(self) -> float:
        """Trims, cuts and offcuts of all bars, mm."""
        return self.bar.length * self.bars - self._pieces

    @property
    def _pieces(self) -> float:
        return sum(piece.length for cut in self.cut for piece in cut.pieces)


def require_fit(pieces: Sequence[BarPiece], bar: Bar) -> None:
    """Raise StockError for a piece longer than *bar* between its trims; the longest is named."""
    longest = max(pieces, key=lambda piece: piece.length, default=None)
    if longest is not None and longest.length > bar.room + ROUNDING:
        raise StockError(
            "A part is too long for the stock",
            where=longest.mark,
            value=f"{longest.length:.1f} mm",
            limit=f"{bar.room:.1f} mm between the trims of a bar of {bar.length:g} mm",
            advice="a longer bar or coil, or a splice",
        )
