"""The material check as CSV: one line per bay of every strip, with the unit in every heading."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from fabrication.export.schedule import write_csv
from fabrication.strength import BayStress
from gridshell.arrays import Floats

COLUMNS = (
    *("strip", "bay", "start_mm", "end_mm", "radius_mm", "twist_deg_per_m", "edge_strain"),
    *("bending_n_mm2", "shear_n_mm2", "helix_edge_n_mm2", "helix_middle_n_mm2"),
    *("edgewise_n_mm2", "von_mises_middle_n_mm2", "von_mises_edge_n_mm2", "utilisation"),
    *("thickest_mm", "widest_mm", "net_area", "net_inertia", "net_section_modulus"),
)
"""Stations count from the strip's first node. Empty: a straight bay's radius, a size that any value
of would do. The net figures are shares of the full section."""


def write_bay_schedule(path: Path | str, stress: BayStress) -> None:
    """Write all figures of all bays, in the strips' order; it opens in any spreadsheet.

    Raises
    ------
    OutputError
        When the file cannot be written.
    """
    figures = [
        *((stress.start, 2), (stress.end, 2), (stress.radius, 1)),
        *((np.degrees(stress.twist) * 1e3, 4), (stress.edge_strain, 7), (stress.bending, 2)),
        *((stress.shear, 2), (stress.helix_edge, 2), (stress.helix_mid, 2), (stress.edgewise, 2)),
        *((stress.von_mises_mid, 2), (stress.von_mises_edge, 2), (stress.utilisation, 4)),
        *((stress.thickest, 3), (stress.widest, 1)),
        *((stress.net_area, 4), (stress.net_inertia, 4), (stress.net_modulus, 4)),
    ]
    columns = [_cells(values, decimals) for values, decimals in figures]
    rows = list(zip(stress.marks, stress.bays, *columns, strict=True))
    write_csv(path, "The list of bays", [COLUMNS, *rows])


def _cells(values: Floats, decimals: int) -> list[str]:
    return [f"{value:.{decimals}f}" if np.isfinite(value) else "" for value in values.tolist()]
