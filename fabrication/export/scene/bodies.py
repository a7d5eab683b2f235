"""Connectors as layers: each kind one layer of few shapes in many places."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from fabrication.colours import css
from fabrication.export.scene.layers import About, Bodies
from fabrication.export.view_meshes import shape_mesh
from fabrication.shapes import Prisms
from gridshell.arrays import Floats

_MANY = 60_000
"""Triangles above which all connectors are hidden until they are asked for."""


def connector_layers(connectors: Sequence[Prisms], centre: Floats) -> list[Bodies]:
    """One layer per kind that has bodies; *centre* (3,) is the origin of the scene, mm."""
    used = [prisms for prisms in connectors if prisms.bodies]
    meshes = [[shape_mesh(shape) for shape in prisms.shapes] for prisms in used]
    count = sum(
        len(made[body.shape][1])
        for prisms, made in zip(used, meshes, strict=True)
        for body in prisms.bodies
    )
    return [
        Bodies(
            id=f"connectors-{prisms.name}",
            name=prisms.name.capitalize(),
            colour=css(prisms.colour),
            visible=count <= _MANY,
            shapes=[((points / 1e3).astype(np.float32), faces) for points, faces in made],
            bodies=np.array([body.shape for body in prisms.bodies]),
            frames=np.array(
                [
                    np.concatenate([(b.frame.origin - centre) / 1e3, b.frame.x, b.frame.y])
                    for b in prisms.bodies
                ]
            ),
            parts=[
                About(body.mark, (prisms.name,), pattern_key(prisms, body.shape))
                for body in prisms.bodies
            ],
        )
        for prisms, made in zip(used, meshes, strict=True)
    ]


def pattern_key(prisms: Prisms, shape: int) -> str:
    """What the flat pattern of a shape is asked for by."""
    return f"{prisms.name} {shape}"
