"""Design surfaces from mesh files, in a unit that is always stated."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np

from gridshell.arrays import Indices, Points
from gridshell.errors import FileError
from gridshell.io.obj import Unit
from gridshell.surface import TriangulatedSurface

_UNREADABLE = (
    ValueError,
    TypeError,
    AttributeError,
    IndexError,
    KeyError,
    OSError,
    NotImplementedError,
)
"""What trimesh raises for files it cannot make sense of."""


def read_surface(path: Path | str, *, unit: Unit) -> TriangulatedSurface:
    """Read a mesh (OBJ, PLY, STL, GLB) as a surface; faces of more corners are cut to triangles.

    Parameters
    ----------
    unit : the file's unit; the surface comes back in mm.

    Raises
    ------
    FileError
        When the file is missing or cannot be read.
    SurfaceError
        When its triangles do not make a surface.
    """
    return TriangulatedSurface(*read_triangles(path, unit=unit))


def read_triangles(path: Path | str, *, unit: Unit) -> tuple[Points, Indices]:
    """Vertices (n, 3) in mm and triangles (f, 3) of a mesh file, as they are.

    Raises
    ------
    FileError
        When the file is missing or cannot be read.
    """
    import trimesh

    if not Path(path).is_file():
        raise FileError("The surface file is missing", where=str(path), advice="check the path")
    try:
        loaded: Any = trimesh.load_mesh(str(path), process=False)
        vertices = np.asarray(loaded.vertices, dtype=np.float64)
        faces = np.asarray(loaded.faces, dtype=np.int64)
    except _UNREADABLE as error:
        raise FileError(
            "The surface file cannot be read",
            where=str(path),
            value=str(error) or type(error).__name__,
            limit="OBJ, PLY, STL or GLB with faces",
        ) from None
    if len(faces) == 0:
        raise FileError("The surface file cannot be read", where=str(path), value="no faces")
    used, compact = np.unique(faces, return_inverse=True)
    return vertices[used] * unit.value, compact.reshape(-1, 3).astype(np.int64)
