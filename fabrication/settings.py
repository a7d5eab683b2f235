"""What the sections of a project stand for, and whether they go together.

Everything here is cheap: neither the CAD kernel nor scipy is loaded, no net is made.
"""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import numpy as np

import fabrication.stock as stock
import gridshell as gs
from fabrication.errors import ProjectError
from fabrication.joint_sections import JointSection, SlottedJoint
from fabrication.motion_sections import UmbrellaSection
from fabrication.placing import placed
from fabrication.remesh_settings import require_mesh, require_remeshable
from fabrication.section_types import MOST_NODES, MaterialSection
from fabrication.sections import ProfileSection, Project, SheetSection
from fabrication.source_sections import (
    AnalyticSection,
    AsymptoticPatchSection,
    ConjugatePatchSection,
    MeshSection,
    PatchSection,
    RemeshSource,
    SingularPatchSection,
    SurfaceSource,
)
from gridshell.arrays import Floats

LARGEST = 1e7
"""No point of a patch is farther than this from the origin along an axis, mm."""

_SURFACES: dict[str, Callable[..., gs.AnalyticSurface]] = {
    "enneper": gs.Enneper,
    "catenoid": gs.Catenoid,
    "helicoid": gs.Helicoid,
    "hypar": gs.Hypar,
    "hyperboloid": gs.Hyperboloid,
    "scherk": gs.Scherk,
    "torus": gs.Torus,
    "sphere": gs.Sphere,
}


def surface_of(section: AnalyticSection) -> gs.AnalyticSurface:
    """The surface of ``[surface]``."""
    sizes = section.model_dump()
    return _SURFACES[sizes.pop("kind")](**sizes)


def patch_of(section: PatchSection) -> gs.Patch:
    """The layout of ``[patch]``."""
    if isinstance(section, AsymptoticPatchSection):
        return gs.AsymptoticPatch(section.p, section.q, section.lamellas)
    if isinstance(section, ConjugatePatchSection):
        return gs.ConjugatePatch(section.v, section.panels, section.u)
    if isinstance(section, SingularPatchSection):
        return gs.SingularPatch(section.valence, section.cells, section.reach, section.cut)
    return gs.BisectingPatch(section.v, section.cells, section.u)


def position_of(section: UmbrellaSection) -> gs.Position:
    """The position of ``[umbrella]`` that is built.

    Raises
    ------
    SettingError
        When no such umbrella can be built, or it locks before it gets there.
    """
    return gs.Umbrella(section.ribs, section.radius, section.bays).position(section.opening)


def profile_of(section: ProfileSection) -> stock.Profile:
    """The strip of ``[profile]``."""
    material = material_of(section.material)
    if section.wall is not None:
        return stock.HollowProfile(section.width, section.thickness, material, section.wall)
    return stock.Profile(section.width, section.thickness, material)


def material_of(chosen: str | MaterialSection) -> stock.Material:
    """A material by its name, or one of the project's own."""
    if isinstance(chosen, str):
        return stock.MATERIALS[chosen]
    return stock.Material(**chosen.model_dump())


def sheet_of(section: SheetSection) -> stock.Sheet:
    """The raw sheet of ``[sheet]`` or ``[panel_sheet]``."""
    return stock.Sheet(**section.model_dump())


def require_makeable(project: Project, path: Path) -> None:
    """Refuse what can be told to fail before a net is made, of the source and of lamellas.

    Parameters
    ----------
    project : from the file *path*; a mesh file is looked for beside it.

    Raises
    ------
    ProjectError
        Naming the file and the key.
    """
    with placed(path, "sheet"):
        sheet = sheet_of(project.sheet)
    if project.panel_sheet is not None:
        with placed(path, "panel_sheet"):
            sheet_of(project.panel_sheet)
    if project.profile is not None and project.joint is not None:
        _require_strips(project.profile, project.joint, sheet, path)
    source = project.source
    if isinstance(source, UmbrellaSection):
        with placed(path, "umbrella"):
            position_of(source)
    elif isinstance(source, MeshSection):
        require_mesh(source, path)
    elif isinstance(source, RemeshSource):
        require_remeshable(source, path, kind=project.net.kind)
    else:
        _require_patch(source, path, planar=project.net.kind == "planar")


