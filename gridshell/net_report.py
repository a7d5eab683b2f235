"""The figures of an optimised net as plain data: the ``net`` part of every ``report.json``."""

from __future__ import annotations

from dataclasses import asdict
from typing import Any

from gridshell.optimization import OptimizedNet
from gridshell.quality import NetQuality, Spread
from gridshell.terms import Planarity


def net_report(
    result: OptimizedNet,
    planarity: Planarity,
    *,
    seconds: float,
    quality: NetQuality | None = None,
) -> dict[str, Any]:
    """Kind, size, effort and quality of *result*; angles in degrees, lengths in mm.

    Parameters
    ----------
    planarity : what the recipe asked to be flat.
    seconds : time of the whole optimisation.
    quality : in place of the result's own, where it was measured against more.
    """
    found = quality or result.quality
    kind = "asymptotic" if planarity.of_stars else "planar"
    report: dict[str, Any] = {
        "kind": "principal-symmetric" if planarity is Planarity.SPHERICAL_STARS else kind,
        "vertices": int((result.control.mesh.valence > 0).sum()),
        "faces": len(result.control.quads),
        "iterations": len(result.steps),
        "seconds": round(seconds, 3),
        "converged": result.converged,
        "status": result.status,
        "verdict": result.verdict and asdict(result.verdict),
        "remarks": list(result.remarks),
        "angle_error_deg": _plain(found.angle_error_deg),
        "node_angle_deg": _limits(found.node_angle_deg),
        "edge_ratio": _limits(found.edge_ratio),
        "corner_angle_deg": _limits(found.corner_angle_deg),
        "collapsed_faces": found.collapsed,
        "surface_distance_mm": _plain(found.surface_distance_mm),
        "curvature_ratio": found.curvature_ratio,
        "memory_mib": round(result.memory, 1),
    }
    for key in ("star_planarity", "face_planarity", "sphericity", "rhombus_error"):
        spread: Spread | None = getattr(found, key)
        if spread is not None:
            report[key] = asdict(spread)
    return report


def history_report(result: OptimizedNet) -> list[dict[str, Any]]:
    """One entry per step: energies and residuals by term, damping, length, seconds."""
    return [
        {
            "step": number,
            "energy": step.energy,
            "energies": dict(step.energies),
            "residuals": dict(step.residuals),
            "damping": step.damping,
            "accepted": step.accepted,
            "length": step.length,
            "seconds": round(step.seconds, 4),
        }
        for number, step in enumerate(result.steps, start=1)
    ]


def _plain(spread: Spread | None) -> dict[str, float] | None:
    return None if spread is None else asdict(spread)


def _limits(pair: tuple[float, float]) -> dict[str, float]:
    return {"min": pair[0], "max": pair[1]}
