"""The quad mesh of a seamless chart: crossings of its integer lines, cells between them.

After Ebke, Bommes, Campen and Kobbelt, QEx (ACM Trans. Graph. 32, 2013): ports are traced exactly
from crossing to crossing, and a cell is the orbit of "the next port clockwise of the reverse one".
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.sparse import coo_matrix
from scipy.sparse.csgraph import connected_components

from gridshell.arrays import Floats, Indices
from gridshell.remesh.lattice import ExactChart, Ports, cross, ports
from gridshell.remesh.seamless import Seamless
from gridshell.remesh.tracing import Traced, trace


@dataclass(frozen=True, eq=False)
class Extracted:
    """Crossings and whole cells.

    Parameters
    ----------
    chart, ports, traced : what the cells were read off.
    cells : (q, 4) crossings around every whole cell, counter-clockwise; the first side runs along
        family 1, as the third does.
    cell_ports : (q, 4) the port that leaves each of them along the cell.
    non_quads : closed cells of another number of corners.
    """

    chart: ExactChart
    ports: Ports
    traced: Traced
    cells: Indices
    cell_ports: Indices
    non_quads: int

    @property
    def faces(self) -> Indices:
        """(c,) the triangle each crossing lies in."""
        return self.ports.face

    @property
    def weights(self) -> Floats:
        """(c, 3) barycentric weights of the crossings in their triangles."""
        return barycentric(self.chart, self.ports.face, self.ports.at)


def extract(found: Seamless) -> Extracted:
    """Read the crossings and the cells off a chart."""
    chart = ExactChart.of(found.mesh, found.corners, found.flips)
    all_ports = ports(chart)
    traced = trace(chart, all_ports)
    onward = _onward(all_ports, traced.reverse)
    walk = [np.arange(len(onward))]
    for _ in range(4):
        walk.append(np.where(walk[-1] < 0, -1, onward[walk[-1]]))
    orbit = np.stack(walk[:4], axis=1)
    closed = (walk[4] == walk[0]) & (orbit.min(axis=1) == walk[0])
    cells = orbit[closed]
    second = all_ports.axes[cells[:, 0]] % 2 == 1
    cells[second] = np.roll(cells[second], -1, axis=1)
    owner = all_ports.owner
    return Extracted(chart, all_ports, traced, owner[cells], cells, _other_orbits(onward))


def barycentric(chart: ExactChart, face: Indices, at: Indices) -> Floats:
    """(m, 3) weights of chart positions *at* (m, 2) in triangles *face* (m,).

    In a triangle that is flat in the chart it is the first corner's.
    """
    a, b, c = np.moveaxis(chart.corners[face], 1, 0)
    total = cross(b - a, c - a).astype(np.float64)
    total[total == 0.0] = 1.0
    second, third = cross(at - a, c - a) / total, cross(b - a, at - a) / total
    return np.stack([1.0 - second - third, second, third], axis=1)


def _onward(ports: Ports, reverse: Indices) -> Indices:
    """(p,) the next port around the cell on a port's left, -1 where the cell is open."""
    count = len(ports.owner)
    first = np.searchsorted(ports.owner, ports.owner)
    last = np.searchsorted(ports.owner, ports.owner, side="right") - 1
    at_first = np.arange(count) == first
    clockwise = np.where(at_first, last, np.arange(count) - 1)
    clockwise[at_first & ~ports.whole[ports.owner]] = -1
    return np.where(reverse >= 0, clockwise[reverse], -1)


def _other_orbits(onward: Indices) -> int:
    """Closed cells that do not have four corners."""
    count = len(onward)
    inner = np.flatnonzero(onward >= 0)
    ones = np.ones(len(inner), dtype=np.int8)
    graph = coo_matrix((ones, (inner, onward[inner])), shape=(count, count))
    _, label = connected_components(graph, directed=False)
    size = np.bincount(label)
    broken = np.bincount(label[onward < 0], minlength=len(size)) > 0
    return int(np.count_nonzero(~broken & (size != 4)))
