"""What a design surface must answer: the closest point, its normal and its curvature."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Protocol, runtime_checkable

import numpy as np
import numpy.typing as npt

from gridshell.arrays import Floats, Indices, Points, Vectors, frozen
from gridshell.errors import InputError, SurfaceError


@dataclass(frozen=True, eq=False)
class Foot:
    """Feet of n points on a surface, as read-only arrays.

    Parameters
    ----------
    points : (n, 3) closest points on the surface, mm.
    normals : (n, 3) unit normals of the surface there.
    curvature : (n, 2) principal curvatures kappa1 <= kappa2 there, 1/mm; positive where the normal
        section bends towards the normal, so a sphere with outward normals has -1/radius twice.

    Raises
    ------
    InputError
        When the three shapes do not belong together.
    """

    points: Points
    normals: Vectors
    curvature: Floats

    def __post_init__(self) -> None:
        for key in ("points", "normals", "curvature"):
            object.__setattr__(self, key, frozen(getattr(self, key)))
        n = len(self.points) if self.points.ndim else 0
        for key, columns in (("points", 3), ("normals", 3), ("curvature", 2)):
            shape = getattr(self, key).shape
            if shape != (n, columns):
                raise InputError(
                    "The arrays of a foot do not belong together",
                    where=key,
                    value=f"shape {shape}",
                    limit=f"({n}, {columns})",
                )


@runtime_checkable
class Surface(Protocol):
    """Anything a net can be kept close to."""

    def closest(self, points: Points) -> Foot:
        """Find the feet of *points* (n, 3), mm, in the same order."""
        ...


def checked_points(points: npt.ArrayLike) -> Points:
    """Return *points* as an (n, 3) array of finite coordinates, mm.

    Raises
    ------
    InputError
        When the shape is another, or a coordinate is not finite (the first such row is named).
    """
    array = np.asarray(points, dtype=np.float64)
    if array.ndim != 2 or array.shape[1] != 3:
        raise InputError(
            "Positions must come as rows of x, y, z",
            value=f"shape {array.shape}",
            limit="(n, 3)",
        )
    bad = np.flatnonzero(~np.isfinite(array).all(axis=1))
    if len(bad):
        raise InputError(
            "A position is not finite",
            where=f"point {bad[0]}",
            value=str(array[bad[0]]),
            limit="finite coordinates, mm",
        )
    return array


def checked_triangles(triangles: npt.ArrayLike, vertices: int) -> Indices:
    """Return *triangles* as a read-only (f, 3) array of indices of so many *vertices*.

    Raises
    ------
    SurfaceError
        When the shape is another, there are none, or an index names no vertex.
    """
    array = frozen(triangles, np.int64)
    right = array.ndim == 2 and array.shape[1] == 3 and len(array) > 0
    if not right or array.min() < 0 or array.max() >= vertices:
        raise SurfaceError(
            "A surface needs triangles over its vertices",
            value=f"shape {array.shape}",
            limit=f"(f, 3) with indices 0 .. {vertices - 1}",
        )
    return array
