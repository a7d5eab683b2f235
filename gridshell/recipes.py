"""Which conditions a net must meet and with which weights: frozen settings.

:func:`a_net`, :func:`pq_net` and :func:`principal_symmetric_net` are the defaults: normals
eliminated, exact derivatives, and every term that only guides the way lowered from step to step.
:func:`paper_a_net` and :func:`paper_pq_net` are the paper's own formulation (Table 1: normals as
unknowns, constant fairness, ten steps), kept to compare with.
"""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from math import pi
from typing import Protocol

import numpy as np

from gridshell.angles import Angle, angles_at
from gridshell.arrays import Floats
from gridshell.conditions import Condition
from gridshell.constraints import (
    Closeness,
    EqualDiagonals,
    Fairness,
    UnitNormal,
    second_differences,
    stars_across_normals,
    white_quads_across_normals,
)
from gridshell.curvature import vertex_normals
from gridshell.errors import SettingError
from gridshell.folding import NoFolding
from gridshell.mesh import diagonal_stars, edge_stars
from gridshell.pose import Pose
from gridshell.solve import Problem, Stop, Term, Weight
from gridshell.surface import Surface
from gridshell.terms import (
    Planarity,
    angle_terms,
    planar_terms,
    polyline_triples,
    problem_of,
    proximity_terms,
)


class Recipe(Protocol):
    """Turns a posed net into a problem and its starting point."""

    @property
    def planarity(self) -> Planarity:
        """What shall be flat."""

    @property
    def angle(self) -> Angle | None:
        """Target node angle, radians; None leaves it free."""

    @property
    def rhombus(self) -> bool:
        """Whether the diagonals of every quad shall be equal."""

    @property
    def stop(self) -> Stop:
        """When to stop."""

    def problem(self, pose: Pose) -> tuple[Problem, Floats]:
        """The problem and its start; the first 3 n unknowns are the vertices."""


@dataclass(frozen=True, eq=False)
class NetRecipe:
    """The default formulation of every net.

    Parameters
    ----------
    planarity : eq. 6, eq. 7, or one of their relatives.
    angle : between the diagonals of every control quad (eq. 4), or for ``EDGE_STARS`` between the
        two families of edges: radians, one for all, one per crossing, or a field over positions
        in mm, which is met where the net ends; None leaves it free.
    rhombus : equal diagonals in every quad (eq. 5).
    keep_shape : fairness acts on the change from where the solve begins. False straightens the
        polylines themselves, which suits a noisy start.
    fairness, closeness, proximity : guiding weights; closeness None leaves the term out.
    conditions : more of them: prescribed lengths, planes of symmetry.
    stop : steps and tolerance.

    Raises
    ------
    SettingError
        For an angle outside (0, 180) degrees.
    """

    planarity: Planarity = Planarity.DIAGONAL_STARS
    angle: Angle | None = None
    rhombus: bool = False
    keep_shape: bool = True
    fairness: Weight = field(default=Weight(1e-2, 0.1))
    closeness: Weight | None = None
    proximity: Weight = field(default=Weight(0.1, 0.3))
    conditions: tuple[Condition, ...] = ()
    stop: Stop = field(default=Stop(steps=30, tolerance=1e-9))

    def __post_init__(self) -> None:
        _check_angle(self.angle)

    def problem(self, pose: Pose) -> tuple[Problem, Floats]:
        """Planarity, angle, rhombi as goals; fairness, closeness, proximity, anchor as guides."""
        control, start = pose.control, pose.start
        triples = polyline_triples(control)
        target = second_differences(start, triples) * float(self.keep_shape)
        terms = [
            *planar_terms(control, self.planarity),
            *angle_terms(pose, self.planarity, self.angle, lag_lengths=False),
            Term("fairness", self._fairness_beside(pose.reference), Fairness(triples, target)),
        ]
        if self.rhombus:
            goal = EqualDiagonals(control.quads)
            terms.append(Term("equal diagonals", Weight(1.0), goal, goal=True))
        if self.closeness is not None:
            terms.append(Term("closeness", self.closeness, Closeness(control.vertices.ravel())))
        terms += [condition.term(pose) for condition in self.conditions]
        terms += proximity_terms(pose, self.proximity)
        return problem_of(pose, start, terms, NoFolding(pose.control.mesh)), start

    def _fairness_beside(self, reference: Surface | None) -> Weight:
        """Lowered no faster than proximity: held to a surface alone, a net slides together."""
        if reference is None or not self.keep_shape:
            return self.fairness
        return replace(self.fairness, decay=max(self.fairness.decay, self.proximity.decay))


