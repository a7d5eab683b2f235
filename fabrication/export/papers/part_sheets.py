"""Part sheets: every strip with running dimensions from one end, as it lies on the bench.

A strip is long and narrow: it is drawn at one scale along and a larger one across, both stated. A
strip longer than a page is wrapped into rows. Above a row stand the places of all cuts from the
strip's left end, below it what is cut there: partner, node and width w of a slot; place, diameter d
and height y of a hole over the lower edge.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from fabrication.export.papers.sheet_frame import (
    MEDIUM,
    THIN,
    Area,
    Page,
    Pen,
    page_area,
    text_width,
)
from fabrication.flattening import corners
from fabrication.jointed import Jointed
from fabrication.parts import FlatPart, uncut_nodes
from fabrication.words import plural
from gridshell.arrays import Floats

_SCALES = (1.0, 2.0, 2.5, 4.0, 5.0, 7.5, 10.0, 12.5, 15.0, 20.0, 25.0, 30.0, 40.0, 50.0)
_PITCH = 3.2
"""Between two figures written across the strip, mm."""

_ABOVE, _BELOW, _HEAD, _GAP = 17.0, 32.0, 8.0, 2.0
"""Room for the figures above and below a row, a strip's heading, and between strips, mm."""

_MARGIN = 8.0
_HIGHEST = 17.0
"""Height of a strip on paper at most, mm."""


@dataclass(frozen=True)
class _Cut:
    """A place on the strip with what is told of it."""

    x: float
    text: str


@dataclass(frozen=True)
class _Row:
    """A length of a strip on paper."""

    part: FlatPart
    low: float
    high: float
    number: int
    rows: int


