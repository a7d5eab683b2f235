"""Quad meshes from Rhino's .3dm files, in the unit the file states."""

from __future__ import annotations

from collections import Counter
from pathlib import Path
from typing import Any

import numpy as np

from gridshell.arrays import Indices, Points
from gridshell.errors import FileError
from gridshell.io.library import required
from gridshell.io.obj import Unit
from gridshell.io.units import require_same_unit, required_unit
from gridshell.mesh import QuadMesh, oriented

_UNSTATED = ("None", "Unset", "CustomUnits")
"""Names of Rhino's unit systems that have no size."""


def read_rhino(path: Path | str, *, unit: Unit | None = None) -> QuadMesh:
    """Read the one quad mesh of a .3dm file, mm, and turn its faces to one orientation.

    Rhino keeps a corner of its meshes several times where normals differ or a seam runs. Corners in
    exactly the same place are one vertex here, as they are one of Rhino's topology vertices;
    corners that are only near each other stay apart.

    Parameters
    ----------
    path : of a file with one mesh among whatever else.
    unit : the file's own may be repeated, not changed; a file without one needs it.

    Raises
    ------
    SettingError
        Where rhino3dm is not installed.
    FileError
        When the file is missing or no .3dm file, holds no mesh or several, or a face is no quad.
    UnitError
        When *unit* contradicts the file's own, or neither is there.
    MeshError, NonManifoldError, OrientationError
        When the quads do not form an orientable surface.
    """
    path = Path(path)
    rhino = required("rhino3dm", needs="A .3dm file", where=str(path), value=path.name)
    if not path.is_file():
        raise FileError("The mesh file is missing", where=str(path), advice="check the path")
    file = rhino.File3dm.Read(str(path))
    if file is None:
        raise FileError("The file is no .3dm file of Rhino", where=str(path))
    scale = _scale(rhino, file, path, unit)
    name, mesh = _only_mesh(rhino, file, path)
    corners = np.array([(p.X, p.Y, p.Z) for p in mesh.Vertices.ToPoint3dArray()]).reshape(-1, 3)
    faces = np.array([mesh.Faces[i] for i in range(len(mesh.Faces))], dtype=np.int64)
    _require_quads(faces.reshape(-1, 4), f"{path}, {name}")
    vertices, quads = _welded(corners, faces)
    return oriented(vertices * scale, quads)


def _scale(rhino: Any, file: Any, path: Path, unit: Unit | None) -> float:
    """Size of the file's unit, mm."""
    stated = file.Settings.ModelUnitSystem
    if stated.name in _UNSTATED:
        return required_unit(path, unit, "The .3dm file").value
    size = float(rhino.UnitSystem.UnitScale(stated, rhino.UnitSystem.Millimeters))
    require_same_unit(path, unit, [size])
    return size


def _only_mesh(rhino: Any, file: Any, path: Path) -> tuple[str, Any]:
    """The mesh of the file and what it is called; parts of blocks do not count."""
    here = [one for one in file.Objects if not one.Attributes.IsInstanceDefinitionObject]
    layers = [layer.Name for layer in file.Layers]
    named = [
        (_called(one.Attributes, layers, number), one.Geometry)
        for number, one in enumerate(here)
        if isinstance(one.Geometry, rhino.Mesh)
    ]
    if not named:
        kinds = Counter(str(one.Geometry.ObjectType).rpartition(".")[2] for one in here)
        raise FileError(
            "The .3dm file holds no mesh",
            where=str(path),
            value=", ".join(f"{n} {kind}" for kind, n in kinds.items()) or "no objects",
            limit="one quad mesh",
            advice="in Rhino make one of the surface (QuadRemesh) and export it alone",
        )
    if len(named) > 1:
        shown = ", ".join(name for name, _ in named[:5]) + (", ..." if len(named) > 5 else "")
        raise FileError(
            "The .3dm file holds several meshes",
            where=str(path),
            value=f"{len(named)}: {shown}",
            limit="one quad mesh",
            advice="export the one alone, or join them and align their vertices",
        )
    return named[0]


def _called(attributes: Any, layers: list[str], number: int) -> str:
    """Name of an object, or its number where it has none, and its layer."""
    name = f"mesh {attributes.Name!r}" if attributes.Name else f"object {number}"
    index = attributes.LayerIndex
    return f"{name} on layer {layers[index]!r}" if 0 <= index < len(layers) else name


def _require_quads(faces: Indices, where: str) -> None:
    """Refuse a mesh without faces, and triangles, which Rhino writes with their last corner twice.

    Parameters
    ----------
    faces : (f, 4).
    """
    if not len(faces):
        raise FileError("The mesh has no faces", where=where, advice="export a quad mesh")
    triangles = np.flatnonzero(faces[:, 2] == faces[:, 3])
    if len(triangles):
        raise FileError(
            "A face is not a quad",
            where=f"{where}, face {int(triangles[0])}",
            value=f"3 corners; {len(triangles)} of {len(faces)} faces are triangles",
            limit="4 corners",
            advice="export the mesh as quads: in Rhino, QuadRemesh",
        )


def _welded(corners: Points, faces: Indices) -> tuple[Points, Indices]:
    """Vertices and quads with corners in exactly the same place made one; the first one stays."""
    places = corners + 0.0  # no negative noughts
    _, first, number = np.unique(places, axis=0, return_index=True, return_inverse=True)
    kept = np.sort(first)
    return corners[kept], np.searchsorted(kept, first[number.ravel()])[faces]
