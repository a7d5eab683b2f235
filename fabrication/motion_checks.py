"""What a person should know of a motion, and what the report says of it."""

from __future__ import annotations

import numpy as np

from fabrication.finding import Finding, Severity
from fabrication.motion import Motion


def motion_findings(found: Motion, opening: float, strength: str) -> list[Finding]:
    """What a person should know of a motion.

    Parameters
    ----------
    opening : of the position that is built.
    strength : name of the material, for the message.
    """
    told = []
    low, high = found.locks
    if not low <= opening <= high:
        nearest = min(max(opening, low), high)
        told.append(
            Finding(
                "motion-built",
                Severity.ERROR,
                "umbrella.opening",
                opening,
                nearest,
                "",
                f"the joints do not reach the position that is built, opening {opening:.3g}: they "
                f"lock at {low:.3g} and {high:.3g}. Build it at {nearest:.3g}",
            )
        )
    worst = max(found.steps, key=lambda step: step.utilisation)
    if worst.utilisation > 1.0:
        fine = [step.opening for step in found.steps if step.utilisation <= 1.0]
        way = f"It bears openings from {min(fine):.3g} to {max(fine):.3g}"
        way = way if fine else "It bears none of them"
        told.append(
            Finding(
                "motion-stress",
                Severity.ERROR,
                f"opening {worst.opening:.3g}",
                worst.utilisation,
                1.0,
                "",
                f"on the way {strength} would bear {100.0 * worst.utilisation:.0f} % of its "
                f"strength. {way}; a thinner section, longer bays or a larger umbrella bend less",
            )
        )
    if found.dead_point is not None and low < found.dead_point < high:
        told.append(
            Finding(
                "dead-point",
                Severity.WARNING,
                "motion.cable",
                found.dead_point,
                low,
                "",
                f"the cables are longest at an opening of {found.dead_point:.3g}: from below it "
                f"they close the umbrella instead of opening it. Stop it there, or end the "
                f"cables higher",
            )
        )
    return told


def motion_section(found: Motion) -> dict[str, object]:
    """For the report."""
    steps = found.steps
    return {
        "positions": len(steps),
        "cable_rings": [found.cable.low, found.cable.high],
        "cable_mm": [steps[0].cable, steps[-1].cable],
        "locks_opening": list(found.locks),
        "node_angle_deg": {
            "closed": np.degrees(steps[0].angles).tolist(),
            "opened": np.degrees(steps[-1].angles).tolist(),
        },
        "height_mm": [steps[0].height, steps[-1].height],
        "top_radius_mm": [steps[0].top_radius, steps[-1].top_radius],
        "dead_point_opening": found.dead_point,
        "edge_length_change": found.kept,
        "star_planarity": found.planar,
        "utilisation_max": max(step.utilisation for step in steps),
        "cable_force_N": {
            "min": min(step.force for step in steps),
            "max": max(step.force for step in steps),
        },
    }
