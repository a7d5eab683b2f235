"""What slots and holes leave of a strip's section."""

from __future__ import annotations

import numpy as np

from fabrication.cut import Edge
from fabrication.parts import FlatPart
from gridshell.arrays import Floats


def net_sections(part: FlatPart) -> tuple[Floats, Floats]:
    """The section at every slot and hole of *part*, with the reliefs of its slots.

    At the middle of each, whatever else is cut away there goes, too: a slot from the other edge, a
    hole behind. Shares are those of the full section b h, b h^3 / 12 and b h^2 / 6.

    Returns
    -------
    (m,) places along the strip, mm, and (3, m) shares of the area, of the second moment about the
    strong axis and of the section modulus. A plain half-lap leaves 1/2, 1/8 and 1/4.
    """
    x = np.array([*(slot.x for slot in part.slots), *(hole.x for hole in part.holes)])
    low = _reach(part, Edge.LOWER, x)
    high = part.width - _reach(part, Edge.UPPER, x)
    centre, diameter = np.array([[h.y, h.diameter] for h in part.holes]).reshape(-1, 2).T
    away = np.abs(x[:, None] - np.array([hole.x for hole in part.holes])) * 2.0
    chord = np.sqrt(np.maximum(diameter**2 - away**2, 0.0))
    bottom = np.clip(centre - chord / 2.0, low[:, None], high[:, None])
    top = np.clip(centre + chord / 2.0, low[:, None], high[:, None])
    area = _moment(high, low, 0) - _moment(top, bottom, 0).sum(axis=1)
    first = _moment(high, low, 1) - _moment(top, bottom, 1).sum(axis=1)
    second = _moment(high, low, 2) - _moment(top, bottom, 2).sum(axis=1)
    solid = area > 1e-9 * part.width
    level = first / np.where(solid, area, 1.0)
    inertia = np.where(solid, np.maximum(second - area * level**2, 0.0), 0.0)
    extreme = np.maximum(np.maximum(high - level, level - low), 1e-9 * part.width)
    shares = np.stack(
        [
            np.where(solid, area, 0.0) / part.width,
            inertia * 12.0 / part.width**3,
            inertia / extreme * 6.0 / part.width**2,
        ]
    )
    return x, shares


def _reach(part: FlatPart, edge: Edge, x: Floats) -> Floats:
    """(m,) how deep the slots of one edge reach into the strip at *x* (m,), mm."""
    own = [(slot.x, slot.spread, slot.reach) for slot in part.slots if slot.edge is edge]
    centre, spread, depth = np.array(own).reshape(-1, 3).T
    inside = np.abs(x[:, None] - centre) <= spread
    deepest = np.where(inside, depth, 0.0).max(axis=1, initial=0.0)
    return np.asarray(np.minimum(deepest, part.width))


def _moment(top: Floats, bottom: Floats, power: int) -> Floats:
    """Integral of y to *power* from *bottom* to *top*."""
    return np.asarray((top ** (power + 1) - bottom ** (power + 1)) / (power + 1))
