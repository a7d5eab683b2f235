"""Stretches of the boundary that run along a family of the field."""

from __future__ import annotations

from math import radians

import numpy as np

from gridshell.arrays import Floats, Mask
from gridshell.field import FrameField

STRAY = radians(6.0)
"""Largest angle between a boundary edge and the family it is to follow."""


def aligned_runs(field: FrameField, family: int, least: float) -> Mask:
    """(3f,) boundary half-edges in runs along *family* (1 or 2) that are *least* mm long or more.

    A run goes on from edge to edge as long as each stays within ``STRAY`` of the family in its own
    triangle.
    """
    mesh = field.mesh
    close = _along(field, family)
    result = np.zeros(len(mesh.twin), dtype=bool)
    for loop in mesh.boundary_loops:
        good = close[loop]
        if good.all():
            result[loop] = True
            continue
        shift = int(np.flatnonzero(~good)[0])
        turned = np.roll(loop, -shift)
        runs = np.split(turned, np.flatnonzero(np.diff(close[turned].astype(int))) + 1)
        for run in runs:
            if close[run[0]] and mesh.edge_lengths[run].sum() >= least:
                result[run] = True
    return result


def _along(field: FrameField, family: int) -> Mask:
    mesh = field.mesh
    angle: Floats = field.first if family == 1 else field.second
    corners = mesh.flat_corners
    edge = (np.roll(corners, -1, axis=1) - corners).reshape(-1, 2)
    direction = np.repeat(np.stack([np.cos(angle), np.sin(angle)], axis=1), 3, axis=0)
    cross = edge[:, 0] * direction[:, 1] - edge[:, 1] * direction[:, 0]
    return np.asarray(np.abs(cross) <= np.sin(STRAY) * np.linalg.norm(edge, axis=1))