def part_pages(jointed: Jointed, parts: Sequence[FlatPart], *, paper: str) -> Iterator[Page]:
    """Pages of all strips, in their order, several on a page."""
    area = page_area(paper).inset(_MARGIN)
    if not parts:
        return
    uncut = uncut_nodes(jointed)
    told = {part.mark: _cuts(part, uncut[part.mark]) for part in parts}
    along = _along(parts, told, area.width)
    across = _scale(parts[0].width / _HIGHEST)
    height = _HEAD + _ABOVE + parts[0].width / across + _BELOW + _GAP
    per_page = max(1, int(area.height // height))
    rows = [row for part in parts for row in _rows(part, along * area.width)]
    scale = f"along 1:{along:g}, across 1:{across:g}"
    for k in range(0, len(rows), per_page):
        chunk = rows[k : k + per_page]

        def draw(pen: Pen, page: Area, chunk: Sequence[_Row] = chunk) -> None:
            inside = page.inset(_MARGIN)
            for place, row in enumerate(chunk):
                top = inside.y + inside.height - place * height
                _draw(pen, row, told[row.part.mark], inside.x, top, along, across, jointed)

        first, last = chunk[0].part.mark, chunk[-1].part.mark
        title = f"Strip {first}" if first == last else f"Strips {first} to {last}"
        yield Page(title, scale, draw)


def _along(parts: Sequence[FlatPart], told: Mapping[str, Sequence[_Cut]], width: float) -> float:
    """The scale at which cuts are legible: no figures closer than half their pitch, most rows."""
    gaps = np.concatenate([np.diff(np.sort([c.x for c in told[p.mark]])) for p in parts])
    gaps = gaps[gaps > 1e-6]
    typical = float(np.quantile(gaps, 0.3)) if len(gaps) else parts[0].length
    longest = max(part.length for part in parts)
    return _scale(min(longest / width, max(typical / _PITCH, longest / (4.0 * width))))


def _scale(least: float) -> float:
    return next((scale for scale in _SCALES if scale >= least - 1e-9), float(np.ceil(least)))


def _rows(part: FlatPart, room: float) -> Iterator[_Row]:
    count = max(1, int(np.ceil(part.length / room - 1e-9)))
    for k in range(count):
        yield _Row(part, k * room, min((k + 1) * room, part.length), k + 1, count)


def _cuts(part: FlatPart, uncut: Sequence[tuple[float, str, str]]) -> list[_Cut]:
    """All places in order: both ends, slots, holes, and nodes where nothing is cut."""
    found = [_Cut(0.0, _end(part, 0)), _Cut(part.length, _end(part, 1))]
    found += [_Cut(x, f"{others} {node}") for x, others, node in uncut]
    found += [_Cut(s.x, f"{s.partner} {s.node} w {s.width:.2f}") for s in part.slots]
    found += [
        _Cut(hole.x, f"{hole.node} d {hole.diameter:g} y {hole.y:.1f}") for hole in part.holes
    ]
    found += [_Cut(d.x, f"{d.node} d {d.diameter:g} drilled") for d in part.drills]
    return sorted(found, key=lambda cut: cut.x)


def _end(part: FlatPart, which: int) -> str:
    run = part.bevels[which]
    if run == 0.0:
        return "end"
    angle = float(np.degrees(np.arctan2(part.thickness, abs(run))))
    return f"end {angle:.1f} deg, {'near' if run > 0.0 else 'far'} longer"


def _section(part: FlatPart) -> str:
    """Width and thickness, and the wall of a tube."""
    size = f"{part.width:g} x {part.thickness:g}"
    return f"{size} x {part.wall:g}" if part.wall else size


def _depths(part: FlatPart) -> str:
    """Edges the slots open to, their depths and floors, where there are any."""
    kinds = sorted({(s.edge.value, s.depth, s.floor.value) for s in part.slots})
    told = [f"{edge} edge, {depth:g} deep, {floor} floors" for edge, depth, floor in kinds]
    if part.drills:
        return "drilled through both narrow walls, square to the edge"
    return f"slots: {'; '.join(told)}" if told else ""


def _draw(
    pen: Pen,
    row: _Row,
    told: Sequence[_Cut],
    x: float,
    top: float,
    along: float,
    across: float,
    jointed: Jointed,
) -> None:
    part = row.part
    material = jointed.design.profile.material
    mass = part.volume * material.density * 1e-9
    more = f"   (row {row.number} of {row.rows})" if row.rows > 1 else ""
    pen.text(x, top - 5.0, part.mark, height=4.0, bold=True)
    pen.text(
        x + 4.0 + text_width(part.mark, 4.0, bold=True),
        top - 5.0,
        f"{plural(part.quantity, 'piece')}   {part.length:.1f} x {_section(part)} mm   "
        f"{material.name}   {mass:.3g} kg   {_depths(part)}{more}",
    )
    base = top - _HEAD - _ABOVE - part.width / across
    outline = corners(part.outline)
    flat = np.column_stack([x + (outline[:, 0] - row.low) / along, base + outline[:, 1] / across])
    _clipped(pen, flat, x, x + (row.high - row.low) / along)
    cuts = [cut for cut in told if row.low - 1e-6 <= cut.x <= row.high + 1e-6]
    _figures(pen, cuts, x, base, part.width / across, row, along)
    for drill in part.drills:
        if row.low <= drill.x <= row.high:
            at = x + (drill.x - row.low) / along
            ends = [(at, base - 1.0), (at, base + part.width / across + 1.0)]
            pen.line(ends, width=THIN, dash=(2.0, 0.7, 0.4, 0.7))
    for hole in part.holes:
        if row.low <= hole.x <= row.high:
            at = x + (hole.x - row.low) / along
            pen.circle(at, base + hole.y / across, max(hole.diameter / across / 2.0, 0.4))


def _clipped(pen: Pen, outline: Floats, low: float, high: float) -> None:
    """The outline between two places on paper; cut ends of a row get a dashed line."""
    canvas = pen.canvas
    canvas.saveState()
    clip = canvas.beginPath()
    size = 72.0 / 25.4
    y = outline[:, 1]
    clip.rect(
        (low - 0.3) * size,
        (y.min() - 0.3) * size,
        (high - low + 0.6) * size,
        (np.ptp(y) + 0.6) * size,
    )
    canvas.clipPath(clip, stroke=0)
    pen.line(outline.tolist(), closed=True, width=MEDIUM, fill=0.93)
    canvas.restoreState()
    for at, beyond in ((low, outline[:, 0].min() < low - 1.0), (high, outline[:, 0].max() > high)):
        if beyond and abs(outline[:, 0].max() - at) > 0.5:
            pen.line([(at, y.min() - 2.0), (at, y.max() + 2.0)], width=THIN, dash=(3.0, 1.0))


def _figures(
    pen: Pen, cuts: Sequence[_Cut], x: float, base: float, height: float, row: _Row, along: float
) -> None:
    """Running dimensions above, what is cut below, both with leaders to their places."""
    at = np.array([x + (cut.x - row.low) / along for cut in cuts])
    placed = spread(at, _PITCH, x, x + (row.high - row.low) / along)
    for cut, here, there in zip(cuts, at.tolist(), placed.tolist(), strict=True):
        top = base + height
        pen.line([(here, top), (here, top + 1.5), (there, top + 4.5)], width=THIN)
        pen.text(there + 0.9, top + 5.0, f"{cut.x:.1f}", height=2.2, angle=90.0)
        pen.line([(here, base), (here, base - 1.5), (there, base - 4.5)], width=THIN)
        pen.text(
            there + 0.9, base - 5.0, cut.text, height=2.0, angle=90.0, align="right", within=28.0
        )


def spread(at: Floats, pitch: float, low: float, high: float) -> Floats:
    """Places (n,) in order moved so far that neighbours are a pitch apart; evenly where it is full.

    Places move as little as they can in one sweep from the left and one from the right.
    """
    if len(at) < 2:
        return at
    room = (high - low + pitch) / len(at)
    pitch = min(pitch, room)
    steps = pitch * np.arange(len(at))
    right = np.maximum.accumulate(at - steps) + steps
    left = np.minimum.accumulate((at - steps)[::-1])[::-1] + steps
    middle = (right + left) / 2.0
    middle = np.maximum.accumulate(middle - steps) + steps
    over = max(0.0, float(middle[-1] - high - pitch / 2.0))
    return np.asarray(np.maximum(middle - over, low - pitch / 2.0 + steps))
