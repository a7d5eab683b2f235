"""Form-finding from supports: the places a net stands on are given, the surface is the result."""

from __future__ import annotations

import numpy as np

from gridshell.anchors import Pinned
from gridshell.arrays import Points
from gridshell.errors import SettingError
from gridshell.mesh import ControlMesh
from gridshell.spreading import spread

FARTHEST = 0.5
"""How far a support may be from the start's boundary, over the size of the start."""


def stand_on(control: ControlMesh, places: Points) -> tuple[ControlMesh, Pinned]:
    """Move the start onto its supports, and hold it there.

    Each place takes the boundary vertex that suits all of them best; what that moves is spread
    over the net as fairly as its lines allow.

    Parameters
    ----------
    control : the start.
    places : (k, 3) mm, at least two.

    Returns
    -------
    The start on its supports, and the anchor that holds it there while ``optimize`` finds the form.

    Raises
    ------
    SettingError
        For fewer than two places, two at one place, more of them than the boundary has vertices, or
        one that is far from the start.
    """
    from scipy.optimize import linear_sum_assignment
    from scipy.spatial.distance import cdist

    places = np.asarray(places, dtype=np.float64).reshape(-1, 3)
    rim = np.unique(np.concatenate([[], *control.mesh.boundary_loops])).astype(np.int64)
    if not 2 <= len(places) <= len(rim):
        raise SettingError(
            "A net needs two supports or more, and no more than its boundary has vertices",
            where="supports",
            value=f"{len(places)} supports, {len(rim)} vertices",
        )
    size = float(np.ptp(control.vertices[rim], axis=0).max())
    _, vertex = linear_sum_assignment(cdist(places, control.vertices[rim]) ** 2)
    held = rim[vertex]
    away = np.linalg.norm(places - control.vertices[held], axis=1)
    worst = int(np.argmax(away))
    if not away[worst] <= FARTHEST * size:
        near = ", ".join(f"{c:.6g}" for c in control.vertices[held[worst]])
        raise SettingError(
            "A support is far from the boundary of the start",
            where=f"supports {worst}",
            value=f"{away[worst]:.6g} mm to the nearest vertex, at ({near})",
            limit=f"{FARTHEST * size:.6g} mm, half of the start's size",
            advice="a support there, or a start of the size of the shell",
        )
    if len(np.unique(places, axis=0)) < len(places):
        raise SettingError("Two supports stand at one place", where="supports")
    known = np.zeros_like(control.vertices)
    known[held] = places - control.vertices[held]
    moved = control.vertices + spread(control, known, held)
    moved[held] = places
    return control.moved(moved), Pinned(tuple(held.tolist()))