@dataclass(frozen=True, eq=False)
class PaperRecipe:
    """The formulation as printed: normals as unknowns, constant weights, ten steps (Table 1).

    Parameters
    ----------
    planarity : ``DIAGONAL_STARS`` (lambda 4 = 1) or ``WHITE_FACES`` (lambda 3 = 1).
    angle : radians (lambda 1 = 1); None leaves it free.
    rhombus : lambda 2 = 1.
    fairness : lambda 5, constant.
    proximity : constant weight of the distance to a reference, where there is one.
    stop : ten steps.

    Raises
    ------
    SettingError
        For an angle outside (0, 180) degrees, or a planarity the paper has no equation for.
    """

    planarity: Planarity = Planarity.DIAGONAL_STARS
    angle: Angle | None = None
    rhombus: bool = False
    fairness: Weight = field(default=Weight(0.1))
    proximity: Weight = field(default=Weight(0.1))
    stop: Stop = field(default=Stop(steps=10, tolerance=1e-9))

    def __post_init__(self) -> None:
        _check_angle(self.angle)
        if self.planarity not in (Planarity.DIAGONAL_STARS, Planarity.WHITE_FACES):
            raise SettingError(
                "The paper has no equation for it",
                where="planarity",
                value=self.planarity.value,
                limit="stars of the diagonal meshes (7), white faces (6)",
            )

    def problem(self, pose: Pose) -> tuple[Problem, Floats]:
        """Normals follow the vertices in the unknown vector: 6 n unknowns; no step is refused."""
        control, n = pose.control, len(pose.net.vertices)
        if self.planarity is Planarity.WHITE_FACES:
            across = white_quads_across_normals(edge_stars(control.mesh), n)
            name = "white faces"
        else:
            across = stars_across_normals(diagonal_stars(control.mesh), n)
            name = "star planarity"
        triples = polyline_triples(control)
        terms = [
            Term(name, Weight(1.0), across, goal=True),
            Term("unit normals", Weight(1.0), UnitNormal(across.points[:, -1])),
            Term("fairness", self.fairness, Fairness(triples, np.zeros((len(triples), 3)))),
            *angle_terms(pose, self.planarity, self.angle, lag_lengths=True),
            *proximity_terms(pose, self.proximity),
        ]
        if self.rhombus:
            goal = EqualDiagonals(control.quads, as_printed=True)
            terms.append(Term("equal diagonals", Weight(1.0), goal, goal=True))
        normals = vertex_normals(control.mesh)
        start = np.concatenate([pose.start, normals.ravel()])
        return problem_of(pose, start, terms, None), start


# ---- the recipes by name ------------------------------------------------------------------------


def a_net(
    *,
    angle: Angle | None = None,
    planarity: Planarity = Planarity.DIAGONAL_STARS,
    keep_shape: bool = True,
    conditions: tuple[Condition, ...] = (),
    steps: int = 30,
    tolerance: float = 1e-9,
) -> NetRecipe:
    """The default recipe for an asymptotic net.

    Parameters
    ----------
    angle : node angle, radians; None leaves it to the surface.
    planarity : which vertex stars are planar.
    keep_shape : False for a noisy start.
    conditions : prescribed lengths, planes of symmetry.
    steps, tolerance : when to stop; the tolerance is the largest residual at unit mean edge.

    Raises
    ------
    SettingError
        For a planarity that is not of stars, or an angle outside (0, 180) degrees.
    """
    if not planarity.of_stars:
        raise SettingError(
            "An asymptotic net has planar vertex stars",
            where="planarity",
            value=planarity.value,
            limit="vertex stars",
            advice="pq_net() for planar faces",
        )
    return _default(planarity, angle, False, keep_shape, conditions, steps, tolerance)


