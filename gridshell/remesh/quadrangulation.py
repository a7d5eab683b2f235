"""The whole way from a curved surface to the quad mesh M along two families of directions."""

from __future__ import annotations

import time
from dataclasses import dataclass

import numpy as np

from gridshell.arrays import Floats, Indices, Points
from gridshell.errors import ColouringError, MeshError, SettingError
from gridshell.field import (
    FieldReport,
    FrameField,
    alignment,
    cleaned,
    field_report,
    require_curvature,
    singularities,
)
from gridshell.mesh import ControlMesh, QuadMesh, control_mesh, main_piece, two_colouring
from gridshell.remesh.directions import Conjugate, Directions
from gridshell.remesh.extent import Extent, cells
from gridshell.remesh.extraction import Extracted, extract
from gridshell.remesh.findings import findings
from gridshell.remesh.remesh_report import RemeshReport, Spike, Spread, coverage
from gridshell.remesh.seamless import LADDER, Seamless, seamless
from gridshell.remesh.tidying import require_around, tidy
from gridshell.remesh.working_surface import Source, WorkingSurface, area_of, working_surface
from gridshell.solve import Engine
from gridshell.surface import CurvedMesh, Remark, Surface, TriangulatedSurface, lift


@dataclass(frozen=True, eq=False)
class Quadrangulation:
    """The quad mesh M and how it came about.

    Parameters
    ----------
    mesh : M, mm, vertices on the surface; its edges follow the two families, the first and third
        edge of every quad family 1.
    reference : the surface itself, to keep nets close to.
    curved, field : the working surface and the directions on it, refined at singular points.
    chart : the seamless chart M was read off.
    edge_points, edge_errors : (m, 3) middles of M's edges on the surface, mm, and (m,) their angle
        to the field, radians: the heat map of the alignment.
    report : all figures.
    """

    mesh: QuadMesh
    reference: Surface
    curved: CurvedMesh
    field: FrameField
    chart: Seamless
    edge_points: Points
    edge_errors: Floats
    report: RemeshReport

    def control(self) -> ControlMesh:
        """The control mesh C: one colour of M's vertices, that of the singular ones (Fig. 6 d).

        Its diagonals of family 1 follow the field's first direction. Around a singular point of
        valence 2 (an umbilic of index +1/2) two quads share two edges: one of them has a corner of
        180 degrees or more and no planar net has it, so both are left out and a hole stays.

        Raises
        ------
        MeshError
            When M is too small or too narrow to hold one.
        """
        control = control_mesh(self.mesh)
        if not _begins_with(self.mesh, control):
            control = control.families_exchanged()
        return _opened(control)


def quadrangulate(
    source: Source | WorkingSurface,
    directions: Directions,
    *,
    quads: int | None = None,
    edge: float | None = None,
    extent: Extent = Extent.COVER,
    ladder: tuple[tuple[float, bool], ...] = LADDER,
    align_boundary: bool = True,
    engine: Engine | None = None,
) -> Quadrangulation:
    """Find the quad mesh M on a surface whose edges follow *directions*.

    Parameters
    ----------
    source : triangles, B-rep faces, a formula, or what :func:`working_surface` made of them.
    quads, edge : how many quads, or how long their edges, mm: one of the two.
    extent : how far M goes at the boundary.
    ladder : weights of direction against spacing to try; ``((1.0, False),)`` is the isotropic
        energy of mixed-integer quadrangulation.
    align_boundary : keep boundaries that run along a family as lines of M.
    engine : solver of the linear systems.

    Raises
    ------
    SettingError
        When neither or both of *quads* and *edge* are given, or one is not positive.
    SurfaceError
        One of its kinds: flat, umbilic, not hyperbolic, angle infeasible, pole, too many
        singularities, or a target too coarse for it.
    """
    start = time.perf_counter()
    ready = (
        source
        if isinstance(source, WorkingSurface)
        else working_surface(source, quads=_about_quads(source, quads, edge))
    )
    curved = ready.curved
    require_curvature(curved)
    field = directions.field(curved)
    spacing = _spacing(field, quads, edge)
    refined = cleaned(curved, field, spacing)
    turns = singularities(refined.field)
    chart = seamless(
        refined.field, turns, spacing, ladder=ladder, align_boundary=align_boundary, engine=engine
    )
    found = extract(chart)
    positions = lift(refined.curved, found.faces, found.weights)
    if ready.exact and len(positions):
        positions = ready.reference.closest(positions).points
    if len(chart.folded) == 0:  # folds make cells that are none, which are left out
        require_around(found, positions, spacing)
    made = cells(found, positions, extent, onto=lambda x: ready.reference.closest(x).points)
    mesh = tidy(made, spacing)
    points, errors = _strays(found, refined.field)
    hand = directions.hand if isinstance(directions, Conjugate) else None
    about = field_report(refined.curved, refined.field, hand=hand)
    report = _report(
        mesh,
        chart,
        about,
        refined.curved,
        Spread.of(np.degrees(errors)),
        found,
        spacing,
        turns.vertices,
        ready.remarks,
        time.perf_counter() - start,
    )
    return Quadrangulation(
        mesh, ready.reference, refined.curved, refined.field, chart, points, errors, report
    )


