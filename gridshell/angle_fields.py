"""Node angles as a field over the surface: the angle as a design parameter (Fig. 13, section 4.2).

A field takes positions to angles. Each of these is a frozen value and may stand wherever a recipe
takes an angle; any other function of positions may, too.
"""

from __future__ import annotations

import ast
from collections.abc import Callable
from dataclasses import dataclass, field
from functools import cached_property
from math import degrees

import numpy as np

from gridshell.angle_formula import parsed, worked_out
from gridshell.arrays import Floats, Points, frozen
from gridshell.errors import SettingError

Place = tuple[float, float, float]

_NAMES = ("x", "y", "z", "r")


@dataclass(frozen=True)
class RadialAngle:
    """An angle that changes linearly with the distance from a centre (Fig. 13).

    Parameters
    ----------
    centre : mm.
    radii : distances where the first and the last angle hold, mm.
    angles : at these distances, radians; constant inside and outside of them.

    Raises
    ------
    SettingError
        For an angle outside (0, 180) degrees, or radii that do not grow.
    """

    centre: Place
    radii: tuple[float, float]
    angles: tuple[float, float]

    def __post_init__(self) -> None:
        _require_growing("radii", self.radii)
        _require_angles("angles", self.angles)

    def __call__(self, points: Points) -> Floats:
        """(m,) angles at *points* (m, 3), mm."""
        distance = np.linalg.norm(points - np.array(self.centre), axis=1)
        return np.asarray(np.interp(distance, self.radii, self.angles))


@dataclass(frozen=True)
class AngleAlong:
    """An angle that changes along a direction, linearly between stations.

    Parameters
    ----------
    direction : of any length but zero; (0, 0, 1) makes the angle a function of the height.
    stations : distances from the origin along the direction, growing, mm.
    angles : at the stations, radians; constant before the first and beyond the last.

    Raises
    ------
    SettingError
        For a direction of length zero, an angle outside (0, 180) degrees, stations that do not
        grow, or another number of them than of angles.
    """

    direction: Place
    stations: tuple[float, ...]
    angles: tuple[float, ...]

    def __post_init__(self) -> None:
        if not np.linalg.norm(self.direction) > 0.0:
            raise SettingError("A direction needs a length", where="direction", value="0")
        _require_growing("stations", self.stations)
        _require_angles("angles", self.angles)
        if len(self.stations) != len(self.angles):
            raise SettingError(
                "Every station needs an angle",
                where="angles",
                value=f"{len(self.angles)} angles",
                limit=f"{len(self.stations)}, one for each station",
            )

    def __call__(self, points: Points) -> Floats:
        """(m,) angles at *points* (m, 3), mm."""
        along = points @ (np.array(self.direction) / np.linalg.norm(self.direction))
        return np.asarray(np.interp(along, self.stations, self.angles))


@dataclass(frozen=True, eq=False)
class SampledAngle:
    """An angle through samples, with no more bend between them than need be.

    The field is the sum of a constant and of cones over the samples (the linear radial basis
    function), held between the smallest and the largest angle. On a line it joins the samples
    linearly.

    Parameters
    ----------
    points : (k, 3) places of the samples, mm.
    angles : (k,) radians.

    Raises
    ------
    SettingError
        Without samples, for an angle outside (0, 180) degrees, for lists of different lengths, or
        two samples at one place.
    """

    points: Points
    angles: Floats

    def __post_init__(self) -> None:
        points = np.asarray(self.points, dtype=np.float64).reshape(-1, 3)
        object.__setattr__(self, "points", frozen(points))
        object.__setattr__(self, "angles", frozen(self.angles))
        if len(points) == 0 or self.angles.shape != (len(points),):
            raise SettingError(
                "Samples need a place and an angle each",
                where="samples",
                value=f"{len(points)} places, {self.angles.size} angles",
                limit="as many of both, at least one",
            )
        _require_angles("samples", tuple(self.angles.tolist()))
        _, first, count = np.unique(points, axis=0, return_index=True, return_counts=True)
        if (count > 1).any():
            where = points[first[count > 1][0]].round(3).tolist()
            raise SettingError("Two samples lie at one place", where="samples", value=str(where))

    def __call__(self, points: Points) -> Floats:
        """(m,) angles at *points* (m, 3), mm."""
        found = self._through(points / self._size)
        return np.asarray(np.clip(found, self.angles.min(), self.angles.max()))

    @cached_property
    def _size(self) -> float:
        return max(float(np.ptp(self.points, axis=0).max()), 1.0)

    @cached_property
    def _through(self) -> Callable[[Points], Floats]:
        from scipy.interpolate import RBFInterpolator

        found: Callable[[Points], Floats] = RBFInterpolator(
            self.points / self._size, self.angles, kernel="linear"
        )
        return found


@dataclass(frozen=True)
class FormulaAngle:
    """An angle given by a formula in x, y, z and r, the distance from a centre, all in mm.

    Parameters
    ----------
    formula : degrees, as in ``"90 - 30 * (r / 4000) ** 2"``; sines take radians.
    centre : of r, mm.

    Raises
    ------
    SettingError
        For a formula that does not parse or reaches for anything but arithmetic, and from the call
        where it has no value between 0 and 180 degrees.
    """

    formula: str
    centre: Place = (0.0, 0.0, 0.0)
    _tree: ast.expr = field(init=False, repr=False, compare=False)

    def __post_init__(self) -> None:
        object.__setattr__(self, "_tree", parsed(self.formula, _NAMES))

    def __call__(self, points: Points) -> Floats:
        """(m,) angles at *points* (m, 3), mm."""
        values = dict(zip("xyz", points.T, strict=True))
        values["r"] = np.linalg.norm(points - np.array(self.centre), axis=1)
        found = worked_out(self._tree, values)
        bad = np.flatnonzero(~((found > 0.0) & (found < 180.0)))
        if len(bad):
            place = ", ".join(f"{c:.6g}" for c in points[bad[0]])
            raise SettingError(
                "The formula leaves the range of node angles",
                where=f"formula at ({place}) mm",
                value=f"{found[bad[0]]:.6g} degrees",
                limit="(0, 180)",
                advice=f"clip({self.formula}, 30, 150)",
            )
        return np.radians(found)


def _require_angles(key: str, angles: tuple[float, ...]) -> None:
    bad = [angle for angle in angles if not 0.0 < angle < np.pi]
    if bad:
        raise SettingError(
            "The node angle must lie between 0 and 180 degrees",
            where=key,
            value=f"{degrees(bad[0]):g} degrees",
            limit="(0, 180)",
            advice="1 degree" if bad[0] <= 0.0 else "60, 75 or 90 degrees",
        )


def _require_growing(key: str, values: tuple[float, ...]) -> None:
    if len(values) == 0 or not np.isfinite(values).all() or not (np.diff(values) > 0.0).all():
        raise SettingError(
            "Distances must grow from each to the next",
            where=key,
            value=", ".join(f"{value:g}" for value in values),
            limit="at least one number, each larger than the one before",
        )
