"""Fig. 10: the net of Fig. 9 at 90 degrees as a slotted model, with slots of least width."""

from __future__ import annotations

import numpy as np

import fabrication as fab
import gridshell as gs
from fabrication.export.raster import Scene
from fabrication.gallery.fig_09 import net
from fabrication.gallery.figure import Condition, Figure, largest
from fabrication.gallery.scenery import lamella_faces
from gridshell.painter import seen_from

THICKNESS = 4.0
CLEARANCE = 0.2
_TWIST = 0.15
"""What twist may add to the width of a slot, over the thickness."""


def figure() -> Figure:
    """Every slot is about as wide as the strip is thick; parts fit without a clash."""
    result = net(90.0, cells=18)
    profile = fab.Profile(160.0, THICKNESS, fab.BIRCH_PLY)
    built = fab.structure(gs.diagonal_meshes(result.control)[0], profile)
    parts = fab.flat_parts(built, fab.SlotJoint(clearance=CLEARANCE))
    widths = np.array([slot.width for part in parts for slot in part.slots])
    fitted = fab.fit(built, parts)
    return Figure(
        name="10",
        title="Timber model: slots of least width",
        paper={"angle, degrees": 90},
        ours={
            "strips": len(parts),
            "slots": len(widths),
            "slots, mm": f"{widths.min():.2f} to {widths.max():.2f}",
        },
        conditions=(
            Condition("angle, degrees", largest(result.quality.angle_error_deg), 0.01),
            Condition(
                "slot wider than thickness and clearance, over thickness",
                float(widths.max() - THICKNESS - CLEARANCE) / THICKNESS,
                _TWIST,
            ),
            Condition("clash, mm3", fitted.max_mm3, 1e-3),
        ),
        scenes=(
            Scene("", lamella_faces(built), seen_from(0.8, -1.0, 0.8)),
            Scene("", lamella_faces(built), seen_from(0.0, -1.0, 0.25)),
        ),
        columns=2,
    )
