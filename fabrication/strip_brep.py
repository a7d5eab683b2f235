"""A bent and twisted strip as a boundary representation, made directly and without any boolean.

Each side of the strip is a B-spline surface of degree 3 x 1 between two corner curves; its
parameters (u, v) are the strip's own (x, y) in mm, so the flat outline, with its arcs and holes, is
literally the trimming loop of the surface. Every vertex and edge is made once and shared by its two
faces, which makes the solid watertight by construction.

A wall runs between the two images of a piece of the outline: a plane over a straight piece across
the strip, a ruled surface over all others.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from fabrication.brep_geometry import (
    SQUARE,
    TOLERANCE,
    bevel_sag,
    bilinear,
    knots,
    ruled_surface,
    side_surface,
    wall_planes,
)
from fabrication.brep_pieces import BrepPieces, poles
from fabrication.errors import no_kernel
from fabrication.sides import Side
from fabrication.strip_loops import DEGREE, Loop, Piece, Run, arc_images

try:
    from OCP.Geom import Geom_BSplineCurve
    from OCP.TopoDS import TopoDS_Edge, TopoDS_Face, TopoDS_Solid, TopoDS_Vertex, TopoDS_Wire
except ImportError as error:  # pragma: no cover - depends on the machine
    raise no_kernel(error) from error


def strip_brep(sides: tuple[Side, Side], thickness: float, loops: Sequence[Loop]) -> TopoDS_Solid:
    """The solid between *sides* within *loops*, the outline first."""
    return _Builder(sides, thickness, loops).solid()


class _Builder(BrepPieces):
    """Makes the shared vertices, edges and faces of one strip."""

    def __init__(self, sides: tuple[Side, Side], thickness: float, loops: Sequence[Loop]) -> None:
        self.thickness, self.loops = thickness, loops
        self.surfaces = [side_surface(side) for side in sides]
        self.corners = [
            [
                side.points(rows[:, 0], rows[:, 1])
                for side, rows in zip(sides, loop.rows, strict=True)
            ]
            for loop in loops
        ]
        arcs = [piece for loop in loops for piece in loop.pieces if piece.run is Run.ARC]
        self.number = {id(piece): i for i, piece in enumerate(arcs)}
        self.images = arc_images(sides, arcs) if arcs else None
        self.curves: dict[tuple[int, int], Geom_BSplineCurve] = {}
        shares, counts = np.unique(self.images.knots if self.images else [], return_counts=True)
        self.shares, self.counts = shares.tolist(), counts.tolist()
        self.planes, planar = wall_planes(loops, self.corners, thickness)
        astray = max(bevel_sag(sides, loops[0]), self.images.off if self.images else 0.0)
        super().__init__(max(TOLERANCE, planar, 2.0 * astray))

    def solid(self) -> TopoDS_Solid:
        """Sides first, then the walls in the order of the loops."""
        walls: list[TopoDS_Face] = []
        wires: tuple[list[TopoDS_Wire], list[TopoDS_Wire]] = ([], [])
        for number, loop in enumerate(self.loops):
            vertices = [[self.vertex(p) for p in side] for side in self.corners[number]]
            across = [self._across(number, i, vertices) for i in range(len(loop.pieces))]
            rims = [
                [self._rim(number, k, piece, vertices[k]) for piece in loop.pieces] for k in (0, 1)
            ]
            for k in (0, 1):
                wires[k].append(
                    self.wire([(e, p.forward) for e, p in zip(rims[k], loop.pieces, strict=True)])
                )
            for i, piece in enumerate(loop.pieces):
                near, far = rims[0][i], rims[1][i]
                low, high = across[piece.first], across[piece.last]
                surface = self._wall(number, i, piece, (near, far, low, high))
                wire = self.wire([(near, True), (high, True), (far, False), (low, False)])
                walls.append(self.face(surface, [wire], forward=piece.forward))
        sides = [self.face(self.surfaces[k], wires[k], forward=k == 1) for k in (0, 1)]
        return self.close([*sides, *walls])

    # ---- vertices and edges --------------------------------------------------------------------

    def _across(
        self, number: int, i: int, vertices: Sequence[Sequence[TopoDS_Vertex]]
    ) -> TopoDS_Edge:
        """The edge through the thickness at corner *i*.

        At a bevelled end the twist makes it a little longer at one edge of the strip than at the
        other; its parameter runs over the length it would have without.
        """
        (a, b), (first, last) = (
            [side[i] for side in both] for both in (self.corners[number], vertices)
        )
        rows = self.loops[number].rows
        run = float(rows[1, i, 0] - rows[0, i, 0])
        if abs(run) < SQUARE:
            return self.straight(a, b, first, last)
        length = float(np.hypot(self.thickness, run))
        ends = poles(np.stack([a, b]))
        line = Geom_BSplineCurve(ends, *knots((0.0, length), (2, 2)), 1)
        return self.edge(line, first, last, 0.0, length)

    def _rim(
        self, number: int, k: int, piece: Piece, vertices: Sequence[TopoDS_Vertex]
    ) -> TopoDS_Edge:
        """The edge of *piece* on side *k*, in its natural direction."""
        first, last = vertices[piece.first], vertices[piece.last]
        low, high, at = piece.low[k], piece.high[k], piece.at[k]
        if piece.run is Run.ACROSS:
            corners = self.corners[number][k]
            edge = self.straight(corners[piece.first], corners[piece.last], first, last)
            self.trace(edge, self.surfaces[k], (at, low), (0.0, 1.0))
        elif piece.run is Run.ALONG:
            curve = self.surfaces[k].VIso(at)
            curve.Segment(low, high)
            edge = self.edge(curve, first, last, low, high)
            self.trace(edge, self.surfaces[k], (0.0, at), (1.0, 0.0))
        else:
            edge = self.edge(self._arc_curve(piece, k), first, last, low, high)
            self.ring(edge, self.surfaces[k], piece.centre, at)
        return edge

    def _arc_curve(self, piece: Piece, k: int) -> Geom_BSplineCurve:
        """The image of an arc on side *k*, made once for its edge and its wall."""
        key = id(piece), k
        if key not in self.curves:
            images = self.images
            if images is None:
                raise AssertionError("an outline without arcs has no images of arcs")
            array = poles(images.poles[self.number[id(piece)], k])
            low, high = piece.low[0], piece.high[0]
            values = [low + (high - low) * share for share in self.shares]
            self.curves[key] = Geom_BSplineCurve(array, *knots(values, self.counts), DEGREE)
        return self.curves[key]

    # ---- faces ---------------------------------------------------------------------------------

    def _wall(
        self,
        number: int,
        i: int,
        piece: Piece,
        edges: tuple[TopoDS_Edge, TopoDS_Edge, TopoDS_Edge, TopoDS_Edge],
    ) -> Any:
        """The surface over *piece*, with the traces of its *edges*: near, far, low, high."""
        plane = self.planes.get((number, i))
        if plane is not None:
            return plane
        near, far, low, high = edges
        corners = self.corners[number]
        depth, starts, ends = self.thickness, piece.low, piece.high
        if piece.run is Run.ACROSS:
            height = piece.high[0] - piece.low[0]
            square = [[side[j] for j in (piece.first, piece.last)] for side in corners]
            depth = float(np.hypot(depth, piece.at[1] - piece.at[0]))
            surface = bilinear(square, height, depth)
            starts, ends = (0.0, 0.0), (height, height)
        elif piece.run is Run.ALONG:
            curves = [side.VIso(piece.at[0]) for side in self.surfaces]
            for curve in curves:
                curve.Segment(min(piece.low), max(piece.high))
            surface = ruled_surface(curves[0], curves[1], depth)
        else:
            curves = [self._arc_curve(piece, k) for k in (0, 1)]
            surface = ruled_surface(curves[0], curves[1], depth)
        self.trace(near, surface, (0.0, 0.0), (1.0, 0.0))
        self.trace(far, surface, (0.0, depth), (1.0, 0.0))
        for edge, place in ((low, starts), (high, ends)):
            self.trace(edge, surface, (place[0], 0.0), (place[1] - place[0], depth))
        return surface
