"""From port to port along the integer lines, all lines at once, in exact integers.

A line that meets a vertex or runs along an edge is taken to pass infinitesimally to the right of it
(to the left for lines along the rim), so it is in exactly one triangle at a time.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from gridshell.arrays import Indices, Mask
from gridshell.remesh.lattice import AXES, UNIT, ExactChart, Ports, cross, edge_key, face_key
from gridshell.surface.triangle_mesh import after

_LONGEST = 50_000
"""Triangles a line may cross on its way to the next crossing."""


class Traced(NamedTuple):
    """Where the lines of the ports lead."""

    reverse: Indices
    """(p,) the port that looks back from the next crossing, -1 where there is none."""
    exits: Indices
    """(p,) boundary half-edge through which a line leaves the surface before, else -1."""
    lefts: Indices
    """(p, 3) position of the port's crossing and axis, in the chart of the exit's triangle."""


class _Rays(NamedTuple):
    port: Indices
    face: Indices
    at: Indices
    axis: Indices
    rim: Mask

    def pick(self, which: Mask) -> _Rays:
        return _Rays(
            self.port[which], self.face[which], self.at[which], self.axis[which], self.rim[which]
        )


def trace(chart: ExactChart, ports: Ports) -> Traced:
    """Follow every port's line for one cell."""
    count = len(ports.owner)
    reverse, exits = np.full(count, -1, dtype=np.int64), np.full(count, -1, dtype=np.int64)
    lefts = np.zeros((count, 3), dtype=np.int64)
    rays = _Rays(np.arange(count), ports.faces, ports.starts, ports.axes, ports.rim)
    for _ in range(_LONGEST):
        if len(rays.port) == 0:
            break
        there, goal = _arrived(chart, rays)
        reverse[rays.port[there]] = _port_at(chart, ports, rays.pick(there), goal[there])
        rays = rays.pick(~there)
        out = _exit(chart, rays)
        rays, out = rays.pick(out >= 0), out[out >= 0]
        over = chart.mesh.twin[out] < 0
        lost = rays.pick(over)
        exits[lost.port] = out[over]
        lefts[lost.port, :2], lefts[lost.port, 2] = lost.at, lost.axis
        rays, out = rays.pick(~over), out[~over]
        rays = _Rays(
            rays.port,
            chart.mesh.twin[out] // 3,
            chart.flips[out, None] * rays.at + chart.shifts[out],
            chart.carried(rays.axis, out),
            rays.rim,
        )
    mutual = reverse >= 0
    mutual[mutual] = reverse[reverse[mutual]] == np.flatnonzero(mutual)
    return Traced(np.where(mutual, reverse, -1), exits, lefts)


def _arrived(chart: ExactChart, rays: _Rays) -> tuple[Mask, Indices]:
    """Whether the next lattice point lies in the closed triangle, and its position."""
    goal = rays.at + AXES[rays.axis] * UNIT
    corners = chart.corners[rays.face]
    inside = np.ones(len(goal), dtype=bool)
    for k in range(3):
        a = corners[:, k]
        inside &= cross(corners[:, (k + 1) % 3] - a, goal - a) >= 0
    return inside, goal


def _exit(chart: ExactChart, rays: _Rays) -> Indices:
    """The half-edge through which every ray leaves its triangle, -1 where there is none."""
    corners = chart.corners[rays.face]
    side = cross(AXES[rays.axis][:, None], corners - rays.at[:, None])
    left = (side > 0) | ((side == 0) & ~rays.rim[:, None])
    leaves = ~left & np.roll(left, -1, axis=1)
    k = np.argmax(leaves, axis=1)
    return np.where(leaves.any(axis=1), 3 * rays.face + k, -1)


def _port_at(chart: ExactChart, ports: Ports, rays: _Rays, goal: Indices) -> Indices:
    """The port at the lattice points *goal* that looks back along the rays, -1 if there is none."""
    back = (rays.axis + 2) % 4
    corners = chart.corners[rays.face]
    key = np.full(len(goal), -1, dtype=np.int64)
    size = len(chart.mesh.twin)
    todo = np.ones(len(goal), dtype=bool)
    for k in range(3):
        hit = todo & (corners[:, k] == goal).all(axis=1)
        todo &= ~hit
        key[hit] = _vertex_key(chart, 3 * rays.face[hit] + k, back[hit])
    for k in range(3):
        a = corners[:, k]
        hit = todo & (cross(corners[:, (k + 1) % 3] - a, goal - a) == 0)
        todo &= ~hit
        key[hit] = _edge_place(chart, ports, 3 * rays.face[hit] + k, goal[hit], back[hit])
    found = np.searchsorted(ports.face_keys, face_key(chart, rays.face[todo], goal[todo]))
    key[todo] = 4 * (size + 2 * len(ports.edge_keys) + found) + back[todo]
    spot = np.minimum(np.searchsorted(ports.keys, key), max(len(ports.keys) - 1, 0))
    return np.where(ports.keys[spot] == key, ports.order[spot], -1)


def _vertex_key(chart: ExactChart, corner: Indices, back: Indices) -> Indices:
    """A direction along the corner's start edge belongs to the corner clockwise of it."""
    a, d = chart.along(corner), AXES[back]
    start = (cross(a, d) == 0) & ((a * d).sum(axis=1) > 0) & (chart.mesh.twin[corner] >= 0)
    other = after(chart.mesh.twin[corner])
    return np.where(start, 4 * other + chart.carried(back, corner), 4 * corner + back)


def _edge_place(
    chart: ExactChart, ports: Ports, halfedge: Indices, goal: Indices, back: Indices
) -> Indices:
    """A direction along the half-edge belongs to the other side."""
    twin = chart.mesh.twin[halfedge]
    item = np.searchsorted(ports.edge_keys, edge_key(chart, halfedge, goal))
    second = (twin >= 0) & (twin < halfedge)
    a, d = chart.along(halfedge), AXES[back]
    swap = (twin >= 0) & (cross(a, d) == 0) & ((a * d).sum(axis=1) > 0)
    side = np.where(swap, ~second, second).astype(np.int64)
    axis = np.where(swap, chart.carried(back, halfedge), back)
    return np.asarray(4 * (len(chart.mesh.twin) + 2 * item + side) + axis)
