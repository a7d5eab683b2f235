"""Lines of principal curvature."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from gridshell.field.frame_field import FrameField
from gridshell.field.guides import Guide, guided, require_directions
from gridshell.field.principal_frames import principal_frames
from gridshell.surface.curved_mesh import CurvedMesh


def principal_field(curved: CurvedMesh, *, guides: Sequence[Guide] = ()) -> FrameField:
    """The principal directions: family 1 along kappa1, family 2 along kappa2, kappa1 <= kappa2.

    They are the conjugate pair of 90 degrees (eq. 2). Turning the surface inside out swaps the
    families.

    Parameters
    ----------
    guides : lines that decide where curvature does not; without any, nothing is smoothed.

    Raises
    ------
    FlatSurfaceError
        For a plane without guides.
    UmbilicRegionError
        When more than 30 % of the area bends alike in all directions and no guide reaches it.
    """
    require_directions(curved, guides)
    axis = principal_frames(curved).axis
    return guided(curved, FrameField.of_lines(curved.mesh, axis, axis + np.pi / 2.0), guides)
