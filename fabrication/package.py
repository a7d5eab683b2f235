"""From a project to the folder a shop gets: every stage once, in order.

Files are written into a folder beside the target and moved in at the end (``delivery``), so a run
that fails leaves nothing half-written behind.
"""

from __future__ import annotations

import json
import time
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import asdict, dataclass, field
from itertools import pairwise
from math import radians
from pathlib import Path
from typing import Any

import fabrication.stock as stock
import gridshell as gs
from fabrication.checks import check
from fabrication.delivery import draft_folder, move_in
from fabrication.errors import KernelError
from fabrication.finding import Finding, Severity
from fabrication.fitting import Fit, fit
from fabrication.joints import SlotJoint
from fabrication.kernel_job import Kernel, kernel
from fabrication.nesting import NestedSheet, nest
from fabrication.net_checks import check_net
from fabrication.parts import FlatPart, flat_parts
from fabrication.remesh_job import Remeshed
from fabrication.sections import Project
from fabrication.settings import profile_of
from fabrication.starts import Start, start
from fabrication.structures import Structure, structure

CLOSURE_LIMIT = 0.05
"""Largest distance between the files and the design that passes, mm."""

VOLUME_LIMIT = 20.0
"""Largest difference between flat area times thickness and the solid's volume, ppm."""

CLASH_LIMIT = 1e-3
"""Largest volume two strips may share at a node, mm3."""

FILES = (
    *("net.json", "net.obj", "parts.csv", "report.html", "report.json", "structure.step"),
    "sheets/sheet-01.dxf",
)
"""What every run makes; there may be more sheets."""

Report = dict[str, Any]
Announce = Callable[[str], None]

_ANCHORS: dict[str, gs.Anchor] = {
    "free": gs.Free(),
    "boundary-pinned": gs.BoundaryPinned(),
    "boundary-glide": gs.BoundaryGlide(),
}


@dataclass
class _Clock:
    """Announces stages and keeps their times."""

    announce: Announce
    seconds: dict[str, float] = field(default_factory=dict)

    @contextmanager
    def stage(self, name: str) -> Iterator[None]:
        self.announce(name)
        start = time.perf_counter()
        yield
        self.seconds[name] = round(time.perf_counter() - start, 3)


@dataclass(frozen=True, eq=False)
class _Design:
    """Everything that is known before a file is written."""

    control: gs.ControlMesh
    net: gs.DiagonalMesh
    structure: Structure
    parts: tuple[FlatPart, ...]
    sheets: tuple[NestedSheet, ...]
    remeshed: Remeshed | None


def run(
    project: Project,
    out: Path | str,
    *,
    folder: Path | str = ".",
    announce: Announce = lambda stage: None,
) -> Report:
    """Design, build and write the package of *project* into *out*.

    Parameters
    ----------
    project : from ``read_project``.
    out : created if it is not there; files of an earlier run are replaced, others are kept.
    folder : what file names in the project are relative to.
    announce : called with the name of each stage as it begins.

    Returns
    -------
    The content of ``report.json``.

    Raises
    ------
    InputError
        When the project asks for something that cannot be made; each names what and where.
    SolveError
        When no net is found near the start.
    OutputError
        When *out* cannot be written.
    """
    out = Path(out)
    clock = _Clock(announce)
    with draft_folder(out, names=FILES) as draft, kernel() as cad:
        report = _write(project, _design(project, Path(folder), clock), draft, cad, clock)
        move_in(draft, out, stale=("sheets/sheet-*.dxf",))
    return report


# ---- design ------------------------------------------------------------------------------------


def _design(project: Project, folder: Path, clock: _Clock) -> tuple[_Design, Report, list[Finding]]:
    begun = start(project, folder, clock.stage)
    with clock.stage("optimise"):
        result = _optimise(project, begun).require()
        kind = gs.Planarity.DIAGONAL_STARS
        quality = gs.net_quality(
            result.control, planarity=kind, angle=_angle(project), reference=begun.surface
        )
    with clock.stage("structure"):
        skin = gs.diagonal_meshes(result.control)[0 if project.net.skin == "D1" else 1]
        built = structure(skin, profile_of(project.profile), overhang=project.profile.overhang)
    with clock.stage("parts"):
        joint = SlotJoint(project.joint.clearance, project.joint.depth_clearance)
        parts = flat_parts(built, joint)
        sheet = stock.Sheet(**project.sheet.model_dump())
        sheets = nest(parts, sheet)
        about_net = check_net(result, quality, kept=project.net.keep_to_surface)
        laid = () if begun.remeshed is None else begun.remeshed.findings
        findings = [*laid, *about_net, *joint.findings(built), *check(built, parts)]
    design = _Design(result.control, skin, built, parts, sheets, begun.remeshed)
    seconds = clock.seconds["optimise"]
    return design, gs.net_report(result, kind, seconds=seconds, quality=quality), findings


