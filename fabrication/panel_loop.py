"""Closing the loop of a planar net: flat parts and solids put back onto the net of ``net.json``.

A flat outline is set *out* by what it was set back, so that it is the face of the net again, and
laid over that face of the net without changing it, by least squares. What is left between its
corners and the net's is the distance of the sheet from the design; the same motion lays the outline
itself into place, where the corners of its solid must be. A plate that is not flat is measured from
the best plane through its four corners: how far those are out of it is a figure of its own.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass

import numpy as np

from fabrication.connector import connectors
from fabrication.connector_pieces import connector_pieces
from fabrication.export.dxf import DxfPart
from fabrication.export.step_prism_reader import StepPrism
from fabrication.outlines import best_frame, inset, polygon_area
from fabrication.panel import panel_mark
from fabrication.panel_structure import PanelSystem, connector_middle
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
    laid = [_laid(want, flat, bent) for want in wanted]
    others = list(_connector_distances(mesh, system, flat, bent))
    distances = [(d, part.mark) for part in laid for d in (part.sheet, part.solid)]
    distances += [(distance, mark) for mark, distance in others]
    largest, worst = max(distances, key=lambda pair: pair[0], default=(0.0, ""))
    return PanelClosure(
        max_mm=largest,
        sheet_mm=max((part.sheet for part in laid), default=0.0),
        solid_mm=max([*(part.solid for part in laid), *(d for _, d in others)], default=0.0),
        worst=worst,
        volume_ppm=max((part.ppm for part in laid), default=0.0),
        panels=len(mesh.faces),
        plates=0 if system.plates is None else len(mesh.edges),
        connectors=len({mark for mark, _ in others}),
    )


@dataclass(frozen=True)
class _Laid:
    """How far a part is from the net: its outline, its solid (mm), and its volume (ppm)."""

    mark: str
    sheet: float
    solid: float
    ppm: float


def _laid(want: Wanted, flat: Mapping[str, DxfPart], bent: Mapping[str, StepPrism]) -> _Laid:
    if want.mark not in flat or want.mark not in bent:
        raise FileError("A part is missing from the files", where=want.mark)
    outline, body = flat[want.mark].outline, bent[want.mark]
    placed, off = lay_over(outline, want)
    ends = body.middle if want.centred else body.low
    volume = polygon_area(outline) * want.thickness
    ppm = abs(volume / body.volume() - 1.0) * 1e6
    return _Laid(want.mark, off, corner_distance(placed, ends), ppm)


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
    mesh: PanelMesh,
    system: PanelSystem,
    flat: Mapping[str, DxfPart],
    bent: Mapping[str, StepPrism],
) -> Iterator[tuple[str, float]]:
    """Of every cylinder or star plate: of its solid, and of its flat outline where it has one."""
    if system.connectors is None:
        return
    made = connectors(mesh, system.connectors)
    for piece in connector_pieces(made, connector_middle(system), system.star):
        corners = piece.connector.section()[:, :2]
        missing = piece.mark not in bent or (system.star is not None and piece.mark not in flat)
        if missing:
            raise FileError("A connector is missing from the files", where=piece.mark)
        yield piece.mark, corner_distance(piece.frame.place(corners), bent[piece.mark].low)
        if system.star is not None:
            yield piece.mark, _turned_distance(flat[piece.mark].outline[:, :2], corners)


def _turned_distance(outline: Floats, corners: Floats) -> float:
    """Largest distance of an outline (k, 2) from corners in the same order, laid over them, mm."""
    if outline.shape != corners.shape:
        return float("inf")
    a, b = (x[:, 0] + 1j * x[:, 1] for x in (outline, corners))
    a, b = a - a.mean(), b - b.mean()
    turn = complex((np.conj(a) * b).sum())
    return float(np.abs(turn / abs(turn) * a - b).max())
