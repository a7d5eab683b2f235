"""The reports on lamellas: the page and the paper."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from fabrication.export.papers.lamella_paper import write_lamella_paper
from fabrication.export.quality_series import Series
from fabrication.export.report import write_report
from fabrication.export.sheet_drawing import SheetDrawing, sheet_drawings
from fabrication.export.sheet_files import sheet_files
from fabrication.joint_sections import SlottedJoint
from fabrication.lamella_design import LamellaDesign
from fabrication.routes import Report


def write_page(
    design: LamellaDesign,
    path: Path,
    report: Report,
    pictures: Sequence[Report],
    series: Sequence[Series],
) -> None:
    """The report on lamellas."""
    joint = design.project.joint
    write_report(
        path,
        name=design.project.name,
        report=report,
        jointed=design.jointed,
        parts=design.parts,
        stress=design.stress,
        sheets=design.sheets[0].sheets,
        clearance=joint.clearance if isinstance(joint, SlottedJoint) else None,
        facade=None if design.facade is None else design.facade.built,
        pictures=pictures,
        series=series,
        copies=() if design.segmented is None else design.segmented.segments.poses[1:],
        moving=None if design.moving is None else (design.moving.motion, design.moving.opening),
        drawings=_sheet_drawings(design),
    )


def write_paper(
    design: LamellaDesign, path: Path, report: Report, series: Sequence[Series]
) -> None:
    """The same to print."""
    write_lamella_paper(
        path,
        name=design.project.name,
        report=report,
        series=series,
        jointed=design.jointed,
        parts=design.parts,
        stress=design.stress,
        sheets=design.sheets[0].sheets,
        copies=() if design.segmented is None else design.segmented.segments.poses[1:],
    )


def _sheet_drawings(design: LamellaDesign) -> list[SheetDrawing]:
    """Of all sheets and bars, those of the panels above the strips included."""
    name, found = design.project.name, []
    for own in design.sheets:
        files = sheet_files(
            own.sheets,
            name=name,
            material=own.material.name,
            prefix=own.prefix,
            process=design.process,
        )
        found += sheet_drawings(own.sheets, files)
    if design.facade is not None:
        panels = design.facade.sheets
        found += sheet_drawings(panels, sheet_files(panels, prefix="panels"))
    return found
