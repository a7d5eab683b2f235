"""Equal parts: outlines that cover each other within a tolerance, whatever corner they start at.

Two outlines are equal when one can be turned, and turned over where that is allowed, so that no
corner is further than the tolerance from its counterpart. The turn is the best one in the sense of
least squares, over all ways to number the corners. A group is named after its first member, and
every member is within the tolerance of that one, so the result depends on nothing but the order.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from fabrication.outlines import Frame
from fabrication.stock import require_positive
from gridshell.arrays import Floats

Complex = npt.NDArray[np.complex128]
"""Points of the plane as complex numbers."""


@dataclass(frozen=True)
class Member:
    """One part of a group.

    Parameters
    ----------
    index : of the part.
    shift : corner ``c`` of the first member is corner ``(c + shift) % k`` of this one, or
        ``(shift - c) % k`` where it is mirrored.
    mirrored : whether it is the first member turned over.
    deviation : largest distance between corresponding corners, mm.
    """

    index: int
    shift: int
    mirrored: bool
    deviation: float


@dataclass(frozen=True)
class Group:
    """Equal parts; the first member is the one that is drawn."""

    name: str
    members: tuple[Member, ...]


def equal_groups(
    outlines: Sequence[Floats], tolerance: float, *, prefix: str, mirror: bool = False
) -> tuple[Group, ...]:
    """Group outlines (k, 2) that are equal within *tolerance* mm.

    Parameters
    ----------
    prefix : of the names: "G" gives G1, G2, ... in the order of their first members.
    mirror : whether a part may be turned over.

    Raises
    ------
    SettingError
        For a tolerance that is not positive.
    """
    require_positive("tolerance", tolerance)
    firsts: dict[int, _Firsts] = {}
    groups: list[list[Member]] = []
    for index, outline in enumerate(outlines):
        shape = _centred(outline)
        known = firsts.setdefault(len(outline), _Firsts())
        found = known.match(shape, tolerance, mirror=mirror)
        if found is None:
            known.add(shape, len(groups))
            groups.append([Member(index, 0, False, 0.0)])
        else:
            group, shift, mirrored, deviation = found
            groups[group].append(Member(index, shift, mirrored, deviation))
    return tuple(Group(f"{prefix}{n}", tuple(g)) for n, g in enumerate(groups, start=1))


def group_names(marks: Sequence[str], groups: Sequence[Group]) -> Mapping[str, str]:
    """The group of every mark."""
    return {marks[member.index]: group.name for group in groups for member in group.members}


def instance_frame(first: Floats, outline: Floats, frame: Frame, member: Member) -> Frame:
    """Where the first member of a group must be put to lie in another member's place.

    Parameters
    ----------
    first, outline : (k, 2) outlines of the first member and of this one, mm.
    frame : where *outline* lies in space.

    Returns
    -------
    The frame for *first*. It is a rigid motion also for a mirrored member: the part is turned
    over, and its normal is the other way round.
    """
    k = len(outline)
    corner = np.arange(k)
    numbers = member.shift - corner if member.mirrored else member.shift + corner
    a, b = _complex(first), _complex(outline)[numbers % k]
    towards, away = a - a.mean(), b - b.mean()
    if member.mirrored:
        towards = np.conj(towards)
    turn = np.vdot(towards, away)
    turn = turn / abs(turn) if abs(turn) > 0.0 else 1.0
    x, y = turn, turn * (-1j if member.mirrored else 1j)
    back = b.mean() - (a.mean().real * x + a.mean().imag * y)
    return Frame(
        frame.place(np.array([back.real, back.imag])),
        x.real * frame.x + x.imag * frame.y,
        y.real * frame.x + y.imag * frame.y,
    )


class _Firsts:
    """First members with one number of corners, as complex outlines about their means."""

    def __init__(self) -> None:
        self.shapes: list[Complex] = []
        self.spans: list[float] = []
        self.groups: list[int] = []

    def add(self, shape: Complex, group: int) -> None:
        self.shapes.append(shape)
        self.spans.append(_span(shape))
        self.groups.append(group)

    def match(
        self, shape: Complex, tolerance: float, *, mirror: bool
    ) -> tuple[int, int, bool, float] | None:
        """Group, shift, whether mirrored, deviation: of the first group that fits best."""
        # the root of the mean square of the corners' radii moves by at most the tolerance
        near = np.flatnonzero(np.abs(np.array(self.spans) - _span(shape)) <= tolerance)
        if len(near) == 0:
            return None
        k = len(shape)
        corner, shifts = np.arange(k), np.arange(k)[:, None]
        ways = [shape[(corner + shifts) % k]]
        if mirror:
            ways.append(np.conj(shape)[(shifts - corner) % k])
        candidates = np.concatenate(ways)
        first = np.stack([self.shapes[n] for n in near])
        turn = np.einsum("gk,wk->gw", first, np.conj(candidates))
        size = np.abs(turn)
        turn = np.where(size > 0.0, turn / np.where(size > 0.0, size, 1.0), 1.0)
        gap = np.abs(first[:, None] - turn[..., None] * candidates[None]).max(axis=2)
        # among equals the first, and none is better by rounding alone
        best = np.argmin(np.round(gap / tolerance, 6), axis=1)
        within = np.flatnonzero(gap[np.arange(len(near)), best] <= tolerance)
        if len(within) == 0:
            return None
        g = int(within[0])
        way = int(best[g])
        return self.groups[int(near[g])], way % k, way >= k, float(gap[g, way])


def _complex(outline: Floats) -> Complex:
    return np.asarray(outline[:, 0] + 1j * outline[:, 1])


def _centred(outline: Floats) -> Complex:
    shape = _complex(outline)
    return np.asarray(shape - shape.mean())


def _span(shape: Complex) -> float:
    return float(np.sqrt((np.abs(shape) ** 2).mean()))
