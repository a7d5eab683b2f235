"""Quad meshes from the JSON files of COMPAS 2, read without COMPAS.

The format is that of ``compas.data``: an object is a table of "dtype", the name of its class, and
"data"; of a mesh, "data" holds "vertex" (key: x, y, z), "face" (key: keys of its corners) and
"default_vertex_attributes" for coordinates a vertex leaves out. A file holds one object, or lists
and tables of them.
"""

from __future__ import annotations

import json
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np

from gridshell.arrays import Indices, Points
from gridshell.errors import FileError
from gridshell.io.obj import Unit
from gridshell.mesh import QuadMesh, oriented


def read_compas(path: Path | str, *, unit: Unit) -> QuadMesh:
    """Read the one mesh of a COMPAS file, and turn its faces to one orientation.

    Parameters
    ----------
    path : as ``mesh.to_json`` or ``compas.json_dump`` of COMPAS 2 write it.
    unit : COMPAS states none; the mesh comes back in mm.

    Raises
    ------
    FileError
        When the file is missing, is not JSON, holds no mesh or several, or the mesh is not whole
        or not of quads.
    MeshError, NonManifoldError, OrientationError
        When the quads do not form an orientable surface.
    """
    path = Path(path)
    vertices, quads = _arrays(_only_mesh(path, _load(path)), str(path))
    return oriented(vertices * unit.value, quads)


def _load(path: Path) -> Any:
    try:
        return json.loads(path.read_text(encoding="utf-8-sig"))
    except OSError as error:
        raise FileError(
            "The mesh file cannot be read",
            where=str(path),
            value=error.strerror or type(error).__name__,
            advice="check the path; it is relative to the project file",
        ) from None
    except (ValueError, RecursionError) as error:
        raise FileError("The mesh file is not JSON", where=str(path), value=str(error)) from None


def _meshes(content: Any) -> Iterator[dict[str, Any]]:
    """Every mesh among lists and tables, by what it holds: subclasses have names of their own."""
    if isinstance(content, list):
        for one in content:
            yield from _meshes(one)
    elif isinstance(content, dict):
        data = content.get("data")
        if "dtype" in content and isinstance(data, dict):
            if "vertex" in data and "face" in data:
                yield content
        else:
            for one in content.values():
                yield from _meshes(one)


def _only_mesh(path: Path, content: Any) -> dict[str, Any]:
    found = list(_meshes(content))
    if len(found) == 1:
        return found[0]
    if found:
        names = ", ".join(repr(one.get("name", one["dtype"])) for one in found[:5])
        raise FileError(
            "The COMPAS file holds several meshes",
            where=str(path),
            value=f"{len(found)}: {names}" + (", ..." if len(found) > 5 else ""),
            limit="one quad mesh",
            advice="write the one alone: mesh.to_json(...)",
        )
    kind = content.get("dtype") if isinstance(content, dict) else None
    raise FileError(
        "The file holds no mesh of COMPAS",
        where=str(path),
        value="no table with dtype and data" if kind is None else repr(kind),
        limit="compas.datastructures/Mesh",
        advice="mesh.to_json(...) of COMPAS 2; of a package of gridshell, its net.obj",
    )


def _arrays(mesh: dict[str, Any], where: str) -> tuple[Points, Indices]:
    """(n, 3) vertices and (f, 4) quads, both in the order of the file."""
    data = mesh["data"]
    usual = data.get("default_vertex_attributes")
    usual = usual if isinstance(usual, dict) else {}
    if not (isinstance(data["vertex"], dict) and isinstance(data["face"], dict)):
        raise FileError(
            "The vertices and the faces of a mesh are tables by key",
            where=f"{where}, data",
            value=f"{type(data['vertex']).__name__} and {type(data['face']).__name__}",
            advice="mesh.to_json(...) of COMPAS 2",
        )
    if not data["face"]:
        raise FileError("The mesh has no faces", where=where, advice="write a quad mesh")
    number = {key: i for i, key in enumerate(data["vertex"])}
    vertices = [_place(v, usual, f"{where}, vertex {key}") for key, v in data["vertex"].items()]
    quads = [_quad(face, number, f"{where}, face {key}") for key, face in data["face"].items()]
    return np.array(vertices, dtype=np.float64).reshape(-1, 3), np.array(quads, dtype=np.int64)


def _place(vertex: Any, usual: dict[str, Any], where: str) -> list[float]:
    attributes = {**usual, **vertex} if isinstance(vertex, dict) else {}
    for axis in "xyz":
        value = attributes.get(axis)
        if not isinstance(value, int | float) or isinstance(value, bool):
            raise FileError(
                "A vertex has no place",
                where=where,
                value=f"{axis} = {value!r}",
                limit="numbers x, y and z",
            )
    return [float(attributes[axis]) for axis in "xyz"]


def _quad(face: Any, number: dict[str, int], where: str) -> list[int]:
    corners = face if isinstance(face, list) else []
    if len(corners) != 4:
        raise FileError(
            "A face is not a quad",
            where=where,
            value=f"{len(corners)} corners",
            limit="4 corners",
            advice="write the mesh as quads",
        )
    for key in corners:
        if str(key) not in number:
            raise FileError(
                "A face names a vertex that does not exist", where=where, value=f"vertex {key}"
            )
    return [number[str(key)] for key in corners]
