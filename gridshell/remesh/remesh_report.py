"""What was made of a surface: figures by which a quad mesh along directions is judged."""

from __future__ import annotations

from dataclasses import asdict, dataclass
from typing import Any

import numpy as np

from gridshell.arrays import Floats
from gridshell.surface import CurvedMesh, Remark, TriangleMesh, TriangulatedSurface

_SAMPLES = 4000
"""Triangles whose centroids tell how much is covered."""

_BESIDE = 0.02
"""Of an edge: a sample whose foot lies further to the side than this is not covered."""


@dataclass(frozen=True)
class Spike:
    """A singular point of the field: where, how often the pair turns, edges that meet there."""

    position: tuple[float, float, float]
    index: float
    valence: int


@dataclass(frozen=True)
class Spread:
    """Mean, 95th percentile and largest of a figure."""

    mean: float
    p95: float
    max: float

    @classmethod
    def of(cls, values: Floats) -> Spread:
        """Of no values, zeros."""
        if len(values) == 0:
            return cls(0.0, 0.0, 0.0)
        return cls(float(values.mean()), float(np.percentile(values, 95)), float(values.max()))


@dataclass(frozen=True)
class RemeshReport:
    """Figures of a quadrangulation; areas are shares of the whole surface.

    Parameters
    ----------
    quads, non_quads, odd_valences, colour_conflicts : of the quad mesh M.
    control_quads : faces of the control mesh C, 0 where there is none.
    singularities : of the field.
    alignment_deg : angle between M's edges and the field, degrees.
    coverage : share of the surface under M.
    edge_ratio : 5th, 50th and 95th percentile of M's edges over the spacing.
    spacing_mm : edge asked for, or what *quads* come to.
    infeasible_area, umbilic_area : see :class:`gridshell.field.FieldReport`.
    angle_deg : angle between the directions at 5, 50 and 95 % of the area, degrees.
    hand : "left", "right", or None.
    lam : weight of direction against spacing that was needed.
    flips, wrong_cones : faults of the chart that were left.
    integers : number of integers that were rounded, and whether exactly.
    triangles : size of the working mesh.
    remarks : what was mended, and findings.
    seconds : of all stages.
    """

    quads: int
    non_quads: int
    odd_valences: int
    colour_conflicts: int
    control_quads: int
    singularities: tuple[Spike, ...]
    alignment_deg: Spread
    coverage: float
    edge_ratio: tuple[float, float, float]
    spacing_mm: float
    infeasible_area: float
    umbilic_area: float
    angle_deg: tuple[float, float, float]
    hand: str | None
    lam: float
    flips: int
    wrong_cones: int
    integers: int
    integers_exact: bool
    triangles: int
    remarks: tuple[Remark, ...]
    seconds: float

    def plain(self) -> dict[str, Any]:
        """As plain data for ``report.json``."""
        return asdict(self)


def coverage(curved: CurvedMesh, over: TriangulatedSurface, spacing: float) -> float:
    """Share of the surface's area under the quads *over*, whose edges are about *spacing* mm.

    A triangle counts when the foot of its centroid lies inside of them, or on their rim but along
    the triangle's normal, not to the side.
    """
    mesh = curved.mesh
    step = max(1, len(mesh.triangles) // _SAMPLES)
    some = np.arange(0, len(mesh.triangles), step)
    halves = TriangleMesh(over.vertices, over.triangles)
    points, normals = mesh.centroids[some], mesh.face_normals[some]
    faces, weights = over.locate(points)
    foot = np.einsum("mk,mkc->mc", weights, over.vertices[over.triangles[faces]])
    away = points - foot
    side = away - np.einsum("mc,mc->m", away, normals)[:, None] * normals
    on_edge = np.roll(weights, 1, axis=1) <= 0.0  # none of the corner behind it
    on_rim = (on_edge & (halves.twin.reshape(-1, 3)[faces] < 0)).any(axis=1)
    on_rim |= ((weights >= 1.0) & halves.on_boundary[halves.triangles[faces]]).any(axis=1)
    covered = ~on_rim | (np.linalg.norm(side, axis=1) <= _BESIDE * spacing)
    weight = mesh.areas[some]
    return float(weight[covered].sum() / weight.sum())
