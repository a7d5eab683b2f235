"""The order of assembly as CSV: one line per step."""

from __future__ import annotations

import csv
from math import degrees
from pathlib import Path

from fabrication.assembling import Assembly, AssemblyStep
from fabrication.errors import OutputError

COLUMNS = ("step", "parts", "what", "side", "slots", "nodes", "axes_spread_deg")
"""Parts and nodes are parted by blanks; nodes stand in the order they are engaged."""


def write_assembly(path: Path | str, assembly: Assembly) -> None:
    """Write one line per step; it opens in any spreadsheet.

    Raises
    ------
    OutputError
        When the file cannot be written.
    """
    try:
        with Path(path).open("w", newline="", encoding="utf-8") as file:
            csv.writer(file).writerows([COLUMNS, *map(_row, assembly.steps)])
    except OSError as error:
        raise OutputError(
            "The order of assembly cannot be written", where=str(path), value=error.strerror or ""
        ) from None


def _row(step: AssemblyStep) -> list[str | int]:
    return [
        step.number,
        " ".join(step.marks),
        step.what,
        "" if step.side is None else step.side.value,
        len(step.nodes),
        " ".join(step.nodes),
        f"{degrees(step.spread):.2f}" if step.nodes else "",
    ]
