"""Meshes the tests share, as session-scoped factories."""

from __future__ import annotations

from collections.abc import Callable
from importlib.util import module_from_spec, spec_from_file_location
from pathlib import Path
from types import ModuleType

import numpy as np
import pytest
from hypothesis import settings

import gridshell as gs
from gridshell.arrays import Floats, Indices, Points
from gridshell.mesh import grid_quads

settings.register_profile("no deadline", deadline=None)
settings.load_profile("no deadline")

Height = Callable[[Floats, Floats], Floats]


def _lattice(rows: int, columns: int) -> Points:
    i, j = np.meshgrid(np.arange(rows + 1.0), np.arange(columns + 1.0), indexing="ij")
    return np.stack([i, j, np.zeros_like(i)], axis=-1).reshape(-1, 3)


@pytest.fixture(scope="session")
def grid() -> Callable[..., gs.QuadMesh]:
    """Unit squares, vertex (i, j) at position (i, j) and index i * (columns + 1) + j."""

    def build(rows: int, columns: int, height: Height | None = None) -> gs.QuadMesh:
        vertices = _lattice(rows, columns)
        if height is not None:
            vertices[:, 2] = height(vertices[:, 0], vertices[:, 1])
        return gs.QuadMesh(vertices, grid_quads(rows, columns))

    return build


@pytest.fixture(scope="session")
def annulus() -> Callable[..., gs.QuadMesh]:
    """A flat ring; vertex (i, j) is the i-th around and the j-th outwards."""

    def build(around: int, across: int = 4) -> gs.QuadMesh:
        angle, radius = np.meshgrid(
            2.0 * np.pi * np.arange(around) / around, 2.0 + np.arange(across + 1.0), indexing="ij"
        )
        xyz = [radius * np.cos(angle), radius * np.sin(angle), np.zeros_like(angle)]
        vertices = np.stack(xyz, axis=-1).reshape(-1, 3)
        return gs.QuadMesh(vertices, grid_quads(around, across, ring=True)[:, ::-1])

    return build


@pytest.fixture(scope="session")
def torus() -> Callable[[int, int], gs.QuadMesh]:
    """A closed mesh without singular vertices; vertex (i, j) has index i * columns + j."""

    def build(rows: int, columns: int) -> gs.QuadMesh:
        i, j = np.meshgrid(np.arange(rows), np.arange(columns), indexing="ij")
        u, v = 2.0 * np.pi * i / rows, 2.0 * np.pi * j / columns
        radius = 3.0 + np.cos(v)
        vertices = np.stack([radius * np.cos(u), radius * np.sin(u), np.sin(v)], axis=-1)
        right, up = (i + 1) % rows, (j + 1) % columns
        corners = [i * columns + j, right * columns + j, right * columns + up, i * columns + up]
        quads = np.stack([c.ravel() for c in corners], axis=1)
        return gs.QuadMesh(vertices.reshape(-1, 3), quads)

    return build


@pytest.fixture(scope="session")
def cube() -> gs.QuadMesh:
    """Closed, eight vertices of valence three."""
    vertices = np.array([[x, y, z] for x in (0, 1) for y in (0, 1) for z in (0, 1)], dtype=float)
    quads = [
        [0, 1, 3, 2],
        [4, 6, 7, 5],
        [0, 4, 5, 1],
        [2, 3, 7, 6],
        [0, 2, 6, 4],
        [1, 5, 7, 3],
    ]
    return gs.QuadMesh(vertices, quads)


@pytest.fixture(scope="session")
def moebius() -> tuple[Points, Indices]:
    """Vertices and quads of a strip of nine quads with half a twist."""
    n = 9
    angle = 2.0 * np.pi * np.arange(n) / n
    rims = []
    for side in (-0.5, 0.5):
        radius = 3.0 + side * np.cos(angle / 2.0)
        rims.append([radius * np.cos(angle), radius * np.sin(angle), side * np.sin(angle / 2.0)])
    vertices = np.transpose(rims, (2, 0, 1)).reshape(-1, 3)
    quads = [[2 * k, 2 * k + 2, 2 * k + 3, 2 * k + 1] for k in range(n - 1)]
    quads.append([2 * n - 2, 1, 0, 2 * n - 1])
    return vertices, np.array(quads)


@pytest.fixture(scope="session")
def sectors() -> Callable[..., gs.QuadMesh]:
    """*valence* rhombic sectors of size x size quads around vertex 0: flat, one singular vertex."""

    def build(valence: int, size: int = 4) -> gs.QuadMesh:
        rays = 2.0 * np.pi * np.arange(valence + 1) / valence
        index: dict[object, int] = {}
        vertices: list[Floats] = []

        def vertex(s: int, i: int, j: int) -> int:
            inner = (s, i, j) if j else (s, i)
            key = "centre" if i == j == 0 else ((s + 1) % valence, j) if i == 0 else inner
            if key not in index:
                index[key] = len(vertices)
                a, b = rays[s], rays[s + 1]
                x, y = i * np.cos(a) + j * np.cos(b), i * np.sin(a) + j * np.sin(b)
                vertices.append(np.array([x, y, 0.0]))
            return index[key]

        quads = [
            [vertex(s, i, j), vertex(s, i + 1, j), vertex(s, i + 1, j + 1), vertex(s, i, j + 1)]
            for s in range(valence)
            for i in range(size)
            for j in range(size)
        ]
        return gs.QuadMesh(np.array(vertices), quads)

    return build


@pytest.fixture(scope="session")
def monkey_saddle(sectors: Callable[..., gs.QuadMesh]) -> gs.QuadMesh:
    """A disk around vertex 0 of valence 6, lifted to z = 0.02 Re (x + i y)^3."""
    flat = sectors(6)
    x, y, _ = flat.vertices.T
    return flat.moved(np.stack([x, y, 0.02 * (x**3 - 3.0 * x * y * y)], axis=1))


@pytest.fixture(scope="session")
def l_shape() -> Callable[[int], gs.QuadMesh]:
    """Three n x n squares of the 2n x 2n grid around the reflex corner (n, n)."""

    def build(n: int) -> gs.QuadMesh:
        vertices, quads = _lattice(2 * n, 2 * n), grid_quads(2 * n, 2 * n)
        centres = vertices[quads].mean(axis=1)
        return gs.QuadMesh(vertices, quads[(centres[:, 0] < n) | (centres[:, 1] < n)])

    return build


@pytest.fixture(scope="session")
def enneper() -> Callable[[int], gs.ControlMesh]:
    """A control mesh on Enneper's surface, almost a net at 90 degrees; 36 cells are 1440 quads."""

    def build(cells: int) -> gs.ControlMesh:
        patch = gs.BisectingPatch(u=(-0.7, 0.7), v=(-0.7778, 0.7778), cells=cells)
        return gs.control_patch(gs.Enneper(4000.0), patch)

    return build


@pytest.fixture(scope="session")
def brep_shapes() -> ModuleType:
    """Makers of kernel shapes, in the file beside this one."""
    spec = spec_from_file_location("brep_shapes", Path(__file__).with_name("brep_shapes.py"))
    assert spec is not None
    assert spec.loader is not None
    module = module_from_spec(spec)
    spec.loader.exec_module(module)
    return module
