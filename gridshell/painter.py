"""A small painter: polygons, lines and dots in space, from far to near, as one SVG.

Parallel projection. Lines and dots lie on their polygons: they are moved towards the eye by about
one polygon before everything is sorted by depth.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from gridshell.arrays import Floats, Indices, Points, Vectors, unit

WIDTH, _MARGIN = 760.0, 14.0
_AHEAD, _ASIDE = 0.8, 0.6
"""The eye stands above the surface, and to its side, by these shares."""

_DARKEST = 0.72


@dataclass(frozen=True, eq=False)
class Faces:
    """Filled polygons.

    Parameters
    ----------
    corners : (m, k, 3) mm; rows with fewer corners repeat their last one.
    colours : (m, 3) sRGB, 0 to 1.
    """

    corners: Floats
    colours: Floats


@dataclass(frozen=True, eq=False)
class Lines:
    """Straight lines.

    Parameters
    ----------
    ends : (m, 2, 3) mm.
    colours : (m, 3) sRGB, 0 to 1.
    width : px.
    """

    ends: Floats
    colours: Floats
    width: float


@dataclass(frozen=True, eq=False)
class Dots:
    """Round dots.

    Parameters
    ----------
    places : (m, 3) mm.
    colours : (m, 3) sRGB, 0 to 1.
    radius : px.
    """

    places: Points
    colours: Floats
    radius: float


Layer = Faces | Lines | Dots


@dataclass(frozen=True, eq=False)
class View:
    """Where the eye stands: rows of *frame* (3, 3) point right, up and to the eye."""

    frame: Floats

    @classmethod
    def onto(cls, normal: Floats) -> View:
        """From the positive side of a surface whose mean *normal* (3,) may be of any length.

        A surface that faces all sides, or one that faces down, is seen from above.
        """
        size = float(np.linalg.norm(normal))
        up = normal / size if size > 0.1 else np.array([0.0, 0.0, 1.0])
        up = -up if up[2] < -1e-9 else up
        across = np.array([1.0, -1.0, 0.0]) if abs(up[2]) > 0.5 else np.array([0.0, 0.0, 1.0])
        aside = across - (across @ up) * up
        eye = _AHEAD * up + _ASIDE * aside / np.linalg.norm(aside)
        eye /= np.linalg.norm(eye)
        top = up if abs(up[2]) > 0.5 else np.array([0.0, 0.0, 1.0])
        right = np.cross(top, eye)
        right /= np.linalg.norm(right)
        return cls(np.stack([right, np.cross(eye, right), eye]))

    def seen(self, points: Points) -> Floats:
        """*points* (..., 3) as right, up and depth towards the eye, mm."""
        return np.asarray(points @ self.frame.T)


def seen_from(*eye: float) -> View:
    """A view towards the origin from the direction *eye*, z upwards."""
    back = np.array(eye) / np.linalg.norm(eye)
    right = np.cross([0.0, 0.0, 1.0], back)
    right /= np.linalg.norm(right)
    return View(np.stack([right, np.cross(back, right), back]))


def bounds(layers: Sequence[Layer], view: View) -> Floats:
    """Lower left and upper right (2, 2) of what is seen of *layers*, mm."""
    flat = np.concatenate([view.seen(corners(layer)).reshape(-1, 3) for layer in layers])
    return np.stack([flat[:, :2].min(axis=0), flat[:, :2].max(axis=0)])


@dataclass(frozen=True, eq=False)
class Mark:
    """One polygon, line or dot, ready to be drawn.

    Parameters
    ----------
    kind : of its layer.
    places : (k, 2) right and up, mm; one row for a dot.
    colour : (3,) sRGB, 0 to 1.
    size : width of a line, radius of a dot, px; 0 for a polygon.
    """

    kind: type[Layer]
    places: Floats
    colour: Floats
    size: float


def in_order(layers: Sequence[Layer], view: View) -> list[Mark]:
    """Everything in *layers* from far to near."""
    ahead = max((thickness(view, layer) for layer in layers), default=0.0)
    depths, marks = [], []
    for layer in layers:
        placed = view.seen(corners(layer))
        step = {Faces: 0.0, Lines: 1.0, Dots: 1.5}[type(layer)]
        depths.append(placed[..., 2].mean(axis=1) + step * ahead)
        colours = shaded(layer, view) if isinstance(layer, Faces) else layer.colours
        size = {Faces: 0.0, Lines: getattr(layer, "width", 0.0)}.get(
            type(layer), getattr(layer, "radius", 0.0)
        )
        flat = placed[..., :2]
        marks += [
            Mark(type(layer), row, colour, size)
            for row, colour in zip(flat, np.asarray(colours), strict=True)
        ]
    order = np.argsort(np.concatenate([np.zeros(0), *depths]), kind="stable")
    return [marks[i] for i in order.tolist()]


def svg(layers: Sequence[Layer], view: View, frame: Floats, *, label: str) -> str:
    """The layers within *frame* (see `bounds`) as an SVG picture with *label* for the blind."""
    low, high = frame
    scale = (WIDTH - 2.0 * _MARGIN) / max(float(high[0] - low[0]), 1e-9)
    height = (high[1] - low[1]) * scale + 2.0 * _MARGIN
    corner, way = np.array([low[0], high[1]]), np.array([scale, -scale])
    body = "\n".join(
        _element(mark, np.round((mark.places - corner) * way + _MARGIN, 1))
        for mark in in_order(layers, view)
    )
    return (
        f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {WIDTH:g} {height:.0f}" role="img" '
        f'aria-label="{label}"><g fill="currentColor" stroke="currentColor" stroke-width="0.5" '
        f'stroke-linejoin="round" stroke-linecap="round">\n{body}\n</g></svg>\n'
    )


def shaded(faces: Faces, view: View) -> Floats:
    """(m, 3) colours, darker the more a face is turned away."""
    x = faces.corners
    normals = unit(np.cross(x[:, 2] - x[:, 0], x[:, -1] - x[:, 1]) + 1e-12)
    turned = np.abs(normals @ _lamp(view))
    return np.asarray(faces.colours * (_DARKEST + (1.0 - _DARKEST) * turned)[:, None])


def _lamp(view: View) -> Vectors:
    lamp = view.frame[2] + 0.5 * view.frame[1] - 0.3 * view.frame[0]
    return np.asarray(lamp / np.linalg.norm(lamp))


def corners(layer: Layer) -> Floats:
    """(m, k, 3) points of a layer, mm."""
    if isinstance(layer, Faces):
        return layer.corners
    return layer.ends if isinstance(layer, Lines) else layer.places[:, None]


def polygons(points: Points, faces: Indices) -> Floats:
    """(m, k, 3) corners of faces padded with -1: the last corner is repeated."""
    known = faces >= 0
    last = np.maximum.accumulate(np.where(known, np.arange(faces.shape[1]), 0), axis=1)
    return np.asarray(points[np.take_along_axis(np.where(known, faces, 0), last, axis=1)])


def padded(outlines: Sequence[Points]) -> Floats:
    """(m, k, 3) corners of polygons of any number of corners: the last one is repeated."""
    most = max((len(one) for one in outlines), default=3)
    rows = [one[np.minimum(np.arange(most), len(one) - 1)] for one in outlines]
    return np.array(rows, dtype=np.float64).reshape(-1, most, 3)


def painted(colour: tuple[float, float, float], count: int) -> Floats:
    """(count, 3) of one colour."""
    return np.tile(np.array(colour), (count, 1))


def thickness(view: View, layer: Layer) -> float:
    """Depth of a large face, mm."""
    if not isinstance(layer, Faces) or len(layer.corners) == 0:
        return 0.0
    return float(np.percentile(np.ptp(view.seen(layer.corners)[..., 2], axis=1), 95))


def _element(mark: Mark, places: Floats) -> str:
    """The SVG element of *mark* at *places* (k, 2), px."""
    name = hexadecimal(mark.colour)
    if mark.kind is Dots:
        x, y = places[0].tolist()
        return f'<circle cx="{x:g}" cy="{y:g}" r="{mark.size:g}" color="{name}"/>'
    rows = dict.fromkeys(map(tuple, places.tolist()))
    path = "M" + "L".join(f"{x:g} {y:g}" for x, y in rows)
    if mark.kind is Lines:
        return f'<path d="{path}" stroke-width="{mark.size:g}" color="{name}"/>'
    return f'<path d="{path}Z" color="{name}"/>'


def hexadecimal(colour: Floats) -> str:
    """An sRGB colour (3,) as ``#rrggbb``."""
    return "#" + "".join(f"{round(255 * min(max(c, 0.0), 1.0)):02x}" for c in colour.tolist())
