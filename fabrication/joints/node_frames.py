"""Directions at nodes: tangents and twists of both families, frames along the node axes."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from fabrication.node import Node, rows_by_lamella
from fabrication.outlines import Frame
from fabrication.structures import Structure
from gridshell.arrays import Floats, unit


def node_tangents(strips: Structure, nodes: Sequence[Node]) -> Floats:
    """(n, 2, 3) unit tangents of both families at regular *nodes* of *strips*."""
    tangents = np.zeros((len(nodes), 2, 3))
    for number, (here, stations) in rows_by_lamella(nodes).items():
        lamella = strips.lamellas[number]
        tangents[here, lamella.family - 1] = lamella.axis.tangents(stations)
    return tangents


def node_twists(strips: Structure, nodes: Sequence[Node]) -> Floats:
    """(n, 2) rates of twist of both families at regular *nodes* of *strips*, rad/mm."""
    twists = np.zeros((len(nodes), 2))
    for number, (here, stations) in rows_by_lamella(nodes).items():
        lamella = strips.lamellas[number]
        twists[here, lamella.family - 1] = lamella.twist(stations)
    return twists


def bisector_frames(nodes: Sequence[Node], tangents: Floats) -> list[Frame]:
    """Frames at *nodes*: z along the axis, x half-way between the lines of the two families."""
    if not nodes:
        return []
    position = np.array([node.position for node in nodes])
    axis = np.array([node.axis for node in nodes])
    a, b = tangents[:, 0], tangents[:, 1]
    turn = np.sign(np.einsum("nc,nc->n", np.cross(a, b), axis))[:, None]
    middle = a + turn * b
    x = unit(middle - np.einsum("nc,nc->n", middle, axis)[:, None] * axis)
    y = np.cross(axis, x)
    return [Frame(o, u, v) for o, u, v in zip(position, x, y, strict=True)]
