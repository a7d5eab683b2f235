"""A net that opens as a layer: all strips in every position of the motion."""

from __future__ import annotations

import numpy as np

from fabrication.colours import FAMILY_COLOURS, css
from fabrication.export.motion_glb import strip_triangles
from fabrication.export.scene.layers import Positions
from fabrication.export.scene.packing import on_screen
from fabrication.motion import Motion
from gridshell.arrays import Floats

_STEPS = 65_535
"""Places along the largest side that coordinates are rounded to."""

_EVERY = 2
"""Of the places along a strip, one in so many is drawn."""


def motion_layers(found: Motion, centre: Floats, opening: float) -> list[Positions]:
    """The strips of each family in all positions; the one nearest to *opening* first.

    Parameters
    ----------
    centre : (3,) mm, the origin of the scene.
    """
    strips = np.stack([step.strips[:, ::_EVERY] for step in found.steps])
    placed = on_screen(strips.reshape(-1, 3), centre).reshape(strips.shape).astype(np.float64)
    low = placed.min(axis=(0, 1, 2, 3))
    scale = float((placed.max(axis=(0, 1, 2, 3)) - low).max()) / _STEPS
    whole = np.round((placed - low) / scale).astype(np.uint16)
    begin = int(np.argmin([abs(step.opening - opening) for step in found.steps]))
    layers = []
    for family, first, last in ((1, 0, found.first), (2, found.first, strips.shape[1])):
        letter = "AB"[family - 1]
        layers.append(
            Positions(
                id=f"motion-{letter}",
                name="Opening",
                colour=css(FAMILY_COLOURS[family]),
                built=False,
                low=low,
                scale=scale,
                frames=[frame[first:last].reshape(-1, 3) for frame in whole],
                triangles=strip_triangles(last - first, strips.shape[2]),
                begin=begin,
            )
        )
    return layers
