"""Finer triangles around singular points, with the field and the curvature carried over.

The chart of a quad mesh has to turn fully around a singular vertex; more triangles there give it
room. Every edge opposite a singular vertex is halved, so that the vertex has twice the triangles.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from gridshell.arrays import Floats, Indices, Mask, Points, Vectors, unit
from gridshell.field.frame_field import FrameField
from gridshell.surface.curved_mesh import CurvedMesh
from gridshell.surface.triangle_mesh import TriangleMesh, after

# Children of a triangle by its number of halved edges, over corners 0 1 2 and midpoints 3 4 5 of
# the edges 01 12 20. One: edge 01. Two: edges 01 and 12.
_CHILDREN = {
    1: [[0, 3, 2], [3, 1, 2]],
    2: [[3, 1, 4], [0, 3, 4], [0, 4, 2]],
    3: [[0, 3, 5], [3, 1, 4], [5, 4, 2], [3, 4, 5]],
}


class Refined(NamedTuple):
    """A refined mesh; old vertices keep their numbers, untouched triangles come first."""

    curved: CurvedMesh
    field: FrameField
    vertex_parents: Indices
    """(k, 2) the two old vertices between which each new vertex stands, in the order of the new
    vertices."""
    face_parents: Indices
    """(f,) the old triangle each new one is or is a part of."""


def split_links(curved: CurvedMesh, field: FrameField, vertices: Indices) -> Refined:
    """Halve every edge opposite one of *vertices* (k,); children copy directions and curvature.

    New vertices stand on the mean of the two quadrics of their parents, not on the chord.
    """
    mesh = curved.mesh
    at = np.zeros(len(mesh.vertices), dtype=bool)
    at[vertices] = True
    links = after(np.flatnonzero(at[mesh.origin]))
    halved = np.zeros(len(mesh.twin), dtype=bool)
    halved[links] = True
    halved[mesh.twin[links][mesh.twin[links] >= 0]] = True
    parents, midpoints = _midpoints(mesh, halved)
    triangles, face_parents = _children(mesh.triangles, halved.reshape(-1, 3), midpoints)
    points, normals, shapes = _lifted(curved, parents)
    finer = TriangleMesh(np.concatenate([mesh.vertices, points]), triangles)
    turn = _turns(mesh, finer, face_parents)
    carried = CurvedMesh(
        finer,
        np.concatenate([curved.normals, normals]),
        np.concatenate([curved.shapes, shapes]),
        _turned(curved.face_shapes[face_parents], turn),
    )
    first, second = field.first[face_parents] - turn, field.second[face_parents] - turn
    copied = FrameField(finer, first, second, field.infeasible[face_parents])
    return Refined(carried, copied, parents, face_parents)


def _midpoints(mesh: TriangleMesh, halved: Mask) -> tuple[Indices, Indices]:
    """Parents (k, 2) of the new vertices, and the new vertex (f, 3) on every edge or -1."""
    once = np.flatnonzero(halved & ((mesh.twin < 0) | (np.arange(len(halved)) < mesh.twin)))
    number = np.full(len(halved), -1, dtype=np.int64)
    number[once] = len(mesh.vertices) + np.arange(len(once))
    inner = once[mesh.twin[once] >= 0]
    number[mesh.twin[inner]] = number[inner]
    return np.stack([mesh.origin[once], mesh.target[once]], axis=1), number.reshape(-1, 3)


def _children(triangles: Indices, halved: Mask, midpoints: Indices) -> tuple[Indices, Indices]:
    count = halved.sum(axis=1)
    whole = np.flatnonzero(count == 0)
    parts, parents = [triangles[whole]], [whole]
    for n, children in _CHILDREN.items():
        faces = np.flatnonzero(count == n)
        # one halved edge comes first, one whole edge last
        start = np.argmax(halved[faces], axis=1) if n == 1 else np.argmin(halved[faces], axis=1) + 1
        start = np.zeros(len(faces), dtype=np.int64) if n == 3 else start
        turn = (start[:, None] + np.arange(3)) % 3
        corners = np.take_along_axis(triangles[faces], turn, axis=1)
        middles = np.take_along_axis(midpoints[faces], turn, axis=1)
        six = np.concatenate([corners, middles], axis=1)
        parts.append(six[:, np.array(children)].reshape(-1, 3))
        parents.append(np.repeat(faces, len(children)))
    return np.concatenate(parts), np.concatenate(parents)


def _lifted(curved: CurvedMesh, parents: Indices) -> tuple[Points, Vectors, Floats]:
    """Positions (k, 3), normals (k, 3), shapes (k, 3, 3) of the vertices between *parents*."""
    chord = curved.mesh.vertices[parents].mean(axis=1)
    normals = curved.normals[parents]
    offset = chord[:, None] - curved.mesh.vertices[parents]
    height = np.einsum("kpc,kpc->kp", normals, offset)
    tangent = offset - height[..., None] * normals
    bend = np.einsum("kpi,kpij,kpj->kp", tangent, curved.shapes[parents], tangent) / 2.0
    points = chord + ((bend - height)[..., None] * normals).mean(axis=1)
    normal = unit(normals.sum(axis=1))
    across = np.eye(3) - normal[:, :, None] * normal[:, None, :]
    shapes = across @ curved.shapes[parents].mean(axis=1) @ across
    return points, normal, (shapes + np.swapaxes(shapes, 1, 2)) / 2.0


def _turns(old: TriangleMesh, new: TriangleMesh, parents: Indices) -> Floats:
    """(f,) angle of each new frame's row 0 in the frame of its parent, rad; exactly 0 if equal."""
    carried = rotated(new.face_frames[:, 0], new.face_normals, old.face_normals[parents])
    frames = old.face_frames[parents]
    turn = np.arctan2(
        np.einsum("fc,fc->f", frames[:, 1], carried), np.einsum("fc,fc->f", frames[:, 0], carried)
    )
    same = (new.triangles == old.triangles[parents]).all(axis=1)
    return np.where(same, 0.0, turn)


def rotated(vectors: Vectors, normals: Vectors, onto: Vectors) -> Vectors:
    """*vectors* (..., 3) turned by the smallest rotation that takes *normals* to *onto*.

    Rodrigues' formula; the two must not be opposite.
    """
    axis = np.cross(normals, onto)
    cosine = np.einsum("...c,...c->...", normals, onto)[..., None]
    along = np.einsum("...c,...c->...", axis, vectors)[..., None]
    return np.asarray(vectors * cosine + np.cross(axis, vectors) + axis * (along / (1.0 + cosine)))


def _turned(shapes: Floats, turn: Floats) -> Floats:
    """Components 11, 12, 22 (f, 3) in a frame turned by *turn* (f,), rad."""
    a, b, c = shapes.T
    mean, half = (a + c) / 2.0, (a - c) / 2.0
    cos, sin = np.cos(2.0 * turn), np.sin(2.0 * turn)
    real, imaginary = half * cos + b * sin, b * cos - half * sin
    moved = np.stack([mean + real, imaginary, mean - real], axis=1)
    return np.where((turn == 0.0)[:, None], shapes, moved)
