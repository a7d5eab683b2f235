"""Shear blocks: what joins the two profiles of an axis into one beam once they are bent (Fig. 14).

A block fills the distance between the two strips of an axis, as far as a straight block can: the
strips bend along it. Blocks stand between the nodes, at equal distances, bolted or glued.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np

from fabrication.arrangement import Arrangement
from fabrication.bolts import HOLE_PLAY, bolt_bodies, bolt_length
from fabrication.cut import Hole
from fabrication.finding import Finding, Severity
from fabrication.jointed import BillLine, Feature, Fixture
from fabrication.lamella import Lamella, curve_beside
from fabrication.outlines import Frame
from fabrication.rooms import room_beside
from fabrication.shapes import Body, Prisms, Shape
from fabrication.stock import Material, require_distance, require_positive
from fabrication.structures import Structure
from gridshell import SettingError
from gridshell.arrays import Floats, unit

COLOUR = (0.80, 0.66, 0.45)
_SEAT = 0.2
"""Between a bolt's head and the bent strip it lies on, mm."""


@dataclass(frozen=True)
class ShearBlock:
    """How shear blocks are made.

    Parameters
    ----------
    per_bay : how many stand between two nodes.
    length : along the axis, mm.
    material : what they are cut from.
    height : along the surface normal, mm; the strips' width unless said otherwise.
    bolt : diameter of the bolt through both strips and the block, mm; 0 where it is glued.
    play : between the block and each strip, mm.
    step : thicknesses are rounded down to steps of this, so that many are alike, mm.

    Raises
    ------
    SettingError
        For a size that is not positive.
    """

    per_bay: int
    length: float
    material: Material
    height: float | None = None
    bolt: float = 0.0
    play: float = 0.1
    step: float = 0.1

    def __post_init__(self) -> None:
        if self.per_bay < 1:
            raise SettingError(
                "A bay has one block or more", where="blocks.per_bay", value=f"{self.per_bay}"
            )
        require_positive("blocks.length", self.length)
        require_positive("blocks.step", self.step)
        if self.height is not None:
            require_positive("blocks.height", self.height)
        for key in ("bolt", "play"):
            require_distance(f"blocks.{key}", getattr(self, key))


@dataclass(frozen=True, eq=False)
class Blocks:
    """All blocks of a design: solids, holes by strip, fixtures, bill and findings."""

    connectors: tuple[Prisms, ...]
    holes: dict[str, list[Hole]]
    fixtures: tuple[Fixture, ...]
    bill: tuple[BillLine, ...]
    findings: tuple[Finding, ...]


def shear_blocks(spec: ShearBlock, design: Structure, made: Arrangement, *, keep: float) -> Blocks:
    """Blocks between the two strips of every axis of *design*.

    Parameters
    ----------
    keep : from a node to the end of its stud along an axis, mm.
    """
    profile = design.profile
    places = [_places(lamella, spec.per_bay) for lamella in design.lamellas]
    marks: list[str] = []
    frames: list[Frame] = []
    rooms: list[Floats] = []
    holes: dict[str, list[Hole]] = {lamella.mark: [] for lamella in made.strips.lamellas}
    fixtures: list[Fixture] = []
    for number, lamella in enumerate(design.lamellas):
        bays, s = places[number]
        own = [i for i, carrier in enumerate(made.carriers) if carrier == number]
        if not len(s):
            continue
        beside = [_beside(lamella, made, i, s) for i in own]
        here = _frames(lamella, made.lanes[own[0]].along, s, beside)
        marks += [f"{lamella.mark}-{bay}.{k}" for bay, k in bays]
        frames += here
        origin = np.array([frame.origin for frame in here])
        across = np.array([frame.y for frame in here])
        room = [
            room_beside(
                made.strips.lamellas[i],
                stations,
                origin,
                np.sign(made.lanes[i].across) * across,
                reach=np.full(len(s), spec.length / 2.0),
                width=profile.width,
                thickness=profile.thickness,
            )
            for i, (stations, _) in zip(own, beside, strict=True)
        ]
        rooms.append(2.0 * np.min(room, axis=0))
        if spec.bolt > 0.0:
            names = marks[-len(s) :]
            for i, (stations, positions) in zip(own, beside, strict=True):
                strip = made.strips.lamellas[i]
                for name, at, position in zip(names, stations, positions, strict=True):
                    x, y = float(at - strip.start), profile.width / 2.0
                    hole = Hole(x, y, spec.bolt + HOLE_PLAY, name, f"bolt M{spec.bolt:g}")
                    holes[strip.mark].append(hole)
                    fixtures.append(Fixture(strip.mark, name, Feature.HOLE, x, y, position))
    clear = np.concatenate(rooms) if rooms else np.zeros(0)
    thick = np.floor((clear - 2.0 * spec.play) / spec.step + 1e-9) * spec.step
    found = tuple(_findings(spec, design, keep, marks, thick))
    standing = thick > 0.0
    kept = [(m, f, t) for m, f, t, ok in zip(marks, frames, thick, standing, strict=True) if ok]
    blocks = _prisms(spec, profile.width, kept)
    connectors: tuple[Prisms, ...] = (blocks,)
    bill = list(_lines(spec, blocks))
    if spec.bolt > 0.0 and kept:
        grip = made_grip(made, profile.thickness)
        bolts, lines = _bolts(spec, kept, grip)
        connectors, bill = (blocks, *bolts), [*bill, *lines]
    return Blocks(connectors, holes, tuple(fixtures), tuple(bill), found)


def made_grip(made: Arrangement, thickness: float) -> float:
    """What a bolt through both strips of an axis holds: from outer face to outer face, mm."""
    across = [lane.across for lane in made.lanes]
    return max(across) - min(across) + thickness + 2.0 * _SEAT


