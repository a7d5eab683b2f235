"""Asymptotic lines: the surface does not bend along them."""

from __future__ import annotations

import numpy as np

from gridshell.errors import NotHyperbolicError
from gridshell.field.checks import require_curvature
from gridshell.field.extension import filled
from gridshell.field.frame_field import FrameField
from gridshell.field.principal_frames import principal_frames
from gridshell.surface.curved_mesh import CurvedMesh
from gridshell.surface.triangle_mesh import place

TOLERATED = 0.01
"""Fraction of the area that may have K >= 0: noise, not shape."""


_ROUNDING = 1e-9
"""Directions closer than 4e-5 rad are one."""


def asymptotic_field(curved: CurvedMesh) -> FrameField:
    """The two directions without normal curvature, where K < 0.

    At angle t from e1 the normal curvature is H - D cos 2t (eq. 1), zero at cos 2t = H / D: family
    1 is e1 turned by -t, the lines of left-handed torsion, family 2 by +t, the right-handed ones,
    whichever side the normals point to.

    Up to 1 % of the area, which is noise and not shape, may have no such directions; they are taken
    from around it and marked as infeasible.

    Raises
    ------
    FlatSurfaceError
        For a plane.
    NotHyperbolicError
        When more than 1 % of the area has K >= 0, naming the fraction and the place of largest K.
    """
    require_curvature(curved)
    axis, mean, half = principal_frames(curved)
    missing = ~(np.abs(mean) < half * (1.0 - _ROUNDING))
    areas = curved.mesh.areas
    fraction = float(areas[missing].sum() / areas.sum())
    if fraction > TOLERATED:
        gauss = mean**2 - half**2
        worst = int(np.argmax(gauss))
        raise NotHyperbolicError(
            "The Gaussian curvature K is not negative everywhere, so there are no two asymptotic "
            "directions",
            where=f"triangle {worst} {place(curved.mesh.centroids[worst])}, where K is largest",
            value=f"K >= 0 on {100.0 * fraction:.3g} % of the area, up to {gauss[worst]:.4g} 1/mm2",
            limit=f"{100.0 * TOLERATED:g} % of the area",
            advice="trim the surface to where it is saddle-shaped, or ask for a conjugate net",
        )
    ratio = np.where(missing, 0.0, mean / np.where(missing, 1.0, half))
    turn = np.arccos(ratio) / 2.0
    field = FrameField(curved.mesh, axis - turn, axis + turn, missing)
    return filled(field, missing)
