"""Lamellas with their joints as a system that writes its own files and closes the loop."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import asdict, dataclass, replace
from itertools import pairwise
from math import degrees
from pathlib import Path

import gridshell as gs
from fabrication.errors import KernelError
from fabrication.export.quality_series import Series
from fabrication.export.step_prism_reader import StepCopy, StepPrism
from fabrication.export.step_reader import StepPart
from fabrication.exporting import write_exports
from fabrication.facade_route import STEP_FILE, facade_findings
from fabrication.finding import Finding
from fabrication.fitting import Fit, fit
from fabrication.jointed import Jointed
from fabrication.kernel_job import Kernel, KernelResult, LamellaWork
from fabrication.lamella_design import LamellaDesign
from fabrication.parts import FlatPart
from fabrication.routes import (
    CLOSURE_LIMIT,
    VOLUME_LIMIT,
    Clock,
    Report,
    Written,
    errors_at,
    loop_findings,
)
from fabrication.stress_checks import stress_section

CLASH_LIMIT = 1e-3
"""Largest volume two parts may share at a node, mm3."""

Rebuilt = Callable[[gs.ControlMesh], tuple[gs.DiagonalMesh, Jointed]]


@dataclass(frozen=True, eq=False)
class LamellaSystem(LamellaDesign):
    """A design that writes its files and lays what it reads back over itself.

    Parameters
    ----------
    rebuilt : builds net and joints anew on a control mesh that was read back.
    """

    rebuilt: Rebuilt

    def write(self, draft: Path, cad: Kernel, clock: Clock) -> Written:
        """Sheets, lists and STEP; the clash at the nodes is measured meanwhile."""
        from fabrication import lamella_files as files
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
            paths, faults = files.write_sheets(self, draft / "sheets", clock)
            drawn = [part for path in paths for part in read_dxf(path, self.process)]
            panels = (
                []
                if facade is None
                else facade.write_sheets(draft / "sheets", name=self.project.name)
            )
        with clock.stage("lists"):
            files.write_lists(self, draft)
        with clock.stage("papers"):
            files.write_papers(self, draft)
            write_exports(
                draft,
                self.project.export,
                self.project.name,
                lambda: files.model_of(self),
                lambda: files.cut_sets(self),
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
        from fabrication.lamella_pages import write_page

        write_page(self, path, report, pictures, series)

    def write_paper(self, path: Path, report: Report, series: Sequence[Series]) -> None:
        """The same to print."""
        from fabrication.lamella_pages import write_paper

        write_paper(self, path, report, series)

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
        angles = [degrees(node.angle) for node in jointed.design.nodes if node.angle is not None]
        return {
            "lamellas": len(jointed.design.lamellas),
            "strips": len(jointed.strips.lamellas),
            "nodes": len(jointed.design.nodes),
            "joints": fitted.nodes,
            "joint_angle_deg": {"min": min(angles), "max": max(angles)} if angles else None,
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
