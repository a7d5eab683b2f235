"""The node schedule: position, angle, strips, slot widths and stations of every node."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import numpy as np

from fabrication.export.papers.sheet_frame import Page
from fabrication.export.papers.tables import Column, table_pages
from fabrication.jointed import Jointed
from fabrication.node import Node
from fabrication.parts import FlatPart

_COLUMNS = (
    Column("node", 0.8),
    Column("x", 0.9, "right"),
    Column("y", 0.9, "right"),
    Column("z", 0.9, "right"),
    Column("angle, degrees", 0.9, "right"),
    Column("strips", 2.2),
    Column("x on each strip", 2.6),
    Column("slot widths", 1.4),
)


def node_pages(jointed: Jointed, parts: Sequence[FlatPart], *, paper: str) -> Iterator[Page]:
    """One row per place where strips cross, in their order."""
    widths: dict[str, list[str]] = {}
    for part in parts:
        for slot in part.slots:
            widths.setdefault(slot.node, []).append(f"{slot.width:.2f}")
    rows = [_row(jointed, node, widths) for node in jointed.strips.nodes]
    yield from table_pages("Nodes", _COLUMNS, rows, paper=paper)


def _row(jointed: Jointed, node: Node, widths: dict[str, list[str]]) -> tuple[str, ...]:
    strips = jointed.strips.lamellas
    crossings = [(strips[c.lamella], c.station) for c in node.crossings]
    return (
        node.name,
        *(f"{value:.1f}" for value in (node.position.round(1) + 0.0).tolist()),
        "-" if node.angle is None else f"{np.degrees(node.angle):.2f}",
        " ".join(strip.mark for strip, _ in crossings),
        " / ".join(_place(station - strip.start, strip.length) for strip, station in crossings),
        " / ".join(widths.get(node.name, ["-"])),
    )


def _place(x: float, length: float) -> str:
    """Where a node lies on a strip, mm; a piece that is cut at the node ends there."""
    return f"{x:.1f}" if 0.0 <= x <= length else "end"
