"""The one door for quad meshes drawn elsewhere: OBJ, Rhino's .3dm, JSON of COMPAS."""

from __future__ import annotations

from pathlib import Path

from gridshell.errors import FileError
from gridshell.io.compas_file import read_compas
from gridshell.io.obj import Unit, read_obj
from gridshell.io.rhino_file import read_rhino
from gridshell.io.units import required_unit
from gridshell.mesh import QuadMesh

MESH_FILES = (".obj", ".3dm", ".json")
"""Endings of the mesh files that can be read."""


def read_mesh(path: Path | str, *, unit: Unit | None = None) -> QuadMesh:
    """Read a quad mesh, mm, and turn its faces to one orientation.

    Parameters
    ----------
    path : the ending tells the kind: OBJ, .3dm (Rhino) or .json (COMPAS).
    unit : a .3dm file states its own, which may be repeated, not changed; others need one.

    Raises
    ------
    FileError
        For another ending, and as :func:`read_obj`, :func:`read_rhino` and :func:`read_compas` do.
    UnitError
        When a unit is needed and missing, or contradicts the file.
    MeshError, NonManifoldError, OrientationError
        When the quads do not form an orientable surface.
    """
    path = Path(path)
    suffix = path.suffix.lower()
    if suffix not in MESH_FILES:
        raise FileError(
            "The mesh file has an ending that is not known",
            where=str(path),
            value=repr(suffix),
            limit=", ".join(MESH_FILES),
        )
    if suffix == ".3dm":
        return read_rhino(path, unit=unit)
    unit = required_unit(path, unit, "The mesh file")
    return read_obj(path, unit=unit) if suffix == ".obj" else read_compas(path, unit=unit)
