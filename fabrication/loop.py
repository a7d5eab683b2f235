"""Closing the loop: from the written files back to the design.

The flat strips are read from the DXF sheets, the bent ones and the connectors from the STEP
assembly; the expectation is built anew on the net that was read back from ``net.json``. Each flat
strip is laid along the middle surface of its own solid: where its slots, holes and ends then lie
must be where the net and the joint put them, over the whole width of the strip. The loops that
trim the solid, unrolled, must be the flat outline and its holes. The net area of the outline times
the thickness must be the volume of the solid: bending and twisting keep it. And every connector
must be in its place.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from fabrication.cut import area, face_outlines
from fabrication.export.dxf import DxfPart, read_dxf
from fabrication.export.step_loops import landmarks
from fabrication.export.step_prism_reader import StepPrism, read_prisms
from fabrication.export.step_reader import StepPart, read_step
from fabrication.jointed import Feature, Fixture, Jointed
from fabrication.parts import FlatPart
from fabrication.shapes import Prisms
from fabrication.stock import hollow_area
from gridshell import FileError
from gridshell.arrays import Floats


@dataclass(frozen=True)
class Closure:
    """How far the files are from the design.

    Parameters
    ----------
    max_mm : the largest of the next three.
    node_mm : largest distance between a slot, a hole or an end laid into place and where it
        belongs, slots and ends over the whole width of the strip.
    outline_mm : largest distance between a flat outline or hole and the unrolled loop of its
        solid.
    connector_mm : largest distance of a connector from its place.
    worst : strip and node of the largest node distance.
    volume_ppm : largest difference between flat area times thickness and the solid's volume.
    strips, slots, holes, ends, connectors : how many were compared.
    """

    max_mm: float
    node_mm: float
    outline_mm: float
    connector_mm: float
    worst: str
    volume_ppm: float
    strips: int
    slots: int
    holes: int
    ends: int
    connectors: int


def closure(
    reference: Jointed, parts: Sequence[FlatPart], sheets: Iterable[Path], step: Path
) -> Closure:
    """Read the sheets and the assembly and compare them with *reference*.

    Parameters
    ----------
    reference : built on the net that was read back from ``net.json``.
    parts : say how thick strips are and how their ends are bevelled.
    sheets, step : the written files.

    Raises
    ------
    FileError
        When a file cannot be read or a part is missing from it.
    """
    flat = [part for path in sheets for part in read_dxf(path)]
    placed = read_prisms(step) if reference.connectors else ()
    return compare(reference, parts, flat, read_step(step), placed)


def compare(
    reference: Jointed,
    parts: Sequence[FlatPart],
    drawn_parts: Iterable[DxfPart],
    bent_parts: Iterable[StepPart],
    placed: Iterable[StepPrism] = (),
) -> Closure:
    """The same for parts that were read from the files already.

    Raises
    ------
    FileError
        When a part is missing, or has another number of slots or holes than it should.
    """
    flat: dict[str, list[DxfPart]] = {}
    for found in drawn_parts:
        flat.setdefault(found.mark, []).append(found)
    bent = {part.mark: part for part in bent_parts}
    missing = [p.mark for p in parts if p.mark not in flat or p.mark not in bent]
    if missing:
        raise FileError("A lamella is missing from the files", where=missing[0])
    wanted: dict[str, list[Fixture]] = {part.mark: [] for part in parts}
    for fixture in reference.fixtures:
        wanted[fixture.mark].append(fixture)
    distances: list[float] = []
    names: list[str] = []
    ppm = outlines = 0.0
    for part in parts:
        solid = bent[part.mark]
        volume = solid.volume()
        for drawn in flat[part.mark]:
            ppm = max(ppm, abs(_flat_volume(drawn, part) / volume - 1.0) * 1e6)
            outlines = max(outlines, _outline_distance(drawn, solid, part.bevels))
            for fixture, off in _fixture_distances(wanted[part.mark], drawn, solid, part):
                distances.append(off)
                names.append(f"{part.mark} at {fixture.node}")
    node_mm = max(distances, default=0.0)
    apart = list(_connector_distances(reference.connectors, placed))
    connector_mm = max(apart, default=0.0)
    count = {feature: sum(f.feature is feature for f in reference.fixtures) for feature in Feature}
    return Closure(
        max_mm=max(node_mm, outlines, connector_mm),
        node_mm=node_mm,
        outline_mm=outlines,
        connector_mm=connector_mm,
        worst=names[int(np.argmax(distances))] if names else "",
        volume_ppm=float(ppm),
        strips=len(parts),
        slots=count[Feature.SLOT],
        holes=count[Feature.HOLE] + count[Feature.DRILL],
        ends=count[Feature.START] + count[Feature.END],
        connectors=len(apart),
    )


def slot_centres(outline: Floats) -> Floats:
    """(m,) x of the middles of the notches of an outline, in order along the strip, mm.

    A notch begins and ends with a wall straight across the strip, on the lower or the upper edge.
    """
    x, y = outline[:, 0], outline[:, 1]
    level = (np.abs(y - y.min()) < 1e-6) | (np.abs(y - y.max()) < 1e-6)
    after, before = np.roll(level, -1), np.roll(level, 1)
    into = np.flatnonzero(level & ~after & (np.abs(np.roll(x, -1) - x) < 1e-6))
    out = np.flatnonzero(level & ~before & (np.abs(np.roll(x, 1) - x) < 1e-6))
    if len(into) != len(out):
        return np.sort(x[into])
    return np.sort((x[into] + x[out]) / 2.0)


def _flat_volume(drawn: DxfPart, part: FlatPart) -> float:
    if part.wall:
        length = float(np.ptp(drawn.outline[:, 0]))
        drilled = 2.0 * part.wall * sum(drill.area for drill in part.drills)
        return length * hollow_area(part.width, part.thickness, part.wall) - drilled
    holes = float((np.pi / 4.0 * drawn.circles[:, 2] ** 2).sum())
    bevelled = sum(abs(run) for run in part.bevels) * part.width / 2.0
    return (area(drawn.outline) - holes - bevelled) * part.thickness


def _outline_distance(drawn: DxfPart, solid: StepPart, bevels: tuple[float, float]) -> float:
    """Largest distance between corners, arcs and holes of a flat part and of its solid, mm."""
    faces = [landmarks(face) for face in face_outlines(drawn.outline, bevels)]
    loops = [
        landmarks(solid.unrolled_loop(loops[0])) for loops in (solid.near_loops, solid.far_loops)
    ]
    either = [
        max(_apart(face, loop) for face, loop in zip(faces, order, strict=True))
        for order in (loops, loops[::-1])
    ]
    found = solid.circles()
    if found.shape != drawn.circles.shape:
        raise _other_number("holes", drawn.mark, len(drawn.circles), len(found))
    return max(min(either), float(np.abs(found - drawn.circles).max(initial=0.0)))


def _apart(a: Floats, b: Floats) -> float:
    """Largest distance from a point of one set to the nearest of the other, mm."""
    apart = np.linalg.norm(a[:, None] - b[None], axis=2)
    return float(max(apart.min(axis=0).max(), apart.min(axis=1).max()))


def _other_number(what: str, mark: str, found: int, wanted: int) -> FileError:
    return FileError(
        f"A flat part has another number of {what} than its lamella",
        where=mark,
        value=f"{found} {what}",
        limit=f"{wanted}",
    )


# ---- places on strips ----------------------------------------------------------------------------


def _fixture_distances(
    fixtures: Sequence[Fixture], drawn: DxfPart, solid: StepPart, part: FlatPart
) -> Iterator[tuple[Fixture, float]]:
    """How far every fixture of a strip is from where the files put it, mm."""
    if not fixtures:
        return
    x, y = _places(fixtures, drawn, solid, part)
    middle = solid.place(x, y)
    wanted = np.array([f.position for f in fixtures])
    off = np.linalg.norm(middle - wanted, axis=1)
    held = np.array([f.axis is not None for f in fixtures])
    axes = np.array([f.axis if f.axis is not None else np.zeros(3) for f in fixtures])
    for share in (0.0, 1.0):
        edge = solid.place(x, np.full_like(x, share * part.width))
        along = (share - 0.5) * part.width * axes
        off = np.where(held, np.maximum(off, np.linalg.norm(edge - wanted - along, axis=1)), off)
    yield from zip(fixtures, off.tolist(), strict=True)


def _places(
    fixtures: Sequence[Fixture], drawn: DxfPart, solid: StepPart, part: FlatPart
) -> tuple[Floats, Floats]:
    """Where the flat part has the features of *fixtures*: x and y, (n,) each, mm.

    What is drilled through narrow walls is no hole on the sheet: its place is the solid's own.
    """
    place = np.array([[f.x, part.width / 2.0] for f in fixtures])
    last = float(drawn.outline[:, 0].max())
    slots = [i for i, f in enumerate(fixtures) if f.feature is Feature.SLOT]
    holes = [i for i, f in enumerate(fixtures) if f.feature is Feature.HOLE]
    centres = slot_centres(drawn.outline)
    if len(centres) != len(slots):
        raise _other_number("slots", drawn.mark, len(centres), len(slots))
    for i, x in zip(sorted(slots, key=lambda i: fixtures[i].x), centres.tolist(), strict=True):
        place[i, 0] = x
    if len(drawn.circles) != len(holes):
        raise _other_number("holes", drawn.mark, len(drawn.circles), len(holes))
    for i in holes:
        wanted = [fixtures[i].x, fixtures[i].y]
        nearest = np.linalg.norm(drawn.circles[:, :2] - wanted, axis=1).argmin()
        place[i] = drawn.circles[nearest, :2]
    drills = [i for i, f in enumerate(fixtures) if f.feature is Feature.DRILL]
    drilled = solid.drills()
    if len(drilled) != len(drills):
        raise _other_number("drillings", drawn.mark, len(drilled), len(drills))
    in_order = sorted(drills, key=lambda i: fixtures[i].x)
    for i, x in zip(in_order, drilled[:, 0].tolist(), strict=True):
        place[i, 0] = x
    for i, fixture in enumerate(fixtures):
        if fixture.feature is Feature.START:
            place[i, 0] = abs(part.bevels[0]) / 2.0
        elif fixture.feature is Feature.END:
            place[i, 0] = last - abs(part.bevels[1]) / 2.0
    return place[:, 0], place[:, 1]


# ---- connectors ----------------------------------------------------------------------------------


def _connector_distances(
    connectors: Sequence[Prisms], placed: Iterable[StepPrism]
) -> Iterator[float]:
    """Distance of every connector's end faces from where they belong, mm."""
    if not connectors:
        return
    found = {prism.mark: prism for prism in placed}
    for kind in connectors:
        for body in kind.bodies:
            if body.mark not in found:
                raise FileError("A connector is missing from the files", where=body.mark)
            shape, prism = kind.shapes[body.shape], found[body.mark]
            ends = [
                body.frame.place(shape.outline[:, :2]) + z * body.frame.normal
                for z in (shape.low, shape.high)
            ]
            yield max(
                _apart(end, corners)
                for end, corners in zip(ends, (prism.low, prism.high), strict=True)
            )
