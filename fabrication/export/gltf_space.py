"""Places and colours as glTF wants them: metres, y upwards; linear instead of sRGB."""

from __future__ import annotations

import numpy as np

from fabrication.shapes import Colour
from gridshell.arrays import Points

_GAMMA = 2.2


def upright(points: Points) -> Points:
    """Points (..., 3), mm and z upwards, in metres with y upwards."""
    return np.stack([points[..., 0], points[..., 2], -points[..., 1]], axis=-1) / 1000.0


def linear(colour: Colour) -> Colour:
    """A colour, sRGB 0 to 1, in linear shares."""
    r, g, b = (c**_GAMMA for c in colour)
    return r, g, b
