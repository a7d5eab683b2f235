"""The room between the two strips of an axis: how wide a straight body may be that stands in it.

Strips bend and twist along a body, which takes some of the distance between their inner faces.
"""

from __future__ import annotations

import numpy as np

from fabrication.lamella import Lamella
from gridshell.arrays import Floats, Points, Vectors

_ALONG, _UP = 7, 5
"""Samples along the strip and over its width."""


def room_beside(
    strip: Lamella,
    stations: Floats,
    origins: Points,
    directions: Vectors,
    *,
    reach: Floats,
    width: float,
    thickness: float,
) -> Floats:
    """(n,) distance from each origin to the near face of *strip*, at the narrowest place, mm.

    Parameters
    ----------
    stations : (n,) of the strip beside each origin, mm.
    origins, directions : (n, 3) middles of the bodies, and unit directions from there to the strip.
    reach : (n,) half the length along the strip that counts, mm.
    width, thickness : of the strip, mm.
    """
    side = np.sign(
        np.einsum("nc,nc->n", strip.axis.spline(stations) - origins, strip.frames(stations).b)
    )
    s = stations[:, None, None] + reach[:, None, None] * np.linspace(-1.0, 1.0, _ALONG)[:, None]
    z = width / 2.0 * np.linspace(-1.0, 1.0, _UP)
    s, z = np.broadcast_arrays(s, z)
    y = np.broadcast_to(-side[:, None, None] * thickness / 2.0, s.shape)
    faces = strip.place(s.ravel(), y.ravel(), z.ravel()).reshape(*s.shape, 3)
    away = np.einsum("nijc,nc->nij", faces - origins[:, None, None], directions)
    return np.asarray(away.min(axis=(1, 2)))
