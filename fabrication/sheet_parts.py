"""Panels, plates and stars as they lie on a sheet: in their smallest box, with their marks.

A panel's outline lies around its middle; on a sheet it lies in (0, 0) .. (length, width). Along
every side of a panel stands the mark of the neighbour, near every end of a plate that of its node.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np

from fabrication.connector import connector_mark
from fabrication.connector_pieces import ConnectorPiece
from fabrication.outlines import outline_area
from fabrication.panel import Panel
from fabrication.parts import LETTER, Label
from fabrication.shapes import Shape
from fabrication.support import SupportPlate, plate_mark
from gridshell.arrays import Floats, frozen

_LARGEST, _OWN, _ASIDE = 25.0, 0.14, 0.6
"""Height of marks: at most, mm; over the part's width; of a neighbour's mark over the own one."""


@dataclass(frozen=True, eq=False)
class SheetPiece:
    """A flat part turned for its sheet; the first corner stays the first.

    Parameters
    ----------
    mark : the part's.
    outline : (k, 2), or (k, 3) with bulges, closed, counter-clockwise, within
        (0, 0) .. (length, width), mm.
    labels : own mark and neighbours'.
    length, width, thickness : mm.
    circles : (m, 3) rows x, y, diameter of round holes, mm.
    """

    mark: str
    outline: Floats
    labels: tuple[Label, ...]
    length: float
    width: float
    thickness: float
    circles: Floats = field(default_factory=lambda: np.zeros((0, 3)))

    @property
    def area(self) -> float:
        """Mm2."""
        return outline_area(self.outline) - float((np.pi / 4.0 * self.circles[:, 2] ** 2).sum())


def panel_piece(panel: Panel) -> SheetPiece:
    """The panel with its mark, and along every side the mark of the panel across."""
    return _piece(panel.mark, panel.outline, panel.neighbours, panel.thickness)


def plate_piece(plate: SupportPlate) -> SheetPiece:
    """The plate with its mark, and at either end the mark of the node; its upper edge is up."""
    first, second = (connector_mark(node) for node in plate.nodes)
    return _piece(plate.mark, plate.outline, (None, second, None, first), plate.thickness)


def star_piece(piece: ConnectorPiece) -> SheetPiece:
    """A star plate with its mark, and beside every slot the mark of the plate that goes in."""
    connector, spec = piece.connector, piece.connector.spec
    outline = np.array(connector.section())
    outline[:, :2] += spec.radius
    height = min(_LARGEST, 1.5 * spec.floor / (LETTER * len(piece.mark)))
    labels = [Label(piece.mark, spec.radius, spec.radius, height)]
    along = (spec.floor + spec.radius) / 2.0
    for arm in connector.arms:
        text = plate_mark(arm.edge)
        small = min(_ASIDE * height, 0.8 * spec.depth / (LETTER * len(text)))
        out = np.array([np.cos(arm.angle), np.sin(arm.angle)])
        side = spec.slot_width / 2.0 + small
        x, y = spec.radius + along * out + side * np.array([-out[1], out[0]])
        labels.append(Label(text, float(x), float(y), small, _upright(out)))
    across = 2.0 * spec.radius
    return SheetPiece(piece.mark, frozen(outline), tuple(labels), across, across, piece.height)


def shape_piece(mark: str, shape: Shape) -> SheetPiece:
    """A connector that is cut from sheet, with its shape's mark below its opening or in its middle.

    Parameters
    ----------
    mark : of the one piece; equal pieces are engraved alike, any of them goes to any place.
    shape : its arcs are half circles at most; its openings are round.
    """
    outline = np.array(shape.outline)
    low = _reach(outline).min(axis=0)
    outline[:, :2] -= low
    length, width = _reach(outline).max(axis=0).tolist()
    circles = np.array([_circle(opening, low) for opening in shape.openings]).reshape(-1, 3)
    hole = float(circles[:, 2].max(initial=0.0))
    height = min(_LARGEST, 0.12 * width, 0.25 * length / (LETTER * len(shape.mark)))
    y = width / 2.0 - (hole / 2.0 + height if hole else 0.0)
    return SheetPiece(
        mark=mark,
        outline=frozen(outline if outline[:, 2].any() else outline[:, :2]),
        labels=(Label(shape.mark, length / 2.0, y, height),),
        length=length,
        width=width,
        thickness=shape.high - shape.low,
        circles=circles,
    )


def _reach(outline: Floats) -> Floats:
    """(n, 2) corners of an outline (k, 3), and the middles of its arcs."""
    a, b = outline[:, :2], np.roll(outline[:, :2], -1, axis=0)
    right = np.stack([b[:, 1] - a[:, 1], a[:, 0] - b[:, 0]], axis=1)
    return np.concatenate([a, (a + b) / 2.0 + outline[:, 2:] / 2.0 * right])


def _circle(opening: Floats, low: Floats) -> list[float]:
    """Row x, y, diameter of a round opening, two half circles, seen from *low*."""
    x, y = opening[:, :2].mean(axis=0) - low
    return [float(x), float(y), float(np.linalg.norm(opening[1, :2] - opening[0, :2]))]


def _piece(
    mark: str, outline: Floats, beside: Sequence[str | None], thickness: float
) -> SheetPiece:
    turned = _turned(outline)
    length, width = turned.max(axis=0).tolist()
    return SheetPiece(mark, frozen(turned), _labels(mark, turned, beside), length, width, thickness)


def _turned(outline: Floats) -> Floats:
    """(k, 2) along the side whose box is the smallest, the box's longer side along x."""
    run = np.roll(outline, -1, axis=0) - outline
    angle = np.arctan2(run[:, 1], run[:, 0])
    angle = np.concatenate([angle, angle - np.pi / 2.0])
    c, s = np.cos(angle)[:, None], np.sin(angle)[:, None]
    x, y = outline.T
    all_x, all_y = c * x + s * y, c * y - s * x
    wide, high = np.ptp(all_x, axis=1), np.ptp(all_y, axis=1)
    # among equal boxes the first, so that like parts lie alike
    cost = np.where(wide >= high * (1.0 - 1e-9), wide * high, np.inf)
    best = int(np.argmin(np.round(cost / cost.min(), 9)))
    points = np.stack([all_x[best], all_y[best]], axis=1)
    return np.asarray(points - points.min(axis=0))


def _labels(mark: str, outline: Floats, beside: Sequence[str | None]) -> tuple[Label, ...]:
    room = float(np.ptp(outline, axis=0).min())
    following = np.roll(outline, -1, axis=0)
    run = following - outline
    side = np.linalg.norm(run, axis=1)
    height = min(_LARGEST, _OWN * room, float(side.max()) / (LETTER * (len(mark) + 2)))
    middle = outline.mean(axis=0)
    labels = [Label(mark, float(middle[0]), float(middle[1]), height)]
    for c, text in enumerate(beside):
        if text is None:
            continue
        small = min(_ASIDE * height, float(side[c]) / (LETTER * (len(text) + 2)))
        inward = np.array([-run[c, 1], run[c, 0]]) / side[c]
        place = (outline[c] + following[c]) / 2.0 + 1.2 * small * inward
        labels.append(Label(text, float(place[0]), float(place[1]), small, _upright(run[c])))
    return tuple(labels)


def _upright(run: Floats) -> float:
    """Angle of a text along *run* that is not upside down, in (-90, 90] degrees, radians."""
    angle = float(np.arctan2(run[1], run[0]))
    if angle > np.pi / 2.0 + 1e-9:
        return angle - np.pi
    return angle + np.pi if angle <= -np.pi / 2.0 + 1e-9 else angle
