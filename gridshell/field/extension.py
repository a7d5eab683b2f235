"""Smooth extension over the triangles: what is known is kept, the rest follows its neighbours.

A line at angle t is the complex number exp(2 i t), so both its signs are one value. Carried from a
triangle to the next it turns by twice the transport angle (connection Laplacian; F. Knoeppel et
al., Globally optimal direction fields, ACM TOG 2013).
"""

from __future__ import annotations

from typing import Any

import numpy as np
import numpy.typing as npt

from gridshell.arrays import Floats, Mask
from gridshell.field.frame_field import FrameField, transport
from gridshell.surface.triangle_mesh import TriangleMesh

Complex = npt.NDArray[np.complex128]

_HOLD = 1e-12
"""Keeps the system regular where a part of the surface holds nothing that is known."""


def line_values(angles: Floats) -> Complex:
    """(...) lines at *angles*, rad, as unit complex numbers that do not know their sign."""
    return np.asarray(np.exp(2j * angles), dtype=np.complex128)


def filled(field: FrameField, unknown: Mask) -> FrameField:
    """The field with the pairs of *unknown* triangles (f,) taken from around them.

    Bisector and opening angle are extended on their own, so that the pair stays a pair.
    """
    if not unknown.any() or unknown.all():
        return field
    none = np.zeros(len(unknown))
    lines = extended(field.mesh, line_values(field.bisector), none, known=~unknown)
    openings = extended(
        field.mesh, field.angle.astype(np.complex128), none, known=~unknown, turns=0
    )
    bisector = np.where(unknown, np.angle(lines) / 2.0, field.bisector)
    opening = np.where(unknown, openings.real, field.angle)
    first = np.where(unknown, bisector - opening / 2.0, field.first)
    second = np.where(unknown, bisector + opening / 2.0, field.second)
    return FrameField(field.mesh, first, second, field.infeasible)


def extended(
    mesh: TriangleMesh, values: Complex, weights: Floats, *, known: Mask, turns: int = 2
) -> Complex:
    """Minimise the change of *values* (f,) between neighbours against the pull to the given ones.

    Parameters
    ----------
    values : (f,) given values; those of *known* triangles are kept.
    weights : (f,) pull towards *values* per area, 1/mm2.
    known : (f,) triangles that are not solved for.
    turns : 2 for lines, as exp(2 i angle); 0 for numbers that do not depend on a frame.
    """
    from scipy.sparse import coo_matrix
    from scipy.sparse.linalg import splu

    free = np.flatnonzero(~known)
    if len(free) == 0:
        return values
    column = np.full(len(values), -1)
    column[free] = np.arange(len(free))
    halfedges = np.flatnonzero(mesh.twin >= 0)
    halfedges = halfedges[~known[halfedges // 3]]
    here, there = halfedges // 3, mesh.twin[halfedges] // 3
    # length of the edge over the distance of the centroids from it: the dual cotangent
    stiffness = 1.5 * mesh.edge_lengths[halfedges] ** 2 / (mesh.areas[here] + mesh.areas[there])
    # what the neighbour holds, seen from here
    pull = stiffness * np.exp(1j * turns * transport(mesh)[mesh.twin[halfedges]])
    data = (mesh.areas * weights)[free]
    diagonal = np.bincount(column[here], stiffness, len(free)) * (1.0 + _HOLD) + data
    right = data * values[free]
    fixed = known[there]
    np.add.at(right, column[here[fixed]], (pull * values[there])[fixed])
    size = len(free)
    rows = np.concatenate([column[here[~fixed]], np.arange(size)])
    columns = np.concatenate([column[there[~fixed]], np.arange(size)])
    entries = np.concatenate([-pull[~fixed], diagonal + 0j])
    matrix: Any = coo_matrix((entries, (rows, columns)), shape=(size, size)).tocsc()
    solution = values.copy()
    solution[free] = splu(matrix).solve(right)
    return solution
