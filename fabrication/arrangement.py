"""Strips beside the axes of a design: double lamellas, two levels, and where strips then cross.

A net gives one axis per lamella. What is built along it may be several strips, each at its own
distance across the axis and along the surface normal (Fig. 14, Fig. 15 c and d). Such a strip is a
lamella of its own: it follows its own curve, which is longer or shorter than the axis, and where
two of them cross is found on these curves, not on the axes.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np
from scipy.interpolate import CubicHermiteSpline, CubicSpline

from fabrication.lamella import Lamella, curve_beside
from fabrication.node import Crossing, Node, node_angles
from fabrication.structures import Structure
from gridshell.arrays import Floats, Indices, Points, Vectors, unit

_NEWTON_STEPS = 8


@dataclass(frozen=True)
class Lane:
    """Where a strip runs beside its axis.

    Parameters
    ----------
    suffix : of the strip's mark: "L" left of the axis, looking along it with the surface normal
        up, "R" right of it.
    across : distance along b = n x t, mm; positive to the left.
    along : distance along the surface normal n, mm.
    """

    suffix: str = ""
    across: float = 0.0
    along: float = 0.0


LEFT, RIGHT = "L", "R"


@dataclass(frozen=True, eq=False)
class Arrangement:
    """Strips of a design.

    Parameters
    ----------
    strips : as lamellas, those of one axis together, in the design's order; the nodes are the
        places where two of them cross, and the design's own nodes where no pair does.
    carriers : index of the design's lamella for each strip.
    lanes : the lane of each strip.
    miss : (n,) distance between the two curves at each crossing, mm.
    """

    strips: Structure
    carriers: tuple[int, ...]
    lanes: tuple[Lane, ...]
    miss: Floats


def arranged(
    design: Structure, lanes: Mapping[int, Sequence[Lane]], *, crossing: bool = True
) -> Arrangement:
    """Put a strip on every lane of every axis of *design*.

    Parameters
    ----------
    lanes : by family.
    crossing : whether strips of the two families meet, in a node for every pair, named after the
        design's node and both suffixes ("N12LR"); on two levels they pass each other, and the
        design's nodes are kept.
    """
    strips: list[Lamella] = []
    carriers: list[int] = []
    chosen: list[Lane] = []
    for number, lamella in enumerate(design.lamellas):
        for lane in lanes[lamella.family]:
            strips.append(_strip(lamella, lane, _cut_back(design, lamella, lane)))
            carriers.append(number)
            chosen.append(lane)
    beside: dict[int, list[int]] = {}
    for index, carrier in enumerate(carriers):
        beside.setdefault(carrier, []).append(index)
    if not crossing:
        nodes = tuple(_kept(node, design, strips, beside) for node in design.nodes)
        built = Structure(tuple(strips), nodes, design.profile)
        return Arrangement(built, tuple(carriers), tuple(chosen), np.zeros(0))
    nodes, strips, miss = _crossed(design, strips, beside, chosen)
    built = Structure(tuple(strips), nodes, design.profile)
    return Arrangement(built, tuple(carriers), tuple(chosen), miss)


def _cut_back(design: Structure, lamella: Lamella, lane: Lane) -> tuple[float, float]:
    """How much shorter a strip is than its axis at singular nodes, where neighbours meet, mm."""
    back = [0.0, 0.0]
    for side, short in enumerate((lamella.start > 0.0, lamella.end < lamella.stations[-1])):
        count = len(design.nodes[int(lamella.nodes[-side])].crossings)
        if short and count > 2 and not lamella.closed:
            back[side] = abs(lane.across) / float(np.tan(np.pi / count))
    return back[0], back[1]


def _strip(lamella: Lamella, lane: Lane, back: tuple[float, float]) -> Lamella:
    if lane.across == 0.0 and lane.along == 0.0:
        return replace(lamella, mark=lamella.mark + lane.suffix)
    curve, stations = curve_beside(lamella, across=lane.across, along=lane.along)
    held = lamella.normals.x
    if lamella.closed:
        values = lamella.normals(held)
        values[-1] = values[0]
        normals = CubicSpline(curve.stations, values, bc_type="periodic")
        gap = lamella.axis.length - lamella.length
        end = float(stations(lamella.end + gap / 2.0)) - gap / 2.0
        start = end + gap - curve.length
    else:
        normals = CubicSpline(stations(held), lamella.normals(held))
        start, end = (float(stations(s)) for s in (lamella.start + back[0], lamella.end - back[1]))
    return Lamella(
        mark=lamella.mark + lane.suffix,
        family=lamella.family,
        nodes=lamella.nodes,
        axis=curve,
        normals=normals,
        start=start,
        end=end,
    )


def _kept(
    node: Node, design: Structure, strips: Sequence[Lamella], beside: Mapping[int, Sequence[int]]
) -> Node:
    """*node* of the design with all strips that pass it, at the feet of the node on their axes."""
    crossings = []
    for crossing in node.crossings:
        carrier = design.lamellas[crossing.lamella]
        k = int(np.argmin(np.abs(carrier.stations - crossing.station)))
        crossings += [Crossing(i, float(strips[i].stations[k])) for i in beside[crossing.lamella]]
    return replace(node, crossings=tuple(crossings))


# ---- crossings ---------------------------------------------------------------------------------


def _crossed(
    design: Structure,
    strips: list[Lamella],
    beside: Mapping[int, Sequence[int]],
    lanes: Sequence[Lane],
) -> tuple[tuple[Node, ...], list[Lamella], Floats]:
    """Nodes of all pairs, strips turned so that both of a pair hold its axis, and their misses."""
    regular = [node for node in design.nodes if node.regular]
    pairs = [
        (number, a, b)
        for number, node in enumerate(regular)
        for a in beside[node.crossings[0].lamella]
        for b in beside[node.crossings[1].lamella]
    ]
    kept = {node.name: _kept(node, design, strips, beside) for node in design.nodes}
    if not pairs:
        return tuple(kept.values()), strips, np.zeros(0)
    owner, first, second = np.array(pairs).T
    feet = [{c.lamella: c.station for c in kept[node.name].crossings} for node in regular]
    start = [
        np.array([feet[n][i] for n, i in zip(owner, side, strict=True)]) for side in (first, second)
    ]
    stations, points, tangents = _meet(strips, (first, second), (start[0], start[1]))
    up = np.array([node.axis for node in regular])[owner]
    normal = unit(np.cross(tangents[0], tangents[1]))
    side = np.sign(np.einsum("nc,nc->n", normal, up))[:, None]
    axes = normal * side
    turned = _turned(strips, (first, second), stations, axes)
    nodes: dict[str, list[Node]] = {}
    angles = node_angles(tangents[0], tangents[1], axes)
    for row, (n, a, b) in enumerate(pairs):
        base = regular[n]
        nodes.setdefault(base.name, []).append(
            Node(
                name=f"{base.name}{lanes[a].suffix}{lanes[b].suffix}",
                position=(points[0][row] + points[1][row]) / 2.0,
                axis=axes[row],
                angle=float(angles[row]),
                crossings=(
                    Crossing(a, float(stations[0][row])),
                    Crossing(b, float(stations[1][row])),
                ),
                star_tilt=base.star_tilt,
            )
        )
    every = tuple(n for node in design.nodes for n in nodes.get(node.name, [kept[node.name]]))
    miss = np.linalg.norm(points[0] - points[1], axis=1)
    return every, turned, miss


def _meet(
    strips: Sequence[Lamella], pair: tuple[Indices, Indices], start: tuple[Floats, Floats]
) -> tuple[tuple[Floats, Floats], tuple[Points, Points], tuple[Vectors, Vectors]]:
    """Stations, points and tangents where the curves of each pair are closest, by Newton's way."""
    s, t = start
    for _ in range(_NEWTON_STEPS):
        p, u = _on(strips, pair[0], s)
        q, v = _on(strips, pair[1], t)
        away, cosine = q - p, np.einsum("nc,nc->n", u, v)
        a, b = np.einsum("nc,nc->n", away, u), np.einsum("nc,nc->n", away, v)
        free = 1.0 - cosine**2
        ds, dt = (a - cosine * b) / free, (cosine * a - b) / free
        s, t = s + ds, t + dt
        if max(np.abs(ds).max(), np.abs(dt).max()) < 1e-10:
            break
    (p, u), (q, v) = _on(strips, pair[0], s), _on(strips, pair[1], t)
    return (s, t), (p, q), (u, v)


