"""Connectors in 3D: each kind one plotly mesh that the page itself puts together.

The page gets every shape once, as points and triangles, and of every body the number of its shape
and its frame; nine numbers a body keep thousands of bolts small.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
import plotly.graph_objects as go

from fabrication.colours import css
from fabrication.export.shell import LIGHT
from fabrication.export.view_meshes import shape_mesh
from fabrication.shapes import Prisms
from gridshell.arrays import Floats, Indices, Points

_FINE = {"facenormalsepsilon": 0.0, "vertexnormalsepsilon": 0.0}
"""Faces of a square millimetre count, too, in a view in metres."""

_MANY = 60_000
"""Triangles above which a page hides all connectors until they are asked for."""


def connector_traces(connectors: Sequence[Prisms], centre: Floats) -> list[Any]:
    """One mesh per kind that has bodies; *centre* (3,) is where the view's origin lies, mm."""
    used = [prisms for prisms in connectors if prisms.bodies]
    meshes = [[shape_mesh(shape) for shape in prisms.shapes] for prisms in used]
    count = sum(
        len(made[body.shape][1])
        for prisms, made in zip(used, meshes, strict=True)
        for body in prisms.bodies
    )
    visible = True if count <= _MANY else "legendonly"
    return [
        go.Mesh3d(
            name=prisms.name.capitalize(),
            showlegend=True,
            color=css(prisms.colour),
            flatshading=True,
            lighting=LIGHT | _FINE,
            hoverinfo="text",
            visible=visible,
            meta=_instances(prisms, made, centre),
        )
        for prisms, made in zip(used, meshes, strict=True)
    ]


def _instances(
    prisms: Prisms, meshes: Sequence[tuple[Points, Indices]], centre: Floats
) -> dict[str, Any]:
    """Shapes in metres, and frames: origin in metres, x and y."""
    frames = [
        np.concatenate([(body.frame.origin - centre) / 1e3, body.frame.x, body.frame.y])
        for body in prisms.bodies
    ]
    return {
        "shapes": [
            {"points": np.round(points / 1e3, 5).ravel().tolist(), "faces": faces.ravel().tolist()}
            for points, faces in meshes
        ],
        "bodies": [body.shape for body in prisms.bodies],
        "frames": np.round(frames, 5).ravel().tolist(),
        "marks": [body.mark for body in prisms.bodies],
    }
