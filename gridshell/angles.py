"""Where a net's angle is measured, and what it shall be there: a constant, a list or a field.

A *crossing* is four points a, b, c, d whose directions c - a (family 1) and d - b (family 2) meet
at the node angle: the corners of a control quad (eq. 4), or the ends of a star of four edges.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from gridshell.arrays import Floats, Indices, Points
from gridshell.errors import SettingError
from gridshell.mesh import ControlMesh, edge_stars

AngleField = Callable[[Points], Floats]
"""From positions (m, 3), mm, to angles (m,), radians."""

Angle = float | Floats | AngleField
"""Radians: one for all crossings, one for each (m,), or a field over their centres."""


def face_crossings(control: ControlMesh) -> Indices:
    """(f, 4) the corners of every control quad."""
    return control.quads


def edge_crossings(control: ControlMesh) -> Indices:
    """(m, 4) ends of the edges at every interior vertex of valence four, family 1 first.

    Edges 0-1 and 2-3 of a labelled quad belong to one family, 1-2 and 3-0 to the other.
    """
    stars, mesh = edge_stars(control.mesh), control.mesh
    centre = np.flatnonzero(stars.closed & (stars.count == 4))
    ring = stars.spokes[centre, :4]
    second = mesh.first_spoke[centre] % 2 == 1
    return np.where(second[:, None], np.roll(ring, -1, axis=1), ring)


def angles_at(angle: Angle, points: Points) -> Floats:
    """(m,) target angles at crossings with centres *points* (m, 3), mm.

    Raises
    ------
    SettingError
        For an angle outside (0, 180) degrees, or a list of another length.
    """
    values = np.asarray(angle(points) if callable(angle) else angle, dtype=np.float64)
    single = values.ndim == 0
    values = np.full(len(points), values) if single else values
    if values.shape != (len(points),):
        raise SettingError(
            "A list of node angles needs one for every crossing",
            where="angle",
            value=f"shape {values.shape}",
            limit=f"({len(points)},)",
        )
    bad = np.flatnonzero(~((values > 0.0) & (values < np.pi)))
    if len(bad):
        raise SettingError(
            "The node angle must lie between 0 and 180 degrees",
            where="angle" if single else f"angle of crossing {bad[0]}",
            value=f"{np.degrees(values[bad[0]]):g} degrees",
            limit="(0, 180)",
            advice="60, 75 or 90 degrees",
        )
    return values
