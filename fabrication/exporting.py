"""Files for other programs: from the formats of a project to the files in ``export/``."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from pathlib import Path

from fabrication.export.interchange.ifc import write_ifc
from fabrication.export.interchange.meshes import write_glb, write_obj_groups, write_ply
from fabrication.export.interchange.missing import required
from fabrication.export.interchange.model import Model
from fabrication.export.interchange.rhino import write_3dm

FORMATS: dict[str, Callable[[Path, Model], None]] = {
    "glb": write_glb,
    "ply": write_ply,
    "obj": write_obj_groups,
    "3dm": write_3dm,
    "ifc": write_ifc,
}
_LIBRARIES = {"3dm": "rhino3dm", "ifc": "ifcopenshell"}


def require_formats(formats: Sequence[str]) -> None:
    """Refuse formats whose libraries are missing, before anything is made.

    Raises
    ------
    SettingError
        Naming the format and how to install what it needs.
    """
    for form in formats:
        if form in _LIBRARIES:
            required(_LIBRARIES[form], form)


def write_exports(folder: Path, formats: Sequence[str], model: Model) -> None:
    """Write ``structure.glb`` and so on into *folder*.

    Raises
    ------
    SettingError
        For a format whose library is missing.
    OutputError
        When a file cannot be written.
    """
    folder.mkdir(parents=True, exist_ok=True)
    for form in dict.fromkeys(formats):
        FORMATS[form](folder / f"structure.{form}", model)
