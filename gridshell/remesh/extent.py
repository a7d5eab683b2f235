"""How far the quad mesh goes: whole cells only, cells that cover the rim, or cells cut at the rim.

A cell at the rim is a chain of crossings that follow each other around it. Its missing corners are
*ghosts*: each hangs on a way whose line leaves the surface, or leaves a crossing outside of it.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from enum import Enum

import numpy as np

from gridshell.arrays import Floats, Indices, Points
from gridshell.remesh.extraction import Extracted
from gridshell.remesh.lattice import AXES, cross
from gridshell.surface.triangle_mesh import after

_LEAST_SHARE = 0.2
"""Of the usual edge: a cell with a shorter side at the rim is left out."""

_SHORTEST = 0.3
"""Of the edge before it: a line's end at the rim is kept this long, by moving its last crossing."""

_LEAST_STEP, _LARGEST_STEP = 0.75, 4.0 / 3.0
"""Of the edge before it: an edge that continues a line beyond the rim."""


class Extent(Enum):
    """Which cells the quad mesh has."""

    INSIDE = "inside"
    """Cells whose four corners lie on the surface."""
    COVER = "cover"
    """Cells with two corners or more on the surface; the others continue their lines beyond it."""
    TRIMMED = "trimmed"
    """The cells of ``COVER``, with the lines ending on the boundary curve."""


@dataclass(frozen=True, eq=False)
class Cells:
    """A quad mesh by its crossings.

    Parameters
    ----------
    positions : (n, 3) mm; crossings first, ghosts after them.
    quads : (q, 4), counter-clockwise; the first side runs along family 1.
    whole : number of quads, the first ones, whose corners are all crossings on the surface.
    """

    positions: Points
    quads: Indices
    whole: int


Onto = Callable[[Points], Points]
"""Brings points (n, 3) onto the surface."""


def cells(found: Extracted, positions: Points, extent: Extent, *, onto: Onto) -> Cells:
    """The cells of *extent* over crossings at *positions* (c, 3), mm.

    Parameters
    ----------
    onto : for crossings close to the rim, which ``TRIMMED`` moves along their lines.
    """
    if extent is Extent.INSIDE:
        return Cells(positions, found.cells, len(found.cells))
    rim = _Rim(found)
    open_cells = rim.cells()
    if not open_cells:
        return Cells(positions, found.cells, len(found.cells))
    names = sorted({rim.name(c) for cell in open_cells for c in cell if isinstance(c, tuple)})
    number = {name: len(positions) + i for i, name in enumerate(names)}
    keys: dict[tuple[int, int], list[tuple[int, int]]] = {name: [] for name in names}
    for key in rim.ghost_ways():
        if rim.name(key) in keys:
            keys[rim.name(key)].append(key)
    place = rim.ending if extent is Extent.TRIMMED else rim.continued
    ghosts = []
    for name in names:
        found_places = [p for p in (place(key, positions) for key in keys[name]) if p is not None]
        ghosts.append(np.mean(found_places, axis=0) if found_places else np.full(3, np.nan))
    quads = [
        [c if isinstance(c, int) else number[rim.name(c)] for c in cell] for cell in open_cells
    ]
    if extent is Extent.TRIMMED:
        places = {key: ghosts[i] for i, name in enumerate(names) for key in keys[name]}
        positions = rim.kept_apart(places, positions, onto)
    beyond = np.array(ghosts, dtype=np.float64).reshape(-1, 3)
    cut = np.array(quads, dtype=np.int64).reshape(-1, 4)
    return _completed(positions, beyond, found.cells, cut, extent)


def _completed(
    positions: Points, ghosts: Points, whole: Indices, quads: Indices, extent: Extent
) -> Cells:
    """Place what has no line of its own by its cell's parallelogram; drop what stays unplaced."""
    total = np.concatenate([positions, ghosts])
    for _ in range(3):
        missing = ~np.isfinite(total[quads]).all(axis=2)
        one = np.flatnonzero(missing.sum(axis=1) == 1)
        if len(one) == 0:
            break
        k = np.argmax(missing[one], axis=1)
        cell = quads[one]
        a, b, c = (cell[np.arange(len(one)), (k + i) % 4] for i in (1, 2, 3))
        total[cell[np.arange(len(one)), k]] = total[a] + total[c] - total[b]
    good = np.isfinite(total[quads]).all(axis=(1, 2))
    if extent is Extent.TRIMMED and (good.any() or len(whole)):
        usual = np.median(_sides(total[whole if len(whole) else quads[good]]))
        good &= _sides(total[quads]).min(axis=1) >= _LEAST_SHARE * usual
    return Cells(total, np.concatenate([whole, quads[good]]), len(whole))


def _sides(corners: Floats) -> Floats:
    """(q, 4) lengths of the sides of quads (q, 4, 3), mm."""
    return np.asarray(np.linalg.norm(np.roll(corners, -1, axis=1) - corners, axis=2))


Key = tuple[int, int]
"""A crossing and the number of one of its four ways, counter-clockwise from its first port."""


