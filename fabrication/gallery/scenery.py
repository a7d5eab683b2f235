"""Layers of pictures that figures share: patterns, nets, lamellas, connectors."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

import gridshell as gs
from fabrication.colours import FAMILY_COLOURS
from fabrication.export.painter import Dots, Faces, Layer, Lines, View
from fabrication.export.view_meshes import shape_mesh
from fabrication.lamella import Lamella
from fabrication.shapes import Prisms
from fabrication.structures import Structure
from gridshell.arrays import Floats, Indices, Points

INK, BLACK, GREY = (0.11, 0.14, 0.18), (0.25, 0.29, 0.34), (0.6, 0.6, 0.6)
RED, BLUE, GLASS = (0.80, 0.16, 0.14), (0.13, 0.34, 0.74), (0.72, 0.85, 0.90)

FROM_ABOVE = View(np.eye(3))
_PER_BAY = 4

Colour = tuple[float, float, float]


def painted(colour: Colour, count: int) -> Floats:
    """(count, 3) of one colour."""
    return np.tile(np.array(colour), (count, 1))


def seen_from(*eye: float) -> View:
    """A view towards the origin from the direction *eye*, z upwards."""
    back = np.array(eye) / np.linalg.norm(eye)
    right = np.cross([0.0, 0.0, 1.0], back)
    right /= np.linalg.norm(right)
    return View(np.stack([right, np.cross(back, right), back]))


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


def polygons(points: Points, faces: Indices) -> Floats:
    """(m, k, 3) corners of faces padded with -1: the last corner is repeated."""
    known = faces >= 0
    last = np.maximum.accumulate(np.where(known, np.arange(faces.shape[1]), 0), axis=1)
    return np.asarray(points[np.take_along_axis(np.where(known, faces, 0), last, axis=1)])


def lamella_faces(built: Structure) -> tuple[Faces, ...]:
    """All strips of a structure by family."""
    made = []
    for family in (1, 2):
        strips = [s for s in built.lamellas if s.family == family]
        corners = [_strip(strip, built.profile.width) for strip in strips]
        if corners:
            found = np.concatenate(corners)
            made.append(Faces(found, painted(FAMILY_COLOURS[family], len(found))))
    return tuple(made)


def _strip(strip: Lamella, width: float) -> Floats:
    """(m, 4, 3) quads along a strip, lower and upper edge."""
    count = max(2, _PER_BAY * len(strip.stations))
    s = np.linspace(strip.start, strip.end, count)
    frames = strip.frames(s)
    low, high = frames.points - width / 2.0 * frames.n, frames.points + width / 2.0 * frames.n
    return np.stack([low[:-1], low[1:], high[1:], high[:-1]], axis=1)


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
