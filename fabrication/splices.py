"""Strips cut into pieces and spliced: where they may be, and the design with its pieces.

Pieces of a strip lie where the strip lay: their stations, cuts and fixtures are those of the strip,
counted from their own cut ends. Splice plates are flat parts; they are bent with the strip on site
and are no solids of the assembly.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from itertools import pairwise

import numpy as np

from fabrication.cut import Cuts, Hole
from fabrication.jointed import Feature, Fixture, Jointed
from fabrication.lamella import Lamella, piece_of
from fabrication.node import Crossing, Node
from fabrication.sheet_parts import SheetPiece
from fabrication.splice_plan import SplicePlan, spans
from fabrication.splice_plate import SplicePlate, require_room
from fabrication.splice_search import Place, Run
from fabrication.structures import Structure
from gridshell.arrays import Floats


def runs_of(
    jointed: Jointed, plate: SplicePlate, *, clear: float = 5.0, positions: int = 3
) -> tuple[Run, ...]:
    """Every strip with the places where it may be spliced.

    Parameters
    ----------
    plate : must lie between two slots or holes.
    clear : between the plate and a slot, a hole or a cut end, mm.
    positions : places per bay, equally far from each other; one is at its middle.
    """
    passed = _passed(jointed)
    beside = _neighbours(jointed)
    runs = []
    for number, strip in enumerate(jointed.strips.lamellas):
        cuts = jointed.cuts[strip.mark]
        walls = [(s.x - s.spread, s.x + s.spread) for s in cuts.slots]
        walls += [(h.x - h.diameter / 2.0, h.x + h.diameter / 2.0) for h in cuts.holes]
        walls = [(0.0, 0.0), *sorted(walls), (strip.length, strip.length)]
        reach = plate.length / 2.0 + clear
        places: list[Place] = []
        at = np.array([x for x, _ in passed[number]])
        high = 0.0
        for (_, before), (after, _) in pairwise(walls):
            high = max(high, before)
            low, top = high + reach, after - reach
            if top < low:
                continue
            count = positions if top > low else 1
            inside = np.linspace(low, top, count) if count > 1 else np.array([(low + top) / 2.0])
            for x in inside.tolist():
                k = int(np.searchsorted(at, x))
                ends = [passed[number][j][1] if 0 <= j < len(at) else -1 for j in (k - 1, k)]
                places.append(Place(x, (min(ends), max(ends))))
        runs.append(Run(strip.mark, strip.length, tuple(places), beside[number]))
    return tuple(runs)


def _passed(jointed: Jointed) -> list[list[tuple[float, int]]]:
    """Of every strip, in order: x of its crossings and the design's lamella that crosses there."""
    found: list[list[tuple[float, int]]] = [[] for _ in jointed.strips.lamellas]
    for node in jointed.strips.nodes:
        for here in node.crossings:
            own = jointed.carriers[here.lamella]
            for other in node.crossings:
                if (carrier := jointed.carriers[other.lamella]) != own:
                    start = jointed.strips.lamellas[here.lamella].start
                    found[here.lamella].append((here.station - start, carrier))
    return [sorted(set(passed)) for passed in found]


def _neighbours(jointed: Jointed) -> list[tuple[str, ...]]:
    """Of every strip: strips of the same axis, and of the next axes of its family."""
    lines: dict[int, list[tuple[float, int]]] = {}
    for node in jointed.design.nodes:
        for here in node.crossings:
            for other in node.crossings:
                if other.lamella != here.lamella:
                    lines.setdefault(here.lamella, []).append((here.station, other.lamella))
    pairs = set()
    for crossed in lines.values():
        for (_, a), (_, b) in pairwise(sorted(crossed)):
            pairs |= {(a, b), (b, a)}
    strips = list(enumerate(jointed.strips.lamellas))
    return [
        tuple(
            other.mark
            for j, other in strips
            if j != i
            and other.family == strip.family
            and (
                jointed.carriers[j] == jointed.carriers[i]
                or (jointed.carriers[i], jointed.carriers[j]) in pairs
            )
        )
        for i, strip in strips
    ]


