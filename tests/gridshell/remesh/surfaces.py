"""Surfaces whose curvature is known exactly, as triangles; about a metre in size.

``CASES`` makes them by name, with about so many triangles. Every case also knows the exact normal
and shape operator at any point, so that a quad mesh can be judged without the code that made it.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field

import numpy as np
from scipy.spatial import ConvexHull

from gridshell.arrays import unit
from gridshell.surface import (
    AnalyticSurface,
    Catenoid,
    CurvedMesh,
    Derivatives,
    Enneper,
    Helicoid,
    Hyperboloid,
    ParameterDisk,
    Scherk,
    Torus,
    TriangleMesh,
    tessellate,
)
from gridshell.surface.exact_curvature import normals_and_shapes, on_triangles

M = 1000.0


# ---- graphs z(x, y) --------------------------------------------------------------------------


@dataclass(frozen=True, eq=False)
class Graph(AnalyticSurface):
    """z(x, y), in metres, from a function to (z, zx, zy, zxx, zxy, zyy)."""

    height: Callable
    half: float = 1.0

    @property
    def length_scale(self):
        return M

    @property
    def domain(self):
        return (-self.half, self.half), (-self.half, self.half)

    def _derivatives(self, u, v):
        o, one = np.zeros_like(u), np.ones_like(u)
        z, zx, zy, zxx, zxy, zyy = (np.broadcast_to(c, u.shape) for c in self.height(u, v))
        rows = [(u, v, z), (one, o, zx), (o, one, zy), (o, o, zxx), (o, o, zxy), (o, o, zyy)]
        return Derivatives(*(M * np.stack(row, axis=-1) for row in rows))


def monkey(x, y):
    return (
        0.35 * (x**3 - 3 * x * y * y),
        1.05 * (x * x - y * y),
        -2.1 * x * y,
        2.1 * x,
        -2.1 * y,
        -2.1 * x,
    )


def saddle(x, y):
    """z = (x^2 - 0.7 y^2) / 2 and a little more, K < 0."""
    return (
        0.4 * x * x - 0.3 * y * y + 0.05 * x * y,
        0.8 * x + 0.05 * y,
        -0.6 * y + 0.05 * x,
        0.8 + 0 * x,
        0.05 + 0 * x,
        -0.6 + 0 * x,
    )


def dome(x, y):
    """An elliptic paraboloid: two umbilics of index +1/2 at x = +-0.786."""
    return (
        -0.45 * x * x - 0.3 * y * y,
        -0.9 * x,
        -0.6 * y,
        -0.9 + 0 * x,
        0 * x,
        -0.6 + 0 * x,
    )


def ridge(x, y):
    """Two umbilics of index -1/2 on a line along which the families nearly change places."""
    return (
        -0.3 * x * x - 0.2 * y * y - 0.08 * (x**4 + y**4),
        -0.6 * x - 0.32 * x**3,
        -0.4 * y - 0.32 * y**3,
        -0.6 - 0.96 * x * x,
        0 * x,
        -0.4 - 0.96 * y * y,
    )


def freeform(x, y):
    """A wavy saddle, K < 0 nearly everywhere."""
    a, b = np.sin(1.3 * x + 0.4), np.cos(1.3 * x + 0.4)
    return (
        0.35 * a * y + 0.3 * x * x - 0.25 * y * y + 0.05 * x**3,
        0.455 * b * y + 0.6 * x + 0.15 * x * x,
        0.35 * a - 0.5 * y,
        -0.5915 * a * y + 0.6 + 0.3 * x,
        0.455 * b,
        -0.5 + 0 * x,
    )


def wave(x, y):
    """K > 0 on half of it."""
    c, s = np.cos(3 * x), np.sin(3 * x)
    return 0.15 * c - 0.3 * y * y, -0.45 * s, -0.6 * y, -1.35 * c, 0 * x, -0.6 + 0 * x


def paraboloid(x, y):
    return 0.4 * (x * x + y * y), 0.8 * x, 0.8 * y, 0.8 + 0 * x, 0 * x, 0.8 + 0 * x


def flat(x, y):
    return (0.3 * x + 0 * y, 0.3 + 0 * x, 0 * x, 0 * x, 0 * x, 0 * x)


# ---- level sets ------------------------------------------------------------------------------


@dataclass(frozen=True, eq=False)
class LevelSet:
    """F(x) = 0, in metres; *inside* where F < 0."""

    value: Callable
    gradient: Callable
    hessian: Callable

    def projected(self, points, steps=12):
        x = points / M
        for _ in range(steps):
            g = self.gradient(x)
            x = x - (self.value(x) / np.einsum("nc,nc->n", g, g))[:, None] * g
        return x * M

    def shapes_at(self, points):
        x = points / M
        g = self.gradient(x)
        size = np.linalg.norm(g, axis=1)
        normal = g / size[:, None]
        across = np.eye(3) - normal[:, :, None] * normal[:, None, :]
        return normal, -across @ self.hessian(x) @ across / (M * size)[:, None, None]

    def curved(self, points, triangles):
        points = self.projected(points)
        mesh = TriangleMesh(points, triangles)
        if np.einsum("fc,fc->f", mesh.face_normals, self.gradient(mesh.centroids / M)).mean() < 0:
            mesh = TriangleMesh(points, triangles[:, ::-1])
        normals, shapes = self.shapes_at(mesh.vertices)
        return CurvedMesh(
            mesh,
            normals,
            shapes,
            on_triangles(mesh, *self.shapes_at(self.projected(mesh.centroids))),
        )


def _ellipsoid(a, b, c):
    axes = np.array([a, b, c])
    return LevelSet(
        lambda x: (x**2 / axes**2).sum(axis=1) - 1.0,
        lambda x: 2.0 * x / axes**2,
        lambda x: np.broadcast_to(np.diag(2.0 / axes**2), (len(x), 3, 3)),
    )


def _diagonals(x):
    out = np.zeros((len(x), 3, 3))
    out[:, [0, 1, 2], [0, 1, 2]] = -np.cos(x)
    return out


SCHWARZ_P = LevelSet(lambda x: np.cos(x).sum(axis=1), lambda x: -np.sin(x), _diagonals)
ELLIPSOID = _ellipsoid(1.0, 0.8, 0.6)


def quartered(points, triangles):
    """Every triangle in four."""
    ends = np.sort(np.stack([triangles, np.roll(triangles, -1, axis=1)], axis=2), axis=2)
    edges, number = np.unique(ends.reshape(-1, 2), axis=0, return_inverse=True)
    middle = len(points) + number.reshape(-1, 3)
    (a, b, c), (ab, bc, ca) = triangles.T, middle.T
    fine = np.stack([a, ab, ca, ab, b, bc, ca, bc, c, ab, bc, ca], axis=1).reshape(-1, 3)
    return np.concatenate([points, points[edges].mean(axis=1)]), fine


def _finest(points, triangles, wanted, onto):
    while len(triangles) < wanted:
        points, triangles = quartered(points, triangles)
        points = onto(points)
    return points, triangles


def icosahedron():
    t = (1.0 + 5.0**0.5) / 2.0
    none = np.zeros(4)
    a, b = np.array([1, 1, -1, -1]), t * np.array([1, -1, 1, -1])
    points = np.concatenate(
        [np.stack(c, axis=1) for c in ((a, b, none), (none, a, b), (b, none, a))]
    )
    triangles = ConvexHull(points).simplices.astype(np.int64)
    x, y, z = np.moveaxis(points[triangles], 1, 0)
    outward = np.einsum("fc,fc->f", np.cross(y - x, z - x), x) > 0
    triangles = np.where(outward[:, None], triangles, triangles[:, ::-1])
    return unit(points.astype(float)), triangles


def ellipsoid(wanted):
    points, triangles = _finest(*icosahedron(), wanted, unit)
    return ELLIPSOID.curved(M * points * [1.0, 0.8, 0.6], triangles)


def sphere_cap(wanted):
    points, triangles = _finest(*icosahedron(), 2 * wanted, unit)
    kept = triangles[points[triangles].mean(axis=1)[:, 2] > 0.1]
    used, kept = np.unique(kept, return_inverse=True)
    return _ellipsoid(1.0, 1.0, 1.0).curved(M * points[used], kept.reshape(-1, 3))


def schwarz_p(wanted):
    """The cell |x|, |y|, |z| <= pi: chi = -4, six circular rims, eight points of valence 6.

    In the cell of the cube it is cut by the planes x, y, z = +-pi. In each octant it is a hexagon
    with corners such as (pi, pi/2, 0), which the centre (pi, pi, pi)/2 divides into six.
    """
    p, h = np.pi, np.pi / 2.0
    ring = np.array([[p, h, 0], [h, p, 0], [0, p, h], [0, h, p], [h, 0, p], [p, 0, h]])
    points, triangles = [], []
    for sx in (1, -1):
        for sy in (1, -1):
            for sz in (1, -1):
                sign = np.array([sx, sy, sz])
                base = len(points)
                points += [*(ring * sign), sign * h]
                fan = [[base + k, base + (k + 1) % 6, base + 6] for k in range(6)]
                triangles += fan if sx * sy * sz > 0 else [t[::-1] for t in fan]
    points, triangles = np.array(points), np.array(triangles)
    names, number = np.unique(np.round(points, 9), axis=0, return_inverse=True)
    points, triangles = names, number.ravel()[triangles]

    def onto(x):
        """Onto the surface, within the mirror planes a point lies in."""
        for _ in range(12):
            g = -np.sin(x)
            g[np.abs(np.abs(x) - p) < 1e-9] = 0.0
            g[np.abs(x) < 1e-9] = 0.0
            x = x - (np.cos(x).sum(axis=1) / np.einsum("nc,nc->n", g, g))[:, None] * g
        return x

    points, triangles = _finest(points, triangles, wanted, onto)
    for _ in range(10):  # evenly: towards the middle of the neighbours, rims stay
        mesh = TriangleMesh(points, triangles)
        total = np.zeros_like(points)
        np.add.at(total, mesh.origin, points[mesh.target])
        inner = ~mesh.on_boundary
        mean = total / mesh.valence[:, None]
        points = points.copy()
        points[inner] = (points[inner] + mean[inner]) / 2.0
        points[inner] = onto(points[inner])
    return SCHWARZ_P.curved(M * points, triangles)


def _torus_gradient(x):
    share = 1.0 - 1.0 / np.hypot(x[:, 0], x[:, 1])
    return 2.0 * np.stack([share * x[:, 0], share * x[:, 1], x[:, 2]], axis=1)


def _torus_hessian(x):
    r = np.hypot(x[:, 0], x[:, 1])
    out = np.zeros((len(x), 3, 3))
    for i in range(2):
        for j in range(2):
            out[:, i, j] = 2.0 * ((i == j) * (1.0 - 1.0 / r) + x[:, i] * x[:, j] / r**3)
    out[:, 2, 2] = 2.0
    return out


TORUS = LevelSet(
    lambda x: (np.hypot(x[:, 0], x[:, 1]) - 1.0) ** 2 + x[:, 2] ** 2 - 0.16,
    _torus_gradient,
    _torus_hessian,
)


def closed_torus(wanted):
    rows = 2 * max(4, round(np.sqrt(wanted) / 2.0))
    columns = max(6, round(rows * 0.5))
    i, j = (x.ravel() for x in np.meshgrid(np.arange(rows), np.arange(columns), indexing="ij"))
    u, v = 2 * np.pi * i / rows, 2 * np.pi * (j + 0.5 * (i % 2)) / columns
    r = 1.0 + 0.4 * np.cos(v)
    points = M * np.stack([r * np.cos(u), r * np.sin(u), 0.4 * np.sin(v)], axis=1)
    # offset rows: the diagonal that keeps triangles even
    a, b = i * columns + j, ((i + 1) % rows) * columns + j
    c, d = ((i + 1) % rows) * columns + (j + 1) % columns, i * columns + (j + 1) % columns
    even = (i % 2 == 0)[:, None]
    one = np.where(even, np.stack([a, b, d], 1), np.stack([a, b, c], 1))
    two = np.where(even, np.stack([b, c, d], 1), np.stack([a, c, d], 1))
    return TORUS.curved(points, np.concatenate([one, two]))


# ---- the cases -------------------------------------------------------------------------------


@dataclass(frozen=True, eq=False)
class Case:
    """Triangles by their number, and (points) -> normals, shape operators of the exact surface."""

    build: Callable[[float], CurvedMesh]
    shapes_at: Callable
    _kept: dict = field(default_factory=dict)

    def triangles(self, wanted):
        """About so many triangles; made once."""
        if wanted not in self._kept:
            self._kept[wanted] = self.build(wanted)
        return self._kept[wanted]


def _formula(surface, over=None, holes=()):
    def build(wanted):
        edge = M * 0.1
        for _ in range(3):
            area = float(tessellate(surface, edge=edge, over=over, holes=holes).mesh.areas.sum())
            edge = float(np.sqrt(area / (min(wanted, 1500) * np.sqrt(3.0) / 4.0)))
        edge = float(np.sqrt(area / (wanted * np.sqrt(3.0) / 4.0)))
        return tessellate(surface, edge=edge, over=over, holes=holes)

    def shapes_at(points):
        u, v = surface._foot_parameters(points)
        return normals_and_shapes(surface.derivatives(u, v))

    return Case(build, shapes_at)


_ROUND = ParameterDisk(0.0, 0.0, 1.0)
_RING = 2.0 * np.pi

CASES = {
    "enneper": _formula(Enneper(M), ParameterDisk(0.0, 0.0, 0.7)),
    "scherk": _formula(Scherk(M), ((-0.7, 0.7), (-0.7, 0.7))),
    "catenoid": _formula(Catenoid(0.5 * M), ((0.0, _RING), (-0.8, 0.8))),
    "hyperboloid": _formula(Hyperboloid(0.5 * M, 0.7 * M), ((0.0, _RING), (-0.8, 0.8))),
    "helicoid": _formula(Helicoid(1.5 * M), ((-0.8, 0.8), (-0.8, 0.8))),
    "hypar": _formula(
        Graph(lambda x, y: (0.6 * x * y, 0.6 * y, 0.6 * x, 0 * x, 0.6 + 0 * x, 0 * x))
    ),
    "inner torus": _formula(Torus(1.0 * M, 0.4 * M), ((0.0, _RING), (-0.6, 0.6))),
    "monkey": _formula(Graph(monkey, 1.3), ParameterDisk(0.0, 0.0, 1.3)),
    "saddle with hole": _formula(Graph(saddle), _ROUND, (ParameterDisk(0.2, 0.1, 0.25),)),
    "saddle": _formula(Graph(saddle), _ROUND),
    "freeform": _formula(Graph(freeform)),
    "freeform with hole": _formula(Graph(freeform), None, (ParameterDisk(0.2, 0.1, 0.25),)),
    "dome": _formula(Graph(dome, 1.3), ((-1.3, 1.3), (-1.0, 1.0))),
    "ridge": _formula(Graph(ridge, 1.3), ((-1.0, 1.0), (-1.3, 1.3))),
    "wave": _formula(Graph(wave)),
    "paraboloid": _formula(Graph(paraboloid), _ROUND),
    "punctured": _formula(Graph(paraboloid), _ROUND, (ParameterDisk(0.0, 0.0, 0.12),)),
    "flat": _formula(Graph(flat)),
    "narrow ring": _formula(Catenoid(0.5 * M), ((0.0, _RING), (-0.05, 0.05))),
    "ellipsoid": Case(ellipsoid, ELLIPSOID.shapes_at),
    "sphere cap": Case(sphere_cap, _ellipsoid(1.0, 1.0, 1.0).shapes_at),
    "torus": Case(closed_torus, TORUS.shapes_at),
    "schwarz p": Case(schwarz_p, SCHWARZ_P.shapes_at),
}