def _require_strips(
    section: ProfileSection, joint: JointSection, sheet: stock.Sheet, path: Path
) -> None:
    with placed(path, "profile"):
        profile = profile_of(section)
    if isinstance(joint, SlottedJoint):
        with placed(path, "joint"):
            stock.require_web(profile, joint.depth_clearance)
    room = sheet.width - 2.0 * sheet.margin
    if profile.width > room:
        raise ProjectError(
            "The strip is wider than the sheet",
            where=f"{path}, profile.width",
            value=f"{profile.width:g} mm",
            limit=f"{room:g} mm between the sheet's margins",
            advice="a wider sheet, or a narrower strip",
        )


def _require_patch(source: SurfaceSource, path: Path, *, planar: bool) -> None:
    layouts = ("conjugate",) if planar else ("asymptotic", "bisecting", "singular")
    if source.patch.layout not in layouts:
        raise ProjectError(
            "This layout belongs to another kind of net",
            where=f"{path}, patch.layout",
            value=f"{source.patch.layout!r} with {'a planar' if planar else 'an asymptotic'} net",
            limit=", ".join(layouts),
        )
    with placed(path, "surface"):
        surface = surface_of(source.surface)
    with placed(path, "patch"):
        patch = patch_of(source.patch)
    if getattr(patch, "u", ()) is None and surface.period_u is None:
        raise ProjectError(
            "This surface does not close into a ring",
            where=f"{path}, patch.u",
            value=type(surface).__name__,
            advice="give u = [first, last], or use a surface of revolution",
        )
    _require_count(surface, patch, path)
    if isinstance(patch, gs.SingularPatch):
        with placed(path, "patch"):
            far = float(np.abs(gs.control_patch(surface, patch).vertices).max())
        _require_reach(far, path)
        return
    if isinstance(surface, gs.Torus):
        return  # its elliptic functions are scipy's
    u, v = _corners(surface, patch)
    with placed(path, "patch"), np.errstate(all="ignore"):
        if planar:
            surface.check(u, v)
        else:
            surface.require_hyperbolic(u, v)
        far = float(np.abs(surface.point(u, v)).max())
    _require_reach(far, path)


def _require_reach(far: float, path: Path) -> None:
    if not far <= LARGEST:
        raise ProjectError(
            "The patch is too large",
            where=f"{path}, patch",
            value=f"a corner {far:.3g} mm from the origin",
            limit=f"{LARGEST:g} mm",
            advice="check the sizes, which are mm, and the ranges, which are pure numbers",
        )


def _require_count(surface: gs.AnalyticSurface, patch: gs.Patch, path: Path) -> None:
    if isinstance(patch, gs.AsymptoticPatch):
        key, value, nodes = "lamellas", list(patch.lamellas), float(np.prod(patch.lamellas))
    elif isinstance(patch, gs.SingularPatch):
        nodes = patch.valence * patch.cells**2 / 2.0
        key, value = "cells", [patch.cells]
    elif isinstance(patch, gs.ConjugatePatch):
        key, value, nodes = "panels", list(patch.panels), float(np.prod(patch.panels))
    else:
        first, last = patch.u or (0.0, surface.period_u or 0.0)
        across = max(2.0, (patch.v[1] - patch.v[0]) * patch.cells / (last - first))
        key, value, nodes = "cells", [patch.cells], patch.cells * (across + 1.0) / 2.0
    if nodes > MOST_NODES:
        raise ProjectError(
            "The net has too many nodes",
            where=f"{path}, patch.{key}",
            value=f"{value}, about {nodes:.3g} nodes",
            limit=f"{MOST_NODES} nodes",
            advice=f"fewer {key}",
        )


_Rectangle = gs.AsymptoticPatch | gs.BisectingPatch | gs.ConjugatePatch


def _corners(surface: gs.AnalyticSurface, patch: _Rectangle) -> tuple[Floats, Floats]:
    """Parameters (u, v), each (5,), of the corners of *patch* and its middle."""
    if isinstance(patch, gs.AsymptoticPatch):
        p, q = (np.append(x, x.mean()) for x in _rectangle(patch.p, patch.q))
        return (p + q) / 2.0, (p - q) / 2.0
    u, v = _rectangle(patch.u or (0.0, surface.period_u or 0.0), patch.v)
    return np.append(u, u.mean()), np.append(v, v.mean())


def _rectangle(first: tuple[float, float], second: tuple[float, float]) -> tuple[Floats, Floats]:
    a, b = np.meshgrid(first, second)
    return a.ravel(), b.ravel()