def _opened(control: ControlMesh) -> ControlMesh:
    """Without the quads around interior vertices of valence 2."""
    mesh = control.mesh
    narrow = (mesh.valence == 2) & ~mesh.on_boundary
    kept = np.flatnonzero(~narrow[mesh.quads].any(axis=1))
    if len(kept) == len(mesh.quads):
        return control
    kept = kept[main_piece(mesh.quads[kept])]
    used, quads = np.unique(mesh.quads[kept], return_inverse=True)
    return ControlMesh(QuadMesh(mesh.vertices[used], quads.reshape(-1, 4)), control.colour[used])


def _begins_with(mesh: QuadMesh, control: ControlMesh) -> bool:
    """Whether the family 1 of *control* is that of the first edges of the quads of *mesh*."""
    corners = control.vertices[control.quads[0]]
    ring = [int(np.flatnonzero((mesh.vertices == corner).all(axis=1))[0]) for corner in corners]
    leaving = np.isin(mesh.target, ring)
    reached = np.bincount(mesh.origin[leaving], minlength=len(mesh.vertices))
    centre = int(np.flatnonzero((reached == 4) & ~mesh.on_boundary)[0])
    spoke = np.flatnonzero((mesh.origin == centre) & (mesh.target == ring[0]))[0]
    return bool(spoke % 2 == 0)


def _about_quads(source: Source, quads: int | None, edge: float | None) -> float:
    """Quads to expect, for the fineness of the triangles."""
    _require_one(quads, edge)
    return float(quads) if quads is not None else area_of(source) / float(edge or 1.0) ** 2


def _require_one(quads: int | None, edge: float | None) -> None:
    if (quads is None) == (edge is None):
        raise SettingError(
            "The size of the quads must be given once",
            where="quads, edge",
            value="neither" if quads is None else "both",
            limit="a number of quads or the length of their edges",
        )
    value = float(quads if quads is not None else edge or 0.0)
    if not (np.isfinite(value) and value > 0.0):
        raise SettingError(
            "The size of the quads must be positive",
            where="quads" if quads is not None else "edge",
            value=f"{value:g}",
            limit="> 0",
        )


def _spacing(field: FrameField, quads: int | None, edge: float | None) -> float:
    _require_one(quads, edge)
    if edge is not None:
        return float(edge)
    return float(np.sqrt((field.mesh.areas / np.sin(field.angle)).sum() / float(quads or 1)))


def _strays(found: Extracted, field: FrameField) -> tuple[Points, Floats]:
    """Middles of the edges between crossings and their angles to the field."""
    port = np.flatnonzero(found.traced.reverse > np.arange(len(found.ports.owner)))
    flat = np.einsum("mk,mkc->mc", found.weights, field.mesh.corners[found.faces])
    a = flat[found.ports.owner[port]]
    b = flat[found.ports.owner[found.traced.reverse[port]]]
    if len(port) == 0:
        return a, np.zeros(0)
    middle = (a + b) / 2.0
    faces, _ = TriangulatedSurface(field.mesh.vertices, field.mesh.triangles).locate(middle)
    families = np.where(found.ports.axes[port] % 2 == 0, 1, 2)
    return middle, alignment(field, faces, middle, b - a, families)


def _report(
    mesh: QuadMesh,
    chart: Seamless,
    about: FieldReport,
    curved: CurvedMesh,
    stray: Spread,
    found: Extracted,
    spacing: float,
    singular: Indices,
    remarks: tuple[Remark, ...],
    seconds: float,
) -> RemeshReport:
    inner = ~mesh.on_boundary
    conflicts, control_quads = _colours(mesh)
    low, middle, high = np.percentile(mesh.edge_lengths / spacing, [5, 50, 95]).tolist()
    angles = np.degrees(about.angles).tolist()
    under = coverage(curved, TriangulatedSurface.of_quads(mesh.vertices, mesh.quads), spacing)
    spikes = tuple(
        Spike((float(p[0]), float(p[1]), float(p[2])), float(i), int(v))
        for p, i, v in zip(about.positions, about.indices, about.valences, strict=True)
    )
    integers = [c.integers for c in chart.coordinates]
    return RemeshReport(
        quads=len(mesh.quads),
        non_quads=found.non_quads,
        odd_valences=int(np.count_nonzero(mesh.valence[inner] % 2)),
        colour_conflicts=conflicts,
        control_quads=control_quads,
        singularities=spikes,
        alignment_deg=stray,
        coverage=under,
        edge_ratio=(low, middle, high),
        spacing_mm=spacing,
        infeasible_area=about.infeasible_area,
        umbilic_area=about.umbilic_area,
        angle_deg=(angles[1], angles[2], angles[3]),
        hand=None if about.hand is None else about.hand.name.lower(),
        lam=chart.lam,
        flips=len(chart.folded),
        wrong_cones=len(chart.cones),
        integers=sum(len(i.integers) for i in integers),
        integers_exact=all(i.exact for i in integers),
        triangles=len(curved.mesh.triangles),
        remarks=(*remarks, *findings(mesh, chart, about, stray, control_quads, singular)),
        seconds=seconds,
    )


def _colours(mesh: QuadMesh) -> tuple[int, int]:
    """Conflicts of M's colours, and faces of C."""
    try:
        two_colouring(mesh)
    except ColouringError:
        return 1, 0
    try:
        return 0, len(control_mesh(mesh).quads)
    except MeshError:
        return 0, 0
