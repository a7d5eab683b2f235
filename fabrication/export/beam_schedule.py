"""The beams of a planar net as CSV: lengths, and at either end what a saw has to be set to."""

from __future__ import annotations

import csv
from collections.abc import Sequence
from math import degrees
from pathlib import Path

from fabrication.beam_layout import Beam, BeamEnd
from fabrication.connector import connector_mark
from fabrication.errors import OutputError

_END = ("node", "mitre_left_deg", "mitre_right_deg", "slope_deg", "roll_deg")
COLUMNS = (
    *("mark", "length_mm", "cut_length_mm"),
    *(f"start_{name}" for name in _END),
    *(f"end_{name}" for name in _END),
)
"""Mitres are seen from above and looking away from the node, between the cut and the beam's line;
an empty mitre is a square cut."""


def write_beam_schedule(path: Path | str, beams: Sequence[Beam]) -> None:
    """Write one line per beam; it opens in any spreadsheet.

    Raises
    ------
    OutputError
        When the file cannot be written.
    """
    rows = [
        (b.mark, f"{b.length:.3f}", f"{b.cut_length:.3f}", *_cells(b.start), *_cells(b.end))
        for b in beams
    ]
    try:
        with Path(path).open("w", newline="", encoding="utf-8") as file:
            csv.writer(file).writerows([COLUMNS, *rows])
    except OSError as error:
        raise OutputError(
            "The list of beams cannot be written", where=str(path), value=error.strerror or ""
        ) from None


def _cells(end: BeamEnd) -> tuple[str, ...]:
    return (connector_mark(end.node), *map(_angle, (end.left, end.right, end.slope, end.roll)))


def _angle(value: float | None) -> str:
    return "" if value is None else f"{degrees(value):.3f}"
