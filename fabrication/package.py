"""From a project to the folder a shop gets: every stage once, in order.

The net and the report are made here; what is built on the net, and its own files, is the work of
one route per kind of net. Files are written into a folder beside the target and moved in at the end
(``delivery``), so a run that fails leaves nothing half-written behind.
"""

from __future__ import annotations

import json
from collections.abc import Sequence
from dataclasses import asdict, dataclass, replace
from glob import escape
from pathlib import Path

import numpy as np

import gridshell as gs
from fabrication.defaults import defaults_of
from fabrication.delivery import draft_folder, move_in
from fabrication.export.quality_series import Series, net_series
from fabrication.export_settings import require_formats_fit
from fabrication.exporting import FILES as EXPORTS
from fabrication.exporting import require_formats
from fabrication.finding import Finding
from fabrication.kernel_job import Kernel, kernel
from fabrication.lamella_route import LamellaRoute
from fabrication.moulds import moulds
from fabrication.net_checks import check_net, off_surface_limit
from fabrication.panel_route import PanelRoute
from fabrication.placing import keyed
from fabrication.remesh_job import Remeshed
from fabrication.routes import Announce, Clock, Report, Route, Shared, System
from fabrication.sections import NetSection, Project
from fabrication.starts import Start, start

FILES = (
    *("net.json", "net.obj", "parts.csv", "structure.step"),
    *("report.html", "report.json", "report.pdf"),
)
"""What every run makes, besides ``sheets/*.dxf``."""

_SHEETS = (
    *("sheet", "bar", "star-washers", "splices", "coupon"),
    *("panels", "plates", "stars"),
)

_STALE = (
    *(f"sheets/{name}-*.dxf" for name in _SHEETS),
    "facade.step",
    *(f"{name}.csv" for name in ("assembly", "bars", "bays", "beams", "bill", "flat")),
    *(f"{name}.csv" for name in ("drillings", "hanging", "motion")),
    *("motion.glb", "motion.html"),
    *EXPORTS,
    *(f"{name}.pdf" for name in ("drawings", "labels", "templates")),
)

_ANCHORS: dict[str, gs.Anchor] = {
    "free": gs.Free(),
    "boundary-pinned": gs.BoundaryPinned(),
    "boundary-glide": gs.BoundaryGlide(),
}


@dataclass(frozen=True, eq=False)
class _Design:
    """Everything that is known before a file is written."""

    control: gs.ControlMesh
    system: System
    net: Report
    series: Sequence[Series]
    findings: Sequence[Finding]
    remeshed: Remeshed | None


def run(
    project: Project,
    out: Path | str,
    *,
    folder: Path | str = ".",
    announce: Announce = lambda stage: None,
    shared: Shared = lambda share: None,
) -> Report:
    """Design, build and write the package of *project* into *out*.

    Parameters
    ----------
    project : from ``read_project``.
    out : created if it is not there; files of an earlier run are replaced, others are kept.
    folder : what file names in the project are relative to.
    announce : called with the name of each stage as it begins.
    shared : called with how much of a stage is done, 0 to 1, where that is known.

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
    clock = Clock(announce, shared)
    if project.export is not None:
        require_formats(project.export.formats)
        with keyed("export"):
            require_formats_fit(project)
    route = route_of(project)
    with draft_folder(out, names=(*FILES, *route.files)) as draft, kernel() as cad:
        design = _design(project, route, Path(folder), clock)
        report = _write(project, design, draft, cad, clock)
        move_in(draft, out, stale=(*_STALE, *_sheets_before(out)))
    return report


def found_by(project: Project, *, folder: Path | str = ".") -> list[Report]:
    """Every finding of the design of *project*, as in ``report.json``; no file is written.

    What only written files can show (closure, clashes, faults of sheets) is not among them.

    Raises
    ------
    As :func:`run`.
    """
    design = _design(project, route_of(project), Path(folder), Clock(lambda stage: None))
    return [{**asdict(f), "severity": f.severity.value} for f in design.findings]


def _sheets_before(out: Path) -> list[str]:
    """Sheets that the report of an earlier run names, whatever the shop called them."""
    try:
        named = json.loads((out / "report.json").read_text(encoding="utf-8"))["sheets"]
        return [f"sheets/{escape(Path(name).name)}" for name in named if name.endswith(".dxf")]
    except (OSError, ValueError, LookupError, TypeError, AttributeError):
        return []  # none, or not ours


def route_of(project: Project) -> Route:
    """The route of the project's kind of net."""
    if project.panels is not None:
        return PanelRoute(project, project.panels)
    if project.profile is not None and project.joint is not None:
        return LamellaRoute(project, project.profile, project.joint)
    raise AssertionError("a project has one of the two kinds")


# ---- design ------------------------------------------------------------------------------------


def _design(project: Project, route: Route, folder: Path, clock: Clock) -> _Design:
    begun = start(project, folder, clock.stage)
    with clock.stage("optimise"):
        net = net_of(project, route, folder, begun, solving(project, clock.shared))
        result, quality = net.result, net.quality
    system = route.build(result.control, clock)
    about_net = check_net(result, quality, kept=project.net.keep_to_surface)
    limit = off_surface_limit(result.control) if project.net.keep_to_surface else None
    laid = () if begun.remeshed is None else begun.remeshed.findings
    seconds = clock.seconds["optimise"]
    return _Design(
        control=result.control,
        system=system,
        net=gs.net_report(result, route.planarity, seconds=seconds, quality=quality),
        series=net_series(quality.figures, surface_limit=limit),
        findings=[*laid, *about_net, *system.findings],
        remeshed=begun.remeshed,
    )


