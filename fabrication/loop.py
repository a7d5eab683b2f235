"""Closing the loop: from the written files back to the design.

The flat strips are read from the DXF sheets, the bent ones from the STEP assembly, the nodes from
``net.json``. Each flat strip is laid along the middle surface of its own solid: where its slots
then lie must be the net's nodes, over the whole width of the strip. The loop that trims the solid,
unrolled, must be the flat outline. And the net area of the outline times the thickness must be the
volume of the solid: bending and twisting keep it.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from fabrication.cut import area
from fabrication.export.dxf import DxfPart, read_dxf
from fabrication.export.step_reader import StepPart, read_step
from fabrication.parts import FlatPart
from fabrication.structures import Structure
from gridshell import DiagonalMesh, FileError
from gridshell.arrays import Floats


@dataclass(frozen=True)
class Closure:
    """How far the files are from the design.

    Parameters
    ----------
    max_mm : the larger of the next two.
    node_mm : largest distance between a slot laid into place and its node, along the node axis.
    outline_mm : largest distance between a flat outline and the unrolled loop of its solid.
    worst : lamella and node of the largest node distance.
    volume_ppm : largest difference between flat area times thickness and the solid's volume.
    strips, slots : how many were compared.
    """

    max_mm: float
    node_mm: float
    outline_mm: float
    worst: str
    volume_ppm: float
    strips: int
    slots: int


def closure(
    structure: Structure,
    parts: Sequence[FlatPart],
    net: DiagonalMesh,
    sheets: Iterable[Path],
    step: Path,
) -> Closure:
    """Read the sheets and the assembly and compare them with *net*.

    Parameters
    ----------
    structure, parts : say which node each slot belongs to.
    net : read back from ``net.json``.
    sheets, step : the written files.

    Raises
    ------
    FileError
        When a file cannot be read or a part is missing from it.
    """
    flat = [part for path in sheets for part in read_dxf(path)]
    return compare(structure, parts, net, flat, read_step(step))


def compare(
    structure: Structure,
    parts: Sequence[FlatPart],
    net: DiagonalMesh,
    drawn_parts: Iterable[DxfPart],
    bent_parts: Iterable[StepPart],
) -> Closure:
    """The same for parts that were read from the files already.

    Raises
    ------
    FileError
        When a part is missing, or has another number of slots than its lamella has nodes.
    """
    flat = {part.mark: part for part in drawn_parts}
    bent = {part.mark: part for part in bent_parts}
    missing = [p.mark for p in parts if p.mark not in flat or p.mark not in bent]
    if missing:
        raise FileError("A lamella is missing from the files", where=missing[0])
    distances: list[float] = []
    names: list[str] = []
    ppm = outlines = 0.0
    nodes = {node.name: i for i, node in enumerate(structure.nodes)}
    for part in parts:
        drawn, solid = flat[part.mark], bent[part.mark]
        ppm = max(ppm, abs(area(drawn.outline) * part.thickness / solid.volume() - 1.0) * 1e6)
        outlines = max(outlines, _outline_distance(drawn.outline, solid.unrolled_loop()))
        at = [nodes[slot.node] for slot in part.slots]
        axes = np.array([structure.nodes[i].axis for i in at]).reshape(-1, 3)
        distances += _node_distances(drawn, solid, net.vertices[at], axes, part.width).tolist()
        names += [f"{part.mark} at {slot.node}" for slot in part.slots]
    node_mm = max(distances, default=0.0)
    return Closure(
        max_mm=max(node_mm, outlines),
        node_mm=node_mm,
        outline_mm=outlines,
        worst=names[int(np.argmax(distances))] if names else "",
        volume_ppm=float(ppm),
        strips=len(parts),
        slots=len(distances),
    )


def slot_centres(outline: Floats) -> Floats:
    """(m,) x of the notches of an axis-parallel outline, in order along the strip, mm.

    A notch floor is a horizontal edge that is neither on the lower nor on the upper edge.
    """
    following = np.roll(outline, -1, axis=0)
    y = outline[:, 1]
    low, high = y.min(), y.max()
    level = np.abs(following[:, 1] - y) < 1e-9
    inside = (y > low + 1e-6) & (y < high - 1e-6)
    floors = level & inside
    return np.sort((outline[floors, 0] + following[floors, 0]) / 2.0)


def _outline_distance(outline: Floats, loop: Floats) -> float:
    """Largest distance from a corner of one to the nearest corner of the other, mm."""
    apart = np.linalg.norm(outline[:, None] - loop[None], axis=2)
    return float(max(apart.min(axis=0).max(), apart.min(axis=1).max()))


def _node_distances(
    drawn: DxfPart, solid: StepPart, positions: Floats, axes: Floats, width: float
) -> Floats:
    """(m,) largest distance over the lower edge, the axis and the upper edge at each slot."""
    x = slot_centres(drawn.outline)
    if len(x) != len(positions):
        raise FileError(
            "A flat part has another number of slots than its lamella has nodes",
            where=drawn.mark,
            value=f"{len(x)} slots",
            limit=f"{len(positions)}",
        )
    offsets = []
    for share in (0.0, 0.5, 1.0):
        placed = solid.place(x, np.full_like(x, share * width))
        wanted = positions + (share - 0.5) * width * axes
        offsets.append(np.linalg.norm(placed - wanted, axis=1))
    return np.asarray(np.max(offsets, axis=0))
