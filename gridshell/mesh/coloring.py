"""Alternating colours: vertices red and blue, face corners even and odd.

Both colourings exist on a quad mesh exactly when every closed walk agrees with itself. An interior
vertex of odd valence breaks the corner parity (Fig. 4 of the paper); a closed strip of odd length
breaks the vertex colours.
"""

from __future__ import annotations

import numpy as np

from gridshell.arrays import Indices
from gridshell.errors import ColouringError, OddValenceError
from gridshell.mesh.parity import alternating_labels
from gridshell.mesh.quad_mesh import QuadMesh, position


def two_colouring(mesh: QuadMesh) -> Indices:
    """Colour 0 or 1 for each vertex so that no edge joins two of one colour.

    Returns
    -------
    (n,) colours; the smallest vertex of every component gets 0, an unused vertex -1.

    Raises
    ------
    ColouringError
        When a closed strip of quads has an odd number of edges across (an odd annulus).
    """
    a, b = mesh.edges.T
    colour = alternating_labels(len(mesh.vertices), a, b, np.ones(len(a), dtype=bool))
    clash = np.flatnonzero(colour[a] == colour[b])
    if len(clash):
        i, j = int(a[clash[0]]), int(b[clash[0]])
        raise ColouringError(
            "The vertices cannot be coloured alternately: a closed strip has an odd length",
            where=f"edge {i}-{j} {position((mesh.vertices[i] + mesh.vertices[j]) / 2)}",
            limit="an even number of quads around every hole",
            advice="add or remove one quad around the ring",
        )
    colour[mesh.valence == 0] = -1
    return colour


def corner_parity(mesh: QuadMesh) -> Indices:
    """First corner (0 or 1) of each quad's family-1 diagonal, continued from quad to quad.

    Diagonals of family 1 form fair polylines: around a vertex the families alternate, so the
    slot parity of a shared vertex alternates from one quad to the next (Fig. 4 of the paper).

    Returns
    -------
    (f,) shifts s such that corners s and s + 2 carry family 1; the first quad gets 0.

    Raises
    ------
    OddValenceError
        At an interior vertex with an odd number of quads.
    ColouringError
        When a closed strip turns one family into the other without a singular vertex.
    """
    interior = ~mesh.on_boundary & (mesh.valence > 0)
    odd = np.flatnonzero(interior & (mesh.valence % 2 == 1))
    if len(odd):
        v = int(odd[0])
        raise OddValenceError(
            "A singularity of odd valence: the two families cannot be told apart around it",
            where=f"vertex {v} {position(mesh.vertices[v])}",
            value=f"valence {mesh.valence[v]}",
            limit="even valences (4, 6, 8, ...)",
            advice="move the singularity to a hole or the boundary, or merge two odd ones",
        )
    inner = np.flatnonzero(mesh.twin > np.arange(len(mesh.twin)))
    other = mesh.twin[inner]
    # origin of `inner` sits in slot inner % 4 here and in slot (other + 1) % 4 there
    same_slot_parity = (inner % 4 + other % 4 + 1) % 2 == 0
    shift = alternating_labels(len(mesh.quads), inner // 4, other // 4, same_slot_parity)
    clash = np.flatnonzero((shift[inner // 4] ^ shift[other // 4]) != same_slot_parity)
    if len(clash):
        f = int(inner[clash[0]] // 4)
        raise ColouringError(
            "The families of diagonals change places around a closed strip",
            where=f"quad {f} {position(mesh.vertices[mesh.quads[f]].mean(axis=0))}",
            limit="an even number of turns around every hole",
            advice="cut the strip open there",
        )
    return shift
