"""Conditions on a net: one file, one equation."""

from gridshell.constraints.across_normal import (
    AcrossNormal,
    stars_across_normals,
    white_quads_across_normals,
)
from gridshell.constraints.angle_bounds import AngleBounds
from gridshell.constraints.closeness import Closeness
from gridshell.constraints.coplanarity import Coplanarity
from gridshell.constraints.edge_length import EdgeLength
from gridshell.constraints.equal_diagonals import EqualDiagonals
from gridshell.constraints.fairness import Fairness, second_differences
from gridshell.constraints.field_angle import FieldAngle
from gridshell.constraints.glide import Curve, Glide, smooth_curve
from gridshell.constraints.node_angle import NodeAngle
from gridshell.constraints.planar_face import planar_faces, planar_white_faces
from gridshell.constraints.planar_star import other_stars, regular_stars
from gridshell.constraints.proximity import Proximity
from gridshell.constraints.spherical_star import SphericalStar, spherical_stars
from gridshell.constraints.symmetry import Symmetry
from gridshell.constraints.unit_normal import UnitNormal

__all__ = [
    "AcrossNormal",
    "AngleBounds",
    "Closeness",
    "Coplanarity",
    "Curve",
    "EdgeLength",
    "EqualDiagonals",
    "Fairness",
    "FieldAngle",
    "Glide",
    "NodeAngle",
    "Proximity",
    "SphericalStar",
    "Symmetry",
    "UnitNormal",
    "other_stars",
    "planar_faces",
    "planar_white_faces",
    "regular_stars",
    "second_differences",
    "smooth_curve",
    "spherical_stars",
    "stars_across_normals",
    "white_quads_across_normals",
]
