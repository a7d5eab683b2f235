"""A motion as one animated GLB: the strips of a family are a mesh, every position a morph target.

Metres, y upwards, as the format asks for. A viewer that plays animations opens the umbrella.
"""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np

from fabrication.colours import FAMILY_COLOURS
from fabrication.export.gltf_space import linear, upright
from fabrication.motion import Motion
from gridshell.arrays import Floats, Indices

SECONDS = 8.0
"""Of the animation, from closed to opened."""

_FLOAT, _WHOLE = 5126, 5125
_ARRAY, _ELEMENTS = 34962, 34963


def write_motion_glb(path: Path | str, found: Motion) -> None:
    """Write the strips in their first position, all others as morph targets, and the animation.

    The nodes are called "family A" and "family B".
    """
    import pygltflib as gltf

    file = _File()
    frames = np.stack([step.strips for step in found.steps])
    times = file.floats(np.linspace(0.0, SECONDS, len(frames))[:, None], bounds=True)
    weights = file.floats(np.eye(len(frames))[:, 1:].reshape(-1, 1)) if len(frames) > 1 else None
    meshes: list[Any] = []
    materials: list[Any] = []
    channels: list[Any] = []
    for family, chosen in ((1, slice(None, found.first)), (2, slice(found.first, None))):
        strips = frames[:, chosen]
        points = upright(strips.reshape(len(frames), -1, 3))
        faces = strip_triangles(strips.shape[1], strips.shape[2])
        targets = [{"POSITION": file.floats(p - points[0], bounds=True)} for p in points[1:]]
        primitive = gltf.Primitive(
            attributes=gltf.Attributes(POSITION=file.floats(points[0], bounds=True)),
            indices=file.whole(faces.reshape(-1, 1)),
            material=len(materials),
            targets=targets,
        )
        meshes.append(gltf.Mesh(primitives=[primitive], weights=[0.0] * len(targets)))
        materials.append(
            gltf.Material(
                name=f"family {'AB'[family - 1]}",
                doubleSided=True,
                pbrMetallicRoughness=gltf.PbrMetallicRoughness(
                    baseColorFactor=[*linear(FAMILY_COLOURS[family]), 1.0],
                    metallicFactor=0.0,
                    roughnessFactor=0.8,
                ),
            )
        )
        target = gltf.AnimationChannelTarget(node=family - 1, path="weights")
        channels.append(gltf.AnimationChannel(sampler=0, target=target))
    animations = []
    if weights is not None:
        sampler = gltf.AnimationSampler(input=times, output=weights, interpolation="LINEAR")
        animations = [gltf.Animation(name="opening", samplers=[sampler], channels=channels)]
    made = gltf.GLTF2(
        asset=gltf.Asset(version="2.0", generator="gridshell"),
        scene=0,
        scenes=[gltf.Scene(nodes=[0, 1])],
        nodes=[gltf.Node(mesh=k, name=f"family {'AB'[k]}") for k in (0, 1)],
        meshes=meshes,
        materials=materials,
        animations=animations,
        accessors=file.accessors,
        bufferViews=file.views,
        buffers=[gltf.Buffer(byteLength=len(file.data))],
    )
    made.set_binary_blob(bytes(file.data))
    Path(path).write_bytes(b"".join(made.save_to_bytes()))


def strip_triangles(strips: int, places: int) -> Indices:
    """(m, 3) triangles of strips of quads, points counted as strip, place, edge."""
    k, i = (a.ravel() for a in np.meshgrid(np.arange(strips), np.arange(places - 1), indexing="ij"))
    a = (k * places + i) * 2
    return np.concatenate(
        [np.stack([a, a + 2, a + 3], axis=1), np.stack([a, a + 3, a + 1], axis=1)]
    )


class _File:
    """The binary part of a GLB and what says where in it everything lies."""

    def __init__(self) -> None:
        self.data = bytearray()
        self.views: list[Any] = []
        self.accessors: list[Any] = []

    def floats(self, rows: Floats, *, bounds: bool = False) -> int:
        """Add (n, 1) or (n, 3) numbers; the number of their accessor."""
        values = np.ascontiguousarray(rows, dtype="<f4")
        limits = {}
        if bounds:
            limits = {"min": values.min(axis=0).tolist(), "max": values.max(axis=0).tolist()}
        kind = "SCALAR" if values.shape[1] == 1 else "VEC3"
        return self._add(values, _FLOAT, kind, _ARRAY if kind == "VEC3" else None, limits)

    def whole(self, rows: Indices) -> int:
        """Add (n, 1) point numbers; the number of their accessor."""
        return self._add(np.ascontiguousarray(rows, dtype="<u4"), _WHOLE, "SCALAR", _ELEMENTS, {})

    def _add(
        self,
        values: np.ndarray,
        component: int,
        kind: str,
        target: int | None,
        limits: dict[str, list[float]],
    ) -> int:
        import pygltflib as gltf

        start = len(self.data)
        self.data += values.tobytes()
        view = gltf.BufferView(buffer=0, byteOffset=start, byteLength=values.nbytes, target=target)
        self.views.append(view)
        accessor = gltf.Accessor(
            bufferView=len(self.views) - 1,
            componentType=component,
            count=len(values),
            type=kind,
            **limits,
        )
        self.accessors.append(accessor)
        return len(self.accessors) - 1