def _optimise(project: Project, begun: Start) -> gs.OptimizedNet:
    net = project.net
    recipe = gs.a_net(angle=_angle(project), steps=net.steps, tolerance=net.tolerance)
    reference = begun.surface if net.keep_to_surface else None
    return gs.optimize(begun.control, recipe, anchor=_ANCHORS[net.anchor], reference=reference)


def _angle(project: Project) -> float | None:
    return None if project.net.angle is None else radians(project.net.angle)


# ---- files -------------------------------------------------------------------------------------


def _write(
    project: Project,
    designed: tuple[_Design, Report, list[Finding]],
    draft: Path,
    cad: Kernel,
    clock: _Clock,
) -> Report:
    from fabrication.export.dxf import read_dxf, write_dxf
    from fabrication.export.schedule import mass, write_schedule
    from fabrication.loop import compare

    design, net_report, findings = designed
    cad.order(design.structure, design.parts, name=project.name, step=draft / "structure.step")
    with clock.stage("fit"):
        fitted = fit(design.structure, design.parts)
    with clock.stage("sheets"):
        gs.write_net(draft / "net.json", design.control)
        gs.write_obj(draft / "net.obj", design.control.mesh, unit=gs.Unit.MM)
        material = design.structure.profile.material
        sheet_files = write_dxf(
            design.sheets, draft / "sheets", name=project.name, material=material.name
        )
        write_schedule(draft / "parts.csv", design.parts, design.sheets, material)
        drawn = [part for path in sheet_files for part in read_dxf(path)]
    with clock.stage("solids"):
        try:
            solid = cad.result()
        except KernelError as error:
            raise _with_findings(error, findings, design.parts) from None
    with clock.stage("closure"):
        skins = gs.diagonal_meshes(gs.read_net(draft / "net.json"))
        net = skins[0 if project.net.skin == "D1" else 1]
        closed = asdict(compare(design.structure, design.parts, net, drawn, solid.parts))
    findings += _loop_findings(closed, fitted)
    report: Report = {
        "name": project.name,
        **({} if design.remeshed is None else {"remesh": design.remeshed.section()}),
        "net": net_report,
        "structure": {
            "lamellas": len(design.structure.lamellas),
            "nodes": len(design.structure.nodes),
            "joints": fitted.nodes,
            "total_length_m": round(sum(p.length for p in design.parts) / 1000.0, 3),
            "mass_kg": float(f"{sum(mass(p, material) for p in design.parts):.6g}"),
            "max_edgewise_mm": max(p.development.edgewise for p in design.parts),
            "max_edge_strain": max(p.development.edge_strain for p in design.parts),
            "sheets": len(design.sheets),
        },
        "closure": closed,
        "fit": {
            "clash_mm3": {"max": fitted.max_mm3},
            "worst": fitted.worst,
            "nodes": fitted.nodes,
        },
        "findings": [{**asdict(f), "severity": f.severity.value} for f in findings],
        "timing": clock.seconds,
        "kernel_timing": solid.seconds,
    }
    _write_reports(project, design, report, draft, clock)
    return report


def _with_findings(
    error: KernelError, findings: Sequence[Finding], parts: Sequence[FlatPart]
) -> KernelError:
    """*error* with what the checks found of its lamella, since no report comes, as advice."""
    part = next((part for part in parts if part.mark == error.where), None)
    if part is None:
        return error
    found = [f for f in findings if f.severity is Severity.ERROR and part.mark in f.where.split()]
    if found:
        told = " ".join(f.message for f in found[:3]).rstrip(".")
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


def _write_reports(
    project: Project, design: _Design, report: Report, draft: Path, clock: _Clock
) -> None:
    from fabrication.export.report import write_report

    with clock.stage("report"):
        pictures: Sequence[Report] = ()
        if design.remeshed is not None:
            from fabrication.export.stages import pictures as drawn

            pictures = drawn(design.remeshed.made, design.control)
        write_report(
            draft / "report.html",
            name=project.name,
            report=report,
            structure=design.structure,
            parts=design.parts,
            sheets=design.sheets,
            clearance=project.joint.clearance,
            pictures=pictures,
        )
    text = json.dumps(report, indent=2, allow_nan=False)
    (draft / "report.json").write_text(text + "\n", encoding="utf-8")


def _loop_findings(closed: Report, fitted: Fit) -> list[Finding]:
    """Errors where the files do not close back onto the design or the strips do not fit."""
    measures = (
        ("closure", closed["worst"], closed["max_mm"], CLOSURE_LIMIT, "mm", "from the design"),
        ("volume", "all", closed["volume_ppm"], VOLUME_LIMIT, "ppm", "between sheet and solid"),
        ("clash", fitted.worst, fitted.max_mm3, CLASH_LIMIT, "mm3", "shared by two strips"),
    )
    return [
        Finding(
            code,
            Severity.ERROR,
            where,
            value,
            limit,
            unit,
            f"{value:.4g} {unit} {what}, {limit:g} allowed",
        )
        for code, where, value, limit, unit, what in measures
        if value > limit
    ]
