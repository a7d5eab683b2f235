"""Lamellas on an asymptotic net: strips, slots, and the files a shop cuts and bends them from."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import asdict, dataclass, replace
from itertools import pairwise
from math import radians
from pathlib import Path

import gridshell as gs
from fabrication.checks import check
from fabrication.errors import KernelError
from fabrication.export.step_prism_reader import StepPrism
from fabrication.export.step_reader import StepPart
from fabrication.facade_route import STEP_FILE, FacadeSystem, facade_findings, facade_system
from fabrication.finding import Finding
from fabrication.fitting import Fit, fit
from fabrication.joint_sections import JointSection
from fabrication.joint_settings import joint_of
from fabrication.jointed import Jointed
from fabrication.kernel_job import Kernel, KernelResult, LamellaWork
from fabrication.nesting import NestedSheet, nest
from fabrication.parts import FlatPart, parts_of
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
from fabrication.sections import ProfileSection, Project
from fabrication.settings import profile_of, sheet_of
from fabrication.stock import Profile
from fabrication.structures import Structure, structure

CLASH_LIMIT = 1e-3
"""Largest volume two strips may share at a node, mm3."""


@dataclass(frozen=True, eq=False)
class LamellaRoute:
    """The route of a project with ``[profile]`` and ``[joint]``."""

    project: Project
    profile: ProfileSection
    joint: JointSection

    @property
    def planarity(self) -> gs.Planarity:
        """Vertex stars of D1 and D2."""
        return gs.Planarity.DIAGONAL_STARS

    @property
    def files(self) -> tuple[str, ...]:
        """One sheet at least, and the facade's where there is one."""
        facade = () if self.project.facade is None else (STEP_FILE, "sheets/panels-01.dxf")
        return ("sheets/sheet-01.dxf", *facade)

    def recipe(self) -> gs.NetRecipe:
        """An A-net."""
        net = self.project.net
        angle = None if net.angle is None else radians(net.angle)
        return gs.a_net(angle=angle, steps=net.steps, tolerance=net.tolerance)

    def build(self, control: gs.ControlMesh, clock: Clock) -> LamellaSystem:
        """Lamellas along one of the two diagonal meshes."""
        profile = profile_of(self.profile)
        with clock.stage("structure"):
            skin = self.skin(control)
            jointed = self._jointed(skin, profile)
        with clock.stage("parts"):
            parts = parts_of(jointed)
            sheets = nest(parts, sheet_of(self.project.sheet))
            facade = self._facade(skin, jointed.design)
            findings = (*jointed.findings, *check(jointed.strips, parts))
        return LamellaSystem(self, jointed, parts, sheets, facade, findings)

    def rebuilt(self, control: gs.ControlMesh) -> Jointed:
        """The strips and their fixtures anew, on a net that was read back."""
        return self._jointed(self.skin(control), profile_of(self.profile))

    def skin(self, control: gs.ControlMesh) -> gs.DiagonalMesh:
        """The diagonal mesh along whose edges lamellas run."""
        return gs.diagonal_meshes(control)[0 if self.project.net.skin == "D1" else 1]

    def _jointed(self, skin: gs.DiagonalMesh, profile: Profile) -> Jointed:
        design = structure(skin, profile, overhang=self.profile.overhang)
        with keyed("joint"):
            return joint_of(self.joint, profile).build(design)

    def _facade(self, net: gs.DiagonalMesh, built: Structure) -> FacadeSystem | None:
        project = self.project
        if project.facade is None:
            return None
        sheet = sheet_of(project.panel_sheet or project.sheet)
        return facade_system(project.facade, net, built, sheet)


