"""A net that moves: node angles change, edges keep their lengths, stars stay planar (section 4.2).

Any net goes through the optimiser; few of them move at all. What does not is told by the verdict of
the position that was asked for.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from gridshell.anchors import Pinned
from gridshell.arrays import Floats, Indices, Points, frozen
from gridshell.conditions import EdgeLengths
from gridshell.errors import SettingError
from gridshell.mesh import DiagonalMesh, QuadMesh, without_families
from gridshell.optimization import OptimizedNet, optimize
from gridshell.recipes import a_net
from gridshell.terms import Planarity


@dataclass(frozen=True, eq=False)
class Mechanism:
    """A net at rest, what holds it and what moves it.

    Parameters
    ----------
    mesh : nodes and faces of the net at rest, mm; its edges keep their lengths.
    held : (h,) nodes that stay where they are.
    cables : (k, 2) pairs of nodes that are drawn together or let go.

    Raises
    ------
    SettingError
        Without cables, or for a node that does not exist.
    """

    mesh: QuadMesh
    held: Indices
    cables: Indices

    def __post_init__(self) -> None:
        object.__setattr__(self, "held", frozen(self.held, np.int64).ravel())
        object.__setattr__(self, "cables", frozen(self.cables, np.int64).reshape(-1, 2))
        if len(self.cables) == 0:
            raise SettingError("A motion needs a cable that drives it", where="cables")
        for key in ("held", "cables"):
            named = getattr(self, key)
            wrong = named[(named < 0) | (named >= len(self.mesh.vertices))]
            if len(wrong):
                raise SettingError(
                    "A node does not exist",
                    where=key,
                    value=str(wrong[0]),
                    limit=f"0 .. {len(self.mesh.vertices) - 1}",
                )

    def cable_lengths(self, nodes: Points) -> Floats:
        """(k,) lengths of the cables when the nodes lie at *nodes* (n, 3), mm."""
        a, b = nodes[self.cables.T]
        return np.asarray(np.linalg.norm(b - a, axis=1))

    def pulled(
        self, lengths: Floats, start: Points | None = None, *, steps: int = 30
    ) -> OptimizedNet:
        """The net with its cables at *lengths* (k,), mm.

        Parameters
        ----------
        start : (n, 3) where the search begins, mm; at rest unless said otherwise.

        Returns
        -------
        Its verdict says what resists where the net does not move so far.

        Raises
        ------
        SettingError
            For a length that is not positive, or another number of them.
        """
        recipe = a_net(
            planarity=Planarity.EDGE_STARS,
            conditions=(
                EdgeLengths(self.mesh.edges, self.mesh.edge_lengths),
                EdgeLengths(self.cables, np.broadcast_to(lengths, (len(self.cables),))),
            ),
            steps=steps,
        )
        anchor = Pinned(tuple(self.held.tolist()))
        return optimize(without_families(self.mesh), recipe, anchor=anchor, start=start)

    def motion(self, lengths: Sequence[Floats], start: Points | None = None) -> list[Points]:
        """Nodes (n, 3) at every one of *lengths*, each (k,); ends before the first that locks.

        Each search begins where the last two positions point to.
        """
        found: list[Points] = []
        for target in lengths:
            guess = start if not found else found[-1]
            if len(found) > 1:
                guess = 2.0 * found[-1] - found[-2]
            net = self.pulled(target, guess)
            if not net.converged:
                break
            found.append(net.control.vertices)
        return found


def quads_of(net: DiagonalMesh) -> QuadMesh:
    """The faces of a diagonal mesh as a mesh of their own, nodes numbered as in *net*."""
    full = (net.faces[:, :4] >= 0).all(axis=1) & (net.faces[:, 4:] < 0).all(axis=1)
    return QuadMesh(net.vertices, net.faces[full, :4])
