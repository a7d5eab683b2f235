"""What a person wants to know about a field before a mesh is built along it."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from gridshell.arrays import Floats, Indices, Points
from gridshell.field.checks import umbilic
from gridshell.field.conjugate import Hand
from gridshell.field.frame_field import FrameField, singularities
from gridshell.surface.curved_mesh import CurvedMesh

PERCENTILES = (0, 5, 50, 95, 100)


@dataclass(frozen=True, eq=False)
class FieldReport:
    """Figures of a field; areas are fractions of the whole, in [0, 1].

    Parameters
    ----------
    positions : (k, 3) singular points, mm.
    indices : (k,) turns of the pair around each, multiples of 1/2.
    valences : (k,) edges of the quad mesh that meet there, 4 - 4 times the index.
    infeasible_area : where the surface has no pair as asked for and a substitute stands; at 1 the
        angle asked for has no effect on a widened field.
    worst : (3,) where the substitute's angle is furthest from what holds elsewhere, mm; None
        without infeasible area.
    angles : (5,) the angle between the lines at 0, 5, 50, 95 and 100 % of the area, rad.
    umbilic_area : where curvature does not tell directions apart.
    hand : which of the two mirror-symmetric pairs, where there was a choice.
    """

    positions: Points
    indices: Floats
    valences: Indices
    infeasible_area: float
    worst: Points | None
    angles: Floats
    umbilic_area: float
    hand: Hand | None


def field_report(curved: CurvedMesh, field: FrameField, *, hand: Hand | None = None) -> FieldReport:
    """Measure a field on the curved mesh it lies on; raises as `singularities` does."""
    found = singularities(field)
    areas = field.mesh.areas / field.mesh.areas.sum()
    return FieldReport(
        positions=found.positions(field.mesh),
        indices=found.indices,
        valences=found.valence,
        infeasible_area=float(areas[field.infeasible].sum()),
        worst=_worst(field),
        angles=_percentiles(field.angle, areas),
        umbilic_area=float(areas[umbilic(curved)].sum()),
        hand=hand,
    )


def _worst(field: FrameField) -> Points | None:
    bad = np.flatnonzero(field.infeasible)
    if len(bad) == 0:
        return None
    kept = field.angle[~field.infeasible]
    usual = float(np.median(kept)) if len(kept) else float(field.angle.min())
    furthest = bad[np.argmax(np.abs(field.angle[bad] - usual))]
    return np.asarray(field.mesh.centroids[furthest])


def _percentiles(values: Floats, shares: Floats) -> Floats:
    """Values (5,) below which the given percentages of the area lie."""
    order = np.argsort(values, kind="stable")
    below = np.cumsum(shares[order])
    at = np.searchsorted(below, np.array(PERCENTILES) / 100.0 * below[-1])
    return np.asarray(values[order[np.minimum(at, len(order) - 1)]])
