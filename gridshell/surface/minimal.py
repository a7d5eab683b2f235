"""The minimal surface spanned by closed curves.

The triangles of a planar mesh, laid into space by a harmonic map, are pulled to least area: every
step solves the Laplace equation on the surface of the step before (U. Pinkall and K. Polthier,
Computing discrete minimal surfaces and their conjugates, Experimental Mathematics 2, 1993). Flips
and moves within the surface keep the triangles well shaped. A coarse surface comes first; the mesh
proper is made over the same domain, measured on that surface, so that its edges are even in space.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np

from gridshell.arrays import Floats, Indices, Points
from gridshell.errors import NoMinimalSurfaceError, SettingError
from gridshell.surface.flat_domain import Flattening, laid_out, length
from gridshell.surface.forms import Derivatives, dot
from gridshell.surface.planar_mesher import flipped, mesh_domain
from gridshell.surface.surface import checked_points
from gridshell.surface.triangle_mesh import TriangleMesh, place

_COARSE = 3.0  # times the edge: the first mesh
_AROUND = 36.0  # edges of the first mesh along the shortest curve, at least
_SHAPING = 30  # first steps, in which triangles are flipped and moved
_STEPS = 200
_PATIENCE = 5  # steps without getting closer
_RESIDUAL = 1e-8
_NECK = 0.3
"""A ring of the surface shorter than this times the shortest boundary curve is a collapsing neck;
between equal circles the catenoid never has less than 0.55."""


def minimal_surface(loops: Sequence[Points], *, edge: float) -> TriangleMesh:
    """Find the minimal surface that *loops* bound.

    Parameters
    ----------
    loops : closed polylines (k, 3), mm, without the first point repeated. One bounds a disk, two a
        ring; their senses do not matter. Three and more must project onto a plane as one outline
        and holes.
    edge : wanted length of the triangles' edges, mm.

    Returns
    -------
    Triangles at rest: the last step along the normals was below 1e-8 of an edge. Corners of the
    curves are kept, and points between them put where the edge length wants them. The positive
    side is the one from which the outline (the largest curve) runs counter-clockwise.

    Raises
    ------
    SettingError
        When there is no loop, or *edge* makes too many triangles.
    NoMinimalSurfaceError
        When a neck closes, naming where, or the steps do not settle: curves too far apart.
    SurfaceError
        When three or more loops do not project onto a plane without crossing.
    """
    curves = [checked_points(loop) for loop in loops]
    if not curves or min(len(c) for c in curves) < 3:
        raise SettingError(
            "A minimal surface needs closed curves of three points or more",
            where="loops",
            value=f"{[len(c) for c in curves]} points",
        )
    flattening = Flattening.of(curves)
    first = max(edge, min(_COARSE * edge, min(length(c) for c in curves) / _AROUND))
    flat, border = laid_out(curves, flattening, first)
    guide = _Guide(*_first_mesh(flat, border, first))
    guide = _Guide(guide.flat, guide.triangles, _pulled(guide.x, guide.triangles, border)[0])
    flat, border = laid_out(curves, flattening, edge)
    uv, triangles = mesh_domain(guide.derivatives, flat, edge=edge)
    x = guide.derivatives(*uv.T).x
    fixed = np.concatenate(border)
    x[: len(fixed)] = fixed
    return TriangleMesh(*_pulled(x, triangles, border))


def _first_mesh(
    flat: list[Floats], border: list[Points], edge: float
) -> tuple[Floats, Indices, Points]:
    """A mesh of the flat domain and its harmonic lift into space."""
    around = sum(float(np.linalg.norm(f - np.roll(f, -1, axis=0), axis=1).sum()) for f in flat)
    scale = around / sum(length(b) for b in border)

    def plane(u: Floats, v: Floats) -> Derivatives:
        zero, one = np.zeros_like(u), np.ones_like(u)
        x = np.stack([u, v, zero], axis=1)
        xu, xv = np.stack([one, zero, zero], axis=1), np.stack([zero, one, zero], axis=1)
        return Derivatives(x, xu, xv, 0.0 * x, 0.0 * x, 0.0 * x)

    uv, triangles = mesh_domain(plane, flat, edge=edge * scale)
    fixed = np.concatenate(border)
    x = np.concatenate([fixed, np.zeros((len(uv) - len(fixed), 3))])
    return (
        uv,
        triangles,
        _solved(_stiffness(np.pad(uv, ((0, 0), (0, 1))), triangles), x, len(fixed)),
    )


@dataclass(frozen=True, eq=False)
class _Guide:
    """A surface over its flat domain, linear on every flat triangle."""

    flat: Floats
    triangles: Indices
    x: Points

    def derivatives(self, u: Floats, v: Floats) -> Derivatives:
        """The point and both derivatives at flat places; second derivatives are zero.

        A place outside belongs to the triangle it is least far out of.
        """
        places = np.stack([u, v], axis=1)
        near = self._tree.query(places, k=min(12, len(self.triangles)))[1].reshape(len(u), -1)
        offset = places[:, None] - self.flat[self.triangles[near, 0]]
        share = np.einsum("nkij,nkj->nki", self._inverse[near], offset)
        least = np.minimum(share.min(axis=2), 1.0 - share.sum(axis=2))
        pick = near[np.arange(len(u)), np.argmax(least, axis=1)]
        a, b, c = np.moveaxis(self.x[self.triangles[pick]], 1, 0)
        offset = places - self.flat[self.triangles[pick, 0]]
        jacobian = np.einsum("nci,nij->ncj", np.stack([b - a, c - a], axis=2), self._inverse[pick])
        x = a + np.einsum("ncj,nj->nc", jacobian, offset)
        none = np.zeros_like(x)
        return Derivatives(x, jacobian[:, :, 0], jacobian[:, :, 1], none, none, none)

    @cached_property
    def _tree(self) -> Any:
        from scipy.spatial import cKDTree

        return cKDTree(self.flat[self.triangles].mean(axis=1))

    @cached_property
    def _inverse(self) -> Floats:
        a, b, c = np.moveaxis(self.flat[self.triangles], 1, 0)
        return np.asarray(np.linalg.inv(np.stack([b - a, c - a], axis=2)))


# ---- least area --------------------------------------------------------------------------------


def _pulled(x: Points, triangles: Indices, border: list[Points]) -> tuple[Points, Indices]:
    """Vertices, of which the border's come first and stay, and triangles at rest."""
    fixed = sum(len(b) for b in border)
    if fixed == len(x):
        return x, flipped(None, x, triangles)
    edge = length(border[0]) / len(border[0])
    for step in range(_SHAPING):
        triangles = flipped(None, x, triangles)
        x = _shaped(x, triangles, fixed)
        stiffness = _stiffness(x, triangles)
        if step % 5 == 0:
            _require_open(stiffness, x, triangles, border)
        x = _solved(stiffness, x, fixed)
    return _at_rest(x, triangles, border, edge), triangles


