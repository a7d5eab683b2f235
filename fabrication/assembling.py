"""In what order strips and connectors go together so that no strip is ever locked out.

What may follow what is in ``contacts``. Here the contacts are read from the joints, the order is
made one a crew can use, and every step gets its sentence:

* strips slotted from above lie below: they are laid out first, the others come down on them, from
  the middle of the grid outwards, so that what is wrong in one bay does not add up over all;
* a strip is pushed on from its middle towards both ends, slot after slot;
* strips on two levels, and pieces between through strips, go in after what they lie or end on;
* connectors come last. Where strips lie on two levels these only fit once all strips are bent into
  their final shape.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from enum import Enum
from itertools import groupby
from typing import Any

import numpy as np

from fabrication.contacts import Contacts, Lap, Order, order_of
from fabrication.cut import Edge
from fabrication.finding import Finding, Severity
from fabrication.joint_contacts import contacts_of
from fabrication.jointed import Jointed
from gridshell.arrays import Floats

_SHOWN = 6
"""Marks in a sentence; longer lists are cut short."""


class Side(Enum):
    """Where a strip comes from, seen along the node axes."""

    ABOVE = "above"
    BELOW = "below"


@dataclass(frozen=True)
class AssemblyStep:
    """One step.

    Parameters
    ----------
    number : 1, 2, ...
    marks : of the strips that go in, or the kind of connector.
    what : a sentence for the crew.
    nodes : those that are engaged, in order.
    side : where strips come from that are pushed into slots; None for all others.
    spread : largest angle between a node axis and the mean of those engaged, radians: by so much
        the strip must turn while it is pushed in, where the grid is not put together flat.
    """

    number: int
    marks: tuple[str, ...]
    what: str
    nodes: tuple[str, ...] = ()
    side: Side | None = None
    spread: float = 0.0


@dataclass(frozen=True)
class Assembly:
    """How everything goes together.

    Parameters
    ----------
    steps : in order; empty where strips lock each other out.
    findings : strips that are locked out, and rings that must be propped.
    """

    steps: tuple[AssemblyStep, ...]
    findings: tuple[Finding, ...]

    def lines(self) -> tuple[str, ...]:
        """The steps as numbered sentences."""
        return tuple(f"{step.number}. {step.what}" for step in self.steps)

    def section(self) -> dict[str, Any]:
        """What the report says of it."""
        pushed = [step for step in self.steps if step.side is not None]
        return {
            "steps": len(self.steps),
            "possible": bool(self.steps),
            "pushed_from_below": sum(step.side is Side.BELOW for step in pushed),
            "slots_at_once": max((len(step.nodes) for step in pushed), default=0),
            "axes_spread_deg": float(
                np.degrees(max((step.spread for step in pushed), default=0.0))
            ),
            "findings": [finding.code for finding in self.findings],
        }


def assembly_order(jointed: Jointed) -> Assembly:
    """The order in which strips and connectors of *jointed* go together.

    See ``contacts`` for the rule that no strip is ever locked out, and for why an order is found
    wherever there is one.
    """
    contacts, levels, faulty = contacts_of(jointed)
    order = order_of(contacts, _wish(jointed, contacts))
    findings = (*faulty, *_locked_findings(jointed, contacts, order), *_rings(jointed, order))
    if order.locked or faulty:
        return Assembly((), findings)
    steps = [
        *_strip_steps(jointed, contacts, order, levels),
        *_last_steps(jointed, contacts, levels),
    ]
    numbered = (
        AssemblyStep(number, step.marks, step.what, step.nodes, step.side, step.spread)
        for number, step in enumerate(steps, start=1)
    )
    return Assembly(tuple(numbered), findings)


# ---- a useful order ----------------------------------------------------------------------------


def _wish(jointed: Jointed, contacts: Contacts) -> list[int]:
    """What lies below in the order of its marks, then the others from the middle outwards."""
    score = Counter(lap.above for lap in contacts.laps)
    score.subtract(Counter(lap.below for lap in contacts.laps))
    score.update(bearing.strip for bearing in contacts.bearings)
    score.subtract(Counter(bearing.on for bearing in contacts.bearings))
    below = [i for i in range(contacts.count) if score[i] <= 0]
    above = [i for i in range(contacts.count) if score[i] > 0]
    carriers = sorted({jointed.carriers[i] for i in above})
    middle = (len(carriers) - 1) / 2.0
    away = {carrier: abs(k - middle) for k, carrier in enumerate(carriers)}
    return below + sorted(above, key=lambda i: (away[jointed.carriers[i]], jointed.carriers[i], i))


# ---- steps -------------------------------------------------------------------------------------


@dataclass(frozen=True)
class _Entry:
    """A strip that goes in: the slots it fills, and what it bears on."""

    strip: int
    nodes: tuple[str, ...]
    side: Side | None
    on: tuple[str, ...]


def _strip_steps(
    jointed: Jointed, contacts: Contacts, order: Order, levels: bool
) -> Iterator[AssemblyStep]:
    lamellas = jointed.strips.lamellas
    axes = {node.name: node.axis for node in jointed.strips.nodes}
    entries = list(_entries(jointed, contacts, order))

    def together(entry: _Entry) -> tuple[int, int]:
        """Strips that fill no slot go in by axis, or all at once where they meet nothing."""
        if entry.nodes:
            return 0, entry.strip
        return (1, jointed.carriers[entry.strip]) if entry.on else (2, 0)

    for _, members in groupby(entries, key=together):
        group = list(members)
        marks = tuple(lamellas[entry.strip].mark for entry in group)
        first = group[0]
        if first.side is not None:
            met = Counter(first.on)
            way = "down on" if first.side is Side.ABOVE else "up from below into"
            what = (
                f"Push {marks[0]} {way} {_listed(tuple(met))}: {len(first.nodes)} "
                f"{'slot' if len(first.nodes) == 1 else 'slots'}"
                f"{', from the middle to both ends' if len(first.nodes) > 2 else ''}"
            )
            yield AssemblyStep(
                0, marks, what + ".", first.nodes, first.side, _spread(axes, first.nodes)
            )
        elif first.on:
            on = tuple(dict.fromkeys(mark for entry in group for mark in entry.on))
            how = f"Lay {_listed(marks)} across" if levels else f"Fit {_listed(marks)} against"
            yield AssemblyStep(0, marks, f"{how} {_listed(on)}.")
        else:
            up = ", slots up" if _open_upwards(jointed, marks) else ""
            beside = " side by side" if len(marks) > 1 else ""
            yield AssemblyStep(0, marks, f"Lay out {_listed(marks)}{beside}{up}.")


def _entries(jointed: Jointed, contacts: Contacts, order: Order) -> Iterator[_Entry]:
    lamellas = jointed.strips.lamellas
    station = {
        (crossing.lamella, node.name): crossing.station
        for node in jointed.strips.nodes
        for crossing in node.crossings
    }
    beside: list[list[tuple[int, str, Side | None]]] = [[] for _ in lamellas]
    for lap in contacts.laps:
        beside[lap.below].append((lap.above, lap.node, Side.BELOW))
        beside[lap.above].append((lap.below, lap.node, Side.ABOVE))
    for bearing in contacts.bearings:
        beside[bearing.strip].append((bearing.on, bearing.node, None))
    present: set[int] = set()
    for strip in order.strips:
        met = [entry for entry in beside[strip] if entry[0] in present]
        met.sort(key=lambda entry: station.get((strip, entry[1]), 0.0))
        slots = [entry for entry in met if entry[2] is not None]
        nodes = tuple(slots[k][1] for k in _outwards(len(slots)))
        on = tuple(dict.fromkeys(lamellas[entry[0]].mark for entry in met))
        present.add(strip)
        yield _Entry(strip, nodes, slots[0][2] if slots else None, on)


def _outwards(count: int) -> list[int]:
    """0 to count - 1 from the middle outwards."""
    return sorted(range(count), key=lambda k: (abs(k - (count - 1) / 2.0), k))


def _spread(axes: Mapping[str, Floats], nodes: Sequence[str]) -> float:
    held = np.array([axes[name] for name in nodes])
    mean = held.sum(axis=0)
    cosine = held @ mean / max(float(np.linalg.norm(mean)), 1e-12)
    return float(np.arccos(np.clip(cosine, -1.0, 1.0)).max())


def _last_steps(jointed: Jointed, contacts: Contacts, levels: bool) -> Iterator[AssemblyStep]:
    kinds = [prisms for prisms in jointed.connectors if prisms.bodies]
    if levels:
        yield AssemblyStep(0, (), "Bend all strips into their final shape on a temporary frame.")
    elif contacts.laps:
        yield AssemblyStep(0, (), "Raise the grid and bend it into its final shape.")
    for prisms in kinds:
        fit = ": they only fit once all strips are in their final shape" if levels else ""
        yield AssemblyStep(
            0, (prisms.name,), f"Put in {_counted(len(prisms.bodies), prisms.name)}{fit}."
        )
    if any(line.item == "weld" for line in jointed.bill):
        yield AssemblyStep(0, ("weld",), "Check the node angles and weld.")


def _counted(count: int, name: str) -> str:
    return f"{count} {name}" if count == 1 or name.endswith("s") else f"{count} {name}s"


def _open_upwards(jointed: Jointed, marks: Sequence[str]) -> bool:
    edges = {slot.edge for mark in marks for slot in jointed.cuts[mark].slots}
    return edges == {Edge.UPPER}


def _listed(marks: Sequence[str]) -> str:
    if len(marks) <= _SHOWN:
        return ", ".join(marks)
    return f"{', '.join(marks[: _SHOWN - 2])}, ..., {marks[-1]} ({len(marks)} strips)"


# ---- findings ----------------------------------------------------------------------------------


def _locked_findings(jointed: Jointed, contacts: Contacts, order: Order) -> Iterator[Finding]:
    """One per strip that others hold from both sides."""
    lamellas, held = jointed.strips.lamellas, set(order.locked)
    under: dict[int, Lap] = {}
    over: dict[int, Lap] = {}
    for lap in contacts.laps:
        if lap.below in held and lap.above in held:
            under.setdefault(lap.above, lap)
            over.setdefault(lap.below, lap)
    for strip in order.locked:
        if strip not in under or strip not in over:
            continue
        low, high = under[strip], over[strip]
        mark = lamellas[strip].mark
        yield Finding(
            "locked-out",
            Severity.ERROR,
            f"{mark} {low.node}",
            2.0,
            1.0,
            "edges",
            f"{mark} is locked out: it must come down on {lamellas[low.below].mark} at {low.node} "
            f"and up into {lamellas[high.above].mark} at {high.node}, and {len(held)} strips hold "
            f"each other so. Open all slots of {mark} to one edge.",
        )


def _rings(jointed: Jointed, order: Order) -> Iterator[Finding]:
    if not order.rings:
        return
    lamellas, first = jointed.strips.lamellas, order.rings[0]
    marks = [lamellas[strip].mark for strip in first]
    yield Finding(
        "bearing-ring",
        Severity.INFO,
        marks[0],
        float(len(order.rings)),
        0.0,
        "rings",
        f"{len(order.rings)} rings of pieces each end on the next, as {_listed(marks)} do. Prop "
        f"them until the ring is closed; {marks[0]} goes in last, slid in along the node axis.",
    )