# ---- pieces -------------------------------------------------------------------------------------


@dataclass(frozen=True, eq=False)
class _Cut:
    """One piece: the strip it is cut from, from *start* to *end*, x of the strip, mm."""

    strip: int
    lamella: Lamella
    start: float
    end: float
    origin: float


def spliced(jointed: Jointed, plan: SplicePlan, plate: SplicePlate) -> Jointed:
    """*jointed* with its strips cut into pieces, and the holes and the bill of the splices.

    Raises
    ------
    SettingError
        For a plate wider than the strips.
    """
    profile = jointed.strips.profile
    require_room(plate, profile.width)
    pieces = [
        piece
        for number, strip in enumerate(jointed.strips.lamellas)
        for piece in _pieces(number, strip, plan)
    ]
    nodes = _nodes(jointed, pieces)
    strips = Structure(tuple(piece.lamella for piece in pieces), nodes, profile)
    renamed = _renamed(jointed.strips, strips, pieces)
    of_strip: dict[str, list[_Cut]] = {}
    for piece in pieces:
        of_strip.setdefault(jointed.strips.lamellas[piece.strip].mark, []).append(piece)
    cuts: dict[str, Cuts] = {}
    fixtures: list[Fixture] = []
    for mark, several in of_strip.items():
        for number, piece in enumerate(several):
            ends = (number == 0, number == len(several) - 1)
            own = _divided(jointed.cuts[mark], piece, ends, renamed)
            holes = tuple(_holes(piece, several, plan.splices.get(mark, ()), plate, profile.width))
            together = tuple(sorted((*own.holes, *holes), key=lambda hole: hole.x))
            cuts[piece.lamella.mark] = replace(own, holes=together)
            fixtures += _fixtures(piece, holes, ends, profile.width)
    fixtures = [*_moved(jointed, of_strip), *fixtures]
    return replace(
        jointed,
        strips=strips,
        carriers=tuple(jointed.carriers[piece.strip] for piece in pieces),
        cuts=cuts,
        fixtures=tuple(fixtures),
        bill=(*jointed.bill, *plate.bill(plan.count // plan.copies, profile.thickness)),
        findings=(*jointed.findings, *plan.findings),
    )


def splice_plates(plan: SplicePlan, plate: SplicePlate) -> tuple[SheetPiece, ...]:
    """The plates of all splices as flat parts: "A3.1-2", or "A3.1-2a" and "A3.1-2b"."""
    letters = "ab" if plate.sides.value > 1 else ("",)
    return tuple(
        plate.piece(f"{mark}.{k}-{k + 1}{letter}")
        for mark, places in plan.splices.items()
        for k in range(1, len(places) + 1)
        for letter in letters
    )


def _pieces(number: int, strip: Lamella, plan: SplicePlan) -> Iterator[_Cut]:
    places = plan.splices.get(strip.mark, ())
    if not places:
        yield _Cut(number, strip, 0.0, strip.length, 0.0)
        return
    for k, (start, end) in enumerate(spans(strip.length, places, plan.gap), start=1):
        low, high = start + strip.start, end + strip.start
        at = strip.stations
        inside = np.flatnonzero((at >= low) & (at <= high))
        if len(inside) > 1:
            first, last = int(inside[0]), int(inside[-1])
        else:
            last = int(np.clip(np.searchsorted(at, high), 1, len(at) - 1))
            first = min(max(int(np.searchsorted(at, low)) - 1, 0), last - 1)
        piece = piece_of(strip, f"{strip.mark}.{k}", (first, last), low, high)
        yield _Cut(number, piece, start, end, float(at[first]))


def _holder(pieces: Sequence[_Cut], x: float) -> _Cut:
    """The piece of a strip that holds *x*."""
    return next((piece for piece in pieces if x <= piece.end), pieces[-1])


def _nodes(jointed: Jointed, pieces: Sequence[_Cut]) -> tuple[Node, ...]:
    of_strip: dict[int, list[tuple[int, _Cut]]] = {}
    for index, piece in enumerate(pieces):
        of_strip.setdefault(piece.strip, []).append((index, piece))
    nodes = []
    for node in jointed.strips.nodes:
        crossings = []
        for crossing in node.crossings:
            several = of_strip[crossing.lamella]
            x = crossing.station - jointed.strips.lamellas[crossing.lamella].start
            index, piece = next((one for one in several if x <= one[1].end), several[-1])
            crossings.append(Crossing(index, crossing.station - piece.origin))
        nodes.append(replace(node, crossings=tuple(crossings)))
    return tuple(nodes)


def _renamed(
    before: Structure, after: Structure, pieces: Sequence[_Cut]
) -> dict[tuple[str, str], str]:
    """Mark of the piece by node and mark of the strip."""
    return {
        (node.name, before.lamellas[pieces[c.lamella].strip].mark): after.lamellas[c.lamella].mark
        for node in after.nodes
        for c in node.crossings
    }


def _divided(
    cuts: Cuts, piece: _Cut, ends: tuple[bool, bool], renamed: dict[tuple[str, str], str]
) -> Cuts:
    """The cuts of a strip that lie on one of its pieces."""
    low = -np.inf if ends[0] else piece.start
    high = np.inf if ends[1] else piece.end
    slots = tuple(
        replace(s, x=s.x - piece.start, partner=renamed.get((s.node, s.partner), s.partner))
        for s in cuts.slots
        if low <= s.x <= high
    )
    holes = tuple(replace(h, x=h.x - piece.start) for h in cuts.holes if low <= h.x <= high)
    bevels = (cuts.bevels[0] if ends[0] else 0.0, cuts.bevels[1] if ends[1] else 0.0)
    return Cuts(slots, holes, bevels)


def _holes(
    piece: _Cut,
    several: Sequence[_Cut],
    places: Sequence[Place],
    plate: SplicePlate,
    width: float,
) -> Iterator[Hole]:
    """Holes of the splices at the ends of *piece*, in its own coordinates."""
    strip = piece.lamella.mark.rpartition(".")[0]
    for k, place in enumerate(places, start=1):
        if piece in several[k - 1 : k + 1]:
            for x in (place.x + plate.offsets - piece.start).tolist():
                if 0.0 < x < piece.end - piece.start:
                    name = f"{strip}.{k}-{k + 1}"
                    yield Hole(x, width / 2.0, plate.hole, name, f"splice bolt M{plate.bolt:g}")


def _fixtures(
    piece: _Cut, holes: Sequence[Hole], ends: tuple[bool, bool], width: float
) -> Iterator[Fixture]:
    """Where the holes of the splices and the ends at the butts must lie."""
    lamella = piece.lamella
    for hole in holes:
        position = _at(lamella, hole.x, hole.y - width / 2.0)
        yield Fixture(lamella.mark, hole.node, Feature.HOLE, hole.x, hole.y, position)
    length = piece.end - piece.start
    butts = ((Feature.START, 0.0, ends[0]), (Feature.END, length, ends[1]))
    for feature, x, outer in butts:
        if not outer:
            axis = lamella.frames(np.array([lamella.start + x])).n[0]
            place = f"{lamella.mark} {feature.value}"
            position = _at(lamella, x, 0.0)
            yield Fixture(lamella.mark, place, feature, x, width / 2.0, position, axis)


def _at(lamella: Lamella, x: float, z: float) -> Floats:
    at = lamella.place(np.array([lamella.start + x]), np.zeros(1), np.array([z]))
    return np.asarray(at[0])


def _moved(jointed: Jointed, of_strip: dict[str, list[_Cut]]) -> Iterator[Fixture]:
    """The fixtures of the joint, on the pieces."""
    for fixture in jointed.fixtures:
        piece = _holder(of_strip[fixture.mark], fixture.x)
        yield replace(fixture, mark=piece.lamella.mark, x=fixture.x - piece.start)
