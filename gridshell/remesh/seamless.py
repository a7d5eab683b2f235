"""The seamless chart of a frame field: coordinates u, v whose integer lines are the quad mesh.

The weight of direction against spacing is lowered, rung by rung, only as far as the chart needs to
be free of folds and to have the right cone at every singular vertex.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from gridshell.arrays import Floats, Indices, Mask
from gridshell.field import FrameField, Singularities, matching
from gridshell.remesh.boundary_runs import aligned_runs
from gridshell.remesh.charts import Charts, charts
from gridshell.remesh.cut import Cut, cut_open
from gridshell.remesh.parametrization import Coordinate, Target, coordinate, ring, winding
from gridshell.remesh.spacing import integrating_factor
from gridshell.solve import Engine
from gridshell.surface import TriangleMesh

LADDER = ((100.0, False), (100.0, True), (30.0, False), (10.0, False), (3.0, False), (1.0, False))
"""Weight of direction against spacing, and whether the spacing follows an integrating factor."""

SOFT = 3.0
"""Weight of direction next to a singular vertex, at most."""

SOFTEST = 1.0
"""Weight of direction where triangles fold, at least: that of the isotropic energy."""

_STIFFENINGS = 5
_AROUND = 4.0
"""Times its own area that a folded triangle spoils."""

_FEW = 0.01
"""Share of the cells that folded triangles may spoil."""

_WORTH = 0.25
"""Of the spoilt cells that may be left for directions to be given up, where some stay spoilt."""

_WRONG_CONE = 0.1
"""Difference of a chart's angle sum from the right one that counts, radians."""


@dataclass(frozen=True, eq=False)
class Seamless:
    """A chart of the surface cut open.

    Parameters
    ----------
    mesh : the triangles.
    corners : (f, 3, 2) chart positions of the corners, multiples of ``parametrization.GRAIN``.
    flips : (3f,) +1 or -1 by which a position is multiplied across a half-edge.
    field_signs : (f,) signs of the frames in the chart: d1 times the sign points to growing u.
    lam : weight of direction that was needed.
    folded : (k,) triangles that are turned over or flat.
    cones : (k,) vertices whose angle sum is wrong.
    coordinates : how u and v were found.
    """

    mesh: TriangleMesh
    corners: Floats
    flips: Indices
    field_signs: Indices
    lam: float
    folded: Indices
    cones: Indices
    coordinates: tuple[Coordinate, Coordinate]


def seamless(
    field: FrameField,
    turns: Singularities,
    spacing: float,
    *,
    ladder: tuple[tuple[float, bool], ...] = LADDER,
    align_boundary: bool = True,
    engine: Engine | None = None,
) -> Seamless:
    """Find the chart in which both families are integer lines about *spacing* mm apart.

    Parameters
    ----------
    field : with the neighbourhoods of singular vertices cleaned and split.
    turns : its singular vertices.
    ladder : what is tried until the chart is free of folds; the last rung is kept as it is.
    align_boundary : keep boundaries that run along a family as lines of the mesh.

    Raises
    ------
    SolveError
        When the linear system cannot be factored.
    """
    work = _Work.of(field, turns, spacing, align_boundary, engine or Engine())
    best: Seamless | None = None
    for lam, by_factor in ladder:
        found = work.rung(lam, by_factor)
        worth = 1.0 if lam == ladder[0][0] or work.spoilt(found) <= _FEW * work.cells else _WORTH
        if best is None or work.spoilt(found) < worth * work.spoilt(best):
            best = found
        if work.spoilt(best) <= _FEW * work.cells:
            break
    assert best is not None
    return best


