"""The control mesh a project begins with, and the surface it belongs to."""

from __future__ import annotations

from collections.abc import Callable
from contextlib import AbstractContextManager
from dataclasses import dataclass, replace
from math import radians
from pathlib import Path

import gridshell as gs
from fabrication.motion_sections import UmbrellaSection
from fabrication.remesh_checks import CONCAVE
from fabrication.remesh_job import GuideFile, Remeshed, Wish, lay, read_wished
from fabrication.sections import Project
from fabrication.settings import patch_of, position_of, surface_of
from fabrication.source_sections import USUAL_QUADS, MeshSection, RemeshSection, RemeshSource

Stage = Callable[[str], AbstractContextManager[None]]
"""Announces a stage and keeps its time."""


@dataclass(frozen=True, eq=False)
class Start:
    """What is optimised, and what it is kept close to.

    Parameters
    ----------
    remeshed : how the control mesh came about, where a mesh was laid over a surface.
    """

    control: gs.ControlMesh
    surface: gs.Surface
    remeshed: Remeshed | None = None


def start(project: Project, folder: Path, stage: Stage) -> Start:
    """The start of *project*: of a mesh file, the mesh itself is the surface.

    Parameters
    ----------
    folder : what file names in the project are relative to.

    Raises
    ------
    InputError
        When the surface or the mesh does not carry the net that is asked for.
    """
    source = project.source
    if isinstance(source, RemeshSource):
        return _remeshed(source, folder, stage)
    if isinstance(source, UmbrellaSection):
        with stage("start mesh"):
            control = position_of(source).control()
            return Start(control, gs.TriangulatedSurface.of_quads(control.vertices, control.quads))
    with stage("start mesh"):
        if isinstance(source, MeshSection):
            return _of_mesh(source, folder, planar=project.net.kind == "planar")
        surface = surface_of(source.surface)
        return Start(gs.control_patch(surface, patch_of(source.patch)), surface)


def _of_mesh(section: MeshSection, folder: Path, *, planar: bool) -> Start:
    unit = None if section.unit is None else gs.Unit.named(section.unit)
    try:
        mesh = gs.read_mesh(folder / section.file, unit=unit)
    except gs.UnitError as error:
        raise _at("mesh.unit", error) from None
    except gs.SettingError as error:
        raise _at("mesh.file", error) from None
    control = gs.control_mesh(mesh) if section.along == "edges" else gs.as_control_mesh(mesh)
    gs.require_sound(mesh)
    if not planar:
        gs.require_hyperbolic(control.mesh)
    return Start(control, gs.TriangulatedSurface.of_quads(mesh.vertices, mesh.quads))


def _remeshed(source: RemeshSource, folder: Path, stage: Stage) -> Start:
    named = source.surface.unit
    unit = None if named is None else gs.Unit.named(named)
    wish = wish_of(source.remesh, folder)
    try:
        with stage("surface"):
            surface = read_wished(folder / source.surface.file, unit, wish)
        with stage("remesh"):
            found = lay(surface, unit, wish)
            control = found.made.control()
    except gs.UnitError as error:
        raise _at("surface.unit", error) from None
    except gs.SettingError as error:
        raise _at(f"remesh.{error.where}", error) from None
    about = tuple(f for f in found.findings if f.code != CONCAVE)  # C is judged when optimised
    return Start(control, found.made.reference, replace(found, findings=about))


def wish_of(section: RemeshSection, folder: Path = Path()) -> Wish:
    """The mesh that ``[remesh]`` asks for; guide lines are looked for in *folder*."""
    usual = USUAL_QUADS if section.edge is None else None
    return Wish(
        directions=_directions(section),
        quads=section.quads or usual,
        edge=section.edge,
        extent=gs.Extent[section.extent.upper()],
        guides=tuple(GuideFile(folder / guide.file, guide.family) for guide in section.guides),
    )


def _directions(section: RemeshSection) -> gs.Directions:
    if section.angle is None:
        return gs.Asymptotic() if section.directions == "asymptotic" else gs.Principal()
    return gs.Conjugate(
        radians(section.angle),
        gs.Hand[(section.hand or "right").upper()],
        gs.Infeasible[(section.infeasible or "widen").upper()],
    )


def _at(key: str, error: gs.InputError) -> gs.InputError:
    """*error* with the project's key before the place it names."""
    place = error.where or ""
    where = key if key.endswith(place) else f"{key}: {place}"
    return type(error)(
        error.what, where=where, value=error.value, limit=error.limit, advice=error.advice
    )
