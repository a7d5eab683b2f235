"""Conditions on a net: one file, one equation."""

from gridshell.constraints.closeness import Closeness
from gridshell.constraints.coplanarity import Coplanarity
from gridshell.constraints.fairness import Fairness, second_differences
from gridshell.constraints.glide import Curve, Glide, smooth_curve
from gridshell.constraints.node_angle import NodeAngle
from gridshell.constraints.planar_star import StarWithNormal, other_stars, regular_stars
from gridshell.constraints.proximity import Proximity
from gridshell.constraints.unit_normal import UnitNormal

__all__ = [
    "Closeness",
    "Coplanarity",
    "Curve",
    "Fairness",
    "Glide",
    "NodeAngle",
    "Proximity",
    "StarWithNormal",
    "UnitNormal",
    "other_stars",
    "regular_stars",
    "second_differences",
    "smooth_curve",
]
