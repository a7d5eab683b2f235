"""What shall be flat, and the terms that say so: from a posed net to the solver's problem."""

from __future__ import annotations

from enum import Enum

import numpy as np

from gridshell.angles import Angle, angles_at, edge_crossings, face_crossings
from gridshell.arrays import Floats, Indices
from gridshell.constraints import (
    FieldAngle,
    NodeAngle,
    Proximity,
    other_stars,
    planar_faces,
    planar_white_faces,
    regular_stars,
    spherical_stars,
)
from gridshell.mesh import ControlMesh, Stars, diagonal_stars, edge_stars
from gridshell.pose import Pose
from gridshell.solve import Constraint, Guard, Problem, Term, Weight


class Planarity(Enum):
    """What shall be flat (or, for the last one, round); the value is its name for people."""

    DIAGONAL_STARS = "vertex stars of the diagonal meshes"
    FIRST_DIAGONAL_STARS = "vertex stars of D1"
    SECOND_DIAGONAL_STARS = "vertex stars of D2"
    EDGE_STARS = "vertex stars of the edges"
    FACES = "faces"
    WHITE_FACES = "white faces of the checkerboard pattern"
    SPHERICAL_STARS = "spherical vertex stars of the diagonal meshes"

    @property
    def of_stars(self) -> bool:
        """Whether vertex stars are planar: an asymptotic net."""
        return self in _STARS


_STARS = frozenset(
    {
        Planarity.DIAGONAL_STARS,
        Planarity.FIRST_DIAGONAL_STARS,
        Planarity.SECOND_DIAGONAL_STARS,
        Planarity.EDGE_STARS,
    }
)


def crossings(control: ControlMesh, planarity: Planarity) -> Indices:
    """(m, 4) where the node angle of a net is measured."""
    return edge_crossings(control) if planarity is Planarity.EDGE_STARS else face_crossings(control)


def target_angles(net: ControlMesh, planarity: Planarity, angle: Angle) -> Floats:
    """(m,) target at every crossing of *net* (mm), radians."""
    corners = crossings(net, planarity)
    return angles_at(angle, net.vertices[corners].mean(axis=1))


def polyline_triples(control: ControlMesh) -> Indices:
    """(m, 3) along the polylines of the edges and of both diagonal meshes."""
    stars = diagonal_stars(control.mesh), edge_stars(control.mesh)
    return np.concatenate([s.continuations() for s in stars])


def planar_terms(control: ControlMesh, planarity: Planarity) -> list[Term]:
    """The goals of eq. 6, eq. 7 or their relatives; a term may have no element."""

    def goal(name: str, constraint: Constraint) -> Term:
        return Term(name, Weight(1.0), constraint, goal=True)

    if planarity is Planarity.FACES:
        return [goal("planar faces", planar_faces(control.quads))]
    if planarity is Planarity.WHITE_FACES:
        return [goal("white faces", planar_white_faces(edge_stars(control.mesh)))]
    if planarity is Planarity.SPHERICAL_STARS:
        return [goal("spherical stars", spherical_stars(diagonal_stars(control.mesh)))]
    stars = planar_stars(control, planarity)
    return [goal("star planarity", regular_stars(stars)), goal("other stars", other_stars(stars))]


def planar_stars(control: ControlMesh, planarity: Planarity) -> Stars:
    """The stars that shall be planar; the others have no spoke."""
    if planarity is Planarity.EDGE_STARS:
        return edge_stars(control.mesh)
    stars = diagonal_stars(control.mesh)
    colour = {Planarity.FIRST_DIAGONAL_STARS: 0, Planarity.SECOND_DIAGONAL_STARS: 1}.get(planarity)
    if colour is None:
        return stars
    return Stars(stars.spokes, np.where(control.colour == colour, stars.count, 0), stars.closed)


def angle_terms(
    pose: Pose, planarity: Planarity, angle: Angle | None, *, lag_lengths: bool
) -> list[Term]:
    """The goal of eq. 4 where an angle is asked for; a field is met where the net ends.

    The paper's own formulation, with lengths lagged, takes the field where the net begins.
    """
    if angle is None:
        return []
    corners = crossings(pose.net, planarity)
    goal: Constraint
    if callable(angle) and not lag_lengths:
        goal = FieldAngle(corners, lambda x: angles_at(angle, pose.outside(x)))
    else:
        goal = NodeAngle(corners, target_angles(pose.net, planarity, angle), lag_lengths)
    return [Term("node angle", Weight(1.0), goal, goal=True)]


def proximity_terms(pose: Pose, weight: Weight) -> list[Term]:
    """The distance of every used vertex from the reference, where there is one."""
    if pose.reference is None:
        return []
    used = np.flatnonzero(pose.net.mesh.valence > 0)
    return [Term("proximity", weight, Proximity(used, pose.reference))]


def problem_of(pose: Pose, start: Floats, terms: list[Term], guard: Guard | None) -> Problem:
    """The terms that have elements, with what the anchor holds, over the unknowns *start*."""
    fixed = (3 * pose.hold.vertices[:, None] + np.arange(3)).ravel()
    used = [t for t in (*terms, *pose.hold.terms) if len(t.constraint.pattern().columns)]
    return Problem(len(start), tuple(used), fixed, guard)
