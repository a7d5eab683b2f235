"""Proximity to a surface: distance to the tangent plane of the foot point (Tang et al. 2014)."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from gridshell.arrays import Floats, Indices
from gridshell.solve import Evaluation, Pattern, columns_of
from gridshell.surface.surface import Foot, Surface


@dataclass(frozen=True, eq=False)
class Proximity:
    """``n . (x - foot) = 0`` with foot point and normal from the previous step.

    Parameters
    ----------
    vertices : (m,) vertex indices.
    surface : in the units of the unknowns.
    """

    vertices: Indices
    surface: Surface

    def pattern(self) -> Pattern:
        """3 columns, one row."""
        return Pattern(columns_of(self.vertices[:, None]), 1)

    def lag(self, x: Floats) -> Foot:
        """The foot points."""
        return self.surface.closest(x.reshape(-1, 3)[self.vertices])

    def evaluate(self, x: Floats, lag: Foot) -> Evaluation:
        """Distances to the tangent planes; the derivative is the normal."""
        offset = x.reshape(-1, 3)[self.vertices] - lag.points
        residual = np.einsum("mc,mc->m", offset, lag.normals)
        return Evaluation(residual[:, None], lag.normals[:, None, :])
