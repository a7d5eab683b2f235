"""How few moulds would make all panels of a skin, were they bent to the surface and not flat."""

from __future__ import annotations

from typing import Any

import gridshell as gs


def moulds(control: gs.ControlMesh, which: gs.Skin, tolerance: float) -> dict[str, Any]:
    """Cluster the curved panels of a skin into moulds, as plain figures for the report.

    Parameters
    ----------
    tolerance : largest distance of a panel from its mould, mm.

    Returns
    -------
    Panels and moulds, the largest deviation, and by how much half of all panels depart from their
    own quadric, mm: a tolerance below that asks for more than a mould can give.

    Raises
    ------
    SettingError
        For a net too small to tell its curvature.
    """
    mesh = gs.skin(control, which)
    curvatures, radius = gs.panel_curvatures_from_mesh(mesh, control)
    found = gs.cluster_panels(curvatures, radius, tolerance)
    return {
        "panels": len(found.mould_of),
        "moulds": len(found.moulds),
        "tolerance_mm": tolerance,
        "deviation_mm": {"max": float(found.deviation.max())},
        "own_variation_mm": gs.own_variation(mesh, curvatures, radius),
    }
