"""Near-uniform triangles over a trimmed parameter domain, measured on the surface itself.

1. A *chart* stretches u and v so that lengths in it are nearly those in space.
2. Interior points: the longest possible sequence of points none of which is closer to an earlier
   one than 0.71 of the edge, measured in space (dart throwing over a low-discrepancy sequence).
3. Delaunay triangulation in the chart, boundary edges recovered by flips, outside taken away.
4. A few rounds of edge flips (Delaunay in space) and moves to the centroid of the neighbourhood.

Sources: R. Bridson, Fast Poisson disk sampling, SIGGRAPH 2007 (idea); S. W. Sloan, A fast algorithm
for generating constrained Delaunay triangulations, Computers & Structures 47 (1993) (3);
L. Chen, Mesh smoothing schemes based on optimal Delaunay triangulations, IMR 2004, section 3 (4).
"""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np

from gridshell.arrays import Floats, Indices, Mask
from gridshell.errors import SettingError, SurfaceError
from gridshell.surface.chart import Chart
from gridshell.surface.constrained_delaunay import constrained_delaunay, inside
from gridshell.surface.forms import Derivatives, dot

Evaluate = Callable[[Floats, Floats], Derivatives]

LARGEST = 2_000_000
"""Triangles; more are a mistake in the edge length."""

_SPACING = 0.71  # of the edge: this gives triangles whose mean edge is the edge asked for
_FROM_BOUNDARY = 0.6
_CANDIDATES = 9  # per interior point
_ROUNDS = 10
_LARGEST_FLIPS = 200


def mesh_domain(
    evaluate: Evaluate, loops: Sequence[Floats], *, edge: float
) -> tuple[Floats, Indices]:
    """Triangulate the domain inside *loops* with edges of about *edge* mm on the surface.

    Parameters
    ----------
    evaluate : the surface at parameters u, v (n,); only x, xu and xv are used.
    loops : closed polygons (k, 2) in (u, v), without the first point repeated; the one that
        encloses most is the outline, the others are holes. Their points are kept as they are, so
        they should be about *edge* apart in space. A side that shrinks to a point of the surface
        (a pole) may have any number of points.
    edge : mm.

    Returns
    -------
    Parameters (n, 2), the points of the loops first and in their order, and triangles (f, 3),
    counter-clockwise in (u, v).

    Raises
    ------
    SettingError
        When *edge* would make no or more than two million triangles.
    SurfaceError
        When the loops cross each other or themselves.
    """
    loops = _oriented(loops)
    border = np.concatenate(loops)
    chart = Chart.of(evaluate, border)
    polygons = [chart.to_chart(loop) for loop in loops]
    inner = _interior(chart, polygons, edge)
    points = np.concatenate([*polygons, inner])
    triangles = constrained_delaunay(points, _edges(loops))
    points, triangles = _relaxed(chart, points, triangles, len(border))
    return np.concatenate([border, chart.to_parameters(points[len(border) :])]), triangles


def _oriented(loops: Sequence[Floats]) -> list[Floats]:
    """The outline counter-clockwise, holes clockwise; the order of points must be right already.

    Raises
    ------
    SurfaceError
        For a loop that runs the wrong way round.
    """
    loops = [np.asarray(loop, dtype=np.float64) for loop in loops]
    areas = np.array([signed_area(loop) for loop in loops])
    outline = int(np.argmax(np.abs(areas)))
    for number, area in enumerate(areas):
        if (area > 0.0) != (number == outline) or area == 0.0:
            raise SurfaceError(
                "A loop of the parameter domain runs the wrong way round",
                where=f"loop {number}",
                value=f"signed area {area:.6g}",
                limit="outline counter-clockwise, holes clockwise",
            )
    return loops


def signed_area(loop: Floats) -> float:
    """Area inside a closed polygon (k, 2), negative when it runs clockwise."""
    following = np.roll(loop, -1, axis=0)
    return float((loop[:, 0] * following[:, 1] - loop[:, 1] * following[:, 0]).sum() / 2.0)


def _edges(loops: Sequence[Floats]) -> Indices:
    """Directed boundary edges (k, 2) between consecutive points of each loop."""
    rows, start = [], 0
    for loop in loops:
        index = start + np.arange(len(loop))
        rows.append(np.stack([index, np.roll(index, -1)], axis=1))
        start += len(loop)
    return np.concatenate(rows)


