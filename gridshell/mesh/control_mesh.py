"""The control mesh C: a quad mesh whose two diagonals per quad belong to known families.

Glossary, do not confuse: the *family* of a diagonal (1 or 2: what eq. 4 of the paper needs) and
the *diagonal mesh* it lies in (D1 or D2, by the colour of its ends) are independent labels.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from gridshell.arrays import Indices, Points, frozen
from gridshell.errors import MeshError
from gridshell.mesh.coloring import corner_parity, two_colouring
from gridshell.mesh.pieces import main_piece
from gridshell.mesh.quad_mesh import QuadMesh, position

_LEAST_PIECE = 0.5
"""More than this share of the quads hangs together over edges; what is hinged on is left out."""


@dataclass(frozen=True, eq=False)
class ControlMesh:
    """A quad mesh with labelled diagonals; build it with :func:`as_control_mesh`.

    Parameters
    ----------
    mesh : corners 0 and 2 of every quad are joined by the diagonal of family 1, corners 1 and 3
        by that of family 2.
    colour : (n,) 0 for the vertices of D1, 1 for those of D2, -1 for an unused vertex, or for all
        where the families are not known (:func:`without_families`).
    """

    mesh: QuadMesh
    colour: Indices

    def __post_init__(self) -> None:
        object.__setattr__(self, "colour", frozen(self.colour, np.int64))

    @property
    def vertices(self) -> Points:
        """(n, 3) positions, mm."""
        return self.mesh.vertices

    @property
    def quads(self) -> Indices:
        """(f, 4) vertex indices; v0-v2 is the diagonal of family 1."""
        return self.mesh.quads

    def moved(self, vertices: Points) -> ControlMesh:
        """The same labels at other positions."""
        return ControlMesh(self.mesh.moved(vertices), self.colour)

    def families_exchanged(self) -> ControlMesh:
        """The same mesh with family 1 called 2 and family 2 called 1."""
        quads = np.roll(self.quads, -1, axis=1)
        return ControlMesh(QuadMesh(self.vertices, quads), self.colour)

    def _repr_html_(self) -> str:
        """For notebooks."""
        from gridshell.mesh.showing import control_mesh_html

        return control_mesh_html(self)


def as_control_mesh(mesh: QuadMesh) -> ControlMesh:
    """Take *mesh* itself as the control mesh and label its diagonals.

    D1 (colour 0) is the diagonal mesh that holds the singular vertices, so that its faces are
    quads; where neither or both hold some, the one with fewer loose ends (vertices that only one
    diagonal reaches), and where both have the same number, the one of the smallest vertex.

    Raises
    ------
    OddValenceError, ColouringError
        Where the labels cannot be continued (Fig. 4 of the paper).
    """
    shift = corner_parity(mesh)
    corners = (np.arange(4)[None, :] + shift[:, None]) % 4
    rolled = QuadMesh(mesh.vertices, np.take_along_axis(mesh.quads, corners, axis=1))
    colour = two_colouring(rolled)
    if _second_first(rolled, colour):
        colour = np.where(colour < 0, -1, 1 - colour)
    return ControlMesh(rolled, colour)


def _second_first(mesh: QuadMesh, colour: Indices) -> bool:
    """Whether colour 1 is that of D1."""
    singular = ~mesh.on_boundary & (mesh.valence > 0) & (mesh.valence != 4)
    held = [bool((singular & (colour == c)).any()) for c in (0, 1)]
    if held[0] != held[1]:
        return held[1]
    loose = [int(np.count_nonzero((mesh.valence == 1) & (colour == c))) for c in (0, 1)]
    return loose[0] > loose[1]


def without_families(mesh: QuadMesh) -> ControlMesh:
    """Take *mesh* as it is, its families unknown: enough for planar faces or stars of its edges.

    The way in for meshes with singularities of odd valence. Nothing that needs an angle, D1 or D2
    can be asked of it.
    """
    return ControlMesh(mesh, np.full(len(mesh.vertices), -1, dtype=np.int64))


def control_mesh(mesh: QuadMesh) -> ControlMesh:
    """The mesh C of the red vertices of *mesh*: its diagonals follow the edges of *mesh* (Fig. 6).

    Red is the colour of the singular vertices, so that every quad of C surrounds a regular blue
    vertex. An edge of D1 spans two edges of *mesh*. Quads of C that touch the others in a vertex
    only, as they occur at a ragged rim, are left out.

    Raises
    ------
    MeshError
        When both colours hold singular vertices, or the mesh is too small or too narrow.
    OddValenceError, ColouringError
        As :func:`as_control_mesh`.
    """
    corner_parity(mesh)
    colour = two_colouring(mesh)
    inner = ~mesh.on_boundary & (mesh.valence > 0)
    singular = inner & (mesh.valence != 4)
    blue = 0 if (colour[singular] == 1).any() else 1
    wrong = np.flatnonzero(singular & (colour == blue))
    if len(wrong):
        v = int(wrong[0])
        raise MeshError(
            "Singular vertices have both colours: the control mesh would need other than quads",
            where=f"vertex {v} {position(mesh.vertices[v])}",
            value=f"valence {mesh.valence[v]}",
            advice="halve every quad of the mesh once: all singular vertices then share a colour",
        )
    centres = np.flatnonzero(inner & (colour == blue))
    if len(centres) == 0:
        raise MeshError(
            "The mesh is too small to hold a control mesh",
            value=f"{len(mesh.quads)} quads",
            limit="at least one interior vertex of the second colour",
            advice="use a finer mesh",
        )
    rings = mesh.target[mesh.fans[centres, :4]]
    kept = main_piece(rings)
    if len(rings) > 1 and np.count_nonzero(kept) <= _LEAST_PIECE * len(rings):
        raise MeshError(
            "The mesh is too narrow to hold a control mesh",
            value=f"{len(mesh.quads)} quads",
            limit="three quads across everywhere",
            advice="use a finer mesh",
        )
    rings = rings[kept]
    used, quads = np.unique(rings, return_inverse=True)
    return as_control_mesh(QuadMesh(mesh.vertices[used], quads.reshape(rings.shape)))
