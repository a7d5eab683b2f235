"""A net of revolution seen as an umbrella: its rings are found, its symmetry is measured."""

from __future__ import annotations

import numpy as np

from gridshell.arrays import Floats, Indices
from gridshell.errors import SettingError
from gridshell.mesh import ControlMesh, DiagonalMesh, diagonal_meshes
from gridshell.umbrella import Position, Umbrella

SYMMETRIC = 1e-6
"""What nodes may be off their rings, over the net's mean edge."""


def umbrella_of(control: ControlMesh, *, tolerance: float = SYMMETRIC) -> Position:
    """D1 of *control* as a position of an umbrella around a vertical axis, its base ring lowest.

    Parameters
    ----------
    control : its D1 consists of rings of as many nodes each, every ring turned by half a step.
    tolerance : what nodes may be off, over the mean edge.

    Raises
    ------
    SettingError
        When the net is no ring or not symmetric; the node that is farthest off is named.
    """
    net = diagonal_meshes(control)[0]
    layer = _layers(control, net)
    count = np.bincount(layer)
    if len(count) < 3 or (count != count[0]).any():
        found = ", ".join(map(str, count[:12].tolist()))
        raise _asymmetric(
            "nodes per ring", found, "equal rings", "a ring of a surface of revolution"
        )
    x = net.vertices
    centre = np.array([x[layer == k].mean(axis=0) for k in range(len(count))])
    axis = centre[:, :2].mean(axis=0)
    about = x - np.r_[axis, centre[0, 2]]
    radius, turn = np.hypot(about[:, 0], about[:, 1]), np.arctan2(about[:, 1], about[:, 0])
    rings = [layer == k for k in range(len(count))]
    radii = np.array([radius[ring].mean() for ring in rings])
    heights = np.array([about[ring, 2].mean() for ring in rings])
    _check(x, layer, radius - radii[layer], about[:, 2] - heights[layer], tolerance * net.mean_edge)
    step = np.pi / count[0]
    phase = np.angle(np.exp(1j * turn[rings[0]] * count[0]).mean()) / count[0]
    cells = (turn - phase) / step - (layer % 2)
    aside = radius * step * (cells - 2.0 * np.round(cells / 2.0))
    _check(x, layer, aside, np.zeros(len(x)), tolerance * net.mean_edge)
    c, s = np.cos(step), np.sin(step)
    across, along = radii[1:] * s, radii[1:] * c - radii[:-1]
    bays = np.sqrt(across**2 + along**2 + np.diff(heights) ** 2)
    umbrella = Umbrella(int(count[0]), float(radii[0]), tuple(bays.tolist()))
    return Position(umbrella, radii, heights)


def _layers(control: ControlMesh, net: DiagonalMesh) -> Indices:
    """(n,) number of edges from the lower one of two boundary loops."""
    from scipy.sparse import coo_matrix
    from scipy.sparse.csgraph import dijkstra

    loops = control.mesh.boundary_loops
    if len(loops) != 2:
        raise _asymmetric(
            "boundary loops", str(len(loops)), "two, as a ring has", "a ring, [patch] without u"
        )
    low = min(loops, key=lambda loop: float(control.vertices[loop, 2].mean()))
    base = np.flatnonzero(np.isin(net.control_vertices, low))
    a, b = net.edges.T
    graph = coo_matrix((np.ones(len(a)), (a, b)), shape=(len(net.vertices),) * 2)
    steps = dijkstra(graph, directed=False, indices=base, unweighted=True, min_only=True)
    return np.asarray(steps, dtype=np.int64)


def _check(x: Floats, layer: Indices, first: Floats, second: Floats, limit: float) -> None:
    off = np.hypot(first, second)
    worst = int(np.argmax(off))
    if not off[worst] <= limit:
        place = ", ".join(f"{c:.6g}" for c in x[worst])
        raise _asymmetric(
            f"node {worst} of ring {layer[worst]} at ({place}) mm",
            f"{off[worst]:.4g} mm off its ring",
            f"{limit:.4g} mm",
            "a ring of a surface of revolution, or Mechanism for nets without symmetry",
        )


def _asymmetric(where: str, value: str, limit: str, advice: str) -> SettingError:
    return SettingError(
        "The net is not symmetric about a vertical axis",
        where=where,
        value=value,
        limit=limit,
        advice=advice,
    )
