"""``.net.json``: the one file handed downstream, versioned.

It holds the control mesh and everything needed to make the same diagonal meshes again, with the
same vertex numbers, so that marks given from them stay stable.
"""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import numpy as np

from gridshell.arrays import Indices
from gridshell.errors import FileError
from gridshell.io.text import write_text
from gridshell.mesh import ControlMesh, QuadMesh

FORMAT = "gridshell-net"
VERSION = 1


def write_net(path: Path | str, control: ControlMesh) -> None:
    """Write *control* in mm and full double precision.

    Raises
    ------
    FileError
        When the file cannot be written.
    """
    document = {
        "format": FORMAT,
        "version": VERSION,
        "unit": "mm",
        "vertices": control.vertices.tolist(),
        "quads": control.quads.tolist(),
        "colour": control.colour.tolist(),
    }
    write_text(path, json.dumps(document, separators=(",", ":")) + "\n")


def read_net(path: Path | str) -> ControlMesh:
    """Read a control mesh back, vertex for vertex.

    Raises
    ------
    FileError
        When the file is missing, is not a net, or has a version this program does not know.
    MeshError
        When its quads do not form a surface.
    """
    document = _load(Path(path))
    try:
        vertices = np.array(document["vertices"], dtype=np.float64)
        quads = np.array(document["quads"], dtype=np.int64)
        colour = np.array(document["colour"], dtype=np.int64)
    except (KeyError, ValueError, TypeError, OverflowError) as error:
        raise FileError("The net is incomplete", where=str(path), value=repr(error)) from None
    mesh = QuadMesh(vertices, quads)
    if colour.shape != (len(vertices),):
        raise FileError(
            "Each vertex needs a colour", where=f"{path}, colour", value=f"{colour.shape}"
        )
    if not _alternates(mesh, colour):
        raise FileError(
            "The colours must alternate along every edge",
            where=f"{path}, colour",
            limit="0 and 1, and -1 for a vertex without quads",
        )
    return ControlMesh(mesh, colour)


def _alternates(mesh: QuadMesh, colour: Indices) -> bool:
    a, b = colour[mesh.edges.T]
    used = mesh.valence > 0
    return bool((a + b == 1).all() and np.isin(colour[used], (0, 1)).all())


def _load(path: Path) -> dict[str, Any]:
    try:
        document = json.loads(path.read_text(encoding="utf-8"))
    except OSError as error:
        raise FileError(
            "The net cannot be read", where=str(path), value=error.strerror or ""
        ) from None
    except ValueError as error:
        raise FileError("The net is not JSON", where=str(path), value=str(error)) from None
    if not isinstance(document, dict) or document.get("format") != FORMAT:
        raise FileError(f"The file is not a {FORMAT}", where=str(path))
    if document.get("version") != VERSION:
        raise FileError(
            "The net has another version",
            where=str(path),
            value=str(document.get("version")),
            limit=str(VERSION),
        )
    if document.get("unit") != "mm":
        raise FileError(
            "A net is in mm", where=f"{path}, unit", value=repr(document.get("unit")), limit="'mm'"
        )
    return document
