"""Whether a file and what is asked of it go together, told without reading the file."""

from __future__ import annotations

from pathlib import Path

from fabrication.errors import ProjectError
from fabrication.source_sections import MeshSection, RemeshSection, RemeshSource

FORMATS = (
    *(".obj", ".ply", ".stl", ".glb", ".csv", ".txt", ".xyz"),
    *(".step", ".stp", ".iges", ".igs", ".brep", ".brp"),
)
"""Endings of the surface files that can be read."""

MESHES = (".obj", ".3dm", ".json")
"""Endings of the files of quad meshes that can be read."""

_STATE_UNIT = (".step", ".stp", ".iges", ".igs")


def require_mesh(source: MeshSection, path: Path) -> None:
    """Refuse a mesh file that is not there, of no known kind, or without the unit it needs.

    Parameters
    ----------
    path : the project file; the mesh is looked for beside it.

    Raises
    ------
    ProjectError
        Naming the file and the key.
    """
    require_file(source.file, "mesh", path, "mesh.file")
    suffix = _known_ending(source.file, "mesh", MESHES, path)
    if source.unit is None and suffix != ".3dm":
        raise _missing_unit("mesh", "only .3dm files state their own", path)


def require_remeshable(source: RemeshSource, path: Path, *, kind: str) -> None:
    """Refuse what can be told to fail before the surface is read.

    Parameters
    ----------
    path : the project file; the others are looked for beside it.
    kind : of the net, asymptotic or planar.

    Raises
    ------
    ProjectError
        Naming the file and the key.
    """
    surface = source.surface
    require_file(surface.file, "surface", path, "surface.file")
    suffix = _known_ending(surface.file, "surface", FORMATS, path)
    if surface.unit is None and suffix not in _STATE_UNIT:
        raise _missing_unit("surface", "only STEP and IGES files state their own", path)
    _require_consistent(source.remesh, path)
    for number, guide in enumerate(source.remesh.guides):
        require_file(guide.file, "guide", path, f"remesh.guides.{number}.file")
    asymptotic = source.remesh.directions == "asymptotic"
    if kind == "asymptotic" and not asymptotic:
        raise ProjectError(
            "Lamellas stand along asymptotic directions only",
            where=f"{path}, remesh.directions",
            value=repr(source.remesh.directions),
            limit="asymptotic",
            advice="net.kind = 'planar' with [panels] for a net of flat panels",
        )
    if kind == "planar" and asymptotic:
        raise ProjectError(
            "Flat panels stand along conjugate directions only",
            where=f"{path}, remesh.directions",
            value="'asymptotic'",
            limit="principal, conjugate",
            advice="'principal': at right angles support plates are flat",
        )


def _known_ending(name: str, section: str, known: tuple[str, ...], path: Path) -> str:
    """The ending of a file, in small letters; raises ProjectError for an unknown one."""
    suffix = Path(name).suffix.lower()
    if suffix not in known:
        raise ProjectError(
            f"The {section} file has an ending that is not known",
            where=f"{path}, {section}.file",
            value=repr(suffix),
            limit=", ".join(known),
        )
    return suffix


def _missing_unit(section: str, why: str, path: Path) -> ProjectError:
    return ProjectError(
        "A key is missing",
        where=f"{path}, {section}.unit",
        advice=f"add {section}.unit: {why}",
    )


def require_file(name: str, kind: str, path: Path, key: str) -> None:
    """Refuse a file that is not beside the project file *path*; raises ProjectError."""
    file = path.parent / name
    if not file.is_file():
        raise ProjectError(
            f"The {kind} file is not there",
            where=f"{path}, {key}",
            value=str(file),
            advice="a path from the folder of the project file",
        )


def _require_consistent(section: RemeshSection, path: Path) -> None:
    """Refuse settings that these directions do not have, and a size that is given twice."""
    if section.directions == "conjugate":
        if section.angle is None:
            raise ProjectError(
                "A key is missing",
                where=f"{path}, remesh.angle",
                advice="add remesh.angle, degrees; 90 gives the principal directions",
            )
    else:
        for key in ("angle", "hand", "infeasible"):
            if getattr(section, key) is not None:
                raise ProjectError(
                    "Only conjugate directions have this setting",
                    where=f"{path}, remesh.{key}",
                    value=f"{getattr(section, key)!r} with {section.directions!r}",
                    advice="leave it out",
                )
    if section.directions == "asymptotic" and section.guides:
        raise ProjectError(
            "Guide lines lead principal and conjugate directions only",
            where=f"{path}, remesh.guides",
            value=f"{len(section.guides)} with 'asymptotic'",
            advice="leave them out: the surface gives asymptotic directions everywhere",
        )
    if section.quads is not None and section.edge is not None:
        raise ProjectError(
            "The size of the quads must be given once",
            where=f"{path}, remesh.edge",
            value="quads and edge",
            advice="leave one of them out",
        )
