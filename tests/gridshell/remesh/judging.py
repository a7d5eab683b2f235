"""A quad mesh judged by the exact surface alone, without the code that made it."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from gridshell.arrays import unit
from gridshell.errors import GridshellError
from gridshell.folding import collapsed, folded_pairs
from gridshell.mesh import QuadMesh, control_mesh, corner_parity, diagonal_meshes, two_colouring


def asymptotic_lines(shapes, normals):
    """Both lines (n, 2, 3) without normal curvature."""
    axes, mean, half = _principal(shapes, normals)
    turn = np.arccos(np.clip(mean / half, -1.0, 1.0)) / 2.0
    return np.stack([_turned(axes, -turn), _turned(axes, turn)], axis=1)


def principal_lines(shapes, normals):
    axes, _, _ = _principal(shapes, normals)
    return axes


def conjugate_lines(angle, hand):
    """Both lines (n, 2, 3) of eq. 3; *hand* +1 is right."""

    def lines(shapes, normals):
        axes, mean, half = _principal(shapes, normals)
        phi = (np.arccos(np.clip(mean / half * np.cos(angle), -1.0, 1.0)) - angle) / 2.0
        first = phi if hand > 0 else -phi - angle
        return np.stack([_turned(axes, first), _turned(axes, first + angle)], axis=1)

    return lines


def _principal(shapes, normals):
    """Axes (n, 2, 3) of k1 < k2, right-handed about the normals, H and D."""
    helper = np.eye(3)[np.argmin(np.abs(normals), axis=1)]
    e1 = unit(np.cross(normals, helper))
    frame = np.stack([e1, np.cross(normals, e1)], axis=1)
    local = frame @ shapes @ frame.transpose(0, 2, 1)
    values, vectors = np.linalg.eigh(local)
    axis = np.einsum("ni,nic->nc", vectors[:, :, 0], frame)
    half = (values[:, 1] - values[:, 0]) / 2.0
    axes = np.stack([axis, np.cross(normals, axis)], axis=1)
    return axes, values.mean(axis=1), np.maximum(half, 1e-300)


def _turned(axes, angle):
    return np.cos(angle)[:, None] * axes[:, 0] + np.sin(angle)[:, None] * axes[:, 1]


def strays(mesh, shapes_at, lines):
    """(e,) degrees between every edge of the mesh and the nearer line at its middle."""
    a, b = mesh.vertices[mesh.edges.T]
    normals, shapes = shapes_at((a + b) / 2.0)
    both = lines(shapes, normals)
    along = b - a
    along = unit(along - np.einsum("nc,nc->n", along, normals)[:, None] * normals)
    cosine = np.abs(np.einsum("nc,nkc->nk", along, both)).max(axis=1)
    return np.degrees(np.arccos(np.minimum(cosine, 1.0)))


@dataclass(frozen=True)
class Faults:
    """What must be nought, but for the counts."""

    odd: int
    conflicts: int
    control_conflicts: int
    bad_diagonal_faces: int
    collapsed: int
    folded: int
    control: int

    @property
    def none(self):
        counts = (self.odd, self.conflicts, self.control_conflicts, self.bad_diagonal_faces)
        return not any(counts) and not self.collapsed and not self.folded


def faults(mesh):
    """Everything that may be wrong with the net's combinatorics and shape."""
    inner = ~mesh.on_boundary & (mesh.valence > 0)
    odd = int(np.count_nonzero(mesh.valence[inner] % 2))
    conflicts = control_conflicts = bad = count = 0
    try:
        two_colouring(mesh)
        corner_parity(mesh)
    except GridshellError:
        conflicts = 1
    try:
        control = control_mesh(mesh)
        count = len(control.quads)
        two_colouring(control.mesh)
        net = diagonal_meshes(control)[0]
        # a face of D1 surrounds a vertex of D2: singular vertices are in D1
        bad = int(np.count_nonzero((net.faces >= 0).sum(axis=1) != 4)) if len(net.faces) else 0
    except GridshellError:
        control_conflicts = 1
    return Faults(
        odd,
        conflicts,
        control_conflicts,
        bad,
        int(np.count_nonzero(collapsed(mesh.vertices, mesh.quads, mesh.mean_edge))),
        len(folded_pairs(mesh.vertices, mesh)),
        count,
    )


def star_planarity(mesh):
    """(k,) largest distance of the neighbours of a vertex from the best plane through it, over the
    mean edge of its star; of vertices whose neighbours lie inside as well."""
    found = []
    for v in np.flatnonzero(~mesh.on_boundary & (mesh.valence > 0)):
        spokes = mesh.fans[v]
        around = mesh.target[spokes[spokes >= 0]]
        if mesh.on_boundary[around].any():
            continue  # what lies beyond the rim is continued, not known
        arms = mesh.vertices[around] - mesh.vertices[v]
        normal = np.linalg.svd(arms)[2][2]
        found.append(np.abs(arms @ normal).max() / np.linalg.norm(arms, axis=1).mean())
    return np.array(found)


def face_planarity(mesh):
    """(f,) distance of the two diagonals over their mean length."""
    a, b, c, d = np.moveaxis(mesh.vertices[mesh.quads], 1, 0)
    normal = np.cross(c - a, d - b)
    mean = (np.linalg.norm(c - a, axis=1) + np.linalg.norm(d - b, axis=1)) / 2.0
    gap = np.abs(np.einsum("nc,nc->n", b - a, normal)) / np.linalg.norm(normal, axis=1)
    return gap / mean


def node_angles(control):
    """(f,) degrees between the diagonals of every quad of the control mesh."""
    a, b, c, d = np.moveaxis(control.vertices[control.quads], 1, 0)
    cosine = np.einsum("nc,nc->n", unit(c - a), unit(d - b))
    return np.degrees(np.arccos(np.clip(cosine, -1.0, 1.0)))


def crossing_points(mesh: QuadMesh):
    """Quads as sorted rows of positions: the mesh without its numbering."""
    rows = np.round(mesh.vertices[mesh.quads].mean(axis=1), 6)
    return rows[np.lexsort(rows.T)]


def inner_strays(mesh, shapes_at, lines):
    """As `strays`, of the edges with an end inside: what lies beyond the rim has no truth."""
    a, b = mesh.edges.T
    return strays(mesh, shapes_at, lines)[~(mesh.on_boundary[a] | mesh.on_boundary[b])]