def _at_rest(x: Points, triangles: Indices, border: list[Points], edge: float) -> Points:
    """Vertices moved along their normals only, by Newton's method for the area.

    The second variation of area along normals N is ``N' L N - 2 |A|^2``, with the squared norm of
    the second fundamental form taken from the differences of the normals.
    """
    from scipy.sparse import diags_array
    from scipy.sparse.linalg import splu

    fixed = sum(len(b) for b in border)
    normals = TriangleMesh(x, triangles).vertex_normals
    moved, shrinking, newton = np.inf, 0, True
    for step in range(_STEPS):
        stiffness = _stiffness(x, triangles)
        if step % 5 == 0:
            _require_open(stiffness, x, triangles, border)
        entries = stiffness.tocoo()
        i, j = entries.coords
        aligned = dot(normals[i], normals[j])
        hessian = entries.copy()
        hessian.data = entries.data * aligned
        # off the diagonal entries are -w: their sum with 1 - n.n' is -|A|^2 times the area
        bent = np.bincount(i, entries.data * (1.0 - aligned), len(x))
        matrix = hessian.tocsc() + (2.0 if newton else 0.0) * diags_array(bent).tocsc()
        force = dot(stiffness @ x, normals)
        offset = splu(matrix[fixed:, fixed:].tocsc()).solve(-force[fixed:])
        largest = float(np.abs(offset).max()) / edge
        if not np.isfinite(largest):
            break
        shrinking = 0 if largest < moved else shrinking + 1
        newton = newton and shrinking == 0 and largest < 0.5
        if shrinking > _PATIENCE or largest > 10.0:
            break
        moved = min(moved, largest)
        x = x.copy()
        x[fixed:] += offset[:, None] * normals[fixed:] * min(1.0, 0.5 / max(largest, 1e-300))
        if largest < _RESIDUAL:
            return x
    raise NoMinimalSurfaceError(
        "The surface does not come to rest",
        value=f"still moving by {moved:.3g} edges a step",
        limit=f"{_RESIDUAL} edges",
        advice="bring the curves closer together, or give a shorter edge",
    )


