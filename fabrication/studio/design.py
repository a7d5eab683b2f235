"""From a project to its net, and from the net to what is built: what ``gridshell run`` does, too.

Both are pure functions of the project: the net of a slider's place does not depend on how the
slider got there, so that what the studio shows is what a package of the saved project holds.
"""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field
from functools import cached_property
from pathlib import Path

import gridshell as gs
from fabrication.export.scene.whole import flat_patterns, panel_patterns
from fabrication.finding import Finding
from fabrication.lamella_system import LamellaSystem
from fabrication.net_checks import check_net
from fabrication.package import net_of, route_of
from fabrication.panel_route import PanelNetSystem
from fabrication.routes import Clock, Route, System
from fabrication.sections import Project
from fabrication.source_sections import MeshSection, RemeshSource
from fabrication.starts import Stage, Start, start

_QUICK = gs.Engine(repeatable=False)
"""Large nets agree with those of a run to rounding: the last bit would cost a tenth of the time."""

Told = Callable[[str], None]
"""Hears what is being done."""


@dataclass(frozen=True, eq=False)
class Residual:
    """After a step of the solve: its number and the largest residual of any goal."""

    step: int
    largest: float


@dataclass(frozen=True, eq=False)
class NetDesign:
    """A net that was found.

    Parameters
    ----------
    figures : quad by quad.
    residuals : of the solve, step by step.
    seconds : it took, from the project on.
    """

    project: Project
    route: Route
    begun: Start
    result: gs.OptimizedNet
    quality: gs.NetQuality
    figures: gs.QuadFigures
    residuals: tuple[Residual, ...]
    seconds: float


@dataclass(eq=False)
class Starts:
    """The last start of a solve, kept while what it comes from stays the same.

    Parameters
    ----------
    workspace : what one solve leaves to the next.
    """

    workspace: gs.Workspace = field(default_factory=gs.Workspace)

    _key: str = ""
    _start: Start | None = field(default=None)

    def of(self, project: Project, folder: Path, told: Told) -> Start:
        """The start of *project*; a file it comes from is read again when it changed."""
        key = _source_key(project, folder)
        if self._start is None or key != self._key:
            self._start, self._key = start(project, folder, _stage(told)), key
        return self._start


def _source_key(project: Project, folder: Path) -> str:
    source = project.source
    files = []
    if isinstance(source, MeshSection):
        files = [source.file]
    elif isinstance(source, RemeshSource):
        files = [source.surface.file, *(guide.file for guide in source.remesh.guides)]
    stamps = [(folder / name).stat().st_mtime_ns for name in files if (folder / name).exists()]
    return f"{source!r} {project.net.kind} {stamps}"


def _stage(told: Told) -> Stage:
    @contextmanager
    def stage(name: str) -> Iterator[None]:
        told(name)
        yield

    return stage


def find_net(
    project: Project,
    folder: Path,
    starts: Starts,
    *,
    told: Told = lambda stage: None,
    stepped: Callable[[Residual], None] = lambda residual: None,
) -> NetDesign:
    """The net of *project*.

    Parameters
    ----------
    stepped : called after every step; what it raises ends the solve.

    Raises
    ------
    InputError
        When the project asks for something that cannot be made.
    SolveError
        When no net is found near the start.
    """
    begin = time.perf_counter()
    begun = starts.of(project, folder, told)
    told("optimise")
    residuals: list[Residual] = []

    def progress(number: int, step: gs.Step) -> None:
        residuals.append(Residual(number, step.unmet))
        stepped(residuals[-1])

    route = route_of(project)
    net = net_of(project, route, folder, begun, progress, starts.workspace, _QUICK)
    figures = gs.quad_figures(
        net.result.control,
        planarity=net.recipe.planarity,
        angle=net.recipe.angle,
        reference=begun.surface,
    )
    return NetDesign(
        project,
        route,
        begun,
        net.result,
        net.quality,
        figures,
        tuple(residuals),
        time.perf_counter() - begin,
    )


def patterns_of(system: System) -> dict[str, str]:
    """Drawings of all flat parts of *system*, SVG."""
    if isinstance(system, LamellaSystem):
        return flat_patterns(system.jointed, system.parts)
    return panel_patterns(system.built) if isinstance(system, PanelNetSystem) else {}


@dataclass(frozen=True, eq=False)
class Built:
    """What is built on a net, and every finding that no file is needed for."""

    net: NetDesign
    system: System
    findings: tuple[Finding, ...]

    @cached_property
    def patterns(self) -> dict[str, str]:
        """Drawings of flat parts, SVG, by what a part asks for."""
        return patterns_of(self.system)


def build(net: NetDesign, *, told: Told = lambda stage: None) -> Built:
    """Strips, joints and parts, or panels and supports, on *net*.

    Raises
    ------
    InputError
        When they cannot be made.
    """
    system = net.route.build(net.result.control, Clock(told))
    laid = () if net.begun.remeshed is None else net.begun.remeshed.findings
    about = check_net(net.result, net.quality, kept=net.project.net.keep_to_surface)
    return Built(net, system, (*laid, *about, *system.findings))
