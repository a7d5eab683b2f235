"""What holds the shape while the conditions are met: a required choice, never a default.

With a free boundary every energy can be small while edges collapse or the net flattens, so the
caller says what is held: nothing, named vertices, the boundary, or the boundary's curves.
"""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise
from typing import Protocol

import numpy as np

from gridshell.arrays import Indices, Points
from gridshell.constraints import Glide, smooth_curve
from gridshell.errors import SettingError
from gridshell.mesh import ControlMesh
from gridshell.solve import Term, Weight


@dataclass(frozen=True, eq=False)
class Hold:
    """What an anchor asks of the solver.

    Parameters
    ----------
    vertices : (k,) control vertices that do not move.
    terms : conditions on the others.
    """

    vertices: Indices
    terms: tuple[Term, ...] = ()


class Anchor(Protocol):
    """Anything that can hold a net."""

    def hold(self, control: ControlMesh, x: Points) -> Hold:
        """What is held, for vertex positions *x* (n, 3) at unit mean edge."""


@dataclass(frozen=True)
class Free:
    """Nothing is held but the fairness of the change: form-finding with a free boundary."""

    def hold(self, control: ControlMesh, x: Points) -> Hold:
        """No vertex, no term."""
        return Hold(np.empty(0, dtype=np.int64))


@dataclass(frozen=True)
class Pinned:
    """Named control vertices stay where they are.

    Parameters
    ----------
    vertices : indices into the control mesh.
    """

    vertices: tuple[int, ...]

    def hold(self, control: ControlMesh, x: Points) -> Hold:
        """The named vertices.

        Raises
        ------
        SettingError
            For an index outside the mesh.
        """
        wrong = [v for v in self.vertices if not 0 <= v < len(x)]
        if wrong:
            raise SettingError(
                "A pinned vertex does not exist",
                where="vertices",
                value=str(wrong[0]),
                limit=f"0 .. {len(x) - 1}",
            )
        return Hold(np.unique(np.array(self.vertices, dtype=np.int64)))


@dataclass(frozen=True)
class BoundaryPinned:
    """The net's boundary vertices stay where they are."""

    def hold(self, control: ControlMesh, x: Points) -> Hold:
        """The vertices of all boundary runs."""
        runs = [run.vertices for run in boundary_runs(control)]
        return Hold(np.unique(np.concatenate(runs)) if runs else np.empty(0, dtype=np.int64))


@dataclass(frozen=True)
class BoundaryGlide:
    """Boundary vertices move along the boundary's own curves; corners stay."""

    def hold(self, control: ControlMesh, x: Points) -> Hold:
        """Corners, and one gliding term per run of the boundary."""
        fixed: list[Indices] = []
        terms: list[Term] = []
        for number, run in enumerate(boundary_runs(control)):
            inner = run.vertices if run.closed else run.vertices[1:-1]
            if not run.closed:
                fixed.append(run.vertices[[0, -1]])
            if len(inner):
                curve = smooth_curve(x[run.vertices], closed=run.closed)
                terms.append(Term(f"glide {number}", Weight(1.0), Glide(inner, curve)))
        held = np.unique(np.concatenate(fixed)) if fixed else np.empty(0, dtype=np.int64)
        return Hold(held, tuple(terms))


@dataclass(frozen=True, eq=False)
class Run:
    """A stretch of boundary between two corners, or a whole loop without corners.

    Parameters
    ----------
    vertices : (k,) control vertices in order; the corners are the first and the last.
    closed : whether the run is a loop.
    """

    vertices: Indices
    closed: bool


def boundary_runs(control: ControlMesh) -> tuple[Run, ...]:
    """The boundary between its corners.

    Where the control mesh has a zigzag rim (its diagonals follow the boundary), the runs are
    those of D1's straight boundary and the outer teeth are free.
    """
    valence = control.mesh.valence
    runs: list[Run] = []
    for loop in control.mesh.boundary_loops:
        straight = np.count_nonzero(valence[loop] == 2)
        if 2 * straight >= len(loop):
            vertices, corner = loop, valence[loop] != 2
        else:
            vertices = loop[(control.colour[loop] == 0) & (valence[loop] >= 2)]
            corner = valence[vertices] == 2
        if len(vertices):
            runs.extend(_between(vertices, np.flatnonzero(corner)))
    return tuple(runs)


def _between(loop: Indices, corners: Indices) -> list[Run]:
    if len(corners) == 0:
        return [Run(loop, True)]
    turned = np.roll(loop, -corners[0])
    stops = np.r_[corners - corners[0], len(loop)]
    turned = np.r_[turned, turned[0]]
    return [Run(turned[a : b + 1], False) for a, b in pairwise(stops)]
