"""Flat outlines and where they lie: frames, polygons set back from their edges, corners.

A frame is how a flat part and its place in space stay one thing: ``flat`` takes points of the
design to the sheet, ``place`` takes the sheet back to the design.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from gridshell.arrays import Floats, Points, Vectors, frozen, unit

_SPIKE = 1e-6
"""Cosine above -1 below which a corner is a spike: its offset would run away."""


@dataclass(frozen=True, eq=False)
class Frame:
    """A plane in space with its own coordinates.

    Parameters
    ----------
    origin : (3,) where (0, 0) lies, mm.
    x, y : (3,) orthogonal unit directions; x cross y is the side that faces up on the sheet.
    """

    origin: Floats
    x: Floats
    y: Floats

    def __post_init__(self) -> None:
        for key in ("origin", "x", "y"):
            object.__setattr__(self, key, frozen(getattr(self, key)))

    @property
    def normal(self) -> Floats:
        """(3,) unit."""
        return np.asarray(np.cross(self.x, self.y))

    def flat(self, points: Points) -> Floats:
        """(k, 2) coordinates of points (k, 3) projected onto the plane, mm."""
        away = np.asarray(points) - self.origin
        return np.stack([away @ self.x, away @ self.y], axis=-1)

    def place(self, flat: Floats) -> Points:
        """(k, 3) where flat points (k, 2), or (k, 3) with heights over the plane, lie, mm."""
        placed = self.origin + flat[..., :1] * self.x + flat[..., 1:2] * self.y
        if flat.shape[-1] == 3:
            placed = placed + flat[..., 2:] * self.normal
        return np.asarray(placed)

    def distance(self, points: Points) -> Floats:
        """(k,) signed distance of points (k, 3) from the plane, mm."""
        return np.asarray((np.asarray(points) - self.origin) @ self.normal)


def best_frame(corners: Points, x: Vectors | None = None) -> Frame:
    """The frame of a polygon (k, 3): through its mean, across its area vector.

    For a quad this plane is parallel to both diagonals and half-way between them: no other plane
    has a smaller largest distance from the four corners.

    Parameters
    ----------
    x : (3,) direction the x axis follows as far as the plane allows; along the first edge unless
        said otherwise.
    """
    origin = corners.mean(axis=0)
    arms = corners - corners[0]
    normal = unit(np.cross(arms[:-1], arms[1:]).sum(axis=0))
    along = corners[1] - corners[0] if x is None else np.asarray(x)
    first = unit(along - (along @ normal) * normal)
    return Frame(origin, first, np.cross(normal, first))


def inset(polygon: Floats, distance: float | Floats) -> Floats | None:
    """A polygon (k, 2), counter-clockwise, with every edge set back.

    Parameters
    ----------
    distance : mm, one for all edges or (k,) with that of the edge from corner 0 to 1 first.

    Returns
    -------
    (k, 2) corners, or None where nothing sound is left: an edge turned round or gone, a spike,
    a straight corner between unlike distances, edges that cross.
    """
    along = unit(np.roll(polygon, -1, axis=0) - polygon)
    inward = np.stack([-along[:, 1], along[:, 0]], axis=1)
    before = np.roll(inward, 1, axis=0)
    after_by = np.broadcast_to(np.asarray(distance, dtype=np.float64), (len(polygon),))
    before_by = np.roll(after_by, 1)
    mean, half = (before_by + after_by) / 2.0, (before_by - after_by) / 2.0
    cosine = np.einsum("kc,kc->k", before, inward)
    if (1.0 + cosine < _SPIKE).any() or ((half != 0.0) & (1.0 - cosine < _SPIKE)).any():
        return None
    straight = np.where(half != 0.0, 1.0 - cosine, 1.0)
    moved = np.asarray(
        polygon
        + (mean / (1.0 + cosine))[:, None] * (before + inward)
        + (half / straight)[:, None] * (before - inward)
    )
    left = np.einsum("kc,kc->k", np.roll(moved, -1, axis=0) - moved, along)
    return moved if (left > 0.0).all() and is_simple(moved) else None


def is_simple(polygon: Floats) -> bool:
    """Whether no two edges of a polygon (k, 2) that do not follow each other meet."""
    k = len(polygon)
    a, b = polygon, np.roll(polygon, -1, axis=0)
    i, j = np.triu_indices(k, 2)
    apart = ~((i == 0) & (j == k - 1))
    i, j = i[apart], j[apart]
    first, second = _side(a[i], b[i], a[j]), _side(a[i], b[i], b[j])
    third, fourth = _side(a[j], b[j], a[i]), _side(a[j], b[j], b[i])
    return not bool(((first * second <= 0.0) & (third * fourth <= 0.0)).any())


def corner_angles(polygon: Floats) -> Floats:
    """(k,) inner angles of a polygon (k, 2), counter-clockwise, in (0, 2 pi), radians."""
    ahead = np.roll(polygon, -1, axis=0) - polygon
    back = np.roll(polygon, 1, axis=0) - polygon
    cross = ahead[:, 0] * back[:, 1] - ahead[:, 1] * back[:, 0]
    return np.asarray(np.arctan2(cross, np.einsum("kc,kc->k", ahead, back)) % (2.0 * np.pi))


def polygon_area(polygon: Floats) -> float:
    """Signed area of a polygon (k, 2), positive counter-clockwise, mm2."""
    x, y = (polygon - polygon[0]).T
    return float(np.dot(x, np.roll(y, -1)) - np.dot(y, np.roll(x, -1))) / 2.0


def outline_area(outline: Floats) -> float:
    """Area of an outline (k, 2), or (k, 3) with the bulges of its pieces, mm2.

    The bulge is tan(sweep / 4); a piece with one adds the segment between its arc and its chord.
    """
    flat = polygon_area(outline[:, :2])
    if outline.shape[1] == 2:
        return flat
    chord = np.linalg.norm(np.roll(outline[:, :2], -1, axis=0) - outline[:, :2], axis=1)
    sweep = 4.0 * np.arctan(outline[:, 2])
    curved = outline[:, 2] != 0.0
    radius = chord[curved] / (2.0 * np.sin(sweep[curved] / 2.0))
    segments = radius**2 / 2.0 * (sweep[curved] - np.sin(sweep[curved]))
    return flat + float(segments.sum())


def _side(a: Floats, b: Floats, c: Floats) -> Floats:
    u, v = b - a, c - a
    return np.asarray(u[:, 0] * v[:, 1] - u[:, 1] * v[:, 0])