def _on(strips: Sequence[Lamella], index: Indices, s: Floats) -> tuple[Points, Vectors]:
    """Points and unit tangents at stations *s* (n,) of the strips *index* (n,)."""
    points, tangents = np.empty((len(s), 3)), np.empty((len(s), 3))
    for number in np.unique(index).tolist():
        here = index == number
        points[here] = strips[number].axis.spline(s[here])
        tangents[here] = strips[number].axis.tangents(s[here])
    return points, tangents


def _turned(
    strips: Sequence[Lamella],
    pair: tuple[Indices, Indices],
    stations: tuple[Floats, Floats],
    axes: Vectors,
) -> list[Lamella]:
    """The strips with their widths along the axes of their crossings.

    The crossings a strip has at one node of the design are a few centimetres apart; the strip
    takes their mean axis at their mean station, and turns there as fast as their axes do.
    """
    turned = list(strips)
    for index, s in zip(pair, stations, strict=True):
        for number in np.unique(index).tolist():
            strip, here = strips[number], index == number
            nearest = np.argmin(np.abs(s[here][:, None] - strip.stations), axis=1)
            count = np.bincount(nearest, minlength=len(strip.stations))
            held = np.flatnonzero(count)
            at, value = np.zeros(len(count)), np.zeros((len(count), 3))
            np.add.at(at, nearest, s[here])
            np.add.at(value, nearest, axes[here])
            x, y = at[held] / count[held], unit(value[held])
            place = np.searchsorted(held, nearest)
            away = s[here] - x[place]
            moment, spread = np.zeros_like(y), np.zeros(len(held))
            np.add.at(moment, place, away[:, None] * axes[here])
            np.add.at(spread, place, away**2)
            turned[number] = replace(strip, normals=_spline(strip, x, y, moment, spread))
    return turned


def _spline(strip: Lamella, x: Floats, y: Vectors, moment: Vectors, spread: Floats) -> CubicSpline:
    """Normals *y* at stations *x*, with the slope moment / spread where two axes give one."""
    if len(x) == 1:
        return strip.normals
    boundary = "not-a-knot"
    if strip.closed:
        boundary = "periodic"
        x, y = np.r_[x, x[0] + strip.axis.length], np.vstack([y, y[:1]])
        moment, spread = np.vstack([moment, moment[:1]]), np.r_[spread, spread[:1]]
    smooth = CubicSpline(x, y, bc_type=boundary)
    known = spread > 0.0
    slope = np.where(known[:, None], moment / np.where(known, spread, 1.0)[:, None], smooth(x, 1))
    held = CubicHermiteSpline(x, y, slope)
    return CubicSpline.construct_fast(held.c, held.x, smooth.extrapolate, smooth.axis)
