"""Where the strips of a joint touch: slots in each other, ends on through strips, two levels."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Sequence

import numpy as np

from fabrication.contacts import Bearing, Contacts, Lap
from fabrication.cut import Edge
from fabrication.finding import Finding, Severity
from fabrication.jointed import Feature, Jointed
from fabrication.node import Node

_APART = 0.5
"""Axes of two levels are further apart than this share of the strips' width."""


def contacts_of(jointed: Jointed) -> tuple[Contacts, bool, tuple[Finding, ...]]:
    """All contacts of the strips of *jointed*.

    Returns
    -------
    The contacts; whether strips lie on others on a second level; and a finding for each pair of
    slots that open to the same edge, which are no contact.
    """
    laps, faulty = _laps(jointed)
    bearings, levels = _bearings(jointed, laps)
    return Contacts(len(jointed.strips.lamellas), laps, bearings), levels, faulty


def _laps(jointed: Jointed) -> tuple[tuple[Lap, ...], tuple[Finding, ...]]:
    """Pairs of slots of two strips at the same node."""
    numbers = {lamella.mark: i for i, lamella in enumerate(jointed.strips.lamellas)}
    open_: dict[tuple[str, frozenset[str]], dict[str, Edge]] = defaultdict(dict)
    for mark, cuts in jointed.cuts.items():
        for slot in cuts.slots:
            if slot.partner in numbers:
                open_[slot.node, frozenset((mark, slot.partner))][mark] = slot.edge
    laps, faulty = [], []
    for (node, pair), edges in open_.items():
        if len(edges) < 2:
            continue
        a, b = sorted(pair, key=lambda mark: (edges[mark] is Edge.LOWER, mark))
        if edges[a] is edges[b]:
            faulty.append(_same_edge(a, b, node, edges[a]))
        else:
            laps.append(Lap(numbers[a], numbers[b], node))
    return tuple(laps), tuple(faulty)


def _same_edge(a: str, b: str, node: str, edge: Edge) -> Finding:
    other = Edge.LOWER if edge is Edge.UPPER else Edge.UPPER
    return Finding(
        "same-edge",
        Severity.ERROR,
        f"{a} {node}",
        2.0,
        1.0,
        f"slots open to the {edge.value} edge",
        f"The slots of {a} and {b} at {node} both open to the {edge.value} edge: they cannot be "
        f"slotted into each other. Open one of them to the {other.value} edge.",
    )


def _bearings(jointed: Jointed, laps: Sequence[Lap]) -> tuple[tuple[Bearing, ...], bool]:
    """Ends of pieces on through strips; strips that lie on others; whether any do."""
    lapped = {(lap.node, frozenset((lap.below, lap.above))) for lap in laps}
    ends = _ends(jointed)
    heights = _heights(jointed)
    family = [lamella.family for lamella in jointed.strips.lamellas]
    apart = _APART * jointed.strips.profile.width
    bearings, levels = [], False
    for node in jointed.strips.nodes:
        here = dict.fromkeys(c.lamella for c in node.crossings)
        here.update(dict.fromkeys(ends.get(node.name, ())))
        ending = [i for i in here if i in ends.get(node.name, ())]
        passing = [i for i in here if i not in ends.get(node.name, ())]
        bearings += [
            Bearing(i, on, node.name) for i in ending for on in passing if family[i] != family[on]
        ]
        for a in passing:
            for b in passing:
                rise = heights.get((node.name, b), 0.0) - heights.get((node.name, a), 0.0)
                if (
                    family[a] != family[b]
                    and rise > apart
                    and (node.name, frozenset((a, b))) not in lapped
                ):
                    bearings.append(Bearing(b, a, node.name))
                    levels = True
    return tuple(dict.fromkeys(bearings)), levels


def _ends(jointed: Jointed) -> dict[str, set[int]]:
    """Strips that end short of a node, by its name.

    Where the node knows the strip's station, that decides; else a fixture of the strip's end.
    """
    ends: dict[str, set[int]] = defaultdict(set)
    known: set[tuple[str, int]] = set()
    for node in jointed.strips.nodes:
        for crossing in node.crossings:
            known.add((node.name, crossing.lamella))
            strip = jointed.strips.lamellas[crossing.lamella]
            if not (strip.closed or strip.start < crossing.station < strip.end):
                ends[node.name].add(crossing.lamella)
    numbers = {lamella.mark: i for i, lamella in enumerate(jointed.strips.lamellas)}
    for fixture in jointed.fixtures:
        number = numbers.get(fixture.mark)
        if fixture.feature not in (Feature.START, Feature.END) or number is None:
            continue
        if (fixture.node, number) not in known:
            ends[fixture.node].add(number)
    return ends


def _heights(jointed: Jointed) -> dict[tuple[str, int], float]:
    """How high each strip passes over the node's position, along its axis, mm."""
    at: dict[int, list[tuple[Node, float]]] = defaultdict(list)
    for node in jointed.strips.nodes:
        for crossing in node.crossings:
            at[crossing.lamella].append((node, crossing.station))
    heights = {}
    for number, held in at.items():
        points = jointed.strips.lamellas[number].axis.spline(np.array([s for _, s in held]))
        away = points - np.array([node.position for node, _ in held])
        rises = np.einsum("nc,nc->n", away, np.array([node.axis for node, _ in held]))
        for (node, _), rise in zip(held, rises.tolist(), strict=True):
            heights[node.name, number] = rise
    return heights
