"""Guide lines: where curvature leaves the directions free, the user draws them.

The bisector of the pair is extended smoothly (see `extension`) from two sources: curvature, with
a pull that grows without bound as it tells directions apart more clearly, and the guides, with a
pull that falls to nothing there. Where curvature is clear, nothing changes.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from gridshell.arrays import Floats, Indices, Mask, Points, Vectors, frozen, unit
from gridshell.errors import SettingError
from gridshell.field.checks import (
    UMBILIC,
    diagonal,
    distinctness,
    require_curvature,
    require_distinct,
    umbilic,
)
from gridshell.field.extension import Complex, extended, line_values
from gridshell.field.frame_field import FrameField
from gridshell.surface.curved_mesh import CurvedMesh
from gridshell.surface.surface import checked_points
from gridshell.surface.triangle_mesh import TriangleMesh
from gridshell.surface.triangulated import TriangulatedSurface

CLEAR = 0.2
"""D / max|kappa| from which curvature alone decides."""

_REACH = 0.1
"""Over this fraction of the diagonal a pull of one holds against the neighbours."""

_GUIDE_PULL = 1e4
_MOST = 1e6


@dataclass(frozen=True, eq=False)
class Guide:
    """A polyline on or near the surface that lines of one family shall follow.

    Parameters
    ----------
    points : (k, 3) mm, k >= 2.
    family : 1 or 2.

    Raises
    ------
    InputError
        When *points* is not (k, 3) or not finite.
    SettingError
        When there is no line, or no such family.
    """

    points: Points
    family: int = 1

    def __post_init__(self) -> None:
        object.__setattr__(self, "points", frozen(checked_points(self.points)))
        if not np.any(np.diff(self.points, axis=0)):
            raise SettingError(
                "A guide line needs two points",
                where="points",
                value=f"{len(self.points)} points, all in one place" if len(self.points) else "0",
                limit="at least two different points",
            )
        if self.family not in (1, 2):
            raise SettingError(
                "A guide line belongs to one of the two families",
                where="family",
                value=repr(self.family),
                limit="1 or 2",
            )

    def samples(self, step: float) -> tuple[Points, Vectors]:
        """Points (m, 3) at most *step*, mm, apart, and the unit tangents there."""
        segments = np.diff(self.points, axis=0)
        lengths = np.linalg.norm(segments, axis=1)
        counts = np.where(lengths > 0.0, np.ceil(lengths / step), 0.0).astype(np.int64)
        segment = np.repeat(np.arange(len(segments)), counts)
        rank = np.arange(len(segment)) - np.repeat(np.cumsum(counts) - counts, counts)
        share = (rank + 0.5) / counts[segment]
        return self.points[segment] + share[:, None] * segments[segment], unit(segments)[segment]


def confidence(curved: CurvedMesh) -> Floats:
    """(f,) in [0, 1]: how far curvature alone decides the directions; 1 where guides do nothing."""
    return np.asarray(np.minimum(distinctness(curved) / CLEAR, 1.0) ** 2)


def guided(curved: CurvedMesh, field: FrameField, guides: Sequence[Guide]) -> FrameField:
    """Pull *field*, as the curvature gives it, towards *guides* where curvature is not clear.

    Raises
    ------
    SettingError
        When a guide line is nowhere along the surface.
    """
    if not guides:
        return field
    mesh = curved.mesh
    clear = confidence(curved)
    pull = np.minimum(clear / np.maximum(1.0 - clear, 1.0 / _MOST), _MOST)
    target = pull * line_values(field.bisector)
    drawn = _GUIDE_PULL * (1.0 - clear)
    for guide in guides:
        faces, lines = _on_triangles(mesh, guide)
        # from the guide's own line to the middle of the pair
        side = 1.0 if guide.family == 1 else -1.0
        target[faces] += drawn[faces] * lines * np.exp(1j * side * field.angle[faces])
        pull[faces] += drawn[faces]
    target = target / np.maximum(pull, 1.0 / _MOST)
    reach = (_REACH * diagonal(mesh)) ** 2
    lines = extended(mesh, target, pull / reach, known=clear >= 1.0)
    bisector = np.where(clear >= 1.0, field.bisector, np.angle(lines) / 2.0)
    first = np.where(clear >= 1.0, field.first, bisector - field.angle / 2.0)
    second = np.where(clear >= 1.0, field.second, first + field.angle)
    return FrameField(mesh, first, second, field.infeasible)


def require_directions(curved: CurvedMesh, guides: Sequence[Guide]) -> None:
    """Refuse a surface on which neither curvature nor a guide tells directions apart.

    Raises
    ------
    FlatSurfaceError
        For a plane without guides.
    UmbilicRegionError
        When more than 30 % of the area bends alike in all directions and no guide reaches it.
    """
    if not guides:
        require_curvature(curved)
    require_distinct(curved, reached(curved, guides) if guides else None)


def reached(curved: CurvedMesh, guides: Sequence[Guide]) -> Mask:
    """(f,) triangles of umbilic regions that a guide line runs through."""
    from scipy.sparse import coo_matrix
    from scipy.sparse.csgraph import connected_components

    mesh, free = curved.mesh, umbilic(curved)
    inner = np.flatnonzero(mesh.twin >= 0)
    here, there = inner // 3, mesh.twin[inner] // 3
    inside = free[here] & free[there]
    links = coo_matrix(
        (np.ones(inside.sum()), (here[inside], there[inside])), shape=(len(free), len(free))
    )
    part = connected_components(links, directed=False)[1]
    touched = np.zeros(part.max() + 1, dtype=bool)
    for guide in guides:
        touched[part[_on_triangles(mesh, guide)[0]]] = True
    return np.asarray(free & touched[part])


def _on_triangles(mesh: TriangleMesh, guide: Guide) -> tuple[Indices, Complex]:
    """Triangles (k,) under a guide and its line in each of their frames as exp(2 i angle), (k,)."""
    surface = TriangulatedSurface(mesh.vertices, mesh.triangles)
    points, tangents = guide.samples(mesh.mean_edge / 2.0)
    faces, _ = surface.locate(points)
    local = np.einsum("nic,nc->ni", mesh.face_frames[faces, :2], tangents)
    squared: Complex = (local[:, 0] + 1j * local[:, 1]) ** 2
    used, slot = np.unique(faces, return_inverse=True)
    total = np.bincount(slot, squared.real) + 1j * np.bincount(slot, squared.imag)
    size = np.abs(total)
    seen = size > UMBILIC  # a guide that pierces the surface has no direction on it
    if not seen.any():
        raise SettingError(
            "A guide line runs across the surface instead of along it",
            where=f"guide of {len(guide.points)} points",
            advice="draw it on the surface",
        )
    return used[seen], np.asarray(total[seen] / size[seen])
