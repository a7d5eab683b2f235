"""Joint details: a node seen along its axis and from the side, from the geometry itself.

Everything near the node is drawn as it lies there: strips by their edges, connectors by their
shapes. The view along the axis is cut nowhere, so that what lies below shows through.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from fabrication.arrangement import LEFT, RIGHT
from fabrication.export.papers.sheet_frame import MEDIUM, THIN, Area, Page, Pen, page_area
from fabrication.flattening import corners
from fabrication.jointed import BillLine, Jointed
from fabrication.joints.node_frames import bisector_frames, node_tangents
from fabrication.lamella import Lamella
from fabrication.node import Node
from fabrication.outlines import Frame
from fabrication.parts import FlatPart
from gridshell.arrays import Floats, Points

_REACH = 1.1
"""Length of strips on either side of the node, in widths of the strip."""

_SCALES = (1.0, 2.0, 2.5, 5.0, 10.0, 20.0)
_SAMPLES = 25
_MARGIN = 14.0
_NOTES = 7
"""Lines of notes at most."""


@dataclass(frozen=True)
class _Band:
    """A face or edge of something as polylines: seen along the axis, and from the side."""

    points: Points
    closed: bool
    width: float
    grey: float


def joint_pages(jointed: Jointed, parts: Sequence[FlatPart], *, paper: str) -> Iterator[Page]:
    """The node with the smallest, the middle and the largest angle; one where all are alike."""
    regular = [node for node in jointed.design.nodes if node.regular]
    if not regular:
        return
    frames = bisector_frames(regular, node_tangents(jointed.design, regular))
    area = page_area(paper).inset(_MARGIN)
    for k in _chosen(regular):
        node, frame = regular[k], frames[k]
        bands = [*_strip_bands(jointed, parts, frame), *_connector_bands(jointed, frame)]
        notes = _notes(jointed, parts, node, frame)
        levels = _levels(jointed, frame)
        half = _REACH * jointed.design.profile.width
        scale = _scale(4.9 * half / area.width, 2.2 * half / (area.height - 14.0))

        def draw(
            pen: Pen,
            page: Area,
            bands: Sequence[_Band] = bands,
            frame: Frame = frame,
            notes: Sequence[str] = notes,
            scale: float = scale,
            half: float = half,
            angle: float = float(node.angle or 0.0),
            width: float = jointed.design.profile.width,
            levels: Sequence[float] = levels,
        ) -> None:
            middle = page.y + page.height / 2.0 + 5.0
            left, right = page.x + 0.24 * page.width, page.x + 0.71 * page.width
            for band in bands:
                flat = frame.flat(band.points) / scale
                up = frame.distance(band.points) / scale
                _line(pen, band, np.stack([left + flat[:, 0], middle + flat[:, 1]], axis=1))
                _line(pen, band, np.stack([right + flat[:, 0], middle + up], axis=1))
            _angle(pen, left, middle, angle, half / scale)
            for level in levels:
                _height(pen, right - half / scale - 6.0, middle + level / scale, width, scale)
            top = middle + half / scale + 8.0
            pen.text(left, top, "along the node axis", align="middle")
            pen.text(right, top, "from the side, across the bisector", align="middle")
            y = page.y + 6.0 + 4.6 * (len(notes) - 1)
            for note in notes:
                pen.text(page.x + 10.0, y, note, within=page.width - 20.0)
                y -= 4.6

        yield Page(f"Joint at {node.name}", f"1:{scale:g}", draw)


def _angle(pen: Pen, x: float, y: float, angle: float, radius: float) -> None:
    """The node angle between the lines of the two families, about the bisector."""
    turn = np.linspace(-angle / 2.0, angle / 2.0, _SAMPLES)
    arc = np.array([x, y]) + 0.85 * radius * np.stack([np.cos(turn), np.sin(turn)], axis=1)
    pen.line(arc.tolist(), width=THIN)
    for end in (turn[0], turn[-1]):
        way = radius * np.array([np.cos(end), np.sin(end)])
        pen.line([(x, y), (x + way[0], y + way[1])], width=THIN, dash=(6.0, 1.0, 1.0, 1.0))
    pen.text(x + 0.85 * radius + 2.0, y - 1.2, f"{np.degrees(angle):.2f} deg", height=3.0)


def _levels(jointed: Jointed, frame: Frame) -> list[float]:
    """Heights over the node at which the middles of strips pass it, mm."""
    reach = _REACH * jointed.design.profile.width
    found: set[float] = set()
    for strip in jointed.strips.lamellas:
        near = _near(strip, frame, reach)
        if near is not None:
            points = strip.axis.spline(np.linspace(*near, _SAMPLES))
            nearest = points[np.linalg.norm(frame.flat(points), axis=1).argmin()]
            found.add(round(float(frame.distance(nearest)), 0) + 0.0)
    return sorted(found)


def _height(pen: Pen, x: float, y: float, width: float, scale: float) -> None:
    """The strip's width beside the view from the side; *y* is its middle."""
    half = width / 2.0 / scale
    pen.line([(x, y - half), (x, y + half)], width=THIN)
    for end in (y - half, y + half):
        pen.line([(x - 1.2, end - 1.2), (x + 1.2, end + 1.2)], width=MEDIUM)
        pen.line([(x - 2.0, end), (x + 5.0, end)], width=THIN)
    pen.text(x - 1.5, y, f"{width:g}", height=3.0, align="middle", angle=90.0)


