"""Built strips with their nodes as layers: middle surfaces, marks, nodes, node axes.

Strips are drawn as their middle surfaces: the flat outline is cut into columns, and each column
laid into place by the strip's own frames. A column has one lower and one upper bound: slots are
drawn as rectangles, as deep as their rounded floors are on average, holes are left out, and a
bevelled end is half-way between its two faces.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from fabrication.colours import FAMILY_COLOURS, css
from fabrication.export.scene.layers import About, Dots, Labels, Layer, Lines, Strips
from fabrication.export.scene.packing import on_screen, runs_of_pairs
from fabrication.export.view_meshes import columns
from fabrication.jointed import Jointed
from fabrication.lamella import Lamella
from fabrication.outlines import Frame
from fabrication.parts import FlatPart
from fabrication.strength import BayStress
from fabrication.structures import Structure
from fabrication.words import fixed, plural
from gridshell.arrays import Floats, Indices

_SAMPLES_PER_BAY = range(2, 7)
_COLUMNS = 10_000
"""Samples per bay: fewest to most, and about how many columns all strips may have between slots."""

_INK, _QUIET = "#1c232d", "#5a6472"


def strip_layers(
    jointed: Jointed,
    parts: Sequence[FlatPart],
    stress: BayStress,
    centre: Floats,
    copies: Sequence[Frame] = (),
) -> list[Layer]:
    """The strips by family, their marks, the nodes and the axes through them.

    Strips are those that are built, marks and nodes those of the design.

    Parameters
    ----------
    parts : one per strip.
    stress : of all bays of the strips.
    centre : (3,) mm, the origin of the scene.
    copies : where else the shell stands; the axes of its strips are drawn there.
    """
    design, strips = jointed.design, jointed.strips
    layers: list[Layer] = []
    for family in FAMILY_COLOURS:
        meshes = [
            _strip_mesh(lamella, part, stress, index)
            for index, (lamella, part) in enumerate(zip(strips.lamellas, parts, strict=True))
            if lamella.family == family
        ]
        layers += [_family(family, meshes, centre, parts[0].width)] if meshes else []
    if copies:
        layers.append(_copies(strips, copies, centre))
    return [*layers, _marks(design, centre), _nodes(design, centre), _node_axes(design, centre)]


@dataclass(frozen=True, eq=False)
class _StripMesh:
    """The middle surface of one strip.

    Parameters
    ----------
    x : (c,) mm, where the columns lie on the flat strip.
    frames : (c, 9) in place: axis mm, tangent, direction of the width.
    columns, heights : (n,) of the points; mm from the middle of the width.
    triangles : (m, 3) point numbers.
    loop : (k,) point numbers around the outline, the first again at the end.
    bays : (m,) number of the bay each triangle lies in, or nearest to.
    """

    x: Floats
    frames: Floats
    columns: Indices
    heights: Floats
    triangles: Indices
    loop: Indices
    bays: Indices
    about: About


def _strip_mesh(lamella: Lamella, part: FlatPart, stress: BayStress, index: int) -> _StripMesh:
    """Columns between all slot walls and a few samples per bay, laid into place at once."""
    per_bay = int(np.clip(_COLUMNS // len(stress), _SAMPLES_PER_BAY[0], _SAMPLES_PER_BAY[-1]))
    x, lower, upper = columns(part, per_bay)
    first = np.arange(len(x) - 1)
    corner_column = np.stack([first, first + 1, first + 1, first], axis=1)
    corner_y = np.stack([lower, lower, upper, upper], axis=1)
    corners = np.stack([corner_column.ravel(), corner_y.ravel()], axis=1)
    flat, number = np.unique(corners, axis=0, return_inverse=True)
    quads = number.reshape(-1, 4)
    loop = np.r_[quads[:, :2].ravel(), quads[::-1, 2:].ravel(), quads[0, 0]]
    bays = stress.of_strip(index)
    middle = lamella.start + (x[:-1] + x[1:]) / 2.0
    column_bay = bays[np.searchsorted(stress.end[bays][:-1], middle)]
    frames = lamella.frames(x + lamella.start)
    return _StripMesh(
        x=x,
        frames=np.concatenate([frames.points, frames.t, frames.n], axis=1),
        columns=flat[:, 0].astype(np.int64),
        heights=np.asarray(flat[:, 1] - part.width / 2.0, dtype=np.float64),
        triangles=np.stack([quads[:, [0, 1, 2]], quads[:, [0, 2, 3]]], axis=1).reshape(-1, 3),
        loop=loop[np.r_[True, np.diff(loop) != 0]],
        bays=np.repeat(column_bay, 2),
        about=_about(lamella, part, stress, bays),
    )


def _about(lamella: Lamella, part: FlatPart, stress: BayStress, bays: Indices) -> About:
    worst = int(bays[np.argmax(stress.utilisation[bays])])
    cuts = [plural(len(part.slots), "slot")]
    if part.holes or part.drills:
        cuts.append(plural(len(part.holes) + len(part.drills), "hole"))
    return About(
        lamella.mark,
        (
            f"family {'AB'[lamella.family - 1]}",
            f"length {fixed(part.length, 1)} mm",
            ", ".join(cuts),
            f"{fixed(100.0 * stress.utilisation[worst], 0)} % used at {stress.bays[worst]}",
        ),
    )


def _family(family: int, meshes: Sequence[_StripMesh], centre: Floats, width: float) -> Strips:
    """All strips of a family as one layer."""
    counts = [len(mesh.x) for mesh in meshes]
    first_column = np.cumsum([0, *counts[:-1]])
    first = np.cumsum([0, *(len(mesh.columns) for mesh in meshes[:-1])])
    gap = sum(len(mesh.columns) for mesh in meshes)
    letter = "AB"[family - 1]
    frames = np.concatenate([mesh.frames for mesh in meshes])
    frames[:, :3] = on_screen(frames[:, :3], centre)
    return Strips(
        id=f"strips-{letter}",
        name=f"Family {letter}",
        colour=css(FAMILY_COLOURS[family]),
        edge=css(FAMILY_COLOURS[family], 0.7),
        built=False,
        x=np.concatenate([mesh.x for mesh in meshes]) / 1e3,
        frames=frames,
        counts=counts,
        columns=np.concatenate(
            [m.columns + at for m, at in zip(meshes, first_column, strict=True)]
        ),
        heights=np.concatenate([mesh.heights for mesh in meshes]) / 1e3,
        triangles=np.concatenate([m.triangles + at for m, at in zip(meshes, first, strict=True)]),
        sizes=[len(mesh.triangles) for mesh in meshes],
        parts=[mesh.about for mesh in meshes],
        loops=np.concatenate(
            [np.r_[m.loop + at, gap] for m, at in zip(meshes, first, strict=True)]
        ),
        cells=np.concatenate([mesh.bays for mesh in meshes]),
        width=width / 1e3,
    )


def _copies(strips: Structure, copies: Sequence[Frame], centre: Floats) -> Lines:
    """The axes of all strips in the other segments."""
    lines = []
    for strip in strips.lamellas:
        s = np.linspace(strip.start, strip.end, 2 * len(strip.stations) + 1)
        points = strip.place(s, np.zeros_like(s), np.zeros_like(s))
        lines += [frame.place(points) for frame in copies]
    return Lines(
        id="copies",
        name="Other segments",
        points=on_screen(np.concatenate(lines), centre),
        pairs=runs_of_pairs([len(line) for line in lines]),
    )


def _marks(structure: Structure, centre: Floats) -> Labels:
    """The mark of every lamella, a little beyond its first end."""
    beyond, nought = 0.4 * structure.profile.width, np.zeros(1)
    lamellas = structure.lamellas
    places = [
        lamella.place(lamella.start - np.array([beyond]), nought, nought) for lamella in lamellas
    ]
    return Labels(
        id="marks",
        name="Marks",
        points=on_screen(np.concatenate(places), centre),
        texts=[lamella.mark for lamella in lamellas],
        colours=[css(FAMILY_COLOURS[lamella.family], 0.6) for lamella in lamellas],
    )


def _nodes(structure: Structure, centre: Floats) -> Dots:
    """A point per node, with its angle and its lamellas."""
    parts = []
    for node in structure.nodes:
        marks = " × ".join(structure.lamellas[c.lamella].mark for c in node.crossings)
        angle = () if node.angle is None else (f"{np.degrees(node.angle):.2f}°",)
        parts.append(About(node.name, (*angle, marks)))
    return Dots(
        id="nodes",
        name="Nodes",
        colour=_INK,
        points=on_screen(np.array([node.position for node in structure.nodes]), centre),
        parts=parts,
    )


def _node_axes(structure: Structure, centre: Floats) -> Lines:
    """The axis of every node, as long as the strips are wide."""
    half = structure.profile.width / 2.0
    places = np.array([node.position for node in structure.nodes])
    axes = half * np.array([node.axis for node in structure.nodes])
    ends = np.stack([places - 1.6 * axes, places + 1.6 * axes], axis=1)
    return Lines(
        id="node-axes",
        name="Node axes",
        colour="#2c7a4b",
        visible=False,
        points=on_screen(ends.reshape(-1, 3), centre),
        pairs=np.arange(2 * len(ends)).reshape(-1, 2),
    )


def axis_layers(points: NDArray[np.float32]) -> list[Layer]:
    """The directions x, y and z in a lower corner around *points* (n, 3) m, a round length long."""
    length = 10.0 ** np.floor(np.log10(max(np.ptp(points, axis=0).max(), 1e-6) / 4.0))
    right, rear, _ = points.max(axis=0) - length
    corner = np.array([right, rear, points[:, 2].min()])
    ends = corner + length * np.eye(3)
    name = f"Axes, {length:g} m long"
    segments = np.stack([np.tile(corner, (3, 1)), ends], axis=1).reshape(-1, 3)
    return [
        Lines(
            id="axes",
            name=name,
            built=False,
            points=segments.astype(np.float32),
            pairs=np.arange(6).reshape(-1, 2),
        ),
        Labels(
            id="axis-names",
            name=name,
            built=False,
            points=(corner + 1.08 * length * np.eye(3)).astype(np.float32),
            texts=("x", "y", "z"),
            colours=(_QUIET,),
        ),
    ]
