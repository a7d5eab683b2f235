"""What is built as plain data that every format can hold."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field, replace

import numpy as np

from fabrication.colours import FAMILY_COLOURS
from fabrication.export.interchange.strip_mesh import strip_mesh
from fabrication.export.view_meshes import shape_mesh
from fabrication.jointed import Jointed
from fabrication.outlines import Frame
from fabrication.parts import FlatPart
from fabrication.shapes import Bodies, Colour, joined
from gridshell.arrays import Indices, Points

Value = str | float | int


@dataclass(frozen=True, eq=False)
class Item:
    """One part.

    Parameters
    ----------
    mark : its name.
    layer : what it belongs to: "family A", "bolts", "panels".
    colour : sRGB, 0 to 1.
    points, triangles : (n, 3) mm and (m, 3), closed, facing outwards.
    axis : (k, 3) mm, of strips; None for other parts.
    numbers : what lists say of it, by name: "length_mm", ...
    """

    mark: str
    layer: str
    colour: Colour
    points: Points
    triangles: Indices
    axis: Points | None = None
    numbers: dict[str, Value] = field(default_factory=dict)


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
        """The same at every one of *poses*; names begin with "segment-1" and so on."""
        items = tuple(
            replace(
                item,
                mark=f"segment-{number} {item.mark}",
                points=pose.place(item.points),
                axis=None if item.axis is None else pose.place(item.axis),
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
    items += _body_items(joined(*jointed.connectors))
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
            yield Item(body.mark, kind.name, kind.colour, body.frame.place(points), triangles)
