"""Strips of a segment as a planar net of slots: what is kept when it lies flat, and a first guess.

On the ground strips stand on edge. Along each the distances of its slots are kept; at a node two
strips can turn against each other like scissors. So the flat net has a point for every node, an
edge for every bay with the developed length between its two slots, and a turn wherever a strip
runs on through a node.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
from scipy.sparse import coo_matrix, csc_matrix
from scipy.sparse.csgraph import connected_components
from scipy.sparse.linalg import splu

from fabrication.lamella import Lamella
from fabrication.node import Node
from fabrication.structures import Structure
from gridshell import SettingError
from gridshell.arrays import Floats, Indices, Mask

_UNEVEN = 0.25
"""How far counted bays may miss whole numbers before a net is taken to close around a hole."""


@dataclass(frozen=True, eq=False)
class FlatGrid:
    """The net of slots of the chosen strips.

    Parameters
    ----------
    lamellas : the chosen strips.
    nodes : the nodes on them.
    rows : of each strip its nodes in order, as numbers of *nodes*.
    stations : of each strip the stations of these nodes, mm.
    edges : (m, 2) nodes at either end of each bay, strip after strip in its direction.
    strip : (m,) the strip each bay belongs to.
    lengths : (m,) developed length of each bay, mm.
    turns : (k, 3) a node with the one before and the one after it on the same strip.
    spans : (k, 2) developed lengths on both sides of each turn, mm.
    arms : (c, 4) of every regular node two nodes that give the direction of its first strip, and
        two of its second, so that the turn from first to second is counter-clockwise.
    crossed : (c,) which node each row of *arms* belongs to.
    pair : (c, 2) the two strips there.
    design : (c,) node angle in the design, radians.
    """

    lamellas: tuple[Lamella, ...]
    nodes: tuple[Node, ...]
    rows: tuple[Indices, ...]
    stations: tuple[Floats, ...]
    edges: Indices
    strip: Indices
    lengths: Floats
    turns: Indices
    spans: Floats
    arms: Indices
    crossed: Indices
    pair: Indices
    design: Floats


def flat_grid(strips: Structure, marks: Sequence[str] | None = None) -> FlatGrid:
    """The net of the strips with these *marks*, or of all.

    A closed strip is taken as it is delivered: open at its seam. A strip with a single node turns
    freely about it and is left out.

    Raises
    ------
    SettingError
        For a mark that no strip has, or strips that do not hang together.
    """
    chosen = _chosen(strips, marks)
    held_at = Counter(c.lamella for node in strips.nodes for c in node.crossings)
    chosen = [number for number in chosen if held_at[number] > 1]
    _require_any(chosen)
    place = {number: row for row, number in enumerate(chosen)}
    on: list[list[tuple[float, int]]] = [[] for _ in chosen]
    nodes: list[Node] = []
    for node in strips.nodes:
        here = [c for c in node.crossings if c.lamella in place]
        if here:
            for crossing in here:
                on[place[crossing.lamella]].append((crossing.station, len(nodes)))
            nodes.append(node)
    for held in on:
        held.sort()
    rows = tuple(np.array([v for _, v in held], dtype=np.int64) for held in on)
    stations = tuple(np.array([s for s, _ in held]) for held in on)
    lamellas = tuple(strips.lamellas[number] for number in chosen)
    edges = np.vstack([np.column_stack([row[:-1], row[1:]]) for row in rows])
    _require_one_piece(edges, len(nodes), lamellas)
    turns = np.vstack([np.column_stack([row[:-2], row[1:-1], row[2:]]) for row in rows])
    bays = [np.diff(s) for s in stations]
    spans = np.vstack([np.column_stack([bay[:-1], bay[1:]]) for bay in bays])
    arms, crossed, pair, design = _arms(nodes, place, lamellas, rows, stations)
    return FlatGrid(
        lamellas=lamellas,
        nodes=tuple(nodes),
        rows=rows,
        stations=stations,
        edges=edges,
        strip=np.repeat(np.arange(len(rows)), [len(bay) for bay in bays]),
        lengths=np.concatenate(bays),
        turns=turns,
        spans=spans,
        arms=arms,
        crossed=crossed,
        pair=pair,
        design=design,
    )


def _chosen(strips: Structure, marks: Sequence[str] | None) -> list[int]:
    numbers = {lamella.mark: i for i, lamella in enumerate(strips.lamellas)}
    unknown = [mark for mark in marks or () if mark not in numbers]
    if unknown or (marks is not None and not len(marks)):
        raise SettingError(
            "No strip has this mark" if unknown else "No strip is chosen to lie flat",
            where="lamellas",
            value=", ".join(unknown[:5]),
            limit=f"{strips.lamellas[0].mark} to {strips.lamellas[-1].mark}",
            advice="see the cut list for the marks",
        )
    return sorted({numbers[m] for m in marks}) if marks is not None else list(numbers.values())


def _require_any(chosen: Sequence[int]) -> None:
    if not chosen:
        raise SettingError(
            "No strip of the segment crosses others at two nodes",
            where="lamellas",
            advice="choose strips that cross each other",
        )


def _require_one_piece(edges: Indices, count: int, lamellas: Sequence[Lamella]) -> None:
    graph = coo_matrix((np.ones(len(edges)), edges.T), shape=(count, count))
    pieces, _ = connected_components(graph, directed=False)
    if pieces != 1:
        raise SettingError(
            "The strips of a flat segment must hang together",
            where="lamellas",
            value=f"{pieces} pieces of {len(lamellas)} strips",
            limit="1",
            advice="choose strips of both families that cross each other, one piece at a time",
        )


def _arms(
    nodes: Sequence[Node],
    place: dict[int, int],
    lamellas: Sequence[Lamella],
    rows: Sequence[Indices],
    stations: Sequence[Floats],
) -> tuple[Indices, Indices, Indices, Floats]:
    """Directions of both strips at the regular nodes, by their neighbours there."""
    beside: list[dict[int, tuple[int, int]]] = [{} for _ in nodes]
    tangent: list[dict[int, Floats]] = [{} for _ in nodes]
    for i, (lamella, row, s) in enumerate(zip(lamellas, rows, stations, strict=True)):
        t = lamella.axis.tangents(s)
        last = len(row) - 1
        for k, v in enumerate(row.tolist()):
            beside[v][i] = (int(row[max(k - 1, 0)]), int(row[min(k + 1, last)]))
            tangent[v][i] = t[k]
    arms, crossed, pair, design = [], [], [], []
    for v, node in enumerate(nodes):
        here = [place[c.lamella] for c in node.crossings if c.lamella in place]
        if not node.regular or len(here) != 2 or node.angle is None:
            continue
        first, second = here
        side = np.dot(np.cross(tangent[v][first], tangent[v][second]), node.axis)
        along = beside[v][second] if side > 0.0 else beside[v][second][::-1]
        arms.append((*beside[v][first], *along))
        crossed.append(v)
        pair.append((first, second))
        design.append(node.angle)
    return (
        np.array(arms, dtype=np.int64).reshape(-1, 4),
        np.array(crossed, dtype=np.int64),
        np.array(pair, dtype=np.int64).reshape(-1, 2),
        np.array(design, dtype=np.float64),
    )


# ---- a first guess -----------------------------------------------------------------------------


def first_guess(grid: FlatGrid, opening: float) -> Floats:
    """(n, 2) positions to begin with, mm.

    Every strip runs in one of two directions, *opening* radians apart: parallelograms of the mean
    bays. Where the net has a node at which more than two families meet there are no two such
    directions; the net is then seen from above, along the mean of its node axes.

    Raises
    ------
    SettingError
        For strips that close around a hole: they cannot lie flat in one piece.
    """
    ways = _ways(grid)
    if ways is None:
        return _from_above(grid)
    family = np.array([lamella.family for lamella in grid.lamellas])[grid.strip]
    way = ways[grid.strip]
    counted = np.column_stack([way * (family == 1), way * (family == 2)])
    lay = _layer(grid)
    bays = lay(counted)
    missed = np.abs(bays[grid.edges[:, 1]] - bays[grid.edges[:, 0]] - counted).max()
    if missed > _UNEVEN:
        return _around(grid)
    half = opening / 2.0
    directions = np.array([[np.cos(half), -np.sin(half)], [np.cos(half), np.sin(half)]])
    return lay(grid.lengths[:, None] * counted @ directions)


def _around(grid: FlatGrid) -> Floats:
    if any(len(node.crossings) > 2 for node in grid.nodes):
        return _from_above(grid)
    raise SettingError(
        "The strips close around a hole and cannot lie flat in one piece",
        where="lamellas",
        value=f"{grid.lamellas[0].mark} to {grid.lamellas[-1].mark}",
        limit="a segment without a hole",
        advice="choose the lamellas of a segment that ends before it meets itself",
    )


def _ways(grid: FlatGrid) -> Floats | None:
    """(strips,) 1 or -1 so that at every node the turn from first to second is counter-clockwise.

    None where no choice does that at all nodes.
    """
    count = len(grid.lamellas)
    # a strip and its reverse are two vertices; a node joins those that may go together
    forward = _forward(grid)
    a, b = grid.pair.T
    other = np.where(forward, b, b + count)
    mirror = np.where(forward, b + count, b)
    joined = np.r_[np.column_stack([a, other]), np.column_stack([a + count, mirror])]
    graph = coo_matrix((np.ones(len(joined)), joined.T), shape=(2 * count, 2 * count))
    _, piece = connected_components(graph, directed=False)
    if (piece[:count] == piece[count:]).any():
        return None
    return np.where(piece[:count] == piece[0], 1.0, -1.0)


def _forward(grid: FlatGrid) -> Mask:
    """(c,) whether the second strip's direction in ``arms`` is the strip's own."""
    rank = np.full((len(grid.lamellas), len(grid.nodes)), -1, dtype=np.int64)
    for i, row in enumerate(grid.rows):
        rank[i, row] = np.arange(len(row))
    second = grid.pair[:, 1]
    return np.asarray(rank[second, grid.arms[:, 2]] < rank[second, grid.arms[:, 3]])


def _layer(grid: FlatGrid) -> Callable[[Floats], Floats]:
    """A function from differences (m, 2) wanted along the edges to positions (n, 2)."""
    m, n = len(grid.edges), len(grid.nodes)
    index = np.arange(m)
    ones = np.ones(m)
    differences = coo_matrix(
        (np.r_[-ones, ones], (np.r_[index, index], grid.edges.T.ravel())), shape=(m, n)
    ).tocsr()
    held = coo_matrix(([1.0], ([0], [0])), shape=(n, n))
    factor = splu(csc_matrix(differences.T @ differences + held))

    def lay(wanted: Floats) -> Floats:
        return np.asarray(factor.solve(np.ascontiguousarray(differences.T @ wanted)))

    return lay


def _from_above(grid: FlatGrid) -> Floats:
    """Positions seen along the mean node axis, as large as the strips are."""
    points = np.array([node.position for node in grid.nodes])
    up = np.array([node.axis for node in grid.nodes]).sum(axis=0)
    up = up / max(float(np.linalg.norm(up)), 1e-12)
    right = np.cross(up, np.eye(3)[int(np.argmin(np.abs(up)))])
    right /= np.linalg.norm(right)
    seen = points @ np.column_stack([right, np.cross(up, right)])
    chords = np.linalg.norm(np.diff(seen[grid.edges], axis=1)[:, 0], axis=1)
    return np.asarray(seen * (grid.lengths.sum() / max(float(chords.sum()), 1e-12)))
