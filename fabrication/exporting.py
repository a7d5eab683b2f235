"""Files for other programs: from the formats of a project to the files in ``export/``."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from pathlib import Path

from fabrication.export.interchange.ifc import write_ifc
from fabrication.export.interchange.meshes import write_glb, write_obj_groups, write_ply
from fabrication.export.interchange.missing import required
from fabrication.export.interchange.model import Model
from fabrication.export.interchange.rhino import write_3dm
from fabrication.export_sections import ExportSection

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


def write_exports(draft: Path, section: ExportSection | None, model: Callable[[], Model]) -> None:
    """Write ``export/structure.glb`` and so on, where the project asks for any.

    Parameters
    ----------
    draft : the package's folder.
    model : makes what is written; not called where nothing is.

    Raises
    ------
    SettingError
        For a format whose library is missing.
    OutputError
        When a file cannot be written.
    """
    if section is None:
        return
    folder = draft / "export"
    folder.mkdir(parents=True, exist_ok=True)
    made = model()
    for form in dict.fromkeys(section.formats):
        FORMATS[form](folder / f"structure.{form}", made)
