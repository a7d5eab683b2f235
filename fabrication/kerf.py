"""Outlines moved outward by half a kerf, exactly: arcs stay arcs."""

from __future__ import annotations

import numpy as np

from gridshell import SettingError
from gridshell.arrays import Floats, Mask

_STEPS = 8
"""Newton's steps to where two moved pieces meet; each doubles the digits."""


def moved_out(outline: Floats, distance: float) -> Floats:
    """The outline of all points within *distance* of a part, with sharp corners.

    Parameters
    ----------
    outline : (k, 2), or (k, 3) with bulges, counter-clockwise, mm.
    distance : outward, mm; negative inward, which undoes it.

    Returns
    -------
    As many corners as before, in the same form.

    Raises
    ------
    SettingError
        When a piece is gone: a slot or an arc is narrower than twice the distance.
    """
    if distance == 0.0:
        return outline
    a = outline[:, :2]
    bulge = outline[:, 2] if outline.shape[1] == 3 else np.zeros(len(a))
    pieces = _Pieces(a, np.roll(a, -1, axis=0), bulge)
    corners = _corners(pieces, distance)
    moved = _Pieces(corners, np.roll(corners, -1, axis=0), bulge)
    _require_same(pieces, moved, distance)
    if outline.shape[1] == 2:
        return corners
    return np.column_stack([corners, pieces.bulges(corners)])


class _Pieces:
    """Lines and arcs from corners *a* to *b*: (k, 2) each, with bulges (k,)."""

    def __init__(self, a: Floats, b: Floats, bulge: Floats) -> None:
        self.a, self.curved = a, np.asarray(bulge != 0.0)
        chord = b - a
        self.length = np.hypot(*chord.T)
        self.along = chord / np.maximum(self.length, 1e-300)[:, None]
        self.normal = np.stack([self.along[:, 1], -self.along[:, 0]], axis=1)
        self.side = np.sign(bulge)
        half = 2.0 * np.arctan(bulge)
        safe = np.where(self.curved, np.tan(half), 1.0)
        away = np.where(self.curved, self.length / 2.0 / safe, 0.0)
        self.centre = (a + b) / 2.0 - away[:, None] * self.normal
        self.radius = np.hypot(*(a - self.centre).T)

    def miss(self, x: Floats, distance: float) -> tuple[Floats, Floats]:
        """(k,) how far points are off the moved pieces, and (k, 2) where that grows fastest."""
        straight = np.einsum("kc,kc->k", self.normal, x - self.a) - distance
        arm = x - self.centre
        reach = np.maximum(np.hypot(*arm.T), 1e-300)
        round_ = self.side * (reach - self.radius) - distance
        steepest = np.where(self.curved[:, None], (self.side / reach)[:, None] * arm, self.normal)
        return np.where(self.curved, round_, straight), steepest

    def bulges(self, corners: Floats) -> Floats:
        """(k,) of arcs around the same centres through other corners."""
        first = corners - self.centre
        last = np.roll(corners, -1, axis=0) - self.centre
        sweep = np.arctan2(*last.T[::-1]) - np.arctan2(*first.T[::-1])
        sweep = self.side * ((self.side * sweep) % (2.0 * np.pi))
        return np.where(self.curved, np.tan(sweep / 4.0), 0.0)


def _corners(pieces: _Pieces, distance: float) -> Floats:
    """(k, 2) where every moved piece meets the one before."""
    _, after = pieces.miss(pieces.a, 0.0)
    end = np.roll(pieces.a, -1, axis=0)
    _, at_end = pieces.miss(end, 0.0)
    before = np.roll(at_end, 1, axis=0)
    cosine = np.einsum("kc,kc->k", before, after)
    x = pieces.a + distance * (before + after) / np.maximum(1.0 + cosine, 1e-3)[:, None]
    for _ in range(_STEPS):
        miss, slope = pieces.miss(x, distance)
        back = np.roll(x, -1, axis=0)
        miss_before, slope_before = (np.roll(v, 1, axis=0) for v in pieces.miss(back, distance))
        turn = slope[:, 0] * slope_before[:, 1] - slope[:, 1] * slope_before[:, 0]
        sharp: Mask = np.abs(turn) > 1e-6
        safe = np.where(sharp, turn, 1.0)
        dx = (miss * slope_before[:, 1] - miss_before * slope[:, 1]) / safe
        dy = (miss_before * slope[:, 0] - miss * slope_before[:, 0]) / safe
        x = x - np.where(sharp[:, None], np.stack([dx, dy], axis=1), 0.0)
    return np.asarray(x)


def _require_same(pieces: _Pieces, moved: _Pieces, distance: float) -> None:
    same = np.einsum("kc,kc->k", pieces.along, moved.along) > 0.0
    gone = pieces.curved & (pieces.radius + pieces.side * distance <= 0.0)
    if not same.all() or gone.any() or not np.isfinite(moved.a).all():
        k = int(np.flatnonzero(~same | gone | ~np.isfinite(moved.length))[0])
        x, y = pieces.a[k].tolist()
        raise SettingError(
            "The kerf leaves nothing of a cut",
            where=f"the outline near ({x:.1f}, {y:.1f})",
            value=f"{2.0 * abs(distance):g} mm",
            advice="a narrower kerf, wider slots or larger radii of their floors",
        )
