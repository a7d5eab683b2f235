"""Rhino's .3dm: a layer per kind, named meshes and axes, numbers as user text. In mm."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np

from fabrication.export.interchange.missing import required
from fabrication.export.interchange.model import Item, Model

_DEGREE = 3


def write_3dm(path: Path, model: Model) -> None:
    """Write meshes on layers by kind, axes on "... axes", nodes on "nodes".

    Raises
    ------
    SettingError
        Where rhino3dm is not installed.
    OutputError
        When the file cannot be written.
    """
    rhino = required("rhino3dm", "3dm")
    from fabrication.errors import OutputError

    file = rhino.File3dm()
    file.Settings.ModelUnitSystem = rhino.UnitSystem.Millimeters
    file.ApplicationName = "gridshell"
    for layer, items in model.layers.items():
        index = _layer(rhino, file, layer, items[0].colour)
        for item in items:
            file.Objects.AddMesh(_mesh(rhino, item), _attributes(rhino, item, index))
        lines = [item for item in items if item.axis is not None]
        if lines:
            index = _layer(rhino, file, f"{layer} axes", items[0].colour)
            for item in lines:
                file.Objects.AddCurve(_curve(rhino, item), _attributes(rhino, item, index))
    if model.nodes:
        index = _layer(rhino, file, "nodes", (0.1, 0.1, 0.1))
        for name, place in model.nodes:
            attributes = rhino.ObjectAttributes()
            attributes.Name, attributes.LayerIndex = name, index
            file.Objects.AddPoint(rhino.Point3d(*place.tolist()), attributes)
    if not file.Write(str(path), 7):
        raise OutputError("The .3dm file cannot be written", where=str(path))


def _layer(rhino: Any, file: Any, name: str, colour: tuple[float, float, float]) -> int:
    layer = rhino.Layer()
    layer.Name = name
    layer.Color = (*(round(255 * c) for c in colour), 255)
    return int(file.Layers.Add(layer))


def _attributes(rhino: Any, item: Item, layer: int) -> Any:
    attributes = rhino.ObjectAttributes()
    attributes.Name, attributes.LayerIndex = item.name, layer
    segment = {"segment": item.segment} if item.segment else {}
    for key, value in {"mark": item.mark, **segment, **item.numbers}.items():
        attributes.SetUserString(key, f"{value}")
    return attributes


def _mesh(rhino: Any, item: Item) -> Any:
    mesh = rhino.Mesh()
    for x, y, z in item.points.tolist():
        mesh.Vertices.Add(x, y, z)
    for a, b, c in item.triangles.tolist():
        mesh.Faces.AddFace(a, b, c)
    mesh.Normals.ComputeNormals()
    return mesh


def _curve(rhino: Any, item: Item) -> Any:
    """A cubic spline through the axis' points, its parameter the length along them."""
    from scipy.interpolate import make_interp_spline

    if item.axis is None:
        raise AssertionError("only strips have axes")
    u = np.r_[0.0, np.cumsum(np.linalg.norm(np.diff(item.axis, axis=0), axis=1))]
    spline = make_interp_spline(u, item.axis, k=_DEGREE)
    curve = rhino.NurbsCurve(3, False, _DEGREE + 1, len(spline.c))
    for i, (x, y, z) in enumerate(spline.c.tolist()):
        curve.Points[i] = rhino.Point4d(x, y, z, 1.0)
    for i, knot in enumerate(spline.t[1:-1].tolist()):  # Rhino leaves out the outermost two
        curve.Knots[i] = knot
    return curve
