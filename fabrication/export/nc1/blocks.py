"""The blocks of an NC1 file, as text.

The format is the "Standard description for steel structure pieces for the numerical controls" of
the Deutscher Stahlbau-Verband (DSTV), 7th edition. A file is lines of ASCII. A block begins with
its two letters in the first columns; its lines begin with two blanks. On a plate (code B) all lies
on its front face, "v": x from the left end, y from the lower edge, "u", in mm. In contours a point
carries the radius of the arc from there to the next one, positive counter-clockwise, negative
clockwise, 0 for a straight line, and how that edge is prepared for welding, here not at all; the
last point is the first again. What is told here was compared
with plates that other programs wrote, round ones with round openings among them.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import numpy as np

from fabrication.parts import LETTER, Label
from fabrication.shapes import with_bulges
from gridshell.arrays import Floats

_FACE, _EDGE = "v", "u"
_SQUARE_EDGE = f"{0.0:11.3f}" * 4
"""No weld preparation: angle and blunting of the edge above and below."""
_WIDEST = np.pi / 2.0
"""Sweep of an arc at most: half circles have two centres for a reader that rounds."""
_ROUND = 1e-6
"""Of a radius: an opening this near to a circle is drilled."""


def contour(code: str, outline: Floats) -> Iterator[str]:
    """AK or IK: an outline (k, 2), or (k, 3) with bulges, mm.

    Outer contours are counter-clockwise; inner ones are turned clockwise here.
    """
    rows = arcs(with_bulges(outline))
    if code == "IK":
        rows = _reversed(rows)
    yield code
    for number, (x, y, radius) in enumerate([*rows, (*rows[0][:2], 0.0)]):
        face = _FACE if number == 0 else " "
        edge = _EDGE if number == 0 else " "
        place = f"  {face}{_number(x, 11)}{edge}{_number(y, 10)}{_number(radius, 11)}"
        yield place + _SQUARE_EDGE


def arcs(rows: Floats) -> list[tuple[float, float, float]]:
    """Corners with the radius of the arc to the next one; arcs of a quarter circle at most.

    Parameters
    ----------
    rows : (k, 3) x, y, bulge, mm; closed, the first corner not repeated.
    """
    found = []
    for a, b, bulge in zip(rows[:, :2], np.roll(rows[:, :2], -1, axis=0), rows[:, 2], strict=True):
        if bulge == 0.0:
            found.append((float(a[0]), float(a[1]), 0.0))
            continue
        sweep = 4.0 * np.arctan(bulge)
        chord = b - a
        radius = float(np.linalg.norm(chord) / (2.0 * np.sin(sweep / 2.0)))  # signed
        left = np.array([-chord[1], chord[0]]) / np.linalg.norm(chord)
        centre = (a + b) / 2.0 + radius * np.cos(sweep / 2.0) * left
        start = np.arctan2(a[1] - centre[1], a[0] - centre[0])
        count = int(np.ceil(abs(sweep) / _WIDEST - 1e-9))
        found.append((float(a[0]), float(a[1]), radius))
        for k in range(1, count):
            angle = start + sweep * k / count
            x, y = centre + abs(radius) * np.array([np.cos(angle), np.sin(angle)])
            found.append((float(x), float(y), radius))
    return found


def holes(circles: Floats) -> Iterator[str]:
    """BO: round holes through the plate, (m, 3) rows x, y, diameter, mm."""
    if len(circles):
        yield "BO"
    for x, y, diameter in circles.tolist():
        yield f"  {_FACE}{_number(x, 11)}{_EDGE}{_number(y, 10)}{_number(diameter, 11)}"


def marks(labels: Sequence[Label]) -> Iterator[str]:
    """SI: texts to stamp, from their lower left corner, angle in degrees, height in whole mm."""
    if labels:
        yield "SI"
    for label in labels:
        height = max(1, int(label.height))
        half = np.array([LETTER * height * len(label.text) / 2.0, height / 2.0])
        c, s = np.cos(label.angle), np.sin(label.angle)
        x, y = np.array([label.x, label.y]) - np.array([[c, -s], [s, c]]) @ half
        angle = np.degrees(label.angle)
        place = f"  {_FACE}{_number(x, 11)}{_EDGE}{_number(y, 10)}{_number(angle, 11)}"
        yield f"{place} {height:3d} {plain(label.text)}"


def circle_of(opening: Floats) -> tuple[float, float, float] | None:
    """x, y and diameter of an opening (k, 3) with bulges that is a whole circle; else None."""
    rows = with_bulges(opening)
    if not (rows[:, 2] != 0.0).all():
        return None
    points = np.array(arcs(rows))
    radius = np.abs(points[:, 2])
    middle = (points[:, :2].min(axis=0) + points[:, :2].max(axis=0)) / 2.0
    away = np.linalg.norm(points[:, :2] - middle, axis=1)
    if (np.abs(away - radius[0]) > _ROUND * radius[0]).any():
        return None
    if (np.abs(radius - radius[0]) > _ROUND * radius[0]).any():
        return None
    return float(middle[0]), float(middle[1]), 2.0 * float(radius[0])


def plain(text: str) -> str:
    """One line of ASCII; what is none becomes a question mark."""
    return " ".join(text.encode("ascii", "replace").decode().split())


def _reversed(
    rows: Sequence[tuple[float, float, float]],
) -> list[tuple[float, float, float]]:
    """The same contour the other way round: every arc belongs to its other end and turns back."""
    after = [*rows[1:], rows[0]]
    return [(b[0], b[1], -a[2]) for a, b in zip(rows, after, strict=True)][::-1]


def _number(value: float, width: int) -> str:
    return f"{value + 0.0:{width}.3f}" if abs(value) >= 5e-4 else f"{0.0:{width}.3f}"
