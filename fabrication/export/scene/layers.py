"""The layers of a 3D scene: frozen arrays in metres around a centre, packed for a page.

Every layer has an ``id`` that stays the same while its contents change, the ``name`` it is switched
by (layers of one name are switched together), and ``visible`` at first. ``built`` layers are those
that only make sense where strips are in place.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import ClassVar

import numpy as np
from numpy.typing import NDArray

from fabrication.export.scene.packing import Packed, packed, runs
from gridshell.arrays import Floats, Indices


@dataclass(frozen=True)
class About:
    """What a part says of itself: its mark, and lines of words.

    Parameters
    ----------
    pattern : what its flat pattern is asked for by; the mark without, since only equal parts share
        one.
    """

    mark: str
    lines: tuple[str, ...] = ()
    pattern: str = ""

    def packed(self) -> Packed:
        """For the page."""
        more = {"pattern": self.pattern} if self.pattern else {}
        return {"mark": self.mark, "lines": list(self.lines), **more}


@dataclass(frozen=True, eq=False, kw_only=True)
class Layer(ABC):
    """What all layers share.

    Parameters
    ----------
    colour : CSS.
    built : shown only while the strips are in place.
    of_net : of the net itself: shown while what is built on it is still to come.
    """

    kind: ClassVar[str]
    id: str
    name: str
    colour: str = "#5a6472"
    visible: bool = True
    built: bool = True
    of_net: bool = False

    def packed(self) -> Packed:
        """For the page."""
        return {
            "kind": self.kind,
            "id": self.id,
            "name": self.name,
            "colour": self.colour,
            "visible": self.visible,
            "built": self.built,
            "of_net": self.of_net,
            **self.arrays(),
        }

    @abstractmethod
    def arrays(self) -> Packed:
        """What the layer's kind adds."""


def _parts(parts: Sequence[About]) -> list[Packed]:
    return [part.packed() for part in parts]


@dataclass(frozen=True, eq=False, kw_only=True)
class Faces(Layer):
    """Triangles of parts.

    Parameters
    ----------
    points : (n, 3) m.
    triangles : (m, 3), those of one part after those of another.
    sizes : triangles of each part.
    parts : what each says; empty where nothing is to point at.
    colours : (p, 3) sRGB 0 to 1 of each part; None for the layer's.
    loops : (k,) point numbers of outlines, n between two of them; None for no outlines.
    cells : (m,) number in a colouring of each triangle; None for that of its part.
    cells_of : which colourings apply, "bays" or "quads"; "" for none.
    """

    kind: ClassVar[str] = "faces"
    points: NDArray[np.float32]
    triangles: Indices
    sizes: Sequence[int]
    parts: Sequence[About] = ()
    colours: Floats | None = None
    loops: Indices | None = None
    cells: Indices | None = None
    cells_of: str = ""
    edge: str = "#5a6472"
    opacity: float = 1.0

    def arrays(self) -> Packed:
        """Points, triangles, outlines, colours."""
        shades = None if self.colours is None else packed(np.round(255.0 * self.colours), "u1")
        return {
            "points": packed(self.points, "f4"),
            "faces": packed(self.triangles, "u4"),
            "sizes": list(self.sizes),
            "parts": _parts(self.parts),
            "colours": shades,
            "loops": None if self.loops is None else packed(self.loops, "u4"),
            "cells": None if self.cells is None else runs(self.cells),
            "cells_of": self.cells_of,
            "edge": self.edge,
            "opacity": self.opacity,
        }


@dataclass(frozen=True, eq=False, kw_only=True)
class Strips(Layer):
    """Middle surfaces of strips, which the page bends from flat to built.

    Parameters
    ----------
    x : (c,) where the columns of all strips lie on the flat strips, m.
    frames : (c, 9) in place: axis m, its tangent, and the direction of the strip's width.
    counts : columns of each strip.
    columns, heights : (n,) column of each point, and its place across the strip's width, m.
    triangles, sizes, parts, loops, cells : as of faces.
    width : of the strips, m.
    """

    kind: ClassVar[str] = "strips"
    x: Floats
    frames: Floats
    counts: Sequence[int]
    columns: Indices
    heights: Floats
    triangles: Indices
    sizes: Sequence[int]
    parts: Sequence[About]
    loops: Indices
    cells: Indices
    width: float
    edge: str = "#5a6472"

    def arrays(self) -> Packed:
        """Columns, the points on them, triangles, outlines."""
        return {
            "x": packed(self.x, "f4"),
            "frames": packed(self.frames, "f4"),
            "counts": list(self.counts),
            "columns": packed(self.columns, "u4"),
            "heights": packed(self.heights, "f4"),
            "faces": packed(self.triangles, "u4"),
            "sizes": list(self.sizes),
            "parts": _parts(self.parts),
            "loops": packed(self.loops, "u4"),
            "cells": runs(self.cells),
            "cells_of": "bays",
            "width": self.width,
            "edge": self.edge,
        }


