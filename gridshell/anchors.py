"""What holds the shape while the conditions are met: a required choice, never a default.

With a free boundary every energy can be small while edges collapse or the net flattens, so the
caller says what is held: nothing, named vertices, the boundary, or the boundary's curves.
"""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise
from typing import Protocol

import numpy as np

from gridshell.arrays import Indices, Mask, Points
from gridshell.constraints import Glide, smooth_curve
from gridshell.errors import SettingError
from gridshell.mesh import ControlMesh, QuadMesh, diagonal_meshes
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

    def restricted(self, vertices: Indices) -> Anchor:
        """The anchor of a coarser mesh that keeps *vertices* (k,), in their new order."""


@dataclass(frozen=True)
class Free:
    """Nothing is held but the fairness of the change: form-finding with a free boundary."""

    def restricted(self, vertices: Indices) -> Free:
        """Itself: it names no vertex."""
        return self

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

    def restricted(self, vertices: Indices) -> Pinned:
        """The pins among *vertices*."""
        return Pinned(tuple(np.flatnonzero(np.isin(vertices, self.vertices)).tolist()))

    def hold(self, control: ControlMesh, x: Points) -> Hold:
        """The named vertices.

        Raises
        ------
        SettingError
            For an index outside the mesh.
        """
        twice = [v for k, v in enumerate(self.vertices) if v in self.vertices[:k]]
        if twice:
            raise SettingError(
                "A vertex is pinned twice", where=f"vertices, vertex {twice[0]}", limit="once"
            )
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

    def restricted(self, vertices: Indices) -> BoundaryPinned:
        """Itself: it names no vertex."""
        return self

    def hold(self, control: ControlMesh, x: Points) -> Hold:
        """The vertices of all boundary runs."""
        runs = [run.vertices for run in boundary_runs(control)]
        return Hold(np.unique(np.concatenate(runs)) if runs else np.empty(0, dtype=np.int64))


@dataclass(frozen=True)
class BoundaryGlide:
    """Boundary vertices move along the boundary's own curves; corners stay."""

    def restricted(self, vertices: Indices) -> BoundaryGlide:
        """Itself: it names no vertex."""
        return self

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
    those of the faces of D1 and the outer teeth are free.
    """
    runs: list[Run] = []
    teeth = np.zeros(len(control.vertices), dtype=bool)
    for loop in control.mesh.boundary_loops:
        corner = control.mesh.valence[loop] != 2
        if 2 * np.count_nonzero(corner) > len(loop):
            teeth[loop] = True
        else:
            runs.extend(_between(loop, corner))
    if teeth.any():
        runs.extend(_rim_of_faces(control, teeth))
    return tuple(runs)


def _rim_of_faces(control: ControlMesh, teeth: Mask) -> list[Run]:
    """Boundary runs of D1's quads along the loops of C whose vertices are marked."""
    net = diagonal_meshes(control)[0]
    quads = net.faces[(net.faces[:, :4] >= 0).all(axis=1) & (net.faces[:, 4:] < 0).all(axis=1), :4]
    if len(quads) == 0:
        return []
    faces = QuadMesh(net.vertices, quads)
    runs: list[Run] = []
    for loop in faces.boundary_loops:
        vertices = net.control_vertices[loop]
        if teeth[vertices].any():
            runs.extend(_between(vertices, faces.valence[loop] != 2))
    return runs


def _between(loop: Indices, corner: Mask) -> list[Run]:
    """Split a loop at its corners."""
    corners = np.flatnonzero(corner)
    if len(corners) == 0:
        return [Run(loop, True)]
    turned = np.roll(loop, -corners[0])
    turned = np.r_[turned, turned[0]]
    stops = np.r_[corners - corners[0], len(loop)]
    return [Run(turned[a : b + 1], False) for a, b in pairwise(stops)]
