"""Inputs of the benchmarks: the comparison's five families, and meshes of Table 1's sizes."""

import numpy as np

import gridshell as gs
from gridshell.mesh import grid_quads

SIZES = {1440: (36, 40), 10_000: (100, 100), 100_000: (250, 400)}
NOISE_SEED = 7


def _enneper(u, v):
    return [u - u**3 / 3 + u * v * v, -v + v**3 / 3 - v * u * u, u * u - v * v]


def _along_edges(s, t):
    return _enneper((s + t) * 0.6 * np.sqrt(2.0), (s - t) * 0.6 * np.sqrt(2.0))


_FAMILIES = {
    "ennd": (0.7, _enneper),
    "enne": (0.5, _along_edges),
    "tran": (1.0, lambda u, v: [u, v, 0.3 * np.sin(2 * u) + 0.35 * np.cos(1.7 * v)]),
    "wave": (
        1.0,
        lambda u, v: [
            u + 0.05 * np.sin(3 * v),
            v + 0.05 * np.sin(2 * u),
            0.35 * np.sin(1.5 * u + 0.7 * v) * np.cos(1.1 * v) + 0.2 * u * v,
        ],
    ),
}


def case(family, quads, *, noisy=False):
    """A control mesh in mm over one of the families; 5 % of noise on every coordinate."""
    m, n = SIZES[quads]
    half, surface = _FAMILIES[family]
    u, v = np.meshgrid(
        np.linspace(-half, half, m + 1), np.linspace(-half, half, n + 1) * n / m, indexing="ij"
    )
    points = np.stack(surface(u, v), axis=-1).reshape(-1, 3)
    faces = grid_quads(m, n)
    if noisy:
        edge = np.linalg.norm(points[faces[:, 0]] - points[faces[:, 1]], axis=1).mean()
        noise = np.random.default_rng(NOISE_SEED).normal(size=points.shape)
        points = points + 0.05 * edge * noise
    return gs.as_control_mesh(gs.QuadMesh(1000.0 * points, faces))


def trimmed_grid(rows, columns, quads, height):
    """A disk of exactly so many quads: a grid whose corners are cut in steps."""
    x, y = np.meshgrid(np.linspace(-1, 1, rows + 1), np.linspace(-1, 1, columns + 1), indexing="ij")
    points = np.stack([x, y * columns / rows, height(x, y)], axis=-1).reshape(-1, 3)
    faces = grid_quads(rows, columns)
    i, j = np.divmod(np.arange(len(faces)), columns)
    from_corner = np.minimum(i, rows - 1 - i) + np.minimum(j, columns - 1 - j)
    keep = np.sort(np.argsort(-from_corner, kind="stable")[:quads])
    used, compact = np.unique(faces[keep], return_inverse=True)
    return gs.as_control_mesh(gs.QuadMesh(1000.0 * points[used], compact.reshape(-1, 4)))


def star_of_six(size, quads, height):
    """Six sectors around a vertex of valence six, outer corners cut to so many quads in all."""
    rays = 2.0 * np.pi * np.arange(7) / 6
    index, points, faces, distance = {}, [], [], []

    def vertex(s, i, j):
        key = "c" if i == j == 0 else ((s + 1) % 6, j) if i == 0 else (s, i, j) if j else (s, i)
        if key not in index:
            index[key] = len(points)
            points.append([i * np.cos(rays[s]) + j * np.cos(rays[s + 1]),
                           i * np.sin(rays[s]) + j * np.sin(rays[s + 1])])  # fmt: skip
        return index[key]

    for s in range(6):
        for i in range(size):
            for j in range(size):
                faces.append([vertex(s, i, j), vertex(s, i + 1, j),
                              vertex(s, i + 1, j + 1), vertex(s, i, j + 1)])  # fmt: skip
                distance.append(i + j)
    keep = np.sort(np.argsort(distance, kind="stable")[:quads])
    xy = np.array(points) / size
    lifted = np.column_stack([xy, height(*xy.T)])
    used, compact = np.unique(np.array(faces)[keep], return_inverse=True)
    return gs.as_control_mesh(gs.QuadMesh(1000.0 * lifted[used], compact.reshape(-1, 4)))


def ring(around, across, angle):
    """A sphere cut conformally for rhombi at an angle (radians): the start of Fig. 7."""
    v = (np.arange(across + 1) - across / 2.0) * 2.0 * np.pi / around / np.tan(angle / 2.0)
    u, v = np.meshgrid(2.0 * np.pi * np.arange(around) / around, v, indexing="ij")
    xyz = [np.cos(u) / np.cosh(v), np.sin(u) / np.cosh(v), np.tanh(v)]
    points = 1000.0 * np.stack(xyz, axis=-1).reshape(-1, 3)
    return gs.as_control_mesh(gs.QuadMesh(points, grid_quads(around, across, ring=True)))
