"""The eight long faces of a built tube as splines of one parameter.

The four corner curves of a strip tell its axis, its normal and its binormal as splines with common
knots; every other curve along the tube is a sum of the three. On all faces u is x on the flat part.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from fabrication.lamella import Lamella
from fabrication.parts import FlatPart
from fabrication.sides import Side, strip_sides
from gridshell.arrays import Floats


@dataclass(frozen=True, eq=False)
class Box:
    """Four faces around a tube's axis, seen along it with the surface normal up.

    Parameters
    ----------
    near, far : at +b and -b; v runs up, from 0 to the height.
    top, bottom : v runs from near to far, from 0 to the depth.
    """

    near: Side
    far: Side
    top: Side
    bottom: Side


def tube_sides(lamella: Lamella, part: FlatPart) -> tuple[Box, Box]:
    """The outer and the inner faces."""
    near, far = strip_sides(lamella, part)
    middle = (near.lower + near.upper + far.lower + far.upper) / 4.0
    up = (near.upper - near.lower) / part.width
    across = (near.upper - far.upper) / part.thickness

    def box(height: float, depth: float) -> Box:
        def corner(b: float, n: float) -> Floats:
            return np.asarray(middle + b * depth / 2.0 * across + n * height / 2.0 * up)

        return Box(
            near=Side(near.knots, corner(1, -1), corner(1, 1), height),
            far=Side(near.knots, corner(-1, -1), corner(-1, 1), height),
            top=Side(near.knots, corner(1, 1), corner(-1, 1), depth),
            bottom=Side(near.knots, corner(1, -1), corner(-1, -1), depth),
        )

    inside = 2.0 * part.wall
    return box(part.width, part.thickness), box(part.width - inside, part.thickness - inside)
