"""Flat outlines with holes as triangles that can be bent: split along lines across the strip."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import numpy as np
import shapely
from manifold3d import triangulate

from gridshell.arrays import Floats, Indices

_CLEAR = 1e-3
"""Lines across keep so far from corners, and from one another, mm: no doubtful crossings."""


def lines_across(rings: Sequence[Floats], wanted: Floats) -> Floats:
    """Those of *wanted*, rising, that pass no corner of *rings* nearly, nor one another, mm."""
    x = np.sort(np.concatenate([ring[:, 0] for ring in rings]))
    after = np.clip(np.searchsorted(x, wanted), 1, len(x) - 1)
    near = np.minimum(np.abs(wanted - x[after - 1]), np.abs(x[after] - wanted))
    clear = wanted[near > _CLEAR]
    return np.asarray(clear[np.diff(clear, prepend=-np.inf) > _CLEAR])


def sheeted(rings: Sequence[Floats], lines: Floats) -> tuple[Floats, Indices]:
    """Corners (n, 2) and triangles (m, 3), counter-clockwise, none of them across a line.

    Every corner of *rings* is among the corners, and where a ring crosses a line.

    Parameters
    ----------
    rings : the outline, counter-clockwise, and holes, each (k, 2) without its first corner again.
    lines : x of lines across, see ``lines_across``.
    """
    lined = [divided(ring, lines) for ring in rings]
    plain, rest = _plain_bands(lined, lines)
    flat = [plain.reshape(-1, 2)]
    faces = [np.arange(4 * len(plain)).reshape(-1, 4)[:, [0, 1, 2, 0, 2, 3]].reshape(-1, 3)]
    first = 4 * len(plain)
    for ring_set in _pieces(lined, lines, rest):
        faces.append(np.asarray(triangulate(ring_set), dtype=np.int64).reshape(-1, 3) + first)
        flat += ring_set
        first += sum(len(ring) for ring in ring_set)
    corners, number = np.unique(np.concatenate(flat), axis=0, return_inverse=True)
    return corners, number.ravel()[np.concatenate(faces)]


def _plain_bands(lined: Sequence[Floats], lines: Floats) -> tuple[Floats, Indices]:
    """Quads (m, 4, 2) of the bands that hold no corner of *lined*, and the numbers of all others.

    All that lies in such a band runs from one of its lines to the other, without crossings: what is
    between the first and the second of these edges is inside, and so on.
    """
    ends = np.concatenate([np.stack([r, np.roll(r, -1, axis=0)], axis=1) for r in lined])
    forward = np.sign(ends[:, 1, 0] - ends[:, 0, 0])
    ends = np.where((forward < 0.0)[:, None, None], ends[:, ::-1], ends)
    middle = ends.mean(axis=1)
    band = np.searchsorted(lines, middle[:, 0])
    whole = np.r_[-np.inf, lines, np.inf]
    across = (ends[:, 0, 0] == whole[band]) & (ends[:, 1, 0] == whole[band + 1])
    holding = np.unique(band[~across])
    plain = ~np.isin(band, holding)
    order = np.flatnonzero(plain)[np.lexsort((middle[plain, 1], band[plain]))]
    below, above = ends[order[::2]], ends[order[1::2]]
    return np.concatenate([below, above[:, ::-1]], axis=1), holding


def _pieces(lined: Sequence[Floats], lines: Floats, bands: Indices) -> Iterator[list[Floats]]:
    """What lies in *bands*: of every polygon its outline and its holes."""
    outline = shapely.Polygon(lined[0], lined[1:])
    low, bottom, high, top = outline.bounds
    ends = np.r_[low - 1.0, lines, high + 1.0]
    boxes = shapely.box(ends[bands], bottom - 1.0, ends[bands + 1], top + 1.0)
    parts = shapely.get_parts(shapely.intersection(outline, boxes))
    for part in parts[shapely.get_type_id(parts) == shapely.GeometryType.POLYGON]:
        own = [np.asarray(ring.coords)[:-1] for ring in (part.exterior, *part.interiors)]
        yield [_turned(ring, left=k == 0) for k, ring in enumerate(own)]


def rim_of(triangles: Indices) -> Indices:
    """(k, 2) edges with a triangle on their left only."""
    edges = triangles[:, [0, 1, 1, 2, 2, 0]].reshape(-1, 2)
    count = int(triangles.max()) + 1
    there = edges[:, 0] * count + edges[:, 1]
    return np.asarray(edges[~np.isin(edges[:, 1] * count + edges[:, 0], there)])


def divided(ring: Floats, lines: Floats) -> Floats:
    """*ring* (k, 2) with corners where it crosses *lines*, at just their x.

    Bands on both sides of a line then have the very same corners on it.
    """
    rows = []
    for a, b in zip(ring, np.roll(ring, -1, axis=0), strict=True):
        rows.append(a[None])
        i, j = np.searchsorted(lines, sorted((a[0], b[0])))
        if i == j:
            continue
        x = lines[i:j] if a[0] < b[0] else lines[i:j][::-1]
        y = a[1] + (b[1] - a[1]) * (x - a[0]) / (b[0] - a[0])
        rows.append(np.column_stack([x, y]))
    return np.concatenate(rows)


def _turned(ring: Floats, *, left: bool) -> Floats:
    x, y = ring.T
    area = float(np.sum(x * np.roll(y, -1) - np.roll(x, -1) * y))
    return ring if (area > 0.0) == left else ring[::-1]