@dataclass(frozen=True, eq=False, kw_only=True)
class Lines(Layer):
    """Straight lines between points (n, 3) m; *pairs* (m, 2) point numbers."""

    kind: ClassVar[str] = "lines"
    points: NDArray[np.float32]
    pairs: Indices

    def arrays(self) -> Packed:
        """Points, and which are joined."""
        return {"points": packed(self.points, "f4"), "pairs": packed(self.pairs, "u4")}


@dataclass(frozen=True, eq=False, kw_only=True)
class Dots(Layer):
    """Points (n, 3) m that say something; *size* px across."""

    kind: ClassVar[str] = "dots"
    points: NDArray[np.float32]
    parts: Sequence[About] = ()
    size: float = 4.0

    def arrays(self) -> Packed:
        """Points and what they say."""
        return {
            "points": packed(self.points, "f4"),
            "parts": _parts(self.parts),
            "size": self.size,
        }


@dataclass(frozen=True, eq=False, kw_only=True)
class Labels(Layer):
    """Words at points (n, 3) m; *colours* in turn."""

    kind: ClassVar[str] = "labels"
    points: NDArray[np.float32]
    texts: Sequence[str]
    colours: Sequence[str] = ("#1c232d",)

    def arrays(self) -> Packed:
        """Places and words."""
        return {
            "points": packed(self.points, "f4"),
            "texts": list(self.texts),
            "colours": list(self.colours),
        }


@dataclass(frozen=True, eq=False, kw_only=True)
class Bodies(Layer):
    """Copies of few shapes in many places.

    Parameters
    ----------
    shapes : points (n, 3) m and triangles (m, 3) of each.
    bodies : (b,) shape of each body.
    frames : (b, 9) origin m, x and y.
    parts : what each body says.
    """

    kind: ClassVar[str] = "bodies"
    shapes: Sequence[tuple[NDArray[np.float32], Indices]]
    bodies: Indices
    frames: Floats
    parts: Sequence[About]

    def arrays(self) -> Packed:
        """Shapes once, and where they are."""
        return {
            "shapes": [
                {"points": packed(points, "f4"), "faces": packed(faces, "u4")}
                for points, faces in self.shapes
            ],
            "bodies": packed(self.bodies, "u4"),
            "frames": packed(self.frames, "f4"),
            "parts": _parts(self.parts),
        }


@dataclass(frozen=True, eq=False, kw_only=True)
class Positions(Layer):
    """Triangles in several positions, one of which is shown.

    Parameters
    ----------
    low, scale : corner m and step m of the grid that coordinates are rounded to.
    frames : per position (n, 3) steps.
    triangles : (m, 3).
    begin : number of the position shown first.
    """

    kind: ClassVar[str] = "positions"
    low: Floats
    scale: float
    frames: Sequence[NDArray[np.uint16]]
    triangles: Indices
    begin: int = 0

    def arrays(self) -> Packed:
        """Positions as whole numbers."""
        return {
            "low": np.asarray(self.low).tolist(),
            "scale": self.scale,
            "frames": [packed(frame, "u2") for frame in self.frames],
            "faces": packed(self.triangles, "u4"),
            "begin": self.begin,
        }


@dataclass(frozen=True, eq=False)
class Colouring:
    """Colours of cells by a figure.

    Parameters
    ----------
    name : of the figure.
    on : the cells: "bays" or "quads".
    values : (n,) from 0 to 1.
    low, high : the two ends in words, with their unit.
    """

    name: str
    on: str
    values: Floats
    low: str
    high: str

    def packed(self) -> Packed:
        """For the page."""
        shares = np.nan_to_num(np.clip(self.values, 0.0, 1.0))
        return {
            "name": self.name,
            "on": self.on,
            "values": packed(shares, "f4"),
            "low": self.low,
            "high": self.high,
        }


SCALE = ((0.0, "#dfe7ee"), (0.35, "#f3d9a0"), (0.7, "#e08a3c"), (1.0, "#a3161f"))
"""Colours from little to much."""


@dataclass(frozen=True, eq=False)
class Scene:
    """Layers and the colourings of their cells."""

    layers: Sequence[Layer]
    colourings: Sequence[Colouring] = field(default=())

    def packed(self) -> Packed:
        """For the page."""
        return {
            "layers": [layer.packed() for layer in self.layers],
            "maps": [colouring.packed() for colouring in self.colourings],
            "scale": [list(stop) for stop in SCALE],
        }
