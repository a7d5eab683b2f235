"""What an object shows of itself in a notebook: a light picture and a short table, as HTML.

The picture is an SVG of far fewer elements than ``painter.svg`` makes: everything is cut into slabs
by its distance from the eye, and of a slab all faces of one tone are one path, and all lines of one
colour another. Nothing in it runs or is fetched, and all text is escaped.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from html import escape

import numpy as np

from gridshell.arrays import Floats, Indices, Points
from gridshell.painter import (
    Dots,
    Faces,
    Layer,
    Lines,
    bounds,
    corners,
    hexadecimal,
    painted,
    seen_from,
    shaded,
    thickness,
)

FAMILY_COLOURS = {1: (0.80, 0.52, 0.25), 2: (0.36, 0.47, 0.58)}
"""Of the two families everywhere, sRGB, 0 to 1."""

PALE, INK = (0.90, 0.92, 0.94), (0.35, 0.39, 0.45)
"""Of faces, and of lines that belong to no family."""

VIEW = seen_from(0.62, -0.64, 0.46)
"""That of the reports: from above, at an angle."""

MOST_LINES = 3_000
"""Straight lines in a picture at most; of larger nets some are left out."""

_SIZE, _MARGIN = (560.0, 360.0), 6.0
"""Px at most."""

_SLABS, _TONES = 48, 24

_STYLE = "font:13px/1.45 system-ui,sans-serif"
_CELL = "text-align:left;padding:1px 14px 1px 0;border:0;background:none"


def sketch(layers: Sequence[Layer], *, label: str) -> str:
    """Faces and lines as one SVG, fitted into a small frame; dots are left out.

    Parameters
    ----------
    layers : lines lie on their faces, as in ``painter``.
    label : what the picture shows, for those who do not see it.
    """
    shown = [one for one in layers if not isinstance(one, Dots) and len(corners(one))]
    low, high = bounds(shown, VIEW) if shown else np.zeros((2, 2))
    room = np.array(_SIZE) - 2.0 * _MARGIN
    scale = float((room / np.maximum(high - low, 1e-9)).min()) if (high > low).any() else 1.0
    width, height = ((high - low) * scale + 2.0 * _MARGIN).tolist()
    corner, way = np.array([low[0], high[1]]), np.array([scale, -scale])
    body = "\n".join(_paths(shown, corner, way))
    return (
        f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {width:.0f} {height:.0f}" '
        f'width="{width:.0f}" style="max-width:100%;height:auto" role="img" '
        f'aria-label="{escape(label)}"><g fill="currentColor" stroke="currentColor" '
        f'stroke-width="0.6" stroke-linejoin="round" stroke-linecap="round">\n{body}\n</g></svg>'
    )


def card(
    title: str,
    figures: Iterable[tuple[str, str]],
    *,
    picture: str = "",
    notes: Iterable[str] = (),
    width: int = 580,
) -> str:
    """Title, picture, table and notes as HTML that is also XML.

    Parameters
    ----------
    title, figures, notes : text, escaped here; a figure without text is left out.
    picture : an SVG, taken as it is.
    width : px at most.
    """
    rows = "".join(
        f'<tr style="background:none"><th scope="row" style="{_CELL};font-weight:400;opacity:0.7">'
        f'{escape(name)}</th><td style="{_CELL}">{escape(text)}</td></tr>'
        for name, text in figures
        if text
    )
    below = "".join(f'<p style="margin:4px 0;opacity:0.7">{escape(note)}</p>' for note in notes)
    return (
        f'<div class="gridshell" style="{_STYLE};max-width:{width}px">'
        f'<div style="font-weight:600">{escape(title)}</div>{picture}'
        f'<table style="border-collapse:collapse;margin:4px 0">{rows}</table>'
        f"{below}</div>"
    )


def family_lines(points: Points, edges: Indices, family: Indices) -> list[Layer]:
    """Edges (m, 2) of a net in the colours of their families (m,)."""
    return [
        straight(points, edges[family == number], colour)
        for number, colour in FAMILY_COLOURS.items()
    ]


def straight(
    points: Points,
    edges: Indices,
    colour: tuple[float, float, float] = INK,
    width: float = 1.3,
) -> Lines:
    """Edges (m, 2) between *points*, *width* in px."""
    return Lines(points[edges], painted(colour, len(edges)), width)


def pale(found: Floats) -> Faces:
    """Faces with the corners (m, k, 3) in the colour of paper."""
    return Faces(found, painted(PALE, len(found)))


def size(points: Points) -> str:
    """What *points* (n, 3) mm span: "8.00 x 6.50 x 1.20 m"."""
    if len(points) == 0:
        return ""
    return " x ".join(f"{side:.2f}" for side in (np.ptp(points, axis=0) / 1e3).tolist()) + " m"


def limits(values: Floats, unit: str, decimals: int = 2) -> str:
    """Smallest and largest of *values* that are numbers: "59.90 to 60.10 degrees"."""
    known = values[np.isfinite(values)]
    if len(known) == 0:
        return ""
    low, high = (f"{value:.{decimals}f}" for value in (known.min(), known.max()))
    return f"{low} {unit}" if low == high else f"{low} to {high} {unit}"


# ---- paths ---------------------------------------------------------------------------------------


def _paths(layers: Sequence[Layer], corner: Floats, way: Floats) -> Iterator[str]:
    """Slab by slab from far to near: the faces by their tones, then the lines on them."""
    ahead = max((thickness(VIEW, one) for one in layers), default=0.0)
    placed = [VIEW.seen(corners(one)) for one in layers]
    flat = [(found[..., :2] - corner) * way + _MARGIN for found in placed]
    depths = [
        found[..., 2].mean(axis=1) + (ahead if isinstance(one, Lines) else 0.0)
        for one, found in zip(layers, placed, strict=True)
    ]
    every = np.concatenate([np.zeros(0), *depths])
    stops = np.quantile(every, np.linspace(0.0, 1.0, _SLABS + 1)[1:-1]) if len(every) else every
    slabs = [np.searchsorted(stops, depth) for depth in depths]
    tones = [_toned(one) for one in layers]
    on_top = sorted(range(len(layers)), key=lambda k: isinstance(layers[k], Lines))
    for slab in range(_SLABS):
        for k in on_top:
            inside = np.flatnonzero(slabs[k] == slab)
            kinds, kind = np.unique(tones[k][inside], axis=0, return_inverse=True)
            for number, colour in enumerate(kinds):
                own = inside[kind.ravel() == number]
                yield _path(layers[k], flat[k][own], hexadecimal(colour))


def _toned(layer: Layer) -> Floats:
    """(m, 3) colours, those of faces shaded in a few steps."""
    if not isinstance(layer, Faces):
        return layer.colours
    light = shaded(layer, VIEW).sum(axis=1) / np.maximum(layer.colours.sum(axis=1), 1e-9)
    return np.asarray(layer.colours * (np.round(light * _TONES) / _TONES)[:, None])


def _path(layer: Layer, rows: Floats, colour: str) -> str:
    if isinstance(layer, Lines):
        moves = _moves(rows, "")
        return f'<path class="lines" stroke-width="{layer.width:g}" color="{colour}" d="{moves}"/>'
    return f'<path color="{colour}" d="{_moves(_one_way(rows), "Z")}"/>'


def _one_way(polygons: Floats) -> Floats:
    """Flat polygons (m, k, 2) all turning alike, so that two of one path never cancel."""
    x, y = polygons[..., 0], polygons[..., 1]
    turned = (x * np.roll(y, -1, axis=1) - y * np.roll(x, -1, axis=1)).sum(axis=1) < 0.0
    return np.where(turned[:, None, None], polygons[:, ::-1], polygons)


def _moves(rows: Floats, end: str) -> str:
    """Rows (m, k, 2) px as the data of one path."""
    return "".join(
        "M" + "L".join(f"{x:g} {y:g}" for x, y in points) + end
        for points in np.round(rows, 1).tolist()
    )
