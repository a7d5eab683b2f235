"""Layers of pictures that figures share: patterns, nets, lamellas, connectors."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

import gridshell as gs
from fabrication.export.view_meshes import shape_mesh
from fabrication.ribbons import ribbons
from fabrication.shapes import Prisms
from fabrication.structures import Structure
from gridshell.arrays import Indices, Points
from gridshell.painter import Dots, Faces, Layer, Lines, View, painted, polygons

INK, BLACK, GREY = (0.11, 0.14, 0.18), (0.25, 0.29, 0.34), (0.6, 0.6, 0.6)
RED, BLUE, GLASS = (0.80, 0.16, 0.14), (0.13, 0.34, 0.74), (0.72, 0.85, 0.90)

FROM_ABOVE = View(np.eye(3))

Colour = tuple[float, float, float]


def edges(points: Points, pairs: Indices, colour: Colour = INK, width: float = 1.0) -> Lines:
    """Edges between *points*."""
    return Lines(points[pairs], painted(colour, len(pairs)), width)


def dots(places: Points, colour: Colour = INK, radius: float = 2.5) -> Dots:
    """Dots at *places*."""
    return Dots(places, painted(colour, len(places)), radius)


def pattern(control: gs.ControlMesh) -> tuple[Layer, ...]:
    """The checkerboard pattern: black parallelograms, white faces."""
    made = gs.checkerboard(control)
    rings = polygons(made.vertices, made.white)
    black = made.vertices[made.black]
    return (
        Faces(rings, painted((1.0, 1.0, 1.0), len(rings))),
        Faces(black, painted(BLACK, len(black))),
        edges(control.vertices, control.mesh.edges, (0.72, 0.74, 0.77), 0.4),
    )


def lamella_faces(built: Structure) -> tuple[Faces, ...]:
    """All strips of a structure by family."""
    return ribbons(built.lamellas, built.profile.width)


def connector_faces(connectors: Sequence[Prisms]) -> tuple[Faces, ...]:
    """Triangles of all connectors in the colours of their kinds."""
    made = []
    for kind in connectors:
        shapes = [shape_mesh(shape) for shape in kind.shapes]
        corners = []
        for body in kind.bodies:
            points, faces = shapes[body.shape]
            corners.append(body.frame.place(points)[faces])
        if corners:
            found = np.concatenate(corners)
            made.append(Faces(found, painted(kind.colour, len(found))))
    return tuple(made)
