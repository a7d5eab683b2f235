"""Closing the loop of a planar net: flat parts and solids put back onto the net of ``net.json``.

A flat outline is set *out* by what it was set back, so that it is the face of the net again, and
laid over that face of the net without changing it, by least squares. What is left between its
corners and the net's is the distance of the sheet from the design; the same motion lays the outline
itself into place, where the corners of its solid must be. A plate that is not flat is measured from
the best plane through its four corners: how far those are out of it is a figure of its own.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass

import numpy as np

from fabrication.connector import connectors
from fabrication.export.dxf import DxfPart
from fabrication.export.step_prism_reader import StepPrism
from fabrication.outlines import best_frame, inset, polygon_area
from fabrication.panel import panel_mark
from fabrication.panel_structure import PanelSystem, connector_span
from fabrication.support import PlateSection, plate_mark
from gridshell import FileError, PanelMesh
from gridshell.arrays import Floats, Points, unit


@dataclass(frozen=True)
class PanelClosure:
    """How far the files are from the design.

    Parameters
    ----------
    max_mm : the larger of the next two.
    sheet_mm : largest distance of a flat part, laid over the net, from the net's corners.
    solid_mm : largest distance of a corner of a solid from its place.
    worst : part of the largest distance.
    volume_ppm : largest difference between flat area times thickness and the solid's volume.
    panels, plates, connectors : how many were compared.
    """

    max_mm: float
    sheet_mm: float
    solid_mm: float
    worst: str
    volume_ppm: float
    panels: int
    plates: int
    connectors: int


@dataclass(frozen=True, eq=False)
class Wanted:
    """Where a flat part belongs.

    Parameters
    ----------
    corners : (k, 3) of the net, in one plane, mm.
    setback : (k,) of the part's sides from the corners' polygon, mm.
    thickness : mm.
    centred : its solid lies on both sides of the plane, not above it.
    """

    mark: str
    corners: Points
    setback: Floats
    thickness: float
    centred: bool


def panel_closure(
    mesh: PanelMesh,
    system: PanelSystem,
    drawn: Iterable[DxfPart],
    solids: Iterable[StepPrism],
) -> PanelClosure:
    """Compare what was read from the files with *mesh*, which was read from ``net.json``.

    Raises
    ------
    FileError
        When a part is missing from the files, or its outline cannot be set out again.
    """
    flat = {part.mark: part for part in drawn}
    bent = {solid.mark: solid for solid in solids}
    wanted = [*_panels(mesh, system), *_plates(mesh, system.plates)]
    return closed(wanted, flat, bent, list(_connector_distances(mesh, system, bent)), system, mesh)


def closed(
    wanted: Sequence[Wanted],
    flat: dict[str, DxfPart],
    bent: dict[str, StepPrism],
    others: Sequence[tuple[str, float]],
    system: PanelSystem,
    mesh: PanelMesh,
) -> PanelClosure:
    """The figures over flat parts and *others*, whose distances are known."""
    marks: list[str] = []
    sheet: list[float] = []
    solid: list[float] = []
    ppm = 0.0
    for want in wanted:
        if want.mark not in flat or want.mark not in bent:
            raise FileError("A part is missing from the files", where=want.mark)
        outline, body = flat[want.mark].outline, bent[want.mark]
        laid, off = lay_over(outline, want)
        ends = body.middle if want.centred else body.low
        marks.append(want.mark)
        sheet.append(off)
        solid.append(corner_distance(laid, ends))
        flat_volume = polygon_area(outline) * want.thickness
        ppm = max(ppm, abs(flat_volume / body.volume() - 1.0) * 1e6)
    distances = [*sheet, *solid, *(distance for _, distance in others)]
    names = [*marks, *marks, *(mark for mark, _ in others)]
    sheet_mm = max(sheet, default=0.0)
    solid_mm = max([*solid, *(distance for _, distance in others)], default=0.0)
    return PanelClosure(
        max_mm=max(sheet_mm, solid_mm),
        sheet_mm=sheet_mm,
        solid_mm=solid_mm,
        worst=names[int(np.argmax(distances))] if names else "",
        volume_ppm=float(ppm),
        panels=len(mesh.faces),
        plates=0 if system.plates is None else len(mesh.edges),
        connectors=len(others),
    )


def lay_over(outline: Floats, want: Wanted) -> tuple[Points, float]:
    """Where the flat *outline* (k, 2) lies on the net, and how far it is from the net's corners.

    Returns
    -------
    laid : (k, 3) the outline in place, mm.
    off : largest distance between the outline, set out again, and the net's corners, mm.
    """
    face = inset(outline, -want.setback) if len(outline) == len(want.corners) else None
    if face is None:
        raise FileError("A flat part is not the one that was designed", where=want.mark)
    there = want.corners.mean(axis=0)
    up = best_frame(want.corners)
    target = up.flat(want.corners) - up.flat(there)
    a = face[:, 0] + 1j * face[:, 1]
    b = target[:, 0] + 1j * target[:, 1]
    turn = complex((np.conj(a - a.mean()) * b).sum())
    turn /= abs(turn)

    def place(flat: Floats) -> Points:
        z = turn * (flat[:, 0] + 1j * flat[:, 1] - a.mean())
        return np.asarray(there + z.real[:, None] * up.x + z.imag[:, None] * up.y)

    off = np.linalg.norm(place(face) - want.corners, axis=1)
    return place(outline), float(off.max())


def corner_distance(first: Points, second: Points) -> float:
    """Largest distance from a corner of one (k, 3) to the nearest corner of the other, mm."""
    apart = np.linalg.norm(first[:, None] - second[None], axis=2)
    return float(max(apart.min(axis=0).max(), apart.min(axis=1).max()))


def _panels(mesh: PanelMesh, system: PanelSystem) -> Iterator[Wanted]:
    spec = system.panels
    for face in range(len(mesh.faces)):
        corners = mesh.corner_points(face)
        setback = np.full(len(corners), spec.setback)
        yield Wanted(panel_mark(face), corners, setback, spec.thickness, False)


def _plates(mesh: PanelMesh, section: PlateSection | None) -> Iterator[Wanted]:
    if section is None:
        return
    setback = np.array([0.0, section.setback, 0.0, section.setback])
    for edge, (i, j) in enumerate(mesh.edges.tolist()):
        p, q = mesh.vertices[i], mesh.vertices[j]
        up, on = mesh.axes[i], mesh.axes[j]
        places = [p + section.below * up, q + section.below * on]
        places += [q + section.above * on, p + section.above * up]
        yield Wanted(
            plate_mark(edge), _flattened(np.stack(places)), setback, section.thickness, True
        )


def _flattened(corners: Points) -> Points:
    """The feet of four corners in the plane along both diagonals."""
    across = unit(np.cross(corners[2] - corners[0], corners[3] - corners[1]))
    away = (corners - corners.mean(axis=0)) @ across
    return np.asarray(corners - away[:, None] * across)


def _connector_distances(
    mesh: PanelMesh, system: PanelSystem, bent: dict[str, StepPrism]
) -> Iterator[tuple[str, float]]:
    if system.connectors is None:
        return
    low, _ = connector_span(system)
    for connector in connectors(mesh, system.connectors):
        if connector.mark not in bent:
            raise FileError("A connector is missing from the files", where=connector.mark)
        frame = connector.frame
        corners = frame.place(connector.section()[:, :2]) + low * frame.normal
        yield connector.mark, corner_distance(corners, bent[connector.mark].low)
