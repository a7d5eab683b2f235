"""One sound quad mesh from the cells that were found: what cannot belong to it is left out."""

from __future__ import annotations

import numpy as np

from gridshell.arrays import Indices, Mask, Points
from gridshell.errors import TargetTooCoarseError
from gridshell.folding import collapsed
from gridshell.mesh import QuadMesh, main_piece
from gridshell.remesh.extent import Cells
from gridshell.remesh.extraction import Extracted
from gridshell.surface.triangle_mesh import place

_ROUNDS = 8


def require_around(found: Extracted, positions: Points, spacing: float) -> None:
    """Refuse a net that closes up around a hole, a neck or a tube after one or two cells.

    Its vertices would be joined by two edges, or one with itself, which no mesh can say.

    Parameters
    ----------
    positions : (c, 3) of the crossings, mm.
    spacing : edge that was asked for, mm.

    Raises
    ------
    TargetTooCoarseError
        Naming the place of the first such edge.
    """
    reverse, owner = found.traced.reverse, found.ports.owner
    of_cell = np.zeros(len(owner), dtype=bool)
    of_cell[found.cell_ports] = True
    port = np.flatnonzero(reverse > np.arange(len(owner)))
    port = port[of_cell[port] | of_cell[reverse[port]]]
    a, b = owner[port], owner[reverse[port]]
    name = np.minimum(a, b) * len(positions) + np.maximum(a, b)
    _, number, count = np.unique(name, return_inverse=True, return_counts=True)
    bad = np.flatnonzero((count[number] > 1) | (a == b))
    if len(bad):
        middle = (positions[a[bad[0]]] + positions[b[bad[0]]]) / 2.0
        raise TargetTooCoarseError(
            "The quads are too large to go around a hole, a neck or a tube of the surface",
            where=place(middle),
            value=f"edges of {spacing:.4g} mm, of which one or two close up",
            limit="three around",
            advice=f"more quads, or edges of {spacing / 2.0:.3g} mm",
        )


def tidy(made: Cells, spacing: float) -> QuadMesh:
    """The main piece of the cells, as a mesh of its own; of two on one side the first stays.

    Parameters
    ----------
    spacing : edge that was asked for, mm.

    Raises
    ------
    TargetTooCoarseError
        When no cell is left.
    """
    quads = _without_spoilt_ends(made, spacing)
    for _ in range(_ROUNDS):  # what was left out may have held others together
        good = _single(quads)
        quads = quads[good]
        held = main_piece(quads)
        quads = quads[held]
        if good.all() and held.all():
            break
    if len(quads) == 0:
        raise TargetTooCoarseError(
            "No quad fits on the surface",
            where=_middle(made.positions),
            value=f"edges of {spacing:.4g} mm",
            limit="several on the surface",
            advice=f"more quads, or edges of {spacing / 2.0:.3g} mm",
        )
    used, compact = np.unique(quads, return_inverse=True)
    return QuadMesh(made.positions[used], compact.reshape(-1, 4))


def _without_spoilt_ends(made: Cells, spacing: float) -> Indices:
    """Cells at the rim that are turned over, slivers, or folded onto others are left out."""
    spoilt = collapsed(made.positions, made.quads, spacing)
    spoilt[: made.whole] = False
    quads = made.quads[~spoilt]
    sides = np.stack([quads, np.roll(quads, -1, axis=1)], axis=-1).reshape(-1, 2)
    order = np.lexsort(np.sort(sides, axis=1).T)
    named = np.sort(sides, axis=1)[order]
    same = np.flatnonzero((named[1:] == named[:-1]).all(axis=1))
    pairs = np.stack([order[same] // 4, order[same + 1] // 4], axis=1)
    corners = made.positions[quads]
    normal = np.cross(corners[:, 2] - corners[:, 0], corners[:, 3] - corners[:, 1])
    folded = pairs[np.einsum("kc,kc->k", normal[pairs[:, 0]], normal[pairs[:, 1]]) < 0.0]
    outside = np.unique(folded.max(axis=1))
    return np.asarray(np.delete(quads, outside[outside >= made.whole], axis=0))


def _middle(positions: Points) -> str | None:
    good = positions[np.isfinite(positions).all(axis=1)]
    return place(good.mean(axis=0)) if len(good) else None


def _single(quads: Indices) -> Mask:
    """(q,) quads with four different corners that are the first on each of their sides."""
    if len(quads) == 0:
        return np.zeros(0, dtype=bool)
    kept = np.flatnonzero((np.diff(np.sort(quads, axis=1), axis=1) > 0).all(axis=1))
    sides = quads[kept] * (int(quads.max()) + 1) + np.roll(quads[kept], -1, axis=1)
    _, first, number = np.unique(sides, return_index=True, return_inverse=True)
    own = first[number].reshape(-1, 4) == np.arange(sides.size).reshape(-1, 4)
    good = np.zeros(len(quads), dtype=bool)
    good[kept] = own.all(axis=1)
    return good
