"""Where a strip must end that is cut at a node, so that it lies against the one running through.

With a the signed angle from the tangent of the through strip (thickness t1) to that of the piece
(t2), and d1 = atan(w1 z), d2 = atan(w2 z) the turn of each at height z over the axis (w1, w2 the
rates of twist), the line of the piece at y across meets the side of the through strip

    s(y, z) = (t1 / 2 cos d1 cos d2 - y cos(a - d1) cos d2 sign(sin a)) / |sin(a + d2 - d1)|

from the node; for d1 = d2 = 0 and y = 0 this is t1 / (2 sin a). Each face of the piece ends where
it meets the through strip first, over the whole height: its end is bevelled by the difference.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from fabrication.jointed import Feature, Fixture
from fabrication.joints.node_frames import node_tangents, node_twists
from fabrication.lamella import Lamella, station_of
from fabrication.node import Node
from fabrication.structures import Structure
from gridshell import SettingError
from gridshell.arrays import Floats, Indices, Mask, unit
from gridshell.mesh import alternating_labels

_HEIGHTS = 17


@dataclass(frozen=True)
class Span:
    """A length of one lamella of the design.

    Parameters
    ----------
    carrier : index of the lamella.
    first, last : numbers of its end nodes along the lamella, see ``lamella.piece_of``.
    cut : whether it ends at the first and at the last of them; it keeps the lamella's end if not.
    """

    carrier: int
    first: int
    last: int
    cut: tuple[bool, bool]


@dataclass(frozen=True, eq=False)
class Ends:
    """Cut ends of pieces, one row each.

    Parameters
    ----------
    span, side : (n,) index of the span; 0 at its start, 1 at its end.
    node : (n,) index of the design's node.
    angle : (n,) signed, from the through strip's tangent to the piece's, radians.
    near, far : (n,) distance along the axis from the node to the end of the near (+b) and of the
        far face, without a gap, mm.
    tangents : (n, 2, 3) of the piece, away from the node, and of the through strip.
    twists : (n, 2) rates of both, rad/mm.
    """

    span: Indices
    side: Indices
    node: Indices
    angle: Floats
    near: Floats
    far: Floats
    tangents: Floats
    twists: Floats


def spans(lamella: Lamella, carrier: int, cut: Mask) -> Iterator[Span]:
    """The pieces of a lamella that is cut at some of its nodes (k,), in order along it.

    What would be left beyond a cut end node is no piece.
    """
    at, last = np.flatnonzero(cut).tolist(), len(cut) - 1
    if not at:
        yield Span(carrier, 0, last, (False, False))
        return
    if not lamella.closed and at[0] > 0:
        yield Span(carrier, 0, at[0], (False, True))
    yield from (Span(carrier, a, b, (True, True)) for a, b in pairwise(at))
    if lamella.closed:
        yield Span(carrier, at[-1], at[0] + len(cut), (True, True))
    elif at[-1] < last:
        yield Span(carrier, at[-1], last, (True, False))


def piece_ends(design: Structure, made: Sequence[Span], *, square: bool) -> Ends:
    """All cut ends of *made*, in order; each face cut back as far as the other where *square*."""
    rows = [
        (i, side, int(lamella.nodes[number % len(lamella.nodes)]), lamella.family)
        for i, span in enumerate(made)
        for lamella in (design.lamellas[span.carrier],)
        for side, number in enumerate((span.first, span.last))
        if span.cut[side]
    ]
    span, side, node, family = np.array(rows, dtype=np.int64).reshape(-1, 4).T
    nodes: list[Node] = [design.nodes[i] for i in node.tolist()]
    tangents, twists = node_tangents(design, nodes), node_twists(design, nodes)
    row, own = np.arange(len(node)), family - 1
    mine, through = tangents[row, own], tangents[row, 1 - own]
    axes = np.array([one.axis for one in nodes]).reshape(-1, 3)
    across = np.einsum("nc,nc->n", np.cross(through, mine), axes)
    angle = np.arctan2(across, np.einsum("nc,nc->n", through, mine))
    outwards = np.where(side == 0, 1.0, -1.0)
    turning = np.stack([twists[row, own], twists[row, 1 - own]], axis=1)
    half = design.profile.width / 2.0
    near, far = (
        face_end(
            angle=angle[:, None],
            twist=turning[:, :1],
            through_twist=turning[:, 1:],
            y=np.asarray(outwards[:, None] * (face * design.profile.thickness / 2.0)),
            through_thickness=design.profile.thickness,
            heights=np.linspace(-half, half, _HEIGHTS),
        ).max(axis=1)
        for face in (1.0, -1.0)
    )
    if square:
        near = far = np.maximum(near, far)
    arms = np.stack([mine * outwards[:, None], through], axis=1)
    return Ends(span, side, node, angle, near, far, arms, turning)


def face_end(
    *,
    angle: Floats | float,
    twist: Floats | float,
    through_twist: Floats | float,
    y: Floats | float,
    through_thickness: float,
    heights: Floats,
) -> Floats:
    """Distance from the node at which a line of the piece meets the through strip, mm.

    All arguments broadcast against each other. The piece begins at the node.

    Parameters
    ----------
    angle : signed, from the through strip's tangent to the piece's, radians.
    twist, through_twist : rates dn/ds . b, rad/mm.
    y : of the line, across the piece, mm; with the other sign where the piece ends at the node.
    through_thickness : mm.
    heights : of the line over the axis, mm.
    """
    d1, d2 = np.arctan(through_twist * heights), np.arctan(twist * heights)
    side = through_thickness / 2.0 * np.cos(d1) - y * np.cos(angle - d1) * np.sign(np.sin(angle))
    return np.asarray(side * np.cos(d2) / np.abs(np.sin(angle + d2 - d1)))


def through_families(design: Structure, through: int, *, pinwheel: bool) -> Indices:
    """(n,) family that runs through at each node of the design; 0 where no two lamellas cross.

    Parameters
    ----------
    through : the family; of a pinwheel that at the first node of every connected part.
    pinwheel : whether the families take turns from node to node.

    Raises
    ------
    SettingError
        For a pinwheel around a ring of an odd number of bays.
    """
    regular = np.array([node.regular for node in design.nodes], dtype=bool)
    turn = _checkerboard(design) if pinwheel else np.zeros(len(regular), dtype=np.int64)
    return np.where(regular, np.where(turn == 0, through, 3 - through), 0)


def _checkerboard(design: Structure) -> Indices:
    """(n,) 0 or 1, different at any two neighbours along a lamella."""
    bays = [
        np.stack([lamella.nodes, np.roll(lamella.nodes, -1)])[:, : None if lamella.closed else -1]
        for lamella in design.lamellas
    ]
    a, b = np.concatenate(bays, axis=1)
    colour = alternating_labels(len(design.nodes), a, b, np.ones(len(a), dtype=bool))
    wrong = np.flatnonzero(colour[a] == colour[b])
    if len(wrong):
        first, second = (design.nodes[int(side[wrong[0]])].name for side in (a, b))
        raise SettingError(
            "The pinwheel does not close around a ring with an odd number of bays",
            where=f"{first} and {second}",
            advice="an even number of lamellas around, or one family running through",
        )
    return colour


def cut_ends(design: Structure, span: Span, trims: tuple[float, float]) -> tuple[float, float]:
    """Stations of the two ends of a span on its lamella, mm.

    Parameters
    ----------
    trims : what is cut back from either end node where the span is cut, mm.
    """
    lamella = design.lamellas[span.carrier]
    first, last = station_of(lamella, np.array([span.first, span.last])).tolist()
    return (
        first + trims[0] if span.cut[0] else lamella.start,
        last - trims[1] if span.cut[1] else lamella.end,
    )


# ---- fixtures ---------------------------------------------------------------------------------


def end_fixtures(
    design: Structure,
    made: Sequence[Span],
    pieces: Sequence[Lamella],
    ends: Ends,
    bevels: Floats,
    gap: float,
) -> tuple[Fixture, ...]:
    """Where the middle line of every strip ends.

    A cut end is taken from its node, along the tangent there with its bending: on the strip it
    lies half the bevel inside the outline. Free ends are those of the design's lamellas.
    """
    row_of = {
        (span, side): row
        for row, (span, side) in enumerate(zip(ends.span.tolist(), ends.side.tolist(), strict=True))
    }
    middle = design.profile.width / 2.0
    fixtures = []
    for index, (span, piece) in enumerate(zip(made, pieces, strict=True)):
        carrier = design.lamellas[span.carrier]
        for side, feature in enumerate((Feature.START, Feature.END)):
            inside = abs(float(bevels[index, side])) / 2.0
            x = (inside, piece.length - inside)[side]
            row = row_of.get((index, side))
            if row is None:
                station = np.array([(carrier.start, carrier.end)[side]])
                f = carrier.frames(station)
                node, place, axis = int(piece.nodes[-side]), f.points[0], f.n[0]
            else:
                node = int(ends.node[row])
                place, axis = _cut_place(design, carrier, ends, row, gap)
            name = design.nodes[node].name
            fixtures.append(Fixture(piece.mark, name, feature, x, middle, place, axis))
    return tuple(fixtures)


def _cut_place(
    design: Structure, carrier: Lamella, ends: Ends, row: int, gap: float
) -> tuple[Floats, Floats]:
    """Where the middle line of a cut end lies, and the direction of the width there."""
    node = design.nodes[int(ends.node[row])]
    away = float(ends.near[row] + ends.far[row]) / 2.0 + gap / 2.0
    out = ends.tangents[row, 0]
    forwards = 1.0 if ends.side[row] == 0 else -1.0
    across = np.cross(node.axis, forwards * out)
    station = next(
        c.station for c in node.crossings if design.lamellas[c.lamella].mark == carrier.mark
    )
    weak, strong = (float(k[0]) for k in carrier.bending(np.array([station])))
    bent = (weak * across + strong * node.axis) * away**2 / 2.0
    turn = float(ends.twists[row, 0]) * forwards * across - strong * out
    return node.position + away * out + bent, unit(node.axis + away * turn)
