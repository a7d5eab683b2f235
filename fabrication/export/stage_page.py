"""The pictures of a remeshing as one HTML page, with a view to turn; it opens from disk."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np
import plotly.graph_objects as go
from jinja2 import Environment, FileSystemLoader
from markupsafe import Markup
from plotly.offline import get_plotlyjs

from fabrication.export.stages import Stage
from fabrication.words import fixed, number, plural
from gridshell.arrays import Floats, Indices, Points
from gridshell.painter import Dots, Faces, Layer, Lines, View, corners, hexadecimal

_LIGHT = {"ambient": 0.9, "diffuse": 0.2, "specular": 0.03, "roughness": 0.9, "fresnel": 0.02}

_AHEAD = 2e-3
"""Of the size: lines stand so far before their faces, dots twice, seen from where it begins."""

_EYE, _FIELD, _ASPECT = (0.62, -0.64, 0.46), np.pi / 4.0, 1.5
"""Towards the camera; plotly's own vertical field of view; the frame's width over its height."""

_TOP = np.array([0.0, 0.0, 1.0])


def stage_page(
    name: str,
    found: Sequence[Stage],
    shown: Sequence[Mapping[str, Any]],
    view: View,
    figures: Mapping[str, Any],
) -> str:
    """The page.

    Parameters
    ----------
    found, shown : the stages and their pictures, in one order.
    figures : of the remeshing, as ``RemeshReport.plain()``.
    """
    environment = Environment(
        loader=FileSystemLoader(Path(__file__).parent),
        autoescape=True,
        trim_blocks=True,
        lstrip_blocks=True,
    )
    environment.filters.update(figure=number, fixed=fixed, plural=plural)
    return environment.get_template("stages.html").render(
        name=name,
        pictures=[{**picture, "svg": Markup(picture["svg"])} for picture in shown],
        figures=figures,
        figure=Markup(stage_figure(found, view).to_json().replace("<", "\\u003c")),
        plotly=Markup(get_plotlyjs()),
    )


def stage_figure(found: Sequence[Stage], view: View) -> Any:
    """All stages in one 3D figure; ``meta`` of a trace is the letter of its stage."""
    everything = np.concatenate(
        [corners(layer).reshape(-1, 3) for stage in found for layer in stage.layers]
    )
    low, high = everything.min(axis=0), everything.max(axis=0)
    centre, ahead = (low + high) / 2.0, _AHEAD * np.linalg.norm(high - low) * view.frame[2]
    traces = [
        trace
        for stage in found
        for layer in stage.layers
        for trace in _traces(layer, centre, ahead, stage.letter)
    ]
    x, y, z = view.frame[2].tolist()
    top = view.frame[1]
    seen = _camera(_on_screen(everything, centre).astype(np.float64), (x, y, z), top)
    return go.Figure(
        traces, {"template": "none", "scene": {"camera": {**seen, "up": _xyz(np.round(top, 4))}}}
    )


def _traces(layer: Layer, centre: Floats, ahead: Floats, letter: str) -> list[Any]:
    if len(corners(layer)) == 0:
        return []
    if isinstance(layer, Faces):
        return [_solid(layer, centre, letter)]
    step = {Lines: 1.0, Dots: 2.0}[type(layer)] * ahead
    points = _on_screen(corners(layer).reshape(-1, 3) + step, centre)
    about = {"meta": letter, "hoverinfo": "skip", "showlegend": False}
    if isinstance(layer, Dots):
        marker = {"size": 1.6 * layer.radius, "color": hexadecimal(layer.colours[0])}
        return [go.Scatter3d(**_xyz(points), mode="markers", marker=marker, **about)]
    return [
        go.Scatter3d(
            **_xyz(_with_gaps(points.reshape(-1, 2, 3)[rows])),
            mode="lines",
            line={"color": colour, "width": 2.0 * layer.width},
            **about,
        )
        for colour, rows in _by_colour(layer)
    ]


def _by_colour(layer: Lines) -> list[tuple[str, Indices]]:
    """Rows of lines of about one colour; a ramp comes in a few steps."""
    steps = np.round(layer.colours * 12.0) / 12.0 if len(layer.colours) else layer.colours
    kinds, which = np.unique(steps, axis=0, return_inverse=True)
    which = which.ravel()
    means = [layer.colours[which == k].mean(axis=0) for k in range(len(kinds))]
    return [(hexadecimal(mean), np.flatnonzero(which == k)) for k, mean in enumerate(means)]


def _with_gaps(ends: Floats) -> Any:
    gap = np.full((len(ends), 1, 3), np.nan, dtype=np.float32)
    return np.concatenate([ends, gap], axis=1).reshape(-1, 3)


def _solid(layer: Faces, centre: Floats, letter: str) -> Any:
    """Faces as a fan of triangles each, every one with its colour."""
    count, sides = layer.corners.shape[:2]
    points, number_of = np.unique(
        _on_screen(layer.corners.reshape(-1, 3), centre), axis=0, return_inverse=True
    )
    faces = number_of.reshape(count, sides)
    fan = np.concatenate([faces[:, [0, k, k + 1]] for k in range(1, sides - 1)])
    colours = np.tile(np.array([hexadecimal(c) for c in layer.colours]), sides - 2)
    real = (fan[:, 0] != fan[:, 1]) & (fan[:, 1] != fan[:, 2]) & (fan[:, 2] != fan[:, 0])
    fan, colours = fan[real], colours[real]
    one = len(set(colours.tolist())) == 1
    paint = {"color": colours[0]} if one else {"facecolor": colours.tolist()}
    return go.Mesh3d(
        **_xyz(points),
        **dict(zip("ijk", fan.T.astype(np.int32), strict=True)),
        **paint,
        flatshading=True,
        lighting=_LIGHT,
        hoverinfo="skip",
        meta=letter,
    )


def _on_screen(points: Points, centre: Floats) -> Any:
    """*points* (n, 3) mm as metres from *centre*: single precision, rounded to 0.1 mm."""
    return np.round((points - centre) / 1e3, 4).astype(np.float32)


def _xyz(points: Any) -> dict[str, Any]:
    """*points* (n, 3), or one (3,), as plotly's x, y and z."""
    return dict(zip("xyz", points.T, strict=True))


def _camera(
    points: Points, eye: tuple[float, float, float] = _EYE, top: Floats = _TOP
) -> dict[str, Any]:
    """Where the camera stands to see all *points* (n, 3) as large as the frame allows.

    plotly's unit is the cube root of the bounding box's volume, its origin the box's middle.

    Parameters
    ----------
    eye, top : directions (3,) to the camera and of what shall be upright in the picture.
    """
    low, high = points.min(axis=0), points.max(axis=0)
    back = np.array(eye) / np.linalg.norm(eye)
    right = np.cross(top, back) / np.linalg.norm(np.cross(top, back))
    frame = np.stack([right, np.cross(back, right), back], axis=1)
    x = (points - (low + high) / 2.0) @ frame / np.cbrt(np.prod(np.maximum(high - low, 1e-3)))
    reach = np.tan(_FIELD / 2.0) * np.array([_ASPECT, 1.0])
    centre = np.zeros(2)
    for _ in range(5):
        distance = ((np.abs(x[:, :2] - centre) / reach).max(axis=1) + x[:, 2]).max()
        seen = (x[:, :2] - centre) / (distance - x[:, 2:])
        centre += (seen.min(axis=0) + seen.max(axis=0)) / 2.0 * distance
    place = np.r_[centre, 1.05 * distance]
    return {"eye": _xyz(frame @ place), "center": _xyz(frame[:, :2] @ centre)}
