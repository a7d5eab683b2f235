"""What a person must know of a quad mesh that was made, but not quite as it was asked for."""

from __future__ import annotations

import numpy as np

from gridshell.arrays import Indices
from gridshell.field import FieldReport
from gridshell.folding import collapsed
from gridshell.mesh import QuadMesh
from gridshell.remesh.remesh_report import Spread
from gridshell.remesh.seamless import Seamless
from gridshell.surface import Remark
from gridshell.surface.triangle_mesh import place

_LEAST_LAM = 10.0
_LARGEST_STRAY = 5.0
"""Degrees: 95th percentile of the alignment beyond which the field counts as not integrable."""


def findings(
    mesh: QuadMesh,
    chart: Seamless,
    about: FieldReport,
    stray: Spread,
    control_quads: int,
    singular: Indices,
) -> list[Remark]:
    """Findings with a code, a sentence that says what to try, and the number that goes with it.

    Parameters
    ----------
    mesh : the quad mesh M.
    stray : angles between the edges and the field, degrees.
    control_quads : faces of the control mesh, 0 where there is none.
    singular : (k,) vertices around which the field turns.
    """
    found = []
    if chart.lam <= _LEAST_LAM or stray.p95 > _LARGEST_STRAY:
        found.append(
            Remark(
                "not-integrable",
                f"the directions cannot be followed evenly: the edges are off by {stray.mean:.1f} "
                f"degrees on average, {stray.p95:.1f} for the 95th of a hundred; try a hole at a "
                "singular point, another angle, or a smaller part of the surface",
                stray.p95,
            )
        )
    lost = np.intersect1d(chart.cones, singular)
    lost = np.union1d(lost, np.intersect1d(chart.mesh.triangles[chart.folded], singular))
    if len(lost):
        found.append(
            Remark(
                "singular-point-lost",
                f"{len(lost)} of {len(singular)} singular points of the directions could not be "
                "made vertices of the mesh, which has a hole there; ask for other quads, or smooth "
                "the surface there",
                float(len(lost)),
                place(chart.mesh.vertices[lost[0]]),
            )
        )
    narrow = np.flatnonzero(about.valences == 2)
    if len(narrow):
        found.append(
            Remark(
                "umbilic-hole",
                f"{len(narrow)} singular points are of valence 2: the control mesh has holes "
                "there, as planar quads cannot go around them",
                float(len(narrow)),
                place(about.positions[narrow[0]]),
            )
        )
    bad = np.flatnonzero(collapsed(mesh.vertices, mesh.quads, mesh.mean_edge))
    if len(bad):
        found.append(
            Remark(
                "concave-quads",
                f"{len(bad)} quads are concave or slivers, as beside a vertex where two edges "
                "meet; the control mesh may be sound all the same",
                float(len(bad)),
                place(mesh.vertices[mesh.quads[bad[0]]].mean(axis=0)),
            )
        )
    if about.infeasible_area > 0.0:
        effect = "; the angle has no effect anywhere" if about.infeasible_area > 1.0 - 1e-9 else ""
        found.append(
            Remark(
                "angle-infeasible",
                f"{about.infeasible_area:.1%} of the area has no such pair of directions; the "
                f"angles reached are {np.degrees(about.angles[0]):.1f} to "
                f"{np.degrees(about.angles[-1]):.1f} degrees, and only the one nearest to 90 of "
                f"these is possible everywhere{effect}",
                about.infeasible_area,
                None if about.worst is None else place(about.worst),
            )
        )
    if control_quads == 0:
        found.append(
            Remark("too-coarse", "the quads are too few to hold a control mesh; ask for more", 0.0)
        )
    return found
