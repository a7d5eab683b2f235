"""What a designer should know about the net itself, before any lamella is made of it."""

from __future__ import annotations

import numpy as np

import gridshell as gs
from fabrication.finding import Finding, Severity

OFF_SURFACE_LIMIT = 0.01
"""Distance from the surface over the net's diagonal above which it is remarked."""


def check_net(result: gs.OptimizedNet, quality: gs.NetQuality, *, kept: bool) -> list[Finding]:
    """Distance from the surface, where it was asked to be kept to, and remarks about the mesh.

    Parameters
    ----------
    quality : measured against the design surface, where there is one.
    kept : whether the project asks to keep to it.
    """
    return [*_off_surface(result, quality, kept=kept), *_remarks(result)]


def _off_surface(result: gs.OptimizedNet, quality: gs.NetQuality, *, kept: bool) -> list[Finding]:
    distance = quality.surface_distance_mm
    if not kept or distance is None:
        return []
    limit = off_surface_limit(result.control)
    if distance.max <= limit:
        return []
    return [
        Finding(
            "off-surface",
            Severity.WARNING,
            "net",
            distance.max,
            limit,
            "mm",
            f"the net leaves its surface by {distance.max:.0f} mm, {distance.mean:.0f} mm on "
            f"average: a surface carries one angle per place, so leave net.angle out, choose "
            f"another surface, or set net.keep_to_surface = false and take the new form",
        )
    ]


def off_surface_limit(control: gs.ControlMesh) -> float:
    """Distance from the surface above which it is remarked, mm."""
    points = control.vertices[control.mesh.valence > 0]
    return OFF_SURFACE_LIMIT * float(np.linalg.norm(np.ptp(points, axis=0)))


def _remarks(result: gs.OptimizedNet) -> list[Finding]:
    return [
        Finding("mesh", Severity.INFO, "net", 1.0, 0.0, "", remark) for remark in result.remarks
    ]
