"""The three skins of a control mesh: D1, D2 or the checkerboard pattern P, with their node axes.

The axis at a vertex of D1 is the normal of the face of D2 around it, and the reverse (Fig. 3 of the
paper): both are the ring of that vertex's neighbours along the edges of C. An edge e of D1 crosses
an edge e' of D2 in a quad of C, and both end axes of e are perpendicular to e'. Where the node
angle is 90 degrees e is, too, so the two axes and e lie in one plane and a support plate between
them is flat. At another angle they do not.

At the rim of C the ring is incomplete. Three neighbours still span a plane, four and more of an
open ring take the plane of the polygon they close, and the single quad at a corner gives the normal
of its parallelogram: in the first and the last case the axis stays perpendicular to every e'
that crosses an edge there, so plates at 90 degrees are flat up to the rim.

A vertex of P is the middle of an edge of C and lies between two white faces, halves of a face of D1
and one of D2; its axis is the bisector of their normals, i.e. of the axes at the edge's ends. At 90
degrees that leaves a twist of third order in the panel size: a hundredth of what D1 may have.
"""

from __future__ import annotations

from enum import Enum

import numpy as np

from gridshell.arrays import Indices, Mask, Vectors, unit
from gridshell.errors import MeshError
from gridshell.mesh.checkerboard import checkerboard
from gridshell.mesh.control_mesh import ControlMesh
from gridshell.mesh.diagonals import diagonal_meshes
from gridshell.mesh.panel_mesh import PanelMesh, area_vectors, panel_mesh
from gridshell.mesh.stars import edge_stars


class Skin(Enum):
    """Which mesh carries the panels."""

    D1 = "d1"
    D2 = "d2"
    PATTERN = "pattern"


def skin(control: ControlMesh, which: Skin) -> PanelMesh:
    """The panels of D1, D2 or P with their node axes.

    Panels are flat as far as *control* is a net of planar white quads (``pq_net``). Diagonals that
    bound no complete face, at the rim, are left out.

    Raises
    ------
    MeshError
        Where the families are not known, or the net is too small to hold a face.
    """
    if (control.colour < 0).all():
        raise MeshError(
            "The diagonal meshes need a mesh whose families are known",
            advice="as_control_mesh() in place of without_families()",
        )
    axes, partial = node_axes(control)
    if which is Skin.PATTERN:
        pattern = checkerboard(control)
        a, b = control.mesh.edges.T
        faces = _stacked(pattern.black, pattern.white)
        black = np.arange(len(faces)) < len(pattern.black)
        between = axes[a] + axes[b]
        rim = partial[a] | partial[b]
        return panel_mesh(pattern.vertices, faces, between, partial=rim, black=black)
    net = diagonal_meshes(control)[0 if which is Skin.D1 else 1]
    own = net.control_vertices
    return panel_mesh(net.vertices, net.faces, axes[own], partial=partial[own])


def node_axes(control: ControlMesh) -> tuple[Vectors, Mask]:
    """The axis at every vertex of the control mesh: the normal of its ring of neighbours.

    Returns
    -------
    axes : (n, 3) unit, on the counter-clockwise side; nought at a vertex without quads.
    partial : (n,) whether the ring is incomplete.
    """
    mesh = control.mesh
    stars = edge_stars(mesh)
    normal = area_vectors(control.vertices, stars.spokes)
    alone = np.flatnonzero(mesh.valence == 1)
    corners = control.vertices[mesh.quads[mesh.first_spoke[alone] // 4]]
    first, second = corners[:, 2] - corners[:, 0], corners[:, 3] - corners[:, 1]
    normal[alone] = np.cross(first, second)
    normal[mesh.valence == 0] = 0.0
    return unit(normal), ~stars.closed


def _stacked(first: Indices, second: Indices) -> Indices:
    width = max(first.shape[1], second.shape[1])
    padded = [
        np.pad(f, ((0, 0), (0, width - f.shape[1])), constant_values=-1) for f in (first, second)
    ]
    return np.concatenate(padded)
