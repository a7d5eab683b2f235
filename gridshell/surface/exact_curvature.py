"""Normals and shape operators of a parametrised surface, at points and carried onto triangles."""

from __future__ import annotations

import numpy as np

from gridshell.arrays import Floats, Vectors, unit
from gridshell.surface import forms
from gridshell.surface.forms import Derivatives
from gridshell.surface.triangle_mesh import TriangleMesh


def normals_and_shapes(d: Derivatives, side: int = 1) -> tuple[Vectors, Floats]:
    """Unit normals (n, 3) on the given side and shape operators (n, 3, 3), 1/mm.

    The operator is symmetric, zero along the normal, and positive where the surface bends towards
    the normal; *side* is -1 for the normal against xu x xv.
    """
    a, b, c = (side * part[:, None, None] for part in forms.shape_operator(d))
    normal = forms.unit_normal(d)
    e1 = unit(d.xu)
    e2 = np.cross(normal, e1)
    mixed = e1[:, :, None] * e2[:, None, :]
    shapes = (
        a * e1[:, :, None] * e1[:, None, :]
        + b * (mixed + np.swapaxes(mixed, 1, 2))
        + c * e2[:, :, None] * e2[:, None, :]
    )
    return side * normal, shapes


def on_triangles(mesh: TriangleMesh, normals: Vectors, shapes: Floats) -> Floats:
    """(f, 3) components 11, 12, 22 of one operator (f, 3, 3) per triangle, in ``mesh.face_frames``.

    The triangle's tangents are turned into the operator's plane by the smallest rotation that
    takes the triangle's normal to *normals* (f, 3).
    """
    frames = mesh.face_frames
    axis = np.cross(frames[:, 2], normals)
    cos = np.einsum("fc,fc->f", frames[:, 2], normals)
    turned = [
        frames[:, k] * cos[:, None]
        + np.cross(axis, frames[:, k])
        + axis * (np.einsum("fc,fc->f", axis, frames[:, k]) / (1.0 + cos))[:, None]
        for k in range(2)
    ]
    e1, e2 = turned
    pairs = ((e1, e1), (e1, e2), (e2, e2))
    return np.stack([np.einsum("fi,fij,fj->f", p, shapes, q) for p, q in pairs], axis=1)
