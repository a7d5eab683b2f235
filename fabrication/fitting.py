"""Do the parts go together? The volume that strips and connectors share where they meet.

Around everything that meets (slots, cut ends, connectors) every strip is taken as it is cut, bent
and twisted into place, and intersected with its neighbours. The pieces are meshed independently of
the CAD solids, see ``strip_pieces``.

Strips that meet away from their slots are found by ``collisions``.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import manifold3d
import numpy as np

from fabrication.collisions import slot_reach
from fabrication.flattening import corners
from fabrication.parts import FlatPart
from fabrication.shapes import Prisms, Shape
from fabrication.strip_pieces import Window, strip_pieces
from fabrication.structures import Structure
from gridshell.arrays import Floats, Indices, Points

_SAMPLE = 20.0
"""Between the points that tell which strips are near a connector or a cut end, mm."""

_LONGEST = 250.0
"""Length of a piece that is taken at once, mm, more or less."""


@dataclass(frozen=True)
class Fit:
    """Clash volumes over all nodes.

    Parameters
    ----------
    max_mm3 : largest volume shared by two parts, mm3.
    worst : the node it is nearest to.
    nodes : how many were tried.
    """

    max_mm3: float
    worst: str
    nodes: int


def fit(strips: Structure, parts: Sequence[FlatPart], connectors: Sequence[Prisms] = ()) -> Fit:
    """Intersect strips with each other and with connectors wherever they meet.

    Parameters
    ----------
    strips, parts : one part per strip, in their order.
    connectors : solids beside the strips; they are not tried against each other.
    """
    clashes = clash_volumes(strips, parts, connectors)
    worst = max(clashes, key=lambda node: clashes[node], default="")
    largest = clashes.get(worst, 0.0)
    return Fit(largest, worst if largest > 0.0 else "", len(clashes))


def clash_volumes(
    strips: Structure, parts: Sequence[FlatPart], connectors: Sequence[Prisms] = ()
) -> dict[str, float]:
    """Largest volume that two parts share at each node where parts meet, mm3, by node.

    Nodes where more than two lamellas end are left to ``collisions``.
    """
    bodies = [solid for kind in connectors for solid in _solids(kind)]
    pieces: list[_Solid] = []
    for index, windows in enumerate(_windows(strips, parts, bodies)):
        pieces += [
            _boxed(piece.solid, index, nodes=piece.nodes)
            for piece in strip_pieces(strips.lamellas[index], parts[index], windows)
        ]
    first, second, middle = _near(pieces, bodies)
    name = _nearest_nodes(strips, middle)
    clashes: dict[str, float] = {}
    solids = [*pieces, *bodies]
    for a, b, nearest in zip(first.tolist(), second.tolist(), name, strict=True):
        slotted = solids[a].nodes & solids[b].nodes
        node = nearest if not slotted or nearest in slotted else min(slotted)
        if node:
            shared = (solids[a].solid ^ solids[b].solid).volume()
            clashes[node] = max(clashes.get(node, 0.0), shared)
    return clashes


@dataclass(frozen=True, eq=False)
class _Solid:
    """Something that may clash: a piece of a strip, or a connector.

    Parameters
    ----------
    strip : index of the strip; -1 for a connector.
    low, high : (3,) corners of its box, mm.
    core, radius : (k, 3) points, and how far from them it reaches; of a connector.
    nodes : whose slots a piece of a strip has.
    """

    solid: manifold3d.Manifold
    strip: int
    low: Floats
    high: Floats
    core: Points
    radius: float
    nodes: frozenset[str] = frozenset()


def _boxed(
    solid: manifold3d.Manifold,
    strip: int,
    *,
    core: Points | None = None,
    radius: float = 0.0,
    nodes: frozenset[str] = frozenset(),
) -> _Solid:
    box = np.array(solid.bounding_box())
    points = box[None, :3] if core is None else core
    return _Solid(solid, strip, box[:3], box[3:], points, radius, nodes)


def _near(pieces: Sequence[_Solid], bodies: Sequence[_Solid]) -> tuple[Indices, Indices, Points]:
    """Pairs of solids with overlapping boxes, and the middles of what the boxes share.

    A connector is no partner of a connector, nor a strip of itself.
    """
    from scipy.spatial import cKDTree

    every = [*pieces, *bodies]
    if not pieces:
        return np.zeros(0, dtype=int), np.zeros(0, dtype=int), np.zeros((0, 3))
    low, high = (np.array([getattr(s, side) for s in every]) for side in ("low", "high"))
    strip = np.array([s.strip for s in every])
    reach = float(np.linalg.norm(high - low, axis=1).max())
    pairs = cKDTree((low + high) / 2.0).query_pairs(reach, output_type="ndarray")
    a, b = np.sort(pairs, axis=1).T
    meet = ((low[a] < high[b]) & (low[b] < high[a])).all(axis=1) & (strip[a] != strip[b])
    a, b = a[meet], b[meet]
    order = np.lexsort((b, a))
    a, b = a[order], b[order]
    middle = (np.maximum(low[a], low[b]) + np.minimum(high[a], high[b])) / 2.0
    return a, b, middle


def _nearest_nodes(strips: Structure, points: Points) -> list[str]:
    """Names of the nodes nearest to *points*; nothing where more than two lamellas end."""
    from scipy.spatial import cKDTree

    if not len(points):
        return []
    tree = cKDTree([node.position for node in strips.nodes])
    _, nearest = tree.query(points)
    names = ["" if node.singular else node.name for node in strips.nodes]
    return [names[i] for i in nearest.tolist()]


# ---- connectors --------------------------------------------------------------------------------


def _solids(kind: Prisms) -> Iterator[_Solid]:
    """The bodies of a kind, each a copy of its shape moved into place."""
    made = [_extruded(shape) for shape in kind.shapes]
    for body in kind.bodies:
        shape, frame = kind.shapes[body.shape], body.frame
        motion = np.column_stack([frame.x, frame.y, frame.normal, frame.origin])
        count = max(2, int(np.ceil((shape.high - shape.low) / _SAMPLE)) + 1)
        z = np.linspace(shape.low, shape.high, count)
        middle = shape.outline[:, :2].mean(axis=0)
        radius = float(np.linalg.norm(shape.outline[:, :2] - middle, axis=1).max())
        core = frame.place(np.tile(middle, (count, 1))) + z[:, None] * frame.normal
        yield _boxed(made[body.shape].transform(motion), -1, core=core, radius=radius)


def _extruded(shape: Shape) -> manifold3d.Manifold:
    contours = [corners(shape.outline), *(corners(o)[::-1] for o in shape.openings)]
    section = manifold3d.CrossSection(contours, manifold3d.FillRule.Positive)
    return section.extrude(shape.high - shape.low).translate([0.0, 0.0, shape.low])


# ---- pieces of strips --------------------------------------------------------------------------


def _windows(
    strips: Structure, parts: Sequence[FlatPart], bodies: Sequence[_Solid]
) -> list[list[Window]]:
    """Where every strip may meet something: around slots, near cut ends and near connectors."""
    found: list[list[Window]] = [[] for _ in parts]
    for own, part in zip(found, parts, strict=True):
        for slot in part.slots:
            reach = slot.width / 2.0 + slot_reach(slot, part.thickness)
            own.append((slot.x - reach, slot.x + reach))
    for index, x, reach in _visits(strips, parts, bodies):
        found[index].append((x - reach, x + reach))
    return [
        _divided(_merged(own, part.length), part) for own, part in zip(found, parts, strict=True)
    ]


def _visits(
    strips: Structure, parts: Sequence[FlatPart], bodies: Sequence[_Solid]
) -> Iterator[tuple[int, float, float]]:
    """Strip, place and reach wherever a strip passes a connector or another strip's cut end."""
    from scipy.spatial import cKDTree

    owner, x, points = _samples(strips, parts)
    width = strips.profile.width
    apart = float(np.hypot(_SAMPLE / 2.0, width / 4.0))
    tree = cKDTree(points)
    if bodies:
        cores = np.concatenate([body.core for body in bodies])
        reach = np.repeat([body.radius for body in bodies], [len(body.core) for body in bodies])
        hits = tree.query_ball_point(cores, reach + apart + _SAMPLE / 2.0)
        near = np.unique(np.concatenate([np.array(hit, dtype=int) for hit in hits]))
        for i in near.tolist():
            yield int(owner[i]), float(x[i]), _SAMPLE
    ends = _ends(strips, parts)
    hits = tree.query_ball_point(ends, apart + 2.0 * strips.profile.thickness + width / 8.0)
    for row, found in enumerate(hits):
        own = row // 6
        beside = [i for i in found if owner[i] != own]
        for i in beside:
            yield int(owner[i]), float(x[i]), _SAMPLE
        if beside:
            yield own, (0.0, parts[own].length)[row % 6 // 3], 2.0 * _SAMPLE


def _samples(strips: Structure, parts: Sequence[FlatPart]) -> tuple[Indices, Floats, Points]:
    """Points of all strips along their edges and their middle, with strip and place."""
    owner, along, points = [], [], []
    for index, (lamella, part) in enumerate(zip(strips.lamellas, parts, strict=True)):
        count = max(2, int(np.ceil(part.length / _SAMPLE)) + 1)
        x = np.repeat(np.linspace(0.0, part.length, count), 3)
        z = np.tile(part.width * np.array([-0.5, 0.0, 0.5]), count)
        points.append(lamella.place(x + lamella.start, np.zeros_like(x), z))
        along.append(x)
        owner.append(np.full(len(x), index))
    return np.concatenate(owner), np.concatenate(along), np.concatenate(points)


def _ends(strips: Structure, parts: Sequence[FlatPart]) -> Points:
    """(6 n, 3) lower edge, middle and upper edge of each strip's start, then of its end."""
    points = []
    for lamella, part in zip(strips.lamellas, parts, strict=True):
        s = np.repeat([lamella.start, lamella.end], 3)
        z = np.tile(part.width * np.array([-0.5, 0.0, 0.5]), 2)
        points.append(lamella.place(s, np.zeros(6), z))
    return np.concatenate(points)


def _merged(windows: Sequence[Window], length: float) -> list[Window]:
    """Windows clipped to the strip; those that overlap are one."""
    merged: list[Window] = []
    for low, high in sorted((max(a, 0.0), min(b, length)) for a, b in windows):
        if merged and low <= merged[-1][1]:
            merged[-1] = (merged[-1][0], max(merged[-1][1], high))
        elif low < high:
            merged.append((low, high))
    return merged


def _divided(windows: Sequence[Window], part: FlatPart) -> list[Window]:
    """Windows of moderate length; none ends within a slot or a hole."""
    closed = [(slot.x - slot.width, slot.x + slot.width) for slot in part.slots]
    closed += [(hole.x - hole.diameter, hole.x + hole.diameter) for hole in part.holes]
    closed.sort()
    divided = []
    for low, high in windows:
        start = low
        while high - start > 1.5 * _LONGEST:
            end = start + _LONGEST
            for a, b in closed:
                if a < end < b:
                    end = b
            divided.append((start, min(end, high)))
            start = min(end, high)
        if high > start:
            divided.append((start, high))
    return divided
