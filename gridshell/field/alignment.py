"""How well the edges of a mesh follow a field, edge by edge."""

from __future__ import annotations

import numpy as np

from gridshell.arrays import Floats, Indices, Points, Vectors, unit
from gridshell.errors import InputError
from gridshell.field.frame_field import FrameField, wrapped
from gridshell.field.refinement import rotated
from gridshell.surface.triangle_mesh import TriangleMesh

_SINGULAR = 1e-9
"""Neighbours whose centroids lie on a line (relative determinant) give no slope."""


def alignment(
    field: FrameField, faces: Indices, points: Points, directions: Vectors, families: Indices
) -> Floats:
    """Angle, rad, in [0, pi/2], between segments and the lines of their family.

    Parameters
    ----------
    faces : (m,) the triangle under the middle of each segment.
    points : (m, 3) the middles, mm.
    directions : (m, 3) along the segments, of any length but not zero.
    families : (m,) 1 or 2.

    Raises
    ------
    InputError
        When the four do not belong together.
    """
    lines = lines_at(field, faces, points, families)
    directions = np.asarray(directions, dtype=np.float64)
    if directions.shape != lines.shape:
        raise InputError(
            "There must be one direction per point",
            value=f"shape {directions.shape}",
            limit=f"{lines.shape}",
        )
    normals = field.mesh.face_normals[faces]
    along = np.einsum("mc,mc->m", directions, lines)
    across = np.einsum("mc,mc->m", directions, np.cross(normals, lines))
    return np.asarray(np.arctan2(np.abs(across), np.abs(along)))


def lines_at(field: FrameField, faces: Indices, points: Points, families: Indices) -> Vectors:
    """Unit vectors (m, 3) along the lines of *families* (m,), 1 or 2, at *points* (m, 3), mm.

    A field is known in the middles of its triangles; in between it is continued with the slope of
    least squares over all triangles that share a corner, so that a turning field is exact to second
    order. The vectors lie in the planes of *faces* (m,), the triangles under the points.

    Raises
    ------
    InputError
        When the three do not belong together.
    """
    mesh = field.mesh
    faces, families = np.asarray(faces, dtype=np.int64), np.asarray(families)
    points = np.asarray(points, dtype=np.float64)
    m = len(faces)
    if points.shape != (m, 3) or families.shape != (m,) or not np.isin(families, (1, 2)).all():
        raise InputError(
            "There must be one triangle and one family per point",
            value=f"points {points.shape}, families {families.shape}, triangles ({m},)",
            limit="(m, 3), (m,) of 1 or 2, (m,)",
        )
    used, slot = np.unique(faces, return_inverse=True)
    slopes = np.stack(
        [
            _slopes(mesh, used, field.first, field.first_directions),
            _slopes(mesh, used, field.second, field.second_directions),
        ]
    )
    row = families.astype(np.int64) - 1
    offset = np.einsum("mic,mc->mi", mesh.face_frames[faces, :2], points - mesh.centroids[faces])
    turn = np.einsum("mi,mi->m", slopes[row, slot], offset)
    angle = np.where(row == 0, field.first[faces], field.second[faces]) + turn
    frames = mesh.face_frames[faces]
    return unit(np.cos(angle)[:, None] * frames[:, 0] + np.sin(angle)[:, None] * frames[:, 1])


def _slopes(mesh: TriangleMesh, faces: Indices, angles: Floats, lines: Vectors) -> Floats:
    """(k, 2) change of the angle per mm along both rows of the frames of *faces* (k,)."""
    pair, around = _neighbours(mesh, faces)
    own = faces[pair]
    frames = mesh.face_frames[own]
    step = np.einsum("pic,pc->pi", frames[:, :2], mesh.centroids[around] - mesh.centroids[own])
    carried = rotated(lines[around], mesh.face_normals[around], mesh.face_normals[own])
    seen = np.einsum("pic,pc->pi", frames[:, :2], carried)
    turn = wrapped(np.arctan2(seen[:, 1], seen[:, 0]) - angles[own], np.pi)
    k = len(faces)
    xx, xy, yy = (
        np.bincount(pair, step[:, i] * step[:, j], k) for i, j in ((0, 0), (0, 1), (1, 1))
    )
    tx, ty = (np.bincount(pair, turn * step[:, i], k) for i in (0, 1))
    determinant = xx * yy - xy * xy
    good = determinant > _SINGULAR * (xx + yy) ** 2
    scale = np.where(good, 1.0 / np.where(good, determinant, 1.0), 0.0)
    return np.stack([(yy * tx - xy * ty) * scale, (xx * ty - xy * tx) * scale], axis=1)


def _neighbours(mesh: TriangleMesh, faces: Indices) -> tuple[Indices, Indices]:
    """Pairs of a row of *faces* and another triangle with a common corner, each pair once."""
    fans = mesh.fans[mesh.triangles[faces]].reshape(len(faces), -1)
    row, column = np.nonzero(fans >= 0)
    around = fans[row, column] // 3
    count = len(mesh.triangles)
    key = np.unique((row * count + around)[around != faces[row]])
    return key // count, key % count
