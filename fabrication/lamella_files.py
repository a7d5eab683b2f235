"""The files a shop gets of lamellas: sheets, lists, papers, and what goes to other programs."""

from __future__ import annotations

from pathlib import Path

from fabrication.export.assembly_schedule import write_assembly
from fabrication.export.bar_schedule import write_bars
from fabrication.export.bay_schedule import write_bay_schedule
from fabrication.export.cut_sets import CutSet, cut_set
from fabrication.export.dxf import write_dxf
from fabrication.export.dxf_lint import lint_dxf
from fabrication.export.flat_schedule import write_flat_state
from fabrication.export.interchange.model import Model, lamella_model
from fabrication.export.papers.drawings import write_drawings
from fabrication.export.papers.labels import write_labels
from fabrication.export.papers.templates import write_templates
from fabrication.export.schedule import write_bill, write_drillings, write_schedule
from fabrication.finding import Finding
from fabrication.lamella_design import LamellaDesign
from fabrication.lamella_sections import PapersSection
from fabrication.lamella_stock import COUPON, SheetSet
from fabrication.placing import keyed
from fabrication.routes import Clock


def write_sheets(
    design: LamellaDesign, folder: Path, clock: Clock
) -> tuple[list[Path], list[Finding]]:
    """Write all sheets; the paths of those with strips, and faults found in any of them."""
    strips: list[Path] = []
    faults: list[Finding] = []
    checked, total = 0, sum(len(own.sheets) for own in design.sheets)
    for own in design.sheets:
        paths = write_dxf(
            own.sheets,
            folder,
            name=design.project.name,
            material=own.material.name,
            prefix=own.prefix,
            process=design.process,
        )
        strips = strips or paths
        for path, sheet in zip(paths, own.sheets, strict=True):
            drawn = [placement.part for placement in sheet.placements]
            found = lint_dxf(path, design.process, drawn)
            faults += [f for f in found if not _beside_bar(design, own, f)]
            checked += 1
            clock.shared(checked / total)
    return strips, faults


def _beside_bar(design: LamellaDesign, own: SheetSet, finding: Finding) -> bool:
    """Whether half a kerf lies beside the long edges of a bar, which are not cut."""
    offset = design.process.offset
    return own.of_bars and finding.code == "outside-sheet" and finding.value <= offset + 1e-6


def model_of(design: LamellaDesign) -> Model:
    """All parts, for other programs."""
    more = None if design.facade is None else design.facade.bodies
    model = lamella_model(design.project.name, design.jointed, design.parts, more)
    return model if design.segmented is None else model.repeated(design.segmented.segments.poses)


def cut_sets(design: LamellaDesign) -> list[CutSet]:
    """All flat parts but the coupons, by material, for machines."""
    own = [one for one in design.sheets if one.prefix != COUPON]
    return [cut_set(one.kind, one.material, one.sheets) for one in own]


def write_lists(design: LamellaDesign, draft: Path) -> None:
    """All lists that the design has something to say in."""
    material = design.jointed.design.profile.material
    lines = [] if design.facade is None else design.facade.lines()
    write_schedule(draft / "parts.csv", design.parts, design.sheets[0].sheets, material, lines)
    if design.segmented is not None:
        design.segmented.write(draft, design.jointed.design)
    write_bill(draft / "bill.csv", design.jointed.bill)
    if any(part.drills for part in design.parts):
        write_drillings(draft / "drillings.csv", design.parts)
    write_bay_schedule(draft / "bays.csv", design.stress)
    if design.plans.assembly.steps:
        write_assembly(draft / "assembly.csv", design.plans.assembly)
    if design.plans.flat is not None:
        write_flat_state(draft / "flat.csv", design.plans.flat)
    if design.moving is not None:
        design.moving.write(draft, design.project.name)
    if design.bars is not None:
        write_bars(draft / "bars.csv", design.bars.plan.bars)


def write_papers(design: LamellaDesign, draft: Path) -> None:
    """Drawings, labels and templates, as the project asks for them."""
    name, papers = design.project.name, design.project.papers or PapersSection()
    material = design.jointed.design.profile.material.name
    if papers.drawings:
        write_drawings(
            draft / "drawings.pdf",
            design.jointed,
            design.parts,
            name=name,
            paper=papers.paper,
            revision=papers.revision,
            findings=design.findings,
            assembly=design.plans.assembly,
            flat=design.plans.flat,
        )
    if papers.labels:
        write_labels(draft / "labels.pdf", design.parts, name=name, material=material)
    if papers.templates is not None:
        with keyed("papers.templates"):
            write_templates(
                draft / "templates.pdf", design.parts, name=name, paper=papers.templates
            )