def _interior(chart: Chart, polygons: Sequence[Floats], edge: float) -> Floats:
    """Points (n, 2) of the chart inside the domain, about *edge* apart in space."""
    from scipy.spatial import cKDTree

    corner = np.concatenate(polygons)
    share = abs(sum(signed_area(p) for p in polygons)) / float(np.prod(np.ptp(corner, axis=0)))
    require_few(chart.area * share, edge)
    wanted = chart.area / (edge * edge * 0.866)
    candidates = chart.samples(int(_CANDIDATES * wanted) + 16)
    candidates = candidates[inside(candidates, polygons)]
    places = chart.derivatives(candidates).x
    halves = [(p + np.roll(p, -1, axis=0)) / 2.0 for p in polygons]
    border = cKDTree(chart.derivatives(np.concatenate([corner, *halves])).x)
    free = border.query(places)[0] > _FROM_BOUNDARY * edge
    candidates, places = candidates[free], places[free]
    return np.asarray(candidates[_apart(places, _SPACING * edge)])


def require_few(area: float, edge: float) -> None:
    """Refuse an edge length, mm, that makes more than two million triangles on *area*, mm2.

    Raises
    ------
    SettingError
        Also for an edge length that is not positive.
    """
    if not edge > 0.0 or 2.0 * area > LARGEST * edge * edge * 0.866:
        raise SettingError(
            "The edge length makes too many triangles",
            where="edge",
            value=f"{edge:.6g} mm on {area:.4g} mm2",
            limit=f"> 0 mm and fewer than {LARGEST} triangles",
            advice="give a longer edge",
        )


def _apart(places: Floats, distance: float) -> Mask:
    """Choose in order every place (n, 3) that is not too close to one chosen before."""
    from scipy.spatial import cKDTree

    count = len(places)
    chosen, waiting = np.zeros(count, dtype=bool), np.ones(count, dtype=bool)
    if count == 0:
        return chosen
    pairs = cKDTree(places).query_pairs(distance, output_type="ndarray")
    early, late = pairs.min(axis=1), pairs.max(axis=1)
    while waiting.any():
        blocked = np.zeros(count, dtype=bool)
        blocked[late] = True
        now = waiting & ~blocked
        chosen |= now
        gone = np.zeros(count, dtype=bool)
        gone[late[now[early]]] = True
        waiting &= ~(now | gone)
        keep = waiting[early] & waiting[late]
        early, late = early[keep], late[keep]
    return chosen


# ---- rounds of flips and moves -----------------------------------------------------------------


def _relaxed(
    chart: Chart, points: Floats, triangles: Indices, fixed: int
) -> tuple[Floats, Indices]:
    """Flip edges and move the points after the first *fixed* ones; all in the chart."""
    points = points.copy()
    d = chart.derivatives(points)
    triangles = flipped(points, d.x, triangles)
    for _ in range(_ROUNDS if len(points) > fixed else 0):
        step = _towards_centroids(d, triangles)
        step[:fixed] = 0.0
        points = _moved(points, step, triangles)
        d = chart.derivatives(points)
        triangles = flipped(points, d.x, triangles)
    return points, triangles


def _towards_centroids(d: Derivatives, triangles: Indices) -> Floats:
    """Chart steps (n, 2) to the centre of gravity of each point's triangles in space."""
    corners = d.x[triangles]
    area = np.linalg.norm(
        np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]), axis=1
    )
    centre, n, rows = corners.mean(axis=1), len(d.x), triangles.ravel()
    pull = np.repeat(area, 3)
    mass = np.bincount(rows, pull, n)
    goal = np.stack(
        [np.bincount(rows, pull * np.repeat(centre[:, c], 3), n) for c in range(3)], axis=1
    )
    offset = goal / np.where(mass > 0.0, mass, 1.0)[:, None] - d.x
    e, f, g = dot(d.xu, d.xu), dot(d.xu, d.xv), dot(d.xv, d.xv)
    bu, bv = dot(offset, d.xu), dot(offset, d.xv)
    determinant = e * g - f * f
    regular = determinant > 1e-12 * e * g
    scale = np.where(regular, 1.0 / np.where(regular, determinant, 1.0), 0.0)
    return np.stack([(g * bu - f * bv) * scale, (e * bv - f * bu) * scale], axis=1)


def _moved(points: Floats, step: Floats, triangles: Indices) -> Floats:
    """Take the steps, halved around every triangle they would turn over."""
    factor = np.ones(len(points))
    for _ in range(12):
        trial = points + factor[:, None] * step
        bad = _areas(trial[triangles]) <= 0.1 * np.minimum(_areas(points[triangles]), np.inf)
        if not bad.any():
            return trial
        factor[triangles[bad].ravel()] *= 0.4
    factor[triangles[bad].ravel()] = 0.0
    trial = points + factor[:, None] * step
    return trial if (_areas(trial[triangles]) > 0.0).all() else points