def _chosen(nodes: Sequence[Node]) -> list[int]:
    angle = np.array([node.angle for node in nodes], dtype=float)
    order = np.argsort(angle, kind="stable")
    if np.ptp(angle) < np.radians(2.0):
        return [int(order[len(order) // 2])]
    return [int(order[0]), int(order[len(order) // 2]), int(order[-1])]


def _scale(*least: float) -> float:
    return next((s for s in _SCALES if s >= max(least)), float(np.ceil(max(least) / 10.0) * 10.0))


def _line(pen: Pen, band: _Band, points: Floats) -> None:
    pen.line(points.tolist(), closed=band.closed, width=band.width, grey=band.grey)


# ---- strips --------------------------------------------------------------------------------------


def _strip_bands(jointed: Jointed, parts: Sequence[FlatPart], frame: Frame) -> Iterator[_Band]:
    """Edges of both faces of every strip near the node, slots and holes among them."""
    reach = _REACH * jointed.design.profile.width
    for strip, part in zip(jointed.strips.lamellas, parts, strict=True):
        near = _near(strip, frame, reach)
        if near is None:
            continue
        low, high = near[0] - strip.start, near[1] - strip.start
        outline = corners(part.outline)
        for y, face in zip((0.5, -0.5), part.faces, strict=True):
            flat = _cut_out(corners(face) if len(face) else outline, low, high)
            for piece in flat:
                yield _Band(
                    strip.place(
                        piece[:, 0] + strip.start,
                        np.full(len(piece), y * part.thickness),
                        piece[:, 1] - part.width / 2.0,
                    ),
                    closed=False,
                    width=MEDIUM,
                    grey=0.0 if strip.family == 1 else 0.35,
                )
        turn = np.linspace(0.0, 2.0 * np.pi, _SAMPLES)
        for x, y, diameter in part.circles.tolist():
            if low <= x <= high:
                yield _Band(
                    strip.place(
                        x + diameter / 2.0 * np.cos(turn) + strip.start,
                        np.full(_SAMPLES, part.thickness / 2.0),
                        y + diameter / 2.0 * np.sin(turn) - part.width / 2.0,
                    ),
                    closed=True,
                    width=THIN,
                    grey=0.2,
                )


def _near(strip: Lamella, frame: Frame, reach: float) -> tuple[float, float] | None:
    """Stations between which a strip is within *reach* of the node."""
    start, end = strip.start, strip.end
    s = np.linspace(start, end, 400)
    points = strip.axis.spline(s)
    away = np.linalg.norm(points - frame.origin, axis=1)
    if away.min() > reach:
        return None
    here = s[away < max(reach, float(away.min()) * 1.05)]
    middle = float(s[away.argmin()])
    return max(start, min(float(here[0]), middle - reach)), min(
        end, max(float(here[-1]), middle + reach)
    )


def _cut_out(outline: Floats, low: float, high: float) -> Iterator[Floats]:
    """The pieces of an outline between two places, along x sampled finely."""
    closed = np.vstack([outline, outline[:1]])
    dense = [closed[:1]]
    for a, b in pairwise(closed):
        inside = np.clip([a[0], b[0]], low, high)
        if abs(b[0] - a[0]) > 5.0:
            share = (np.linspace(inside[0], inside[1], _SAMPLES) - a[0]) / (b[0] - a[0])
            dense.append(a + share[:, None] * (b - a))
        dense.append(b[None])
    points = np.concatenate(dense)
    keep = (points[:, 0] >= low - 1e-6) & (points[:, 0] <= high + 1e-6)
    edges = np.flatnonzero(np.diff(np.r_[False, keep, False].astype(int)))
    for first, last in edges.reshape(-1, 2).tolist():
        if last - first > 1:
            yield points[first:last]


# ---- connectors and notes ------------------------------------------------------------------------


def _connector_bands(jointed: Jointed, frame: Frame) -> Iterator[_Band]:
    reach = _REACH * jointed.design.profile.width
    for kind in jointed.connectors:
        for body in kind.bodies:
            if np.linalg.norm(body.frame.origin - frame.origin) > reach:
                continue
            shape = kind.shapes[body.shape]
            for loop in (shape.outline, *shape.openings):
                flat = corners(loop)
                ends = [
                    body.frame.place(flat) + z * body.frame.normal for z in (shape.low, shape.high)
                ]
                for end in ends:
                    yield _Band(end, closed=True, width=THIN, grey=0.0)
                for a, b in list(zip(*ends, strict=True))[:: max(1, len(flat) // 12)]:
                    yield _Band(np.array([a, b]), closed=False, width=THIN, grey=0.5)


def _notes(jointed: Jointed, parts: Sequence[FlatPart], node: Node, frame: Frame) -> list[str]:
    """What the drawing does not dimension, each a line."""
    profile = jointed.design.profile
    angle = float(np.degrees(node.angle or 0.0))
    notes = [f"Node angle {angle:.2f} degrees; strips {profile.size} mm"]
    slots = [
        (part.mark[0], slot)
        for part in parts
        for slot in part.slots
        if slot.node.rstrip(LEFT + RIGHT) == node.name
    ]
    if slots:
        told = []
        for family in sorted({family for family, _ in slots}):
            widths = [f"{slot.width:.2f}" for own, slot in slots if own == family]
            told.append(f"in {family} {' / '.join(sorted(set(widths)))}")
        depth = max(slot.depth for _, slot in slots)
        notes.append(f"Slots {', '.join(told)} mm wide, {depth:.1f} mm deep")
    notes += [
        f"{line.item}: {line.size}{f', {line.note}' if line.note else ''}"
        for line in _bill_here(jointed, frame)
    ]
    return notes[:_NOTES]


def _bill_here(jointed: Jointed, frame: Frame) -> Iterator[BillLine]:
    """Lines of the bill for what is drawn; of several shapes those at the node."""
    reach = _REACH * jointed.design.profile.width
    here = {
        kind.shapes[body.shape].mark
        for kind in jointed.connectors
        for body in kind.bodies
        if np.linalg.norm(body.frame.origin - frame.origin) <= reach
    }
    marks = {shape.mark for kind in jointed.connectors for shape in kind.shapes}
    seen: set[str] = set()
    for line in jointed.bill:
        mark = line.size.split(":")[0]
        if mark in here or (mark not in marks and line.item not in seen):
            seen.add(line.item)
            yield line
