"""Gliding: vertices stay on a curve and may move along it."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from gridshell.arrays import Floats, Indices, Points, Vectors, frozen, unit
from gridshell.solve import Evaluation, Pattern, columns_of


@dataclass(frozen=True, eq=False)
class Curve:
    """A curve known by dense samples, joined by chords.

    Parameters
    ----------
    points : (k, 3) samples in order; a closed curve repeats its first point.
    """

    points: Points

    def closest(self, points: Points) -> tuple[Points, Vectors]:
        """Foot points and unit tangents, each (n, 3)."""
        from scipy.spatial import cKDTree

        a, b = self.points[:-1], self.points[1:]
        _, nearest = cKDTree((a + b) / 2.0).query(points, k=min(4, len(a)))
        nearest = nearest.reshape(len(points), -1)
        along = b[nearest] - a[nearest]
        offset = points[:, None, :] - a[nearest]
        square = np.maximum(np.einsum("nkc,nkc->nk", along, along), 1e-300)
        t = np.clip(np.einsum("nkc,nkc->nk", offset, along) / square, 0.0, 1.0)
        feet = a[nearest] + t[..., None] * along
        best = np.argmin(np.linalg.norm(points[:, None, :] - feet, axis=2), axis=1)
        rows = np.arange(len(points))
        return feet[rows, best], unit(along[rows, best])


def smooth_curve(vertices: Points, *, closed: bool, samples: int = 32) -> Curve:
    """A cubic spline through *vertices* (k, 3) with *samples* chords per edge."""
    from scipy.interpolate import CubicSpline

    through = np.vstack([vertices, vertices[:1]]) if closed else np.asarray(vertices)
    t = np.r_[0.0, np.cumsum(np.linalg.norm(np.diff(through, axis=0), axis=1))]
    spline = CubicSpline(t, through, bc_type="periodic" if closed else "not-a-knot")
    steps = np.linspace(0.0, 1.0, samples, endpoint=False)
    dense = (t[:-1, None] + np.diff(t)[:, None] * steps).ravel()
    return Curve(frozen(spline(np.r_[dense, t[-1]])))


@dataclass(frozen=True, eq=False)
class Glide:
    """The offset from a curve's tangent at the foot point vanishes across the curve.

    Parameters
    ----------
    vertices : (m,) vertex indices.
    curve : in the units of the unknowns.
    """

    vertices: Indices
    curve: Curve

    def pattern(self) -> Pattern:
        """3 columns, three rows."""
        return Pattern(columns_of(self.vertices[:, None]), 3)

    def lag(self, x: Floats) -> tuple[Points, Floats]:
        """Foot points (m, 3) and projections across the tangent (m, 3, 3)."""
        feet, tangents = self.curve.closest(x.reshape(-1, 3)[self.vertices])
        return feet, np.eye(3) - tangents[:, :, None] * tangents[:, None, :]

    def evaluate(self, x: Floats, lag: tuple[Points, Floats]) -> Evaluation:
        """Offsets across the curve."""
        feet, across = lag
        offset = x.reshape(-1, 3)[self.vertices] - feet
        return Evaluation(np.einsum("mij,mj->mi", across, offset), across)