def _stiffness(x: Points, triangles: Indices) -> Any:
    """The cotangent Laplacian (n, n): positive semi-definite, without unit."""
    from scipy.sparse import coo_array

    corners = x[triangles]
    ahead = np.roll(corners, -1, axis=1) - corners
    behind = np.roll(corners, 1, axis=1) - corners
    sine = np.linalg.norm(np.cross(ahead, behind), axis=2)
    cosine = dot(ahead, behind)
    weight = cosine / np.maximum(2.0 * sine, 1e-6 * np.abs(cosine) + 1e-300)
    i, j = np.roll(triangles, -1, axis=1).ravel(), np.roll(triangles, 1, axis=1).ravel()
    w = weight.ravel()
    rows, columns = np.concatenate([i, j, i, j]), np.concatenate([j, i, i, j])
    values = np.concatenate([-w, -w, w, w])
    return coo_array((values, (rows, columns)), shape=(len(x),) * 2).tocsc()


def _solved(stiffness: Any, x: Floats, fixed: int) -> Floats:
    """Values (n, k) that are harmonic after the first *fixed* ones."""
    from scipy.sparse.linalg import splu

    if fixed == len(x):
        return x
    free = stiffness[fixed:, fixed:]
    right = -stiffness[fixed:, :fixed] @ x[:fixed]
    inner = splu(free.tocsc(), permc_spec="COLAMD").solve(np.ascontiguousarray(right))
    return np.concatenate([x[:fixed], inner])


def _shaped(x: Points, triangles: Indices, fixed: int) -> Points:
    """Every free vertex moved within the surface to the centre of gravity of its triangles."""
    corners, n, rows = x[triangles], len(x), triangles.ravel()
    normal = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    area = np.linalg.norm(normal, axis=1)
    pull, centre = np.repeat(area, 3), corners.mean(axis=1)

    def gathered(values: Floats) -> Floats:
        columns = [np.bincount(rows, np.repeat(values[:, c], 3), n) for c in range(3)]
        return np.stack(columns, axis=1)

    step = gathered(area[:, None] * centre) / np.bincount(rows, pull, n)[:, None] - x
    side = gathered(normal)
    side /= np.maximum(np.linalg.norm(side, axis=1, keepdims=True), 1e-300)
    step -= dot(step, side)[:, None] * side
    step[:fixed] = 0.0
    return x + 0.6 * step


def _require_open(stiffness: Any, x: Points, triangles: Indices, border: list[Points]) -> None:
    """Refuse a neck: a short ring of the surface around one of several curves.

    The rings are level lines of the harmonic function that is 1 on the curve and 0 on the others.
    """
    if len(border) < 2:
        return
    fixed, shortest = sum(len(b) for b in border), min(length(b) for b in border)
    ends = np.cumsum([len(b) for b in border])
    for k in range(1, len(border)):
        height = np.zeros((len(x), 1))
        height[ends[k - 1] : ends[k]] = 1.0
        height = _solved(stiffness, height, fixed)
        for level in np.linspace(0.06, 0.94, 23):
            around, middle = _ring(x, triangles, height[:, 0], level)
            if around < _NECK * shortest:
                raise NoMinimalSurfaceError(
                    "A neck of the surface closes: the curves are too far apart to be joined",
                    where=f"the neck near {place(middle)}",
                    value=f"{around:.6g} mm around",
                    limit=f"> {_NECK * shortest:.6g} mm, {_NECK} of the shortest curve",
                    advice="bring the curves closer together; equal circles may be at most 1.32 "
                    "radii apart",
                )


def _ring(x: Points, triangles: Indices, height: Floats, level: float) -> tuple[float, Floats]:
    """Length of the level line of *height* (n,) and its middle (3,), mm."""
    value, corners = height[triangles] - level, x[triangles]
    following, ahead = np.roll(value, -1, axis=1), np.roll(corners, -1, axis=1)
    crossed = (value < 0.0) != (following < 0.0)
    both = crossed.sum(axis=1) == 2
    change = np.where(crossed, value - following, 1.0)
    point = corners + (value / change)[..., None] * (ahead - corners)
    ends = point[both][crossed[both]].reshape(-1, 2, 3)
    around = np.linalg.norm(ends[:, 1] - ends[:, 0], axis=1)
    middle = np.average(ends.mean(axis=1), axis=0, weights=around + 1e-300)
    return float(around.sum()), middle
