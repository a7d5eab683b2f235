"""Whether the formats of ``[export]`` can hold what the project builds."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

from fabrication.panel_settings import panel_system
from fabrication.placing import placed
from fabrication.sections import Project
from fabrication.settings import material_of, profile_of
from fabrication.stock import Material, wall_of
from gridshell import SettingError

_PLATES = "glb, ply, obj, 3dm, ifc, or the DXF sheets, which are always there"


def require_formats_fit(project: Project) -> None:
    """Refuse NC1 of what is no steel plate, and BTLx of what is no timber strip.

    Raises
    ------
    SettingError
        Naming the format and what stands against it.
    """
    formats = () if project.export is None else project.export.formats
    if "nc1" in formats:
        _require_nc1(project)
    if "btlx" in formats:
        _require_btlx(project)


def require_export(project: Project, path: Path) -> None:
    """The same with the project file *path* in the error; raises ProjectError."""
    with placed(path, "export"):
        require_formats_fit(project)


def _require_nc1(project: Project) -> None:
    if project.profile is None:
        made = list(_materials(project))
        if not any(material.is_steel for material in made):
            names = ", ".join(dict.fromkeys(material.name for material in made))
            raise _refused("NC1 files are of steel plates", names, "S235, S355, stainless")
        return
    profile = profile_of(project.profile)
    if not profile.material.is_steel:
        told = f"strips of {profile.material.name}"
        raise _refused("NC1 files are of steel plates", told, "S235, S355, stainless")
    if wall_of(profile):
        raise _refused("NC1 files are of flat plates", "a hollow section", "solid strips")
    joint = project.joint
    if joint is not None and joint.kind == "reciprocal" and not joint.square_ends:
        raise _refused(
            "NC1 files are of plates with square ends",
            "bevelled ends",
            "square ends",
            "joint.square_ends = true, or leave nc1 out",
        )


def _require_btlx(project: Project) -> None:
    if project.profile is None:
        raise _refused("BTLx files are of strips", "panels", "projects with [profile]")
    profile = profile_of(project.profile)
    if not profile.material.is_timber:
        told = f"strips of {profile.material.name}"
        raise _refused("BTLx files are of timber", told, "birch-ply, poplar-ply, own timber")
    if wall_of(profile):
        raise _refused("BTLx files are of solid strips", "a hollow section", "solid strips")


def _materials(project: Project) -> Iterator[Material]:
    """Of panels, plates and star plates."""
    if project.panels is None:
        return
    yield material_of(project.panels.material)
    system = panel_system(project, project.panels)
    if system.plates is not None:
        yield system.plates.material
    if system.star is not None and system.connector_material is not None:
        yield system.connector_material


def _refused(what: str, value: str, limit: str, advice: str = "") -> SettingError:
    form = what.partition(" ")[0].lower()
    return SettingError(
        what,
        where="formats",
        value=value,
        limit=limit,
        advice=advice or f"leave {form} out: {_PLATES}",
    )