def _places(lamella: Lamella, per_bay: int) -> tuple[list[tuple[int, int]], Floats]:
    """Bay and number of every block of an axis, and its station."""
    nodes = lamella.stations
    if lamella.closed:
        nodes = np.r_[nodes, lamella.axis.length]
    share = np.arange(1, per_bay + 1) / (per_bay + 1)
    s = (nodes[:-1, None] + np.diff(nodes)[:, None] * share).ravel()
    bays = [(bay, k) for bay in range(1, len(nodes)) for k in range(1, per_bay + 1)]
    if lamella.closed and per_bay % 2:  # no block over the seam, half-way in the last bay
        last = len(bays) - (per_bay + 1) // 2
        bays, s = [*bays[:last], *bays[last + 1 :]], np.delete(s, last)
    return bays, s


def _beside(lamella: Lamella, made: Arrangement, index: int, s: Floats) -> tuple[Floats, Floats]:
    """Stations of a strip beside stations *s* of its axis, and where the design puts them."""
    lane = made.lanes[index]
    _, stations = curve_beside(lamella, across=lane.across, along=lane.along)
    flat = np.ones_like(s)
    return np.asarray(stations(s)), lamella.place(s, lane.across * flat, lane.along * flat)


def _frames(
    lamella: Lamella, along: float, s: Floats, beside: Sequence[tuple[Floats, Floats]]
) -> list[Frame]:
    """X along the axis at its level, y from the right strip to the left one."""
    left, right = (positions for _, positions in beside)
    step = 1e-3 * lamella.axis.length
    flat = np.full_like(s, along)
    none = np.zeros_like(s)
    ahead = lamella.place(s + step, none, flat) - lamella.place(s - step, none, flat)
    y = unit(left - right)
    x = unit(ahead - np.einsum("nc,nc->n", ahead, y)[:, None] * y)
    origin = (left + right) / 2.0
    return [Frame(o, a, b) for o, a, b in zip(origin, x, y, strict=True)]


def _prisms(spec: ShearBlock, width: float, kept: Sequence[tuple[str, Frame, float]]) -> Prisms:
    height = width if spec.height is None else spec.height
    sizes = sorted({round(float(t), 6) for *_, t in kept})
    half = spec.length / 2.0
    shapes = tuple(
        Shape(f"block {t:g}", _rectangle(half, t / 2.0), -height / 2.0, height / 2.0) for t in sizes
    )
    bodies = tuple(Body(mark, sizes.index(round(float(t), 6)), frame) for mark, frame, t in kept)
    return Prisms("shear blocks", COLOUR, shapes, bodies, spec.material)


def _rectangle(x: float, y: float) -> Floats:
    return np.array([[-x, -y, 0.0], [x, -y, 0.0], [x, y, 0.0], [-x, y, 0.0]])


def _bolts(
    spec: ShearBlock, kept: Sequence[tuple[str, Frame, float]], grip: float
) -> tuple[tuple[Prisms, Prisms], list[BillLine]]:
    """Bolts across the strips through the blocks' middles."""
    heads = [Frame(f.origin + grip / 2.0 * f.y, f.normal, f.x) for _, f, _ in kept]
    length = bolt_length(grip, spec.bolt)
    count = len(kept)
    bolts = bolt_bodies(
        [mark for mark, *_ in kept],
        heads,
        np.full(count, grip),
        [length] * count,
        spec.bolt,
        of="block ",
    )
    lines = [
        BillLine("bolt", f"M{spec.bolt:g} x {length:g}", count, note="through strips and block"),
        BillLine("nut", f"M{spec.bolt:g}", count),
    ]
    return bolts, lines


def _lines(spec: ShearBlock, blocks: Prisms) -> Iterator[BillLine]:
    used = Counter(body.shape for body in blocks.bodies)
    drilled = f", drilled {spec.bolt + HOLE_PLAY:g} mm" if spec.bolt > 0.0 else ", glued"
    for number, shape in enumerate(blocks.shapes):
        x, y = np.ptp(shape.outline[:, :2], axis=0)
        yield BillLine(
            "shear block",
            f"{x:g} x {shape.high - shape.low:g} x {y:.1f} mm",
            used[number],
            material=spec.material.name,
            mass=shape.volume * spec.material.density * 1e-9,
            note=f"between the two strips of an axis{drilled}",
        )


def _findings(
    spec: ShearBlock, design: Structure, keep: float, marks: Sequence[str], thick: Floats
) -> Iterator[Finding]:
    lost = [mark for mark, t in zip(marks, thick, strict=True) if t <= 0.0]
    if lost:
        yield Finding(
            "block-room",
            Severity.ERROR,
            lost[0],
            float(thick.min()),
            0.0,
            "mm",
            f"The strips leave no room for {len(lost)} shear blocks, {lost[0]} first. Use a larger "
            "spacing or shorter blocks.",
        )
    bays = [
        float(np.diff(lamella.stations).min())
        for lamella in design.lamellas
        if len(lamella.stations) > 1
    ]
    apart = min(bays, default=np.inf) / (spec.per_bay + 1)
    room = 2.0 * (apart - keep)
    if spec.per_bay > 1:
        room = min(room, apart)
    if spec.length > room:
        yield Finding(
            "block-length",
            Severity.ERROR,
            "the shortest bay",
            spec.length,
            float(room),
            "mm",
            f"{spec.per_bay} shear blocks of {spec.length:g} mm do not stand clear of each other "
            f"and of the studs: {max(room, 0.0):.0f} mm are left for each. Use shorter or fewer "
            "blocks.",
        )
