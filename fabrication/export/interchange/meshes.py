"""GLB, PLY and OBJ through trimesh: what viewers and renderers open.

GLB is in metres, y upwards, a node per part, named by its mark; PLY and OBJ are in mm.
"""

from __future__ import annotations

from pathlib import Path

import numpy as np

from fabrication.export.gltf_space import linear, upright
from fabrication.export.interchange.model import Item, Model


def write_glb(path: Path, model: Model) -> None:
    """Write every part as a node of its own, under one node per layer."""
    import trimesh

    scene = trimesh.Scene()
    for layer, items in model.layers.items():
        scene.graph.update(frame_to=layer, frame_from=scene.graph.base_frame)
        for item in items:
            mesh = trimesh.Trimesh(upright(item.points), item.triangles, process=False)
            mesh.visual = trimesh.visual.TextureVisuals(material=_material(item))
            mesh.metadata.update({"mark": item.mark, **item.numbers})
            scene.add_geometry(mesh, item.name, geom_name=item.name, parent_node_name=layer)
    path.write_bytes(scene.export(file_type="glb"))


def write_ply(path: Path, model: Model) -> None:
    """Write all parts as one coloured mesh."""
    import trimesh

    path.write_bytes(trimesh.util.concatenate(_coloured(model)).export(file_type="ply"))


def write_obj_groups(path: Path, model: Model) -> None:
    """Write an object per part, named by its mark, in groups by layer."""
    lines, first = ["# unit: mm"], 1
    for layer, items in model.layers.items():
        for item in items:
            lines += [f"o {item.name.replace(' ', '_')}", f"g {layer.replace(' ', '_')}"]
            lines += [f"v {x:.5f} {y:.5f} {z:.5f}" for x, y, z in item.points.tolist()]
            lines += [f"f {a} {b} {c}" for a, b, c in (item.triangles + first).tolist()]
            first += len(item.points)
    path.write_text("\n".join(lines) + "\n", encoding="utf-8")


def _coloured(model: Model) -> list[object]:
    import trimesh

    made = []
    for item in model.items:
        mesh = trimesh.Trimesh(item.points, item.triangles, process=False)
        colour = [*(round(255 * c) for c in item.colour), 255]
        mesh.visual.vertex_colors = np.tile(colour, (len(item.points), 1))
        made.append(mesh)
    return made


def _material(item: Item) -> object:
    import trimesh

    return trimesh.visual.material.PBRMaterial(
        name=item.layer,
        baseColorFactor=[*(round(255 * c) for c in linear(item.colour)), 255],
        metallicFactor=0.0,
        roughnessFactor=0.8,
        doubleSided=False,
    )
