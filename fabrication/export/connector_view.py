"""Connectors in 3D: each kind one plotly mesh that the page itself puts together.

The page gets every shape once, as points and triangles, and of every body the number of its shape
and its frame; nine numbers a body keep thousands of bolts small.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
import plotly.graph_objects as go
from manifold3d import triangulate

from fabrication.colours import css
from fabrication.export.shell import LIGHT
from fabrication.flattening import corners
from fabrication.shapes import Prisms, Shape
from gridshell.arrays import Floats, Indices, Points

_STEP = np.pi / 4.0
"""Largest turn of an arc between two of its points."""

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


def shape_mesh(shape: Shape) -> tuple[Points, Indices]:
    """Points (n, 3), mm, and triangles (m, 3), facing outwards, of a shape with its openings."""
    rings = [corners(shape.outline, _STEP), *(corners(o, _STEP)[::-1] for o in shape.openings)]
    flat = np.concatenate(rings)
    caps = np.asarray(triangulate(rings), dtype=np.int64).reshape(-1, 3)
    count = len(flat)
    levels = (np.full(count, shape.low), np.full(count, shape.high))
    points = np.concatenate([np.column_stack([flat, level]) for level in levels])
    first = np.cumsum([0, *(len(ring) for ring in rings[:-1])])
    here = np.arange(count)
    after = np.concatenate(
        [at + np.roll(np.arange(len(ring)), -1) for at, ring in zip(first, rings, strict=True)]
    )
    walls = [
        np.stack([here, after, after + count], axis=1),
        np.stack([here, after + count, here + count], axis=1),
    ]
    return points, np.concatenate([caps[:, ::-1], caps + count, *walls])
