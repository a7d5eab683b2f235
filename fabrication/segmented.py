"""Equal segments as part of a package: lists times their number, and what is read back of them."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from fabrication.export.step_prism_reader import StepCopy
from fabrication.finding import Finding
from fabrication.jointed import BillLine
from fabrication.routes import Report, loop_findings
from fabrication.segment_checks import Seam, largest_difference, seam_findings
from fabrication.segments import Segments, hanging
from fabrication.structures import Structure
from gridshell import FileError

IDENTICAL_LIMIT = 1e-6
"""Largest distance of a copy in the file from its exact place that passes, mm."""


@dataclass(frozen=True, eq=False)
class Segmented:
    """A canopy of equal segments.

    Parameters
    ----------
    segments : how many there are, and where.
    seam : the closest approach of two of them.
    hang : whether the state of prefabrication is written.
    """

    segments: Segments
    seam: Seam
    hang: bool

    @property
    def findings(self) -> list[Finding]:
        """Seams that are too narrow."""
        return seam_findings(self.segments, self.seam)

    def bill(self, lines: Sequence[BillLine]) -> tuple[BillLine, ...]:
        """The bill of all segments."""
        count = self.segments.count
        return tuple(replace(line, quantity=line.quantity * count) for line in lines)

    def write(self, draft: Path, design: Structure) -> None:
        """``hanging.csv``: the nodes of a segment upside down, as it is put together."""
        from fabrication.export.schedule import write_csv

        if not self.hang:
            return
        rows = []
        for node, place in zip(design.nodes, hanging(design), strict=True):
            marks = [design.lamellas[c.lamella].mark for c in node.crossings]
            angle = "" if node.angle is None else f"{np.degrees(node.angle):.3f}"
            rows.append((node.name, *(f"{c:.2f}" for c in place + 0.0), " ".join(marks), angle))
        write_csv(draft / "hanging.csv", "The hanging state", [HANGING_COLUMNS, *rows])

    def closure(
        self, design: Structure, read: Sequence[StepCopy], parts: int
    ) -> tuple[Report, list[Finding]]:
        """The section of the report, and an error where a copy is not where it belongs.

        Raises
        ------
        FileError
            When the file holds another number of copies.
        """
        if len(read) != self.segments.count:
            raise FileError(
                "The STEP file holds another number of segments",
                value=f"{len(read)}",
                limit=f"{self.segments.count}",
            )
        nodes = np.array([node.position for node in design.nodes])
        off = largest_difference(self.segments, [(c.turn, c.shift) for c in read], nodes)
        section = {
            "count": self.segments.count,
            "identical_mm": off,
            "seam_mm": {
                "min": self.seam.distance,
                "between": [self.seam.first, self.seam.second],
                "asked": self.segments.seam,
            },
            "distinct_parts": parts,
            "parts": parts * self.segments.count,
        }
        found = loop_findings(
            (("segment-place", "segments", off, IDENTICAL_LIMIT, "mm", "from its exact place"),)
        )
        return {"segments": section}, found


HANGING_COLUMNS = ("node", "x_mm", "y_mm", "z_mm", "strips", "angle_deg")
"""Of ``hanging.csv``."""
