"""Control meshes and surfaces that figures begin with."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

import gridshell as gs
from gridshell.arrays import Floats
from gridshell.mesh import grid_quads

Height = Callable[[Floats, Floats], Floats]


def ring_on_sphere(around: int, across: int, angle: float, radius: float) -> gs.ControlMesh:
    """A sphere cut conformally into quads whose diagonals meet at *angle*, radians (Fig. 7)."""
    v = (np.arange(across + 1) - across / 2.0) * 2.0 * np.pi / around / np.tan(angle / 2.0)
    u, v = np.meshgrid(2.0 * np.pi * np.arange(around) / around, v, indexing="ij")
    xyz = [np.cos(u) / np.cosh(v), np.sin(u) / np.cosh(v), np.tanh(v)]
    points = radius * np.stack(xyz, axis=-1).reshape(-1, 3)
    return gs.as_control_mesh(gs.QuadMesh(points, grid_quads(around, across, ring=True)))


def graph(rows: int, columns: int, height: Height, size: float) -> gs.QuadMesh:
    """Quads over a rectangle of equal steps; *height* of shares of half the shorter side."""
    long = columns / rows
    x, y = np.meshgrid(
        np.linspace(-1.0, 1.0, rows + 1), np.linspace(-long, long, columns + 1), indexing="ij"
    )
    points = size * np.stack([x, y, height(x, y)], axis=-1).reshape(-1, 3)
    return gs.QuadMesh(points, grid_quads(rows, columns))


def triangles(height: Height, size: float, steps: int) -> gs.TriangulatedSurface:
    """A square of triangles, as a designer brings it (Fig. 6 a)."""
    mesh = graph(steps, steps, height, size)
    q = mesh.quads
    halves = np.concatenate([q[:, [0, 1, 2]], q[:, [0, 2, 3]]])
    return gs.TriangulatedSurface(mesh.vertices, halves)


def dome(x: Floats, y: Floats) -> Floats:
    """Curved alike to all sides, a little lopsided."""
    return np.asarray(-0.35 * x**2 - 0.25 * y**2 + 0.05 * x * y**2)


def shell(x: Floats, y: Floats) -> Floats:
    """A free form that bends much more one way than the other, to either side (Fig. 6)."""
    return np.asarray(-0.4 * x**2 + 0.05 * y**2 + 0.03 * x * y**2 + 0.04 * x**3)