@dataclass(frozen=True, eq=False)
class _Work:
    """What stays the same from rung to rung."""

    field: FrameField
    turns: Singularities
    spacing: float
    cut: Cut
    unknowns: tuple[Charts, Charts]
    engine: Engine

    @classmethod
    def of(
        cls, field: FrameField, turns: Singularities, spacing: float, align: bool, engine: Engine
    ) -> _Work:
        mesh = field.mesh
        sign, rotation = matching(field)
        singular, half = _masks(mesh, turns)
        cut = cut_open(mesh, sign, rotation, half)
        middle = np.linalg.norm(mesh.vertices - mesh.centroids.mean(axis=0), axis=1)
        origin = int(np.argmin(middle))
        runs = [
            aligned_runs(field, family, 3.0 * spacing)
            if align
            else np.zeros(len(mesh.twin), dtype=bool)
            for family in (2, 1)  # u is constant along lines of family 2
        ]
        unknowns = [charts(mesh, cut, singular, run, origin=origin) for run in runs]
        return cls(field, turns, spacing, cut, (unknowns[0], unknowns[1]), engine)

    @property
    def cells(self) -> float:
        """Quads that the target spacing makes."""
        mesh = self.field.mesh
        return float((mesh.areas / np.sin(self.field.angle)).sum() / self.spacing**2)

    def spoilt(self, chart: Seamless) -> float:
        """Cells that the chart's faults spoil.

        Around folded triangles it is their share of the area, several times. A wrong cone where
        nothing is folded is a singular vertex that the field does not have, and a fold or a wrong
        cone at a singular vertex one that the net will not have: any of them spoils all.
        """
        mesh = self.field.mesh
        beside = np.zeros(len(mesh.vertices), dtype=bool)
        beside[mesh.triangles[chart.folded]] = True
        wrong = np.count_nonzero(~beside[chart.cones])
        beside[chart.cones] = True
        wrong += np.count_nonzero(beside[self.turns.vertices])
        share = len(chart.folded) / len(mesh.triangles)
        return self.cells * (_AROUND * share + wrong)

    def rung(self, lam: float, by_factor: bool) -> Seamless:
        """Solve with the weight *lam*, stiffening where triangles fold."""
        mesh = self.field.mesh
        lams = np.full(len(mesh.triangles), lam)
        near = ring(mesh, self.turns.vertices, 2)
        lams[near] = np.minimum(lam, SOFT)
        weight = np.ones(len(mesh.triangles))
        rises = self._rises(by_factor)
        best: Seamless | None = None
        for _ in range(_STIFFENINGS + 1):
            found = self._solve(lams, weight, lam, rises)
            if best is None or self.spoilt(found) < self.spoilt(best):
                best = found
            if self.spoilt(found) == 0.0:
                break
            bad = np.unique(mesh.triangles[found.folded])
            soft = np.union1d(ring(mesh, bad, 1), ring(mesh, found.cones, 4))
            lams[soft] = np.maximum(lams[soft] / 5.0, SOFTEST)
            weight[soft] *= 1.5
        assert best is not None
        return best

    def _solve(self, lams: Floats, weight: Floats, lam: float, rises: list[Floats]) -> Seamless:
        mesh = self.field.mesh
        found: list[Coordinate] = []
        for (lines, across), rise in zip(self._families(), rises, strict=True):
            target = Target(lines, across, rise, weight, lams)
            unknowns = self.unknowns[len(found)]
            found.append(coordinate(mesh, unknowns, target, self.engine))
        corners = np.stack([found[0].corners, found[1].corners], axis=-1)
        area, total = winding(mesh, corners)
        cones = self._wrong_cones(total)
        return Seamless(
            mesh,
            corners,
            self.cut.flips,
            self.cut.signs,
            lam,
            np.flatnonzero(area <= 0.0),
            cones,
            (found[0], found[1]),
        )

    def _families(self) -> list[tuple[Floats, Floats]]:
        """Lines and what is across them, (f, 2) each: of u, constant along family 2, then of v."""
        first, second = (
            _flat(angle) * self.cut.signs[:, None]
            for angle in (self.field.first, self.field.second)
        )
        return [(second, _turned(second, -1.0)), (first, _turned(first, 1.0))]

    def _rises(self, by_factor: bool) -> list[Floats]:
        """Derivatives wanted across both families, (f,) each, 1/mm; they make as many cells."""
        mesh, sine = self.field.mesh, np.sin(self.field.angle)
        rise = 1.0 / (self.spacing * sine)
        if not by_factor:
            return [rise, rise]
        u, v = (
            integrating_factor(mesh, across * rise[:, None], self.engine)
            for _, across in self._families()
        )
        more = float(np.average(u * v, weights=mesh.areas / sine))
        return [rise * factor / np.sqrt(more) for factor in (u, v)]

    def _wrong_cones(self, total: Floats) -> Indices:
        mesh = self.field.mesh
        right = np.full(len(mesh.vertices), 2.0 * np.pi)
        right[self.turns.vertices] *= 1.0 - self.turns.indices
        wrong = np.abs(total - right) > _WRONG_CONE
        return np.flatnonzero(wrong & ~mesh.on_boundary)


def _masks(mesh: TriangleMesh, turns: Singularities) -> tuple[Mask, Mask]:
    singular = np.zeros(len(mesh.vertices), dtype=bool)
    half = singular.copy()
    singular[turns.vertices] = True
    half[turns.vertices] = np.rint(2.0 * turns.indices).astype(int) % 2 != 0
    return singular, half


def _flat(angle: Floats) -> Floats:
    return np.stack([np.cos(angle), np.sin(angle)], axis=1)


def _turned(direction: Floats, side: float) -> Floats:
    """A quarter turn, counter-clockwise for side +1."""
    return np.stack([-side * direction[:, 1], side * direction[:, 0]], axis=1)