@dataclass(frozen=True, eq=False)
class LamellaSystem:
    """Lamellas, their flat parts, and the sheets these lie on."""

    route: LamellaRoute
    jointed: Jointed
    parts: tuple[FlatPart, ...]
    sheets: tuple[NestedSheet, ...]
    facade: FacadeSystem | None
    findings: Sequence[Finding]

    @property
    def project(self) -> Project:
        """What all this is made for."""
        return self.route.project

    def write(self, draft: Path, cad: Kernel, clock: Clock) -> Written:
        """Sheets, cut list and STEP; the clash at the nodes is measured meanwhile."""
        from fabrication.export.dxf import read_dxf, write_dxf
        from fabrication.export.schedule import write_schedule
        from fabrication.loop import compare

        name, material = self.project.name, self.jointed.design.profile.material
        facade = self.facade
        work = LamellaWork(self.jointed.strips, self.parts, name, self.jointed.connectors)
        if facade is not None:
            work = replace(work, more=facade.bodies, beside=STEP_FILE)
        cad.order(work, draft / "structure.step")
        with clock.stage("fit"):
            fitted = fit(self.jointed.strips, self.parts, self.jointed.connectors)
        with clock.stage("sheets"):
            files = write_dxf(self.sheets, draft / "sheets", name=name, material=material.name)
            drawn = [part for path in files for part in read_dxf(path)]
            lines = [] if facade is None else facade.lines()
            panels = [] if facade is None else facade.write_sheets(draft / "sheets", name=name)
            write_schedule(draft / "parts.csv", self.parts, self.sheets, material, lines)
        with clock.stage("solids"):
            solid = self._solids(cad)
        with clock.stage("closure"):
            control = gs.read_net(draft / "net.json")
            reference = self.route.rebuilt(control)
            strips = [part for part in solid.parts if isinstance(part, StepPart)]
            prisms = [part for part in solid.parts if isinstance(part, StepPrism)]
            closed = asdict(compare(reference, self.parts, drawn, strips, prisms))
            findings = lamella_loop_findings(closed, fitted)
            more: Report = {}
            if facade is not None:
                net = self.route.skin(control)
                glazed = facade.closure(net, reference.design, panels, prisms)
                more = {"facade": facade.figures(glazed)}
                findings += facade_findings(glazed)
        return Written(
            sections={
                "structure": self._figures(fitted),
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

    def write_page(self, path: Path, report: Report, pictures: Sequence[Report]) -> None:
        """The report on lamellas."""
        from fabrication.export.report import write_report

        write_report(
            path,
            name=self.project.name,
            report=report,
            jointed=self.jointed,
            parts=self.parts,
            sheets=self.sheets,
            clearance=getattr(self.route.joint, "clearance", None),
            facade=None if self.facade is None else self.facade.built,
            pictures=pictures,
        )

    def _figures(self, fitted: Fit) -> Report:
        from fabrication.export.schedule import mass

        material = self.jointed.design.profile.material
        return {
            "lamellas": len(self.jointed.design.lamellas),
            "strips": len(self.jointed.strips.lamellas),
            "nodes": len(self.jointed.design.nodes),
            "joints": fitted.nodes,
            "total_length_m": round(sum(p.length for p in self.parts) / 1000.0, 3),
            "mass_kg": float(f"{sum(mass(p, material) for p in self.parts):.6g}"),
            "max_edgewise_mm": max(p.development.edgewise for p in self.parts),
            "max_edge_strain": max(p.development.edge_strain for p in self.parts),
            "sheets": len(self.sheets),
        }

    def _solids(self, cad: Kernel) -> KernelResult:
        try:
            return cad.result()
        except KernelError as error:
            raise _with_findings(error, self.findings, self.parts) from None


def lamella_loop_findings(closed: Report, fitted: Fit) -> list[Finding]:
    """Errors where the files do not close back onto the design or the strips do not fit."""
    return loop_findings(
        (
            ("closure", closed["worst"], closed["max_mm"], CLOSURE_LIMIT, "mm", "from the design"),
            ("volume", "all", closed["volume_ppm"], VOLUME_LIMIT, "ppm", "between sheet and solid"),
            ("clash", fitted.worst, fitted.max_mm3, CLASH_LIMIT, "mm3", "shared by two strips"),
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
