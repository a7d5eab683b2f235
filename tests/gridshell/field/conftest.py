"""Triangle meshes with the exact curvature of the surface they are taken from."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pytest

from gridshell.arrays import Floats, Indices, Points, unit
from gridshell.surface import AnalyticSurface, CurvedMesh, Derivatives, TriangleMesh, forms

Box = tuple[tuple[float, float], tuple[float, float]]
Formula = Callable[[Floats, Floats], Derivatives]


def shapes_of(d: Derivatives) -> Floats:
    """(n, 3, 3) shape operators, 1/mm."""
    frame, (a, b, c) = forms.frame(d), forms.shape_operator(d)
    e1 = unit(d.xu)
    e2 = (d.xv - frame.skew[:, None] * d.xu) / frame.width[:, None]
    form = np.stack([np.stack([a, b], -1), np.stack([b, c], -1)], -2)
    return np.einsum("nic,nij,njd->ncd", np.stack([e1, e2], 1), form, np.stack([e1, e2], 1))


def curved_mesh(formula: Formula, u: Floats, v: Floats, triangles: Indices) -> CurvedMesh:
    """The surface *formula* over triangles in parameters (n,); flipped if they turn clockwise."""
    d = formula(u, v)
    mesh = TriangleMesh(d.x, triangles)
    return CurvedMesh.of_vertices(mesh, forms.unit_normal(d), shapes_of(d))


def lattice(
    box: Box, cells: tuple[int, int], closed: tuple[bool, bool] = (False, False)
) -> tuple[Floats, Floats, Indices]:
    """Parameters (n,), (n,) of a grid over *box* and its triangles, diagonals alternating."""
    (a, b), (c, d) = box
    rows, columns = cells[0] + (not closed[0]), cells[1] + (not closed[1])
    u = a + (b - a) * np.arange(rows) / cells[0]
    v = c + (d - c) * np.arange(columns) / cells[1]
    i, j = (x.ravel() for x in np.meshgrid(np.arange(cells[0]), np.arange(cells[1]), indexing="ij"))
    p, q, r, s = (
        ((i + di) % rows) * columns + (j + dj) % columns
        for di, dj in ((0, 0), (1, 0), (1, 1), (0, 1))
    )
    even = ((i + j) % 2 == 0)[:, None]
    one = np.where(even, np.stack([p, q, r], 1), np.stack([p, q, s], 1))
    two = np.where(even, np.stack([p, r, s], 1), np.stack([q, r, s], 1))
    grid = np.meshgrid(u, v, indexing="ij")
    return grid[0].ravel(), grid[1].ravel(), np.concatenate([one, two])


@pytest.fixture(scope="session")
def on_grid() -> Callable[..., CurvedMesh]:
    """The grid over a box of parameters of a surface, *cells* along each."""

    def build(
        surface: AnalyticSurface | Formula,
        box: Box,
        cells: tuple[int, int] = (30, 30),
        closed: tuple[bool, bool] = (False, False),
    ) -> CurvedMesh:
        formula = surface.derivatives if isinstance(surface, AnalyticSurface) else surface
        return curved_mesh(formula, *lattice(box, cells, closed))

    return build


def graph(height: Callable[[Floats, Floats], tuple[Floats, ...]]) -> Formula:
    """The surface z(x, y) from z, zx, zy, zxx, zxy, zyy."""

    def formula(x: Floats, y: Floats) -> Derivatives:
        o, one = np.zeros_like(x), np.ones_like(x)
        z, zx, zy, zxx, zxy, zyy = (np.broadcast_to(c, x.shape) for c in height(x, y))
        rows = [(x, y, z), (one, o, zx), (o, one, zy), (o, o, zxx), (o, o, zxy), (o, o, zyy)]
        return Derivatives(*(np.stack(row, axis=-1) for row in rows))

    return formula


def disk(rings: int) -> tuple[Floats, Floats, Indices]:
    """A hexagonal disk of radius 1 with its centre at vertex 0."""
    from scipy.spatial import Delaunay

    points = [np.zeros((1, 2))]
    for k in range(1, rings + 1):
        turn = 2.0 * np.pi * (np.arange(6 * k) + 0.3 * k) / (6 * k)
        points.append(k / rings * np.stack([np.cos(turn), np.sin(turn)], axis=1))
    xy = np.concatenate(points)
    return xy[:, 0], xy[:, 1], Delaunay(xy).simplices.astype(np.int64)


@pytest.fixture(scope="session")
def on_disk() -> Callable[..., CurvedMesh]:
    """The unit disk, *rings* of triangles around its centre, under a height function."""

    def build(
        height: Callable[[Floats, Floats], tuple[Floats, ...]], rings: int = 20
    ) -> CurvedMesh:
        return curved_mesh(graph(height), *disk(rings))

    return build


def icosphere(level: int) -> tuple[Points, Indices]:
    """Points on the unit sphere and triangles, counter-clockwise from outside."""
    import trimesh

    sphere = trimesh.creation.icosphere(subdivisions=level)
    return np.asarray(sphere.vertices), np.asarray(sphere.faces, dtype=np.int64)


def ellipsoid_mesh(axes: tuple[float, float, float], points: Points, tri: Indices) -> CurvedMesh:
    """The ellipsoid with semi-axes *axes* at the images of unit vectors (n, 3), normals outward.

    The shape operator of the level set F = 1 is -P Hess(F) P / |grad F|.
    """
    x = points * axes
    gradient, hessian = 2.0 * x / np.square(axes), np.diag(2.0 / np.square(axes))
    size = np.linalg.norm(gradient, axis=1)
    normals = gradient / size[:, None]
    across = np.eye(3) - normals[:, :, None] * normals[:, None, :]
    shapes = -across @ hessian @ across / size[:, None, None]
    return CurvedMesh.of_vertices(TriangleMesh(x, tri), normals, shapes)


@pytest.fixture(scope="session")
def on_ellipsoid() -> Callable[..., CurvedMesh]:
    """A closed ellipsoid, or its part above *cut* times the third axis."""

    def build(
        axes: tuple[float, float, float], level: int = 4, cut: float | None = None
    ) -> CurvedMesh:
        points, triangles = icosphere(level)
        if cut is not None:
            triangles = triangles[points[triangles, 2].mean(axis=1) > cut]
            used, triangles = np.unique(triangles, return_inverse=True)
            points, triangles = points[used], triangles.reshape(-1, 3)
        return ellipsoid_mesh(axes, points, triangles)

    return build


@pytest.fixture(scope="session")
def monkey(on_disk: Callable[..., CurvedMesh]) -> Callable[[int], CurvedMesh]:
    """The monkey saddle z = x^3 - 3 x y^2 over the unit disk, in so many rings."""

    def height(x: Floats, y: Floats) -> tuple[Floats, ...]:
        cube = x**3 - 3.0 * x * y * y
        return cube, 3.0 * (x * x - y * y), -6.0 * x * y, 6.0 * x, -6.0 * y, -6.0 * x

    return lambda rings: on_disk(height, rings)


@pytest.fixture(scope="session")
def quartic(on_disk: Callable[..., CurvedMesh]) -> CurvedMesh:
    """z = Re (x + i y)^4 + 0.03 Re (x + i y)^2: two points of index -1/2, 0.15 apart."""

    def height(x: Floats, y: Floats) -> tuple[Floats, ...]:
        return (
            x**4 - 6.0 * x * x * y * y + y**4 + 0.03 * (x * x - y * y),
            4.0 * x**3 - 12.0 * x * y * y + 0.06 * x,
            -12.0 * x * x * y + 4.0 * y**3 - 0.06 * y,
            12.0 * (x * x - y * y) + 0.06,
            -24.0 * x * y,
            12.0 * (y * y - x * x) - 0.06,
        )

    return on_disk(height, 40)


@pytest.fixture(scope="session")
def turned_over() -> Callable[[CurvedMesh], CurvedMesh]:
    """The same surface with the other side up; triangles keep their numbers and first edges."""

    def flip(curved: CurvedMesh) -> CurvedMesh:
        mesh = TriangleMesh(curved.mesh.vertices, curved.mesh.triangles[:, [1, 0, 2]])
        # row 0 of the frames turns round and row 1 stays: the mixed component changes sign twice
        shapes = curved.face_shapes * [-1.0, 1.0, -1.0]
        return CurvedMesh(mesh, -curved.normals, -curved.shapes, shapes)

    return flip


@pytest.fixture(scope="session")
def plane(on_grid: Callable[..., CurvedMesh]) -> CurvedMesh:
    """A flat square of side 1."""
    return on_grid(graph(lambda x, y: (x * 0.0,) * 6), ((0.0, 1.0), (0.0, 1.0)), (16, 16))


@pytest.fixture(scope="session")
def with_forms(plane: CurvedMesh) -> Callable[[Floats], CurvedMesh]:
    """Triangles in a plane that claim the shape operators (f, 3), repeated over all of them."""

    def build(forms_: Floats) -> CurvedMesh:
        rows = np.resize(forms_, (len(plane.mesh.triangles), 3))
        return CurvedMesh(plane.mesh, plane.normals, plane.shapes, rows)

    return build
