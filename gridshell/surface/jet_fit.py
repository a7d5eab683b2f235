"""Fits of cubic height functions: normal, shape operator and noise of a surface seen by points.

Over the tangent plane at a place the surface is the height z(u, v) = sum c_ij u^i v^j, i + j <= 3,
fitted with Gaussian weights. Lengths are divided by the radius of the neighbourhood, so that the
normal equations are well conditioned whatever the unit. Their matrix holds only the 28 moments
sum w u^i v^j, i + j <= 6, which one batched product of powers gives.

Sources: F. Cazals and M. Pouget, Estimating differential quantities using polynomial fitting of
osculating jets, CAGD 22 (2005); the forms from do Carmo, section 3-3.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from gridshell.arrays import Floats, Indices, Points, Vectors, unit
from gridshell.surface.neighbourhoods import Neighbourhoods

_I = np.array([0, 1, 0, 2, 1, 0, 3, 2, 1, 0])
_J = np.array([0, 0, 1, 0, 1, 2, 0, 1, 2, 3])
"""Exponents of u and v of the ten coefficients."""

_BLOCK = 60_000
"""Points looked at together: what one thread's cache holds several times over is slower."""

_WIDTH = 1.0
"""Of the Gaussian weight, in root mean square radii of the neighbourhood."""

_RIDGE = 1e-11
"""Added to the normal equations, whose first entry is 1: decides only what the points do not."""


class Jets(NamedTuple):
    """What m fits found."""

    feet: Points
    """(m, 3) the places moved along their normals onto the fitted heights, mm."""
    normals: Vectors
    """(m, 3) unit."""
    shapes: Floats
    """(m, 3, 3) tangential shape operators, 1/mm, with the sign of `CurvedMesh`."""
    residuals: Floats
    """(m,) root mean square distance of the points from the fit per degree of freedom, mm."""


def fit_jets(
    points: Points,
    places: Points,
    normals: Vectors,
    around: Neighbourhoods,
    *,
    passes: int = 2,
) -> Jets:
    """Fit a cubic over the tangent plane at every place.

    Parameters
    ----------
    points : (n, 3) mm.
    places : (m, 3) mm, where the surface is asked for.
    normals : (m, 3) unit, roughly normal: the side is kept, the direction is improved.
    around : which points describe which place.
    passes : fits, each over the tangent plane the one before found.
    """
    m = len(places)
    found = Jets(np.empty((m, 3)), np.empty((m, 3)), np.empty((m, 3, 3)), np.empty(m))
    order = np.argsort(around.sizes, kind="stable")
    for rows in _blocks(order, around.sizes[order]):
        nearby, present = _padded(around, rows)
        offsets = points[nearby] - places[rows, None]
        normal = normals[rows]
        for _ in range(passes):
            jets = _fit(offsets, present, normal)
            normal = jets.normals
        found.feet[rows] = places[rows] + jets.feet
        found.normals[rows] = jets.normals
        found.shapes[rows] = jets.shapes
        found.residuals[rows] = jets.residuals
    return found


def _blocks(order: Indices, sizes: Indices) -> list[Indices]:
    """Rows of about equal size together, so that padding costs little."""
    total = np.cumsum(sizes) // _BLOCK
    return np.split(order, np.flatnonzero(np.diff(total)) + 1) if len(order) else []


def _padded(around: Neighbourhoods, rows: Indices) -> tuple[Indices, Floats]:
    """Members (b, k) of the rows, and 1 where a row has that many (else 0)."""
    sizes = around.sizes[rows]
    column = np.arange(int(sizes.max()))
    within = np.minimum(column, sizes[:, None] - 1)
    nearby = around.members[around.starts[rows][:, None] + within]
    return nearby, (column < sizes[:, None]).astype(np.float64)


def _fit(offsets: Floats, present: Floats, normals: Vectors) -> Jets:
    """One fit per row: *offsets* (b, k, 3) from the place, mm; *present* (b, k) 0 or 1."""
    frames = tangent_frames(normals)
    u, v, z = np.moveaxis(offsets @ frames.transpose(0, 2, 1), 2, 0)
    count = present.sum(axis=1)
    squared = u * u + v * v
    scale = np.sqrt((squared * present).sum(axis=1) / count)
    scale = np.where(scale > 0.0, scale, 1.0)
    weight = np.exp(squared * (-0.5 / (_WIDTH * scale) ** 2)[:, None]) * present
    weight /= weight.sum(axis=1)[:, None]
    shrink = 1.0 / scale[:, None]
    z = z * shrink
    powers_u, powers_v = _powers(u * shrink), _powers(v * shrink)
    powers_u *= weight[:, None]
    moments = powers_u @ powers_v.transpose(0, 2, 1)
    heights = (powers_u[:, :4] * z[:, None]) @ powers_v[:, :4].transpose(0, 2, 1)
    gram = moments[:, _I[:, None] + _I, _J[:, None] + _J]
    gram[:, np.arange(10), np.arange(10)] += _RIDGE
    right = heights[:, _I, _J]
    c = np.linalg.solve(gram, right[..., None])[..., 0]
    left = np.einsum("bk,bk,bk->b", weight, z, z) - np.einsum("bi,bi->b", c, right)
    freedom = np.maximum(count - 10.0, 1.0) / count
    normals, shapes = _forms(c, frames, scale)
    feet = (c[:, 0] * scale)[:, None] * frames[:, 2]
    return Jets(feet, normals, shapes, scale * np.sqrt(np.maximum(left, 0.0) / freedom))


def _powers(x: Floats) -> Floats:
    """(b, 7, k) powers 0 to 6 of x (b, k)."""
    powers = np.empty((x.shape[0], 7, x.shape[1]))
    powers[:, 0], powers[:, 1] = 1.0, x
    for i in range(2, 7):
        np.multiply(powers[:, i - 1], x, out=powers[:, i])
    return powers


def _forms(c: Floats, frames: Floats, scale: Floats) -> tuple[Vectors, Floats]:
    """Normals (b, 3) and shape operators (b, 3, 3) from coefficients (b, 10)."""
    slope = c[:, 1:3]
    stretch = np.sqrt(1.0 + np.einsum("bi,bi->b", slope, slope))
    normals = (frames[:, 2] - np.einsum("bi,bic->bc", slope, frames[:, :2])) / stretch[:, None]
    second = np.empty((len(c), 2, 2))
    second[:, 0, 0], second[:, 1, 1] = 2.0 * c[:, 3], 2.0 * c[:, 5]
    second[:, 0, 1] = second[:, 1, 0] = c[:, 4]
    second /= (stretch * scale)[:, None, None]
    # tangents x_u, x_v in space, and their duals: (first form)^-1 times the tangents
    tangents = frames[:, :2] + slope[..., None] * frames[:, 2:]
    outer = slope[:, :, None] * slope[:, None, :]
    inverse = np.eye(2) - outer / (stretch**2)[:, None, None]
    duals = inverse @ tangents
    return normals, duals.transpose(0, 2, 1) @ second @ duals


def tangent_frames(normals: Vectors) -> Floats:
    """(m, 3, 3) rows: two tangents and the normal, right-handed.

    The first tangent is the coordinate axis least along the normal, made tangential.
    """
    axis = np.zeros_like(normals)
    axis[np.arange(len(normals)), np.argmin(np.abs(normals), axis=1)] = 1.0
    along = np.einsum("mc,mc->m", axis, normals)[:, None]
    first = unit(axis - along * normals)
    return np.stack([first, np.cross(normals, first), normals], axis=1)
