"""Lamellas with their joints as a system that writes its own files and closes the loop."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import asdict, dataclass, replace
from itertools import pairwise
from pathlib import Path

import gridshell as gs
from fabrication.assembling import Assembly
from fabrication.errors import KernelError
from fabrication.export.cut_sets import CutSet, cut_set
from fabrication.export.interchange.model import Model, lamella_model
from fabrication.export.quality_series import Series
from fabrication.export.sheet_drawing import SheetDrawing, sheet_drawings
from fabrication.export.sheet_files import sheet_files
from fabrication.export.step_prism_reader import StepCopy, StepPrism
from fabrication.export.step_reader import StepPart
from fabrication.exporting import write_exports
from fabrication.facade_route import STEP_FILE, FacadeSystem, facade_findings
from fabrication.finding import Finding
from fabrication.fitting import Fit, fit
from fabrication.flat_state import FlatState
from fabrication.joint_sections import SlottedJoint
from fabrication.jointed import Jointed
from fabrication.kernel_job import Kernel, KernelResult, LamellaWork
from fabrication.lamella_sections import PapersSection
from fabrication.lamella_stock import COUPON, BarStock, SheetSet
from fabrication.moving import Moving
from fabrication.parts import FlatPart
from fabrication.placing import keyed
from fabrication.routes import (
    CLOSURE_LIMIT,
    VOLUME_LIMIT,
    Clock,
    Report,
    Written,
    errors_at,
    loop_findings,
)
from fabrication.sections import Project
from fabrication.segmented import Segmented
from fabrication.shop import Process
from fabrication.strength import BayStress
from fabrication.stress_checks import stress_section

CLASH_LIMIT = 1e-3
"""Largest volume two parts may share at a node, mm3."""

Rebuilt = Callable[[gs.ControlMesh], tuple[gs.DiagonalMesh, Jointed]]


@dataclass(frozen=True, eq=False)
class Plans:
    """How the shell is put together.

    Parameters
    ----------
    assembly : the order of strips and connectors.
    flat : the flat scissor state; None where it was not asked for.
    """

    assembly: Assembly
    flat: FlatState | None

    @property
    def findings(self) -> tuple[Finding, ...]:
        """Strips that are locked out, distances that cannot be kept, ..."""
        flat = () if self.flat is None else self.flat.findings
        return (*self.assembly.findings, *flat)

    def sections(self) -> Report:
        """For the report."""
        flat = {} if self.flat is None else {"flat": self.flat.section()}
        return {"assembly": self.assembly.section(), **flat}


@dataclass(frozen=True, eq=False)
class LamellaSystem:
    """Strips, their joints, flat parts and stock.

    Parameters
    ----------
    rebuilt : builds net and joints anew on a control mesh that was read back.
    stress : of every bay.
    bars : None where strips are cut from sheets.
    sheets : of the strips first, then of connectors, splice plates and coupons.
    moving : where the net moves.
    segmented : where there are equal segments.
    process : how the shop cuts, and wants its files.
    """

    project: Project
    rebuilt: Rebuilt
    jointed: Jointed
    parts: tuple[FlatPart, ...]
    stress: BayStress
    bars: BarStock | None
    sheets: tuple[SheetSet, ...]
    facade: FacadeSystem | None
    plans: Plans
    moving: Moving | None
    segmented: Segmented | None
    process: Process
    findings: Sequence[Finding]

    def write(self, draft: Path, cad: Kernel, clock: Clock) -> Written:
        """Sheets, lists and STEP; the clash at the nodes is measured meanwhile."""
        from fabrication.export.dxf import read_dxf

        facade, jointed = self.facade, self.jointed
        work = LamellaWork(jointed.strips, self.parts, self.project.name, jointed.connectors)
        if facade is not None:
            work = replace(work, more=facade.bodies, beside=STEP_FILE)
        if self.segmented is not None:
            work = replace(work, poses=self.segmented.segments.poses)
        cad.order(work, draft / "structure.step")
        with clock.stage("fit"):
            fitted = fit(jointed.strips, self.parts, jointed.connectors)
        with clock.stage("sheets"):
            files, faults = self._write_sheets(draft / "sheets", clock)
            drawn = [part for path in files for part in read_dxf(path, self.process)]
            panels = (
                []
                if facade is None
                else facade.write_sheets(draft / "sheets", name=self.project.name)
            )
        with clock.stage("lists"):
            self._write_lists(draft)
        with clock.stage("papers"):
            self._write_papers(draft)
            write_exports(
                draft, self.project.export, self.project.name, self._model, self._cut_sets
            )
        with clock.stage("solids"):
            solid = self._solids(cad)
        with clock.stage("closure"):
            from fabrication.loop import compare

            net, reference = self.rebuilt(gs.read_net(draft / "net.json"))
            strips = [part for part in solid.parts if isinstance(part, StepPart)]
            prisms = [part for part in solid.parts if isinstance(part, StepPrism)]
            closed = asdict(compare(reference, self.parts, drawn, strips, prisms))
            findings = [*faults, *lamella_loop_findings(closed, fitted)]
            more: Report = {}
            if self.segmented is not None:
                copies = [part for part in solid.parts if isinstance(part, StepCopy)]
                more, misplaced = self.segmented.closure(reference.design, copies, len(self.parts))
                findings += misplaced
            if facade is not None:
                glazed = facade.closure(net, reference.design, panels, prisms)
                more = {**more, "facade": facade.figures(glazed)}
                findings += facade_findings(glazed)
        return Written(
            sections={
                "structure": self._figures(fitted),
                "stress": stress_section(self.stress),
                "stock": self._stock(),
                **self.plans.sections(),
                **({} if self.moving is None else self.moving.sections()),
                "closure": closed,
                "fit": {
                    "clash_mm3": {"max": fitted.max_mm3},
                    "worst": fitted.worst,
                    "nodes": fitted.nodes,
                },
                **more,
            },
            findings=findings,
            kernel_seconds=solid.seconds,
        )

    def write_page(
        self, path: Path, report: Report, pictures: Sequence[Report], series: Sequence[Series]
    ) -> None:
        """The report on lamellas."""
        from fabrication.export.report import write_report

        joint = self.project.joint
        write_report(
            path,
            name=self.project.name,
            report=report,
            jointed=self.jointed,
            parts=self.parts,
            stress=self.stress,
            sheets=self.sheets[0].sheets,
            clearance=joint.clearance if isinstance(joint, SlottedJoint) else None,
            facade=None if self.facade is None else self.facade.built,
            pictures=pictures,
            series=series,
            copies=() if self.segmented is None else self.segmented.segments.poses[1:],
            moving=None if self.moving is None else (self.moving.motion, self.moving.opening),
            drawings=self._sheet_drawings(),
        )

    def write_paper(self, path: Path, report: Report, series: Sequence[Series]) -> None:
        """The same to print."""
        from fabrication.export.papers.lamella_paper import write_lamella_paper

        write_lamella_paper(
            path,
            name=self.project.name,
            report=report,
            series=series,
            jointed=self.jointed,
            parts=self.parts,
            stress=self.stress,
            sheets=self.sheets[0].sheets,
            copies=() if self.segmented is None else self.segmented.segments.poses[1:],
        )

    def _sheet_drawings(self) -> list[SheetDrawing]:
        """Of all sheets and bars, those of the panels above the strips included."""
        name, found = self.project.name, []
        for own in self.sheets:
            files = sheet_files(
                own.sheets,
                name=name,
                material=own.material.name,
                prefix=own.prefix,
                process=self.process,
            )
            found += sheet_drawings(own.sheets, files)
        if self.facade is not None:
            panels = self.facade.sheets
            found += sheet_drawings(panels, sheet_files(panels, prefix="panels"))
        return found

    # ---- files ---------------------------------------------------------------------------------

    def _write_sheets(self, folder: Path, clock: Clock) -> tuple[list[Path], list[Finding]]:
        """Write all sheets; the paths of those with strips, and faults found in any of them."""
        from fabrication.export.dxf import write_dxf
        from fabrication.export.dxf_lint import lint_dxf

        strips: list[Path] = []
        faults: list[Finding] = []
        checked, total = 0, sum(len(own.sheets) for own in self.sheets)
        for own in self.sheets:
            paths = write_dxf(
                own.sheets,
                folder,
                name=self.project.name,
                material=own.material.name,
                prefix=own.prefix,
                process=self.process,
            )
            strips = strips or paths
            for path, sheet in zip(paths, own.sheets, strict=True):
                drawn = [placement.part for placement in sheet.placements]
                found = lint_dxf(path, self.process, drawn)
                faults += [f for f in found if not self._beside_bar(own, f)]
                checked += 1
                clock.shared(checked / total)
        return strips, faults

    def _beside_bar(self, own: SheetSet, finding: Finding) -> bool:
        """Whether half a kerf lies beside the long edges of a bar, which are not cut."""
        offset = self.process.offset
        return own.of_bars and finding.code == "outside-sheet" and finding.value <= offset + 1e-6

    def _model(self) -> Model:
        """All parts, for other programs."""
        more = None if self.facade is None else self.facade.bodies
        model = lamella_model(self.project.name, self.jointed, self.parts, more)
        return model if self.segmented is None else model.repeated(self.segmented.segments.poses)

    def _cut_sets(self) -> list[CutSet]:
        """All flat parts but the coupons, by material, for machines."""
        own = [one for one in self.sheets if one.prefix != COUPON]
        return [cut_set(one.kind, one.material, one.sheets) for one in own]

    def _write_lists(self, draft: Path) -> None:
        from fabrication.export.assembly_schedule import write_assembly
        from fabrication.export.bar_schedule import write_bars
        from fabrication.export.bay_schedule import write_bay_schedule
        from fabrication.export.flat_schedule import write_flat_state
        from fabrication.export.schedule import write_bill, write_drillings, write_schedule

        material = self.jointed.design.profile.material
        lines = [] if self.facade is None else self.facade.lines()
        write_schedule(draft / "parts.csv", self.parts, self.sheets[0].sheets, material, lines)
        if self.segmented is not None:
            self.segmented.write(draft, self.jointed.design)
        write_bill(draft / "bill.csv", self.jointed.bill)
        if any(part.drills for part in self.parts):
            write_drillings(draft / "drillings.csv", self.parts)
        write_bay_schedule(draft / "bays.csv", self.stress)
        if self.plans.assembly.steps:
            write_assembly(draft / "assembly.csv", self.plans.assembly)
        if self.plans.flat is not None:
            write_flat_state(draft / "flat.csv", self.plans.flat)
        if self.moving is not None:
            self.moving.write(draft, self.project.name)
        if self.bars is not None:
            write_bars(draft / "bars.csv", self.bars.plan.bars)

    def _write_papers(self, draft: Path) -> None:
        from fabrication.export.papers.drawings import write_drawings
        from fabrication.export.papers.labels import write_labels
        from fabrication.export.papers.templates import write_templates

        name, papers = self.project.name, self.project.papers or PapersSection()
        material = self.jointed.design.profile.material.name
        if papers.drawings:
            write_drawings(
                draft / "drawings.pdf",
                self.jointed,
                self.parts,
                name=name,
                paper=papers.paper,
                revision=papers.revision,
                findings=self.findings,
                assembly=self.plans.assembly,
                flat=self.plans.flat,
            )
        if papers.labels:
            write_labels(draft / "labels.pdf", self.parts, name=name, material=material)
        if papers.templates is not None:
            with keyed("papers.templates"):
                write_templates(
                    draft / "templates.pdf", self.parts, name=name, paper=papers.templates
                )

    # ---- report --------------------------------------------------------------------------------

    def _stock(self) -> Report:
        from fabrication.export.bar_schedule import stock_report

        sets = {own.prefix: own.figures() for own in self.sheets}
        if self.bars is None:
            return sets
        return {**sets, "bars": stock_report(self.bars.plan, self.bars.front)}

    def _figures(self, fitted: Fit) -> Report:
        jointed, parts = self.jointed, self.parts
        density = jointed.design.profile.material.density
        return {
            "lamellas": len(jointed.design.lamellas),
            "strips": len(jointed.strips.lamellas),
            "nodes": len(jointed.design.nodes),
            "joints": fitted.nodes,
            "connectors": {kind.name: len(kind.bodies) for kind in jointed.connectors},
            "total_length_m": round(sum(p.quantity * p.length for p in parts) / 1000.0, 3),
            "mass_kg": float(f"{sum(p.quantity * p.volume for p in parts) * density * 1e-9:.6g}"),
            "max_edgewise_mm": max(p.development.edgewise for p in parts),
            "max_edge_strain": max(p.development.edge_strain for p in parts),
            "sheets": len(self.sheets[0].sheets),
            **({} if self.segmented is None else {"segments": self.segmented.segments.count}),
        }

    def _solids(self, cad: Kernel) -> KernelResult:
        try:
            return cad.result()
        except KernelError as error:
            raise _with_findings(error, self.findings, self.parts) from None


def lamella_loop_findings(closed: Report, fitted: Fit) -> list[Finding]:
    """Errors where the files do not close back onto the design or the parts do not fit."""
    return loop_findings(
        (
            ("closure", closed["worst"], closed["max_mm"], CLOSURE_LIMIT, "mm", "from the design"),
            ("volume", "all", closed["volume_ppm"], VOLUME_LIMIT, "ppm", "between sheet and solid"),
            ("clash", fitted.worst, fitted.max_mm3, CLASH_LIMIT, "mm3", "shared by two parts"),
        )
    )


def _with_findings(
    error: KernelError, findings: Sequence[Finding], parts: Sequence[FlatPart]
) -> KernelError:
    """*error* with what the checks found of its lamella, since no report comes, as advice."""
    part = next((part for part in parts if part.mark == error.where), None)
    if part is None:
        return error
    told = errors_at(part.mark, findings)
    if told:
        advice = f"to mend what the checks found there: {told}"
    else:
        gaps = (b.x - a.x - (a.width + b.width) / 2.0 for a, b in pairwise(part.slots))
        advice = (
            f"fewer lamellas or a thinner strip; its slots are {min(gaps, default=0.0):.2f} mm "
        )
        advice += "apart at the closest, and the checks found no error in it"
    return KernelError(
        error.what, where=error.where, value=error.value, limit=error.limit, advice=advice
    )
