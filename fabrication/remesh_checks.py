"""What a designer should know about a quad mesh that follows directions on a surface."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

import gridshell as gs
from fabrication.finding import Finding, Severity
from gridshell.arrays import Floats
from gridshell.remesh.working_surface import area_of

MOST_QUADS = 100_000
"""Of the largest quad mesh that is tried."""

LEAST_COVERAGE = 0.9
"""Share of the surface under the mesh below which it is remarked, where it shall be covered."""

CONCAVE = "concave-quads"
"""Code of the finding that M itself, not its control mesh, cannot be optimised."""

_INFO, _WARNING, _ERROR = Severity.INFO, Severity.WARNING, Severity.ERROR

_KNOWN: dict[str, tuple[Severity, float, str]] = {
    "noise": (_WARNING, 0.0, "edges"),
    "coarse-triangles": (_WARNING, 5e-3, "edges"),
    "slivers": (_INFO, 0.0, "of the area"),
    "unusual-size": (_WARNING, 1e6, "mm"),
    "crossings-unknown": (_WARNING, 0.0, ""),
    "not-integrable": (_WARNING, 5.0, "degrees"),
    "angle-infeasible": (_WARNING, 0.0, "of the area"),
    "too-coarse": (_WARNING, 1.0, "quads"),
    CONCAVE: (_WARNING, 0.0, "quads"),
    "umbilic-hole": (_INFO, 0.0, "points"),
    "singular-point-lost": (_WARNING, 0.0, "points"),
}
"""Severity, limit and unit of remarks that are more than a note of what was mended."""


def check_quads(made: gs.Quadrangulation, *, extent: gs.Extent) -> list[Finding]:
    """Faults of the mesh M first, then what the surface and the directions gave rise to."""
    return [*_faults(made), *_uncovered(made, extent), *map(_finding, made.report.remarks)]


def require_few_quads(
    surface: gs.TriangulatedSurface | gs.BrepSurface | None,
    quads: int | None,
    edge: float | None,
) -> None:
    """Refuse a mesh of more than `MOST_QUADS`, by *quads* or by an *edge* on *surface*, mm.

    Raises
    ------
    SettingError
    """
    if surface is not None and edge is not None and edge > 0.0:
        area = area_of(surface)
        found, limit = area / edge**2, f"edges of {np.sqrt(area / MOST_QUADS):.4g} mm or more"
        value, where = f"{edge:g} mm, about {found:.3g} quads", "edge"
    else:
        found, limit = float(quads or 0), f"{MOST_QUADS} quads"
        value, where = f"{quads}", "quads"
    if found > MOST_QUADS:
        raise gs.SettingError("The mesh has too many quads", where=where, value=value, limit=limit)


def _faults(made: gs.Quadrangulation) -> Iterator[Finding]:
    mesh, report = made.mesh, made.report
    if report.non_quads:
        yield Finding(
            "non-quads",
            _ERROR,
            _smallest_hole(mesh),
            report.non_quads,
            0.0,
            "faces",
            f"{report.non_quads} cells of the mesh are no quads and were left out as holes. Ask "
            "for more quads, or cut a hole into the surface at the singular point beside them.",
        )
    odd = np.flatnonzero(~mesh.on_boundary & (mesh.valence % 2 == 1))
    if len(odd):
        yield Finding(
            "odd-valence",
            _ERROR,
            f"vertex {odd[0]} {_place(mesh.vertices[odd[0]])}",
            len(odd),
            0.0,
            "vertices",
            f"{len(odd)} vertices have an odd number of edges: families of lines end there "
            "(Fig. 4). Ask for more quads.",
        )
    if report.colour_conflicts:
        yield Finding(
            "colour-conflict",
            _ERROR,
            "a closed strip of quads",
            report.colour_conflicts,
            0.0,
            "strips",
            "The vertices cannot be coloured red and blue in turn, so there is no control mesh: a "
            "strip of quads closes after an odd number. Ask for another number of quads, or cut "
            "the surface open.",
        )
    yield from _chart_faults(made)


def _chart_faults(made: gs.Quadrangulation) -> Iterator[Finding]:
    """Turned triangles of the chart, and cones it should not have."""
    flat, folded, cones = made.curved.mesh, made.chart.folded, made.chart.cones
    if len(folded):
        yield Finding(
            "chart-flips",
            _WARNING,
            f"triangle {folded[0]} {_place(flat.centroids[folded[0]])}",
            len(folded),
            0.0,
            "triangles",
            f"{len(folded)} triangles of the chart are turned over; lines may miss each other "
            "there. Ask for another number of quads.",
        )
    if len(cones):
        yield Finding(
            "chart-cones",
            _WARNING,
            f"vertex {cones[0]} {_place(flat.vertices[cones[0]])}",
            len(cones),
            0.0,
            "vertices",
            f"{len(cones)} points of the chart have another valence than the directions. Ask for "
            "another number of quads.",
        )


def _uncovered(made: gs.Quadrangulation, extent: gs.Extent) -> Iterator[Finding]:
    share = made.report.coverage
    if extent is not gs.Extent.INSIDE and share < LEAST_COVERAGE:
        yield Finding(
            "uncovered",
            _WARNING,
            "mesh",
            share,
            LEAST_COVERAGE,
            "of the area",
            f"the mesh covers {share:.1%} of the surface only. Ask for more quads.",
        )


def _finding(remark: gs.Remark) -> Finding:
    severity, limit, unit = _KNOWN.get(remark.code, (_INFO, 0.0, ""))
    value = float(remark.value) if np.isfinite(remark.value) else 1.0
    where = remark.where or "surface"
    return Finding(remark.code, severity, where, value, limit, unit, f"{remark.message}.")


def _smallest_hole(mesh: gs.QuadMesh) -> str:
    """Where the shortest loop of boundary is: a cell left out, where there are several."""
    loop = min(mesh.boundary_loops, key=len)
    if len(mesh.boundary_loops) < 2:
        return "the edge of the mesh"
    return f"a hole {_place(mesh.vertices[mesh.origin[loop]].mean(axis=0))}"


def _place(point: Floats) -> str:
    x, y, z = point.tolist()
    return f"({x:.6g}, {y:.6g}, {z:.6g}) mm"
