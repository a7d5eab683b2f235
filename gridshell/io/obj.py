"""Wavefront OBJ with quads, in a unit that is always stated."""

from __future__ import annotations

from enum import Enum
from pathlib import Path

import numpy as np

from gridshell.arrays import Indices, Points
from gridshell.errors import FileError
from gridshell.io.text import write_text
from gridshell.mesh import QuadMesh, oriented


class Unit(Enum):
    """A unit of length; the value is its size in mm."""

    MM = 1.0
    CM = 10.0
    M = 1000.0
    INCH = 25.4
    FOOT = 304.8

    @classmethod
    def named(cls, name: str) -> Unit:
        """The unit called mm, cm, m, inch or foot.

        Raises
        ------
        FileError
            For any other name.
        """
        try:
            return cls[name.upper()]
        except KeyError:
            names = ", ".join(unit.name.lower() for unit in cls)
            raise FileError("Unknown unit", where="unit", value=repr(name), limit=names) from None


def read_obj(path: Path | str, *, unit: Unit) -> QuadMesh:
    """Read a quad mesh and turn its faces to one orientation.

    Parameters
    ----------
    path : an OBJ file; only ``v`` and ``f`` lines are read.
    unit : the file's unit; the mesh comes back in mm.

    Raises
    ------
    FileError
        When the file is missing, a line cannot be read or a face is not a quad.
    MeshError, NonManifoldError, OrientationError
        When the quads do not form an orientable surface.
    """
    path = Path(path)
    try:
        text = path.read_text(encoding="utf-8-sig", errors="replace")
    except OSError as error:
        raise FileError(
            "The mesh file cannot be read",
            where=str(path),
            value=error.strerror or type(error).__name__,
            advice="check the path; it is relative to the project file",
        ) from None
    vertices, quads = _parse(path, text.replace("\\\n", " ").splitlines())
    return oriented(vertices * unit.value, quads)


def write_obj(path: Path | str, mesh: QuadMesh, *, unit: Unit) -> None:
    """Write vertices and quads in full double precision.

    Raises
    ------
    FileError
        When the file cannot be written.
    """
    rows = [f"# unit: {unit.name.lower()}"]
    rows += ["v {!r} {!r} {!r}".format(*row) for row in (mesh.vertices / unit.value).tolist()]
    rows += ["f {} {} {} {}".format(*row) for row in (mesh.quads + 1).tolist()]
    write_text(path, "\n".join(rows) + "\n")


def _parse(path: Path, lines: list[str]) -> tuple[Points, Indices]:
    vertices: list[list[float]] = []
    quads: list[list[int]] = []
    for number, line in enumerate(lines, start=1):
        fields = line.partition("#")[0].split()
        try:
            if fields[:1] == ["v"]:
                x, y, z = (float(field) for field in fields[1:4])
                vertices.append([x, y, z])
            elif fields[:1] == ["f"]:
                quads.append([_index(field, len(vertices)) for field in fields[1:]])
        except ValueError:
            raise FileError(
                "A line cannot be read", where=f"{path}, line {number}", value=repr(line[:60])
            ) from None
        if fields[:1] == ["f"] and len(quads[-1]) != 4:
            raise FileError(
                "A face is not a quad",
                where=f"{path}, line {number}, face {len(quads) - 1}",
                value=f"{len(quads[-1])} corners",
                limit="4 corners",
                advice="export the mesh as quads",
            )
    for number, quad in enumerate(quads):
        for index in quad:
            if not 0 <= index < len(vertices):
                raise FileError(
                    "A face names a vertex that does not exist",
                    where=f"{path}, face {number}",
                    value=f"vertex {index + 1}"
                    if index >= 0
                    else "an index before the first vertex",
                    limit=f"1 .. {len(vertices)}",
                )
    if not quads:
        raise FileError("The file holds no faces", where=str(path), advice="export a quad mesh")
    return np.array(vertices, dtype=np.float64).reshape(-1, 3), np.array(quads, dtype=np.int64)


def _index(field: str, count: int) -> int:
    """Zero-based index of a corner; negative ones count back from the last vertex read."""
    index = int(field.split("/")[0])
    if index < 0:
        return count + index if count + index >= 0 else -1
    return index - 1
