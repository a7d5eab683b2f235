"""Files for other programs: from the formats of a project to the files in ``export/``."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from pathlib import Path

from fabrication.export.btlx.files import write_btlx
from fabrication.export.cut_sets import CutSet
from fabrication.export.interchange.ifc import write_ifc
from fabrication.export.interchange.meshes import write_glb, write_obj_groups, write_ply
from fabrication.export.interchange.missing import required
from fabrication.export.interchange.model import Model
from fabrication.export.interchange.rhino import write_3dm
from fabrication.export.nc1.files import write_nc1
from fabrication.export_sections import ExportSection

FORMATS: dict[str, Callable[[Path, Model], None]] = {
    "glb": write_glb,
    "ply": write_ply,
    "obj": write_obj_groups,
    "3dm": write_3dm,
    "ifc": write_ifc,
}
"""Of everything that is built, where it stands."""

FILES = (
    *(f"export/structure.{form}" for form in FORMATS),
    *("export/structure.btlx", "export/nc1/*.nc1", "export/nc1/index.csv"),
)
"""Patterns of all files that may come."""

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


def write_exports(
    draft: Path,
    section: ExportSection | None,
    name: str,
    model: Callable[[], Model],
    cut: Callable[[], Sequence[CutSet]],
) -> None:
    """Write ``export/structure.glb``, ``export/nc1/A1.nc1`` and so on, where there are to be any.

    Parameters
    ----------
    draft : the package's folder.
    name : of the project.
    model, cut : make what is written: bodies in their places, flat parts. Not called where nothing
        of the kind is.

    Raises
    ------
    SettingError
        For a format whose library is missing, or that cannot hold what is built.
    OutputError
        When a file cannot be written.
    """
    if section is None:
        return
    folder = draft / "export"
    folder.mkdir(parents=True, exist_ok=True)
    formats = dict.fromkeys(section.formats)
    placed = [form for form in formats if form in FORMATS]
    if placed:
        made = model()
        for form in placed:
            FORMATS[form](folder / f"structure.{form}", made)
    if len(placed) < len(formats):
        sets = cut()
        if "nc1" in formats:
            write_nc1(folder / "nc1", name, sets)
        if "btlx" in formats:
            write_btlx(folder / "structure.btlx", name, sets)