def pq_net(
    *,
    angle: Angle | None = None,
    planarity: Planarity = Planarity.WHITE_FACES,
    rhombus: bool = False,
    square: bool = False,
    keep_shape: bool = True,
    conditions: tuple[Condition, ...] = (),
    steps: int = 30,
    tolerance: float = 1e-9,
) -> NetRecipe:
    """The default recipe for a net of planar quads.

    Parameters
    ----------
    angle : between the diagonals of every quad, radians; None leaves it to the surface.
    planarity : ``WHITE_FACES`` (eq. 6) or ``FACES``, of the mesh itself.
    rhombus : the black parallelograms are rhombi (eq. 5).
    square : they are squares: rhombi at 90 degrees, a discrete isothermic surface.
    keep_shape : False for a noisy start.
    conditions : prescribed lengths, planes of symmetry.
    steps, tolerance : when to stop; the tolerance is the largest residual at unit mean edge.

    Raises
    ------
    SettingError
        For a planarity that is not of faces, an angle outside (0, 180) degrees, or squares at
        another angle than 90.
    """
    if planarity not in (Planarity.WHITE_FACES, Planarity.FACES):
        raise SettingError(
            "A planar-quad net has planar faces",
            where="planarity",
            value=planarity.value,
            limit="faces or white faces",
            advice="a_net() for planar vertex stars",
        )
    if square and angle is not None and not (np.ndim(angle) == 0 and angle == pi / 2.0):  # type: ignore[arg-type]
        raise SettingError(
            "The conditions contradict each other: squares have right angles",
            where="angle, square",
            value="another node angle" if callable(angle) else f"{np.degrees(np.max(angle)):g}",
            limit="90 degrees",
            advice="rhombi instead of squares, or no angle",
        )
    angle = pi / 2.0 if square else angle
    return _default(planarity, angle, rhombus or square, keep_shape, conditions, steps, tolerance)


def principal_symmetric_net(
    *, angle: Angle | None = None, keep_shape: bool = True, steps: int = 30, tolerance: float = 1e-9
) -> NetRecipe:
    """Spherical vertex stars on D1 and D2: families with equal normal curvatures (the remark).

    Parameters and errors as for :func:`a_net`.
    """
    return _default(Planarity.SPHERICAL_STARS, angle, False, keep_shape, (), steps, tolerance)


def paper_a_net(*, angle: Angle | None = None, rhombus: bool = False) -> PaperRecipe:
    """The paper's own setting: lambda 1 = lambda 4 = 1, lambda 5 = 0.1, ten steps."""
    return PaperRecipe(angle=angle, rhombus=rhombus)


def paper_pq_net(
    *, angle: Angle | None = None, rhombus: bool = False, fairness: float = 0.1
) -> PaperRecipe:
    """The paper's own setting: lambda 1 = lambda 3 = 1, ten steps; lambda 5 is *fairness*."""
    return PaperRecipe(
        planarity=Planarity.WHITE_FACES, angle=angle, rhombus=rhombus, fairness=Weight(fairness)
    )


def _default(
    planarity: Planarity,
    angle: Angle | None,
    rhombus: bool,
    keep_shape: bool,
    conditions: tuple[Condition, ...],
    steps: int,
    tolerance: float,
) -> NetRecipe:
    return NetRecipe(
        planarity=planarity,
        angle=angle,
        rhombus=rhombus,
        keep_shape=keep_shape,
        closeness=None if keep_shape else Weight(1e-2, 0.1),
        conditions=conditions,
        stop=Stop(steps=steps, tolerance=tolerance),
    )


def _check_angle(angle: Angle | None) -> None:
    if angle is not None and not callable(angle):
        values = np.atleast_1d(np.asarray(angle, dtype=np.float64))
        angles_at(angle if np.ndim(angle) else float(values[0]), np.zeros((len(values), 3)))
