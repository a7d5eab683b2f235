"""Lamellas as ribbons in space, for pictures: quads along the strip from edge to edge."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from fabrication.colours import FAMILY_COLOURS
from fabrication.lamella import Lamella
from gridshell.arrays import Floats
from gridshell.painter import Faces, painted

_PER_BAY = 4


def ribbons(
    lamellas: Sequence[Lamella], width: float, *, per_bay: int = _PER_BAY
) -> tuple[Faces, ...]:
    """All strips in the colours of their families, one layer for each that has any.

    Parameters
    ----------
    width : of the strips, mm.
    per_bay : quads along a strip for every node it passes.
    """
    made = []
    for family, colour in FAMILY_COLOURS.items():
        corners = [_ribbon(one, width, per_bay) for one in lamellas if one.family == family]
        if corners:
            found = np.concatenate(corners)
            made.append(Faces(found, painted(colour, len(found))))
    return tuple(made)


def _ribbon(strip: Lamella, width: float, per_bay: int) -> Floats:
    """(m, 4, 3) quads along a strip, lower and upper edge."""
    count = max(2, per_bay * len(strip.stations))
    s = np.linspace(strip.start, strip.end, count)
    frames = strip.frames(s)
    low, high = frames.points - width / 2.0 * frames.n, frames.points + width / 2.0 * frames.n
    return np.stack([low[:-1], low[1:], high[1:], high[:-1]], axis=1)
