"""Which conditions a net must meet and with which weights: frozen settings.

:func:`a_net` is the default: normals eliminated, exact derivatives, and every term that only
guides the way lowered from step to step. :func:`paper_a_net` is the paper's own formulation
(Table 1: normals as unknowns, constant fairness 0.1, ten steps), kept to compare with.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Protocol

import numpy as np

from gridshell.anchors import Hold
from gridshell.arrays import Floats, Points
from gridshell.constraints import (
    Closeness,
    Fairness,
    NodeAngle,
    Proximity,
    StarWithNormal,
    UnitNormal,
    other_stars,
    regular_stars,
    second_differences,
)
from gridshell.curvature import vertex_normals
from gridshell.errors import SettingError
from gridshell.mesh import ControlMesh, diagonal_stars, edge_stars
from gridshell.solve import Problem, Stop, Term, Weight
from gridshell.surface import Surface


class Recipe(Protocol):
    """Turns a control mesh at unit mean edge into a problem and its starting point."""

    @property
    def angle(self) -> float | None:
        """Target node angle, radians; None leaves it free."""

    @property
    def stop(self) -> Stop:
        """When to stop."""

    def problem(
        self, control: ControlMesh, x: Points, hold: Hold, reference: Surface | None
    ) -> tuple[Problem, Floats]:
        """The problem and its start; the first 3n unknowns are the vertices."""


@dataclass(frozen=True)
class ANet:
    """Asymptotic net on D1 and D2: planar vertex stars (eq. 7), optionally a node angle (eq. 4).

    Parameters
    ----------
    angle : between the diagonals of every control quad, radians; None leaves it free.
    keep_shape : fairness acts on the change from the start. False straightens the polylines
        themselves, which suits a noisy start.
    fairness, closeness, proximity : guiding weights; closeness None leaves the term out.
    stop : steps and tolerance.

    Raises
    ------
    SettingError
        For an angle outside (0, 180) degrees.
    """

    angle: float | None = None
    keep_shape: bool = True
    fairness: Weight = field(default=Weight(1e-2, 0.1))
    closeness: Weight | None = None
    proximity: Weight = field(default=Weight(0.1, 0.3))
    stop: Stop = field(default=Stop(steps=30, tolerance=1e-9))

    def __post_init__(self) -> None:
        _check_angle(self.angle)

    def problem(
        self, control: ControlMesh, x: Points, hold: Hold, reference: Surface | None
    ) -> tuple[Problem, Floats]:
        """Stars and angle as goals; fairness, closeness, proximity and the anchor as guides."""
        start = x.ravel()
        stars = diagonal_stars(control.mesh)
        triples = _polyline_triples(control)
        target = second_differences(start, triples) * float(self.keep_shape)
        terms = [
            Term("star planarity", Weight(1.0), regular_stars(stars), goal=True),
            Term("other stars", Weight(1.0), other_stars(stars), goal=True),
            Term("fairness", self.fairness, Fairness(triples, target)),
        ]
        if self.angle is not None:
            terms.append(_angle_term(control, self.angle, lag_lengths=False))
        if self.closeness is not None:
            terms.append(Term("closeness", self.closeness, Closeness(start)))
        if reference is not None:
            terms.append(_proximity_term(control, reference, self.proximity))
        return _problem(start, terms, hold), start


@dataclass(frozen=True)
class PaperANet:
    """The A-net as the paper solves it: Table 1, row 9.

    Parameters
    ----------
    angle : radians; None leaves it free.
    fairness : lambda 5, constant.
    proximity : constant weight of the distance to a reference, where there is one.
    stop : ten steps.
    """

    angle: float | None = None
    fairness: Weight = field(default=Weight(0.1))
    proximity: Weight = field(default=Weight(0.1))
    stop: Stop = field(default=Stop(steps=10, tolerance=1e-9))

    def __post_init__(self) -> None:
        _check_angle(self.angle)

    def problem(
        self, control: ControlMesh, x: Points, hold: Hold, reference: Surface | None
    ) -> tuple[Problem, Floats]:
        """Normals follow the vertices in the unknown vector: 6 n unknowns."""
        n = len(x)
        normals = vertex_normals(control.mesh)
        stars = diagonal_stars(control.mesh)
        centre = stars.regular()
        points = np.column_stack([centre, stars.spokes[centre, :4], n + centre])
        triples = _polyline_triples(control)
        terms = [
            Term("star planarity", Weight(1.0), StarWithNormal(points), goal=True),
            Term("unit normals", Weight(1.0), UnitNormal(n + centre)),
            Term("fairness", self.fairness, Fairness(triples, np.zeros((len(triples), 3)))),
        ]
        if self.angle is not None:
            terms.append(_angle_term(control, self.angle, lag_lengths=True))
        if reference is not None:
            terms.append(_proximity_term(control, reference, self.proximity))
        start = np.concatenate([x.ravel(), normals.ravel()])
        return _problem(start, terms, hold), start


def a_net(
    *, angle: float | None = None, keep_shape: bool = True, steps: int = 30, tolerance: float = 1e-9
) -> ANet:
    """The default recipe for an asymptotic net.

    Parameters
    ----------
    angle : node angle, radians; None leaves it to the surface.
    keep_shape : False for a noisy start.
    steps, tolerance : when to stop; the tolerance is the largest residual at unit mean edge.
    """
    closeness = None if keep_shape else Weight(1e-2, 0.1)
    return ANet(
        angle=angle,
        keep_shape=keep_shape,
        closeness=closeness,
        stop=Stop(steps=steps, tolerance=tolerance),
    )


def paper_a_net(*, angle: float | None = None) -> PaperANet:
    """The paper's own setting: lambda 1 = lambda 4 = 1, lambda 5 = 0.1, ten steps."""
    return PaperANet(angle=angle)


def _check_angle(angle: float | None) -> None:
    if angle is not None and not 0.0 < angle < np.pi:
        raise SettingError(
            "The node angle must lie between 0 and 180 degrees",
            where="angle",
            value=f"{np.degrees(angle):g} degrees",
            limit="(0, 180)",
            advice="60, 75 or 90 degrees",
        )


def _problem(start: Floats, terms: list[Term], hold: Hold) -> Problem:
    fixed = (3 * hold.vertices[:, None] + np.arange(3)).ravel()
    used = [t for t in (*terms, *hold.terms) if len(t.constraint.pattern().columns)]
    return Problem(len(start), tuple(used), fixed)


def _angle_term(control: ControlMesh, angle: float, *, lag_lengths: bool) -> Term:
    angles = np.full(len(control.quads), angle)
    return Term("node angle", Weight(1.0), NodeAngle(control.quads, angles, lag_lengths), goal=True)


def _proximity_term(control: ControlMesh, reference: Surface, weight: Weight) -> Term:
    used = np.flatnonzero(control.mesh.valence > 0)
    return Term("proximity", weight, Proximity(used, reference))


def _polyline_triples(control: ControlMesh) -> np.ndarray:
    """Polylines of the control mesh's edges and of both diagonal meshes."""
    stars = diagonal_stars(control.mesh), edge_stars(control.mesh)
    return np.concatenate([s.continuations() for s in stars])
