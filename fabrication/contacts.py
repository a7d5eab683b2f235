"""Which strips touch, from which side, and in what order they can go together.

The rule. Strips are stiff across their width: they bend and twist, but a strip cannot be woven
over one and under the next. So a strip is added from one side, along the node axes, and fills all
slots it shares with strips that are there already, one after the other:

* it can come from above when all these slots in it open to its lower edge, from below when all open
  to its upper edge, and is *locked out* when there are both;
* it goes in after everything its ends bear on, or it lies on.

An order that keeps the rule exists exactly where the strips can be taken apart one by one under
the same rule, the last one added first. A strip that can be taken off can also be taken off later,
when fewer strips are left: whatever is taken off first, the same set remains at the end. So taking
off any strip that can be, until none can, finds an order if there is one, and leaves otherwise the
largest set of strips that lock each other. No search is needed.

Bearings alone can close in a ring (pinwheels: each piece ends on the next). Such a piece can still
be slid in along the node axis, between pieces that were propped so far: the ring is told, and
opened there.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from heapq import heappop, heappush


@dataclass(frozen=True)
class Lap:
    """Two strips slotted into each other.

    Parameters
    ----------
    below : number of the strip slotted from its upper edge: the other comes down on it.
    above : number of the strip slotted from its lower edge.
    node : name of the node.
    """

    below: int
    above: int
    node: str


@dataclass(frozen=True)
class Bearing:
    """A strip that ends on, or lies on, another.

    Parameters
    ----------
    strip : number of the strip that bears.
    on : number of the strip it bears on.
    node : name of the node.
    """

    strip: int
    on: int
    node: str


@dataclass(frozen=True)
class Contacts:
    """All contacts of *count* strips."""

    count: int
    laps: tuple[Lap, ...] = ()
    bearings: tuple[Bearing, ...] = ()


@dataclass(frozen=True)
class Order:
    """How strips can go together.

    Parameters
    ----------
    strips : their numbers, first to be placed first; without the locked ones and what depends on
        them where there are any.
    locked : those that lock each other out; empty where an order exists.
    rings : bearings that close in a ring, as strip numbers, each bearing on the next and the last
        on the first; the first goes in last.
    """

    strips: tuple[int, ...]
    locked: tuple[int, ...]
    rings: tuple[tuple[int, ...], ...]


def order_of(contacts: Contacts, wish: Sequence[int]) -> Order:
    """The order nearest to *wish*, all strip numbers in the order they should go together.

    Strips are taken off from the end of the wish; see the rule above.
    """
    apart = _Apart(contacts, wish)
    rings: list[tuple[int, ...]] = []
    while apart.present:
        if apart.take():
            continue
        ring = apart.ring()
        if ring is None:
            break
        rings.append(ring)
        apart.remove(ring[0])
    locked = tuple(sorted(s for s in apart.present if apart.locked(s)))
    return Order(tuple(reversed(apart.taken)), locked, tuple(rings))


class _Apart:
    """Strips being taken apart."""

    def __init__(self, contacts: Contacts, wish: Sequence[int]) -> None:
        count = contacts.count
        self.rank = {strip: k for k, strip in enumerate(wish)}
        self.over: list[list[int]] = [[] for _ in range(count)]
        self.under: list[list[int]] = [[] for _ in range(count)]
        for lap in contacts.laps:
            self.over[lap.below].append(lap.above)
            self.under[lap.above].append(lap.below)
        self.bearers: list[list[int]] = [[] for _ in range(count)]
        self.carriers: list[list[int]] = [[] for _ in range(count)]
        for bearing in contacts.bearings:
            self.bearers[bearing.on].append(bearing.strip)
            self.carriers[bearing.strip].append(bearing.on)
        self.covered = [len(own) for own in self.over]
        self.resting = [len(own) for own in self.under]
        self.borne = [len(own) for own in self.bearers]
        self.present = set(range(count))
        self.taken: list[int] = []
        self.ready: list[tuple[int, int]] = []
        for strip in range(count):
            self._offer(strip)

    def locked(self, strip: int) -> bool:
        """Whether strips on both of its edges hold it."""
        return self.covered[strip] > 0 and self.resting[strip] > 0

    def take(self) -> bool:
        """Take off the last strip of the wish that can be; False where none can."""
        while self.ready:
            _, strip = heappop(self.ready)
            if strip in self.present:
                self.remove(strip)
                return True
        return False

    def remove(self, strip: int) -> None:
        """Take off *strip* and offer those it held."""
        self.present.discard(strip)
        self.taken.append(strip)
        for held, counts in (
            (self.over[strip], self.resting),
            (self.under[strip], self.covered),
            (self.carriers[strip], self.borne),
        ):
            for other in held:
                counts[other] -= 1
                self._offer(other)

    def ring(self) -> tuple[int, ...] | None:
        """Strips that bear on each other in a ring, one first that no slot holds; or None."""
        seen: set[int] = set()
        for start in sorted(self.present, key=lambda s: -self.rank[s]):
            path: list[int] = []
            strip: int | None = start
            while strip is not None and strip not in seen:
                seen.add(strip)
                path.append(strip)
                strip = max(
                    (b for b in self.bearers[strip] if b in self.present),
                    key=lambda s: self.rank[s],
                    default=None,
                )
            if strip in path:
                ring = path[path.index(strip) :][::-1]
                free = [s for s in ring if not self.locked(s)]
                if free:
                    k = ring.index(max(free, key=lambda s: self.rank[s]))
                    return tuple(ring[k:] + ring[:k])
        return None

    def _offer(self, strip: int) -> None:
        if strip in self.present and not self.locked(strip) and self.borne[strip] == 0:
            heappush(self.ready, (-self.rank[strip], strip))