@dataclass(frozen=True, eq=False)
class FoundNet:
    """A net with what it was asked for, and how well it meets that."""

    recipe: gs.NetRecipe
    result: gs.OptimizedNet
    quality: gs.NetQuality


def net_of(
    project: Project,
    route: Route,
    folder: Path,
    begun: Start,
    progress: gs.Progress | None = None,
    workspace: gs.Workspace | None = None,
    engine: gs.Engine | None = None,
) -> FoundNet:
    """The net of *project* from where it begins.

    Parameters
    ----------
    progress : called after every step with its number and the step.
    workspace : what solves one after the other share.
    engine : the linear solver; that of the route's recipe without.

    Raises
    ------
    SolveError
        When none is found near the start.
    """
    recipe = route.recipe(folder)
    if engine is not None:
        recipe = replace(recipe, stop=replace(recipe.stop, engine=engine))
    result = _found(optimised(project, recipe, begun, progress, workspace), begun)
    quality = gs.measured_against(result.quality, result.control, begun.surface)
    if project.umbrella is not None:  # D2 only fills it: its quads have no node angle
        angles = np.degrees(gs.umbrella_of(result.control).node_angles)
        quality = replace(quality, node_angle_deg=(float(angles.min()), float(angles.max())))
    return FoundNet(recipe, result, quality)


def solving(project: Project, shared: Shared) -> gs.Progress:
    """Tell *shared* how far a solve is: by its residual on the way to the tolerance."""
    tolerance, first = project.net.tolerance, [0.0]

    def progress(number: int, step: gs.Step) -> None:
        first[0] = max(first[0], step.unmet)
        if tolerance < step.unmet < first[0]:
            by_residual = np.log(first[0] / step.unmet) / np.log(first[0] / tolerance)
            shared(max(float(by_residual), number / project.net.steps))

    return progress


_CAUSES = ("angle-infeasible", "not-integrable")
"""Findings of the remeshing that explain why no net is found."""


def _found(result: gs.OptimizedNet, begun: Start) -> gs.OptimizedNet:
    """*result* when it is the net that was asked for; else told with what the surface said."""
    try:
        return result.require()
    except gs.SolveError as error:
        laid = () if begun.remeshed is None else begun.remeshed.findings
        causes = [f for f in laid if f.code in _CAUSES]
        if not causes:
            raise
        told = " ".join(f"{f.message} [{f.where}]" for f in causes)
        raise gs.SolveError(
            error.what,
            where=error.where,
            value=error.value,
            limit=error.limit,
            advice=f"to mend what the surface does not allow: {told}",
        ) from None


def optimised(
    project: Project,
    recipe: gs.NetRecipe,
    begun: Start,
    progress: gs.Progress | None = None,
    workspace: gs.Workspace | None = None,
) -> gs.OptimizedNet:
    """The net from where it begins, held, weighted and kept to its surface as the project says.

    Parameters
    ----------
    progress : called after every step with its number and the step.
    workspace : what solves one after the other share.
    """
    net = project.net
    recipe = _weighted(recipe, net)
    control, reference = begun.control, begun.surface if net.keep_to_surface else None
    if net.supports is None:
        anchor: gs.Anchor = _ANCHORS[net.anchor]
    else:
        with keyed("net"):
            control, anchor = gs.stand_on(control, np.array(net.supports))
    return gs.optimize(
        control,
        recipe,
        anchor=anchor,
        reference=reference,
        progress=progress,
        workspace=workspace,
    )


def _weighted(recipe: gs.NetRecipe, net: NetSection) -> gs.NetRecipe:
    """*recipe* with the guiding weights of ``[net]``; those that are unset stay its own."""
    if net.fairness is not None:
        recipe = replace(recipe, fairness=replace(recipe.fairness, start=net.fairness))
    if net.proximity is not None:
        recipe = replace(recipe, proximity=replace(recipe.proximity, start=net.proximity))
    return recipe


# ---- files -------------------------------------------------------------------------------------


def _write(project: Project, design: _Design, draft: Path, cad: Kernel, clock: Clock) -> Report:
    gs.write_net(draft / "net.json", design.control)
    gs.write_obj(draft / "net.obj", design.control.mesh, unit=gs.Unit.MM)
    written = design.system.write(draft, cad, clock)
    report: Report = {
        "name": project.name,
        "defaults": defaults_of(project),
        **({} if design.remeshed is None else {"remesh": design.remeshed.section()}),
        "net": design.net,
        **written.sections,
        **_moulds(project, design.control),
        "sheets": sorted(path.name for path in (draft / "sheets").glob("*.dxf")),
        "findings": [
            {**asdict(f), "severity": f.severity.value}
            for f in (*design.findings, *written.findings)
        ],
        "timing": clock.seconds,
        "kernel_timing": written.kernel_seconds,
    }
    with clock.stage("report"):
        design.system.write_page(draft / "report.html", report, _pictures(design), design.series)
        design.system.write_paper(draft / "report.pdf", report, design.series)
    text = json.dumps(report, indent=2, allow_nan=False)
    (draft / "report.json").write_text(text + "\n", encoding="utf-8")
    return report


def _moulds(project: Project, control: gs.ControlMesh) -> Report:
    if project.moulds is None:
        return {}
    which = gs.Skin.PATTERN if project.net.skin == "P" else gs.Skin[project.net.skin]
    return {"moulds": moulds(control, which, project.moulds.tolerance)}


def _pictures(design: _Design) -> Sequence[Report]:
    if design.remeshed is None:
        return ()
    from fabrication.export.stages import pictures

    return pictures(design.remeshed.made, design.control)
