"""What is built as plain data that every format can hold."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field, replace

import numpy as np

from fabrication.colours import FAMILY_COLOURS
from fabrication.export.interchange.strip_mesh import strip_mesh
from fabrication.export.view_meshes import shape_mesh
from fabrication.jointed import Jointed
from fabrication.materials import Material
from fabrication.outlines import Frame
from fabrication.parts import FlatPart
from fabrication.shapes import Bodies, Colour, Shape, joined
from gridshell.arrays import Indices, Points

Value = str | float | int


@dataclass(frozen=True, eq=False)
class Item:
    """One part.

    Parameters
    ----------
    mark : what is engraved on it.
    layer : what it belongs to: "family A", "bolts", "panels".
    colour : sRGB, 0 to 1.
    points, triangles : (n, 3) mm and (m, 3), closed, facing outwards.
    axis : (k, 3) mm, of strips; None for other parts.
    numbers : what lists say of it, by name: "length_mm", ...
    segment : "segment-1", ... where the same is built several times.
    """

    mark: str
    layer: str
    colour: Colour
    points: Points
    triangles: Indices
    axis: Points | None = None
    numbers: dict[str, Value] = field(default_factory=dict)
    segment: str = ""

    @property
    def name(self) -> str:
        """Its mark, with the segment it stands in where equal ones stand in others."""
        return f"{self.segment} {self.mark}".strip()


@dataclass(frozen=True, eq=False)
class Model:
    """Everything that is built.

    Parameters
    ----------
    name : of the project.
    items : in the order of lists.
    nodes : names and places (3,) mm of the net's nodes.
    """

    name: str
    items: tuple[Item, ...]
    nodes: tuple[tuple[str, Points], ...] = ()

    @property
    def layers(self) -> dict[str, list[Item]]:
        """Items by layer, in their order."""
        found: dict[str, list[Item]] = {}
        for item in self.items:
            found.setdefault(item.layer, []).append(item)
        return found

    def repeated(self, poses: Sequence[Frame]) -> Model:
        """The same at every one of *poses*, in segments "segment-1" and so on."""
        items = tuple(
            replace(
                item,
                segment=f"segment-{number}",
                points=pose.place(item.points),
                axis=None if item.axis is None else pose.place(item.axis),
                numbers={**item.numbers, **({"quantity": 1} if "quantity" in item.numbers else {})},
            )
            for number, pose in enumerate(poses, start=1)
            for item in self.items
        )
        nodes = tuple(
            (f"segment-{number} {name}", pose.place(place))
            for number, pose in enumerate(poses, start=1)
            for name, place in self.nodes
        )
        return replace(self, items=items, nodes=nodes)


def lamella_model(
    name: str, jointed: Jointed, parts: Sequence[FlatPart], more: Bodies | None = None
) -> Model:
    """Strips with their slots and holes, connectors, and *more* bodies."""
    density = jointed.design.profile.material.density
    items = []
    for strip, part in zip(jointed.strips.lamellas, parts, strict=True):
        points, triangles = strip_mesh(strip, part)
        s = np.linspace(strip.start, strip.end, 4 * len(strip.stations) + 1)
        nought = np.zeros_like(s)
        items.append(
            Item(
                mark=strip.mark,
                layer=f"family {'AB'[strip.family - 1]}",
                colour=FAMILY_COLOURS[strip.family],
                points=points,
                triangles=triangles,
                axis=strip.place(s, nought, nought),
                numbers={
                    "length_mm": round(part.length, 3),
                    "width_mm": part.width,
                    "thickness_mm": part.thickness,
                    "slots": len(part.slots),
                    "holes": len(part.holes) + len(part.drills),
                    "mass_kg": round(part.volume * density * 1e-9, 5),
                    "material": jointed.design.profile.material.name,
                    "quantity": part.quantity,
                },
            )
        )
    items += _with_heads(list(_body_items(joined(*jointed.connectors))))
    items += () if more is None else _body_items(more)
    nodes = tuple((node.name, np.asarray(node.position)) for node in jointed.design.nodes)
    return Model(name, tuple(items), nodes)


def bodies_model(name: str, bodies: Bodies) -> Model:
    """Panels, plates and connectors of a planar net."""
    return Model(name, tuple(_body_items(bodies)))


def _body_items(bodies: Bodies) -> Iterator[Item]:
    meshes = [shape_mesh(shape, fine=True) for shape in bodies.shapes]
    for kind in bodies.kinds:
        for body in kind.bodies:
            points, triangles = meshes[body.shape]
            yield Item(
                mark=body.mark,
                layer=kind.name,
                colour=kind.colour,
                points=body.frame.place(points),
                triangles=triangles,
                numbers=_numbers(bodies.shapes[body.shape], kind.material),
            )


def _numbers(shape: Shape, material: Material | None) -> dict[str, Value]:
    """Size and mass: of round bars diameter and length, of all else the thickness."""
    high = round(shape.high - shape.low, 3)
    across = round(float(np.ptp(shape.outline[:, 0])), 3)
    is_round = len(shape.outline) == 2 and not shape.openings
    size: dict[str, Value] = (
        {"diameter_mm": across, "length_mm": high}
        if is_round and high > across
        else {"thickness_mm": high}
    )
    if material is None:
        return size
    mass = round(shape.volume * material.density * 1e-9, 5)
    return {**size, "mass_kg": mass, "material": material.name}


def _with_heads(items: Sequence[Item]) -> list[Item]:
    """Bolts in one piece with their heads; nuts stay alone."""
    heads = {item.mark: item for item in items if item.mark.endswith("-head")}
    found = []
    for item in items:
        head = heads.get(f"{item.mark.removesuffix('-bolt')}-head")
        if item.mark in heads:
            continue
        if item.mark.endswith("-bolt") and head is not None:
            points = np.concatenate([item.points, head.points])
            triangles = np.concatenate([item.triangles, head.triangles + len(item.points)])
            item = replace(item, points=points, triangles=triangles)
        found.append(replace(item, layer=item.layer.replace("heads and nuts", "nuts")))
    return found