def _areas(corners: Floats) -> Floats:
    """Twice the signed areas (f,) of triangles (f, 3, 2)."""
    a, b = corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]
    area: Floats = a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0]
    return area


def flipped(points: Floats | None, places: Floats, triangles: Indices) -> Indices:
    """Flip edges until the two angles opposite each one in space add up to at most pi.

    Parameters
    ----------
    points : (n, 2) chart positions in which no triangle may turn over, or None where there is no
        chart: then no normal may turn by more than a right angle.
    places : (n, 3) positions in space, mm.
    triangles : (f, 3), counter-clockwise.
    """
    triangles = triangles.copy()
    for _ in range(_LARGEST_FLIPS):
        first, second = inner_pairs(triangles, len(places))
        angle = _angles(places[triangles]).ravel()
        excess = angle[_across(first)] + angle[_across(second)] - np.pi
        bad = excess > 1e-9
        first, second, excess = first[bad], second[bad], excess[bad]
        a, b = triangles.ravel()[first], triangles.ravel()[second]
        c, d = triangles.ravel()[_across(first)], triangles.ravel()[_across(second)]
        new = np.stack([np.stack([c, a, d], axis=1), np.stack([d, b, c], axis=1)], axis=1)
        allowed = _may_be(points, places, new, triangles[first // 3]) & (c != d)
        allowed &= ~_exists(triangles, c, d, len(places))
        first, second, new = first[allowed], second[allowed], new[allowed]
        excess = excess[allowed]
        if not len(first):
            break
        worst = np.zeros(len(triangles))
        np.maximum.at(worst, first // 3, excess)
        np.maximum.at(worst, second // 3, excess)
        now = (excess >= worst[first // 3]) & (excess >= worst[second // 3])
        taken = np.full(len(triangles), len(first), dtype=np.int64)
        order = np.flatnonzero(now)
        np.minimum.at(taken, first[order] // 3, order)
        np.minimum.at(taken, second[order] // 3, order)
        order = order[(taken[first[order] // 3] == order) & (taken[second[order] // 3] == order)]
        triangles[first[order] // 3] = new[order, 0]
        triangles[second[order] // 3] = new[order, 1]
    return triangles


def inner_pairs(triangles: Indices, count: int) -> tuple[Indices, Indices]:
    """Half-edges 3 f + k of the inner edges, once each, and the half-edges opposite to them."""
    origin, target = triangles.ravel(), np.roll(triangles, -1, axis=1).ravel()
    key = np.minimum(origin, target) * count + np.maximum(origin, target)
    order = np.argsort(key, kind="stable")
    pair = np.flatnonzero(key[order][1:] == key[order][:-1])
    return order[pair], order[pair + 1]


def _across(halfedge: Indices) -> Indices:
    """The corner of its triangle that a half-edge does not touch, as 3 f + k."""
    return halfedge - halfedge % 3 + (halfedge + 2) % 3


def _angles(corners: Floats) -> Floats:
    """Angles (f, 3) at the corners of triangles (f, 3, 3); a right angle where a side vanishes."""
    ahead = np.roll(corners, -1, axis=1) - corners
    behind = np.roll(corners, 1, axis=1) - corners
    angle: Floats = np.arctan2(np.linalg.norm(np.cross(ahead, behind), axis=2), dot(ahead, behind))
    short = (dot(ahead, ahead) == 0.0) | (dot(behind, behind) == 0.0)
    return np.where(short, np.pi / 2.0, angle)


def _may_be(points: Floats | None, places: Floats, new: Indices, old: Indices) -> Mask:
    """Whether both new triangles (k, 2, 3) face the way the old ones (k, 3) did."""
    if points is not None:
        return (_areas(points[new[:, 0]]) > 0.0) & (_areas(points[new[:, 1]]) > 0.0)

    def normal(t: Indices) -> Floats:
        corner = places[t]
        return np.cross(corner[:, 1] - corner[:, 0], corner[:, 2] - corner[:, 0])

    reference = normal(old)
    return (dot(normal(new[:, 0]), reference) > 0.0) & (dot(normal(new[:, 1]), reference) > 0.0)


def _exists(triangles: Indices, a: Indices, b: Indices, count: int) -> Mask:
    """Whether the edges a-b are in the mesh already."""
    origin, target = triangles.ravel(), np.roll(triangles, -1, axis=1).ravel()
    keys = np.unique(np.minimum(origin, target) * count + np.maximum(origin, target))
    wanted = np.minimum(a, b) * count + np.maximum(a, b)
    return np.isin(wanted, keys)
