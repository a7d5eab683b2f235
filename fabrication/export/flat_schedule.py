"""A flat segment as CSV: where every node lies on the ground, to lay it out with two tapes."""

from __future__ import annotations

import csv
from pathlib import Path

import numpy as np

from fabrication.errors import OutputError
from fabrication.flat_state import FlatState

COLUMNS = ("node", "x_mm", "y_mm", "angle_deg", "design_angle_deg", "strips")


def write_flat_state(path: Path | str, state: FlatState) -> None:
    """Write one line per node; it opens in any spreadsheet.

    Raises
    ------
    OutputError
        When the file cannot be written.
    """
    marks: list[list[str]] = [[] for _ in state.names]
    for strip in state.strips:
        for node in strip.nodes.tolist():
            marks[node].append(strip.mark)
    rows = [
        (name, f"{x:.1f}", f"{y:.1f}", _angle(flat), _angle(design), " ".join(own))
        for name, (x, y), flat, design, own in zip(
            state.names,
            state.positions.tolist(),
            state.angles.tolist(),
            state.design_angles.tolist(),
            marks,
            strict=True,
        )
    ]
    try:
        with Path(path).open("w", newline="", encoding="utf-8") as file:
            csv.writer(file).writerows([COLUMNS, *rows])
    except OSError as error:
        raise OutputError(
            "The flat segment cannot be written", where=str(path), value=error.strerror or ""
        ) from None


def _angle(value: float) -> str:
    return f"{np.degrees(value):.2f}" if np.isfinite(value) else ""
