"""The positions of a motion as a CSV list."""

from __future__ import annotations

import csv
from math import degrees
from pathlib import Path

from fabrication.motion import Motion

COLUMNS = (
    *("position", "opening", "cable_mm", "cable_lean_deg", "cables_force_N", "height_mm"),
    *("top_radius_mm", "smallest_angle_deg", "largest_angle_deg", "bend_radius_mm"),
    *("twist_deg_per_m", "utilisation"),
)


def write_motion(path: Path | str, found: Motion) -> None:
    """Write one line per position, from the closed to the opened one.

    Columns: length of each cable, its angle from the vertical (positive outwards), sum of all
    cables' tensions, heights and radii, node angles, smallest bending radius, largest twist, use of
    the material's strength.
    """
    with Path(path).open("w", encoding="utf-8", newline="") as file:
        rows = csv.writer(file, lineterminator="\n")
        rows.writerow(COLUMNS)
        for number, step in enumerate(found.steps, start=1):
            low, high = map(degrees, step.angles)
            rows.writerow(
                [
                    number,
                    f"{step.opening:.5f}",
                    f"{step.cable:.3f}",
                    f"{degrees(step.lean):.3f}",
                    f"{step.force:.2f}",
                    f"{step.height:.3f}",
                    f"{step.top_radius:.3f}",
                    f"{low:.4f}",
                    f"{high:.4f}",
                    f"{step.radius:.1f}",
                    f"{1000.0 * degrees(step.twist):.4f}",
                    f"{step.utilisation:.4f}",
                ]
            )
