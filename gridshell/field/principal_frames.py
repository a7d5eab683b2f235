"""Principal curvatures and their directions, triangle by triangle."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from gridshell.arrays import Floats
from gridshell.surface.curved_mesh import CurvedMesh


class PrincipalFrames(NamedTuple):
    """Principal curvatures kappa1 <= kappa2, signed, and the direction of kappa1, per triangle."""

    axis: Floats
    """(f,) angle of e1, the direction of kappa1, against row 0 of the face frame, rad."""
    mean: Floats
    """(f,) H = (kappa1 + kappa2) / 2, 1/mm."""
    half: Floats
    """(f,) D = (kappa2 - kappa1) / 2 >= 0, 1/mm."""

    @property
    def largest(self) -> Floats:
        """(f,) the larger principal curvature by amount, 1/mm."""
        return np.asarray(np.abs(self.mean) + self.half)


def principal_frames(curved: CurvedMesh) -> PrincipalFrames:
    """Diagonalise the shape operator of every triangle.

    The normal curvature at angle t is (a + c) / 2 + (a - c) / 2 cos 2t + b sin 2t, largest at
    2t = atan2(2b, a - c). Because kappa1 is the smaller one with its sign, e1 is one and the same
    family all over an oriented surface.
    """
    a, b, c = curved.face_shapes.T
    axis = np.arctan2(2.0 * b, a - c) / 2.0 - np.pi / 2.0
    return PrincipalFrames(axis, (a + c) / 2.0, np.hypot((a - c) / 2.0, b))