class _Rim:
    """Open cells along the boundary; Python loops over what grows with its length only."""

    def __init__(self, found: Extracted) -> None:
        self.found = found
        ports, reverse = found.ports, found.traced.reverse
        self.first = np.searchsorted(ports.owner, np.arange(len(ports.face) + 1))
        self.reverse, self.owner = reverse, ports.owner
        in_whole = np.zeros(len(ports.owner), dtype=bool)
        in_whole[found.cell_ports] = True
        self.in_whole = in_whole
        self.joined: dict[Key, Key] = {}

    def ways(self, crossing: int) -> int:
        """Ports a crossing has."""
        return int(self.first[crossing + 1] - self.first[crossing])

    def port(self, key: Key) -> int:
        """The port of a way, -1 for one outside of the surface."""
        crossing, way = key
        return int(self.first[crossing]) + way if way < self.ways(crossing) else -1

    def step(self, key: Key) -> Key | None:
        """The next corner around the cell on the left of a way."""
        port = self.port(key)
        if port < 0 or self.reverse[port] < 0:
            return None
        back = int(self.reverse[port])
        crossing = int(self.owner[back])
        way = back - int(self.first[crossing])
        return crossing, (way - 1) % self._around(crossing)

    def _around(self, crossing: int) -> int:
        whole = bool(self.found.ports.whole[crossing])
        return self.ways(crossing) if whole else max(4, self.ways(crossing))

    def ghost_ways(self) -> list[Key]:
        """Every way that leads to a ghost."""
        rim = np.flatnonzero(~self.found.ports.whole)
        loose = np.unique(self.owner[self.reverse < 0])
        return [
            (c, way)
            for c in np.union1d(rim, loose).tolist()
            for way in range(self._around(c))
            if self.step((c, way)) is None
        ]

    def name(self, key: Key) -> Key:
        """One name for ways that lead to the same ghost."""
        while key in self.joined:
            key = self.joined[key]
        return key

    def _join(self, a: Key, b: Key) -> None:
        a, b = self.name(a), self.name(b)
        if a != b:
            self.joined[max(a, b)] = min(a, b)

    def cells(self) -> list[list[int | Key]]:
        """Corners around every open cell with two crossings or more; ghosts by their ways."""
        before: dict[Key, Key] = {}
        ports = self.found.ports
        for p in np.flatnonzero((self.reverse >= 0) & ~self.in_whole).tolist():
            c = int(self.owner[p])
            key = (c, p - int(self.first[c]))
            follower = self.step(key)
            if follower is not None and not ports.rim[int(self.reverse[p])]:
                before[follower] = key
        starts = sorted(set(before.values()) - set(before))
        found: list[list[int | Key]] = []
        after_of = {key: follower for follower, key in before.items()}
        for start in starts:
            chain = [start]
            while chain[-1] in after_of and len(chain) < 5:
                chain.append(after_of[chain[-1]])
            corners: list[int | Key] = [key[0] for key in chain]
            first, last = self._entering(start), chain[-1]
            if len(chain) == 3:
                self._join(last, first)
                corners.append(last)
            elif len(chain) == 2:
                corners += [last, first]
            elif len(chain) != 4:
                continue
            second = int(ports.axes[self.port(start)]) % 2
            found.append(corners[second:] + corners[:second])
        return found

    def _entering(self, key: Key) -> Key:
        """The way by which the cell left of *key* comes back to its crossing."""
        crossing, way = key
        return crossing, (way + 1) % self._around(crossing)

    # ---- where ghosts are --------------------------------------------------------------------

    def continued(self, key: Key, positions: Points) -> Floats | None:
        """Beyond the crossing, along its line: quadratically where three points are known."""
        line = positions[self._line(key)]
        if len(line) < 2:
            return None
        last = line[0] - line[1]
        step = 2.0 * last - (line[1] - line[2]) if len(line) == 3 else last
        before, length = float(np.linalg.norm(last)), float(np.linalg.norm(step))
        if length == 0.0:
            return None
        wanted = min(max(length, _LEAST_STEP * before), _LARGEST_STEP * before)
        return np.asarray(line[0] + step * (wanted / length))

    def kept_apart(self, places: dict[Key, Floats], positions: Points, onto: Onto) -> Points:
        """Crossings close to the end of their own line, moved back along it."""
        moves = np.zeros_like(positions)
        for key, place in places.items():
            line = self._line(key)
            if len(line) < 2 or not np.isfinite(place).all():
                continue
            back = positions[line[1]] - positions[line[0]]
            gap = float(np.linalg.norm(place - positions[line[0]]) / np.linalg.norm(back))
            moves[line[0]] += max(0.0, _SHORTEST - gap) * back
        moved = np.flatnonzero(moves.any(axis=1))
        result = positions.copy()
        if len(moved):
            result[moved] = onto(positions[moved] + moves[moved])
        return result

    def _line(self, key: Key) -> list[int]:
        """The crossing and up to two before it on the line of a way."""
        line = [key[0]]
        while len(line) < 3:
            crossing, way = key
            if self._around(crossing) != 4:
                break
            back = self.port((crossing, (way + 2) % 4))
            if back < 0 or self.reverse[back] < 0:
                break
            port = int(self.reverse[back])
            key = (int(self.owner[port]), port - int(self.first[self.owner[port]]))
            line.append(key[0])
        return line

    def ending(self, key: Key, positions: Points) -> Floats | None:
        """Where the line of a way meets the boundary curve; None for a way outside the surface."""
        port = self.port(key)
        if port < 0 or self.found.traced.exits[port] < 0:
            return None
        chart, halfedge = self.found.chart, int(self.found.traced.exits[port])
        start, axis = self.found.traced.lefts[port, :2], int(self.found.traced.lefts[port, 2])
        a, b = chart.flat[halfedge], chart.flat[int(after(np.array([halfedge]))[0])]
        d = AXES[axis]
        share = float(cross(d, start - a)) / float(cross(d, b - a))
        mesh = chart.mesh
        x, y = mesh.vertices[mesh.origin[halfedge]], mesh.vertices[mesh.target[halfedge]]
        return np.asarray(x + share * (y - x))
