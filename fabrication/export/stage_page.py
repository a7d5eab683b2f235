"""The pictures of a remeshing as one HTML page, with a view to turn; it opens from disk."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np
from markupsafe import Markup

import gridshell as gs
from fabrication.errors import OutputError
from fabrication.export.html import rendered
from fabrication.export.scene import layers as scene
from fabrication.export.scene.packing import on_screen
from fabrication.export.scene.page import as_json, scripts, style
from fabrication.export.scene.whole import middle
from fabrication.export.stages import Stage, drawn, stages, view_of
from gridshell.arrays import Floats, Indices
from gridshell.painter import Dots, Faces, Layer, Lines, View, corners, hexadecimal

_SHADES = 12
"""Steps of each channel that lines of a ramp of colours come in."""


def write_stages(
    folder: Path, made: gs.Quadrangulation, *, name: str, net: gs.ControlMesh | None = None
) -> None:
    """Write ``stages.html``, to turn, and one SVG per stage into *folder*, which exists.

    Raises
    ------
    OutputError
        When a file cannot be written.
    """
    found, view = stages(made, net), view_of(made)
    shown = drawn(found, view)
    page = stage_page(name, found, shown, view, made.report.plain())
    try:
        for picture in shown:
            (folder / picture["file"]).write_text(picture["svg"], encoding="utf-8")
        (folder / "stages.html").write_text(page, encoding="utf-8")
    except OSError as error:
        raise OutputError(
            "The pictures cannot be written", where=str(folder), value=error.strerror or ""
        ) from None


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
    view : where the 3D view looks from at first.
    figures : of the remeshing, as ``RemeshReport.plain()``.
    """
    return rendered(
        "stages.html",
        name=name,
        pictures=[{**picture, "svg": Markup(picture["svg"])} for picture in shown],
        figures=figures,
        home=as_json(view.frame[2].tolist()),
        scene=as_json(stage_scene(found).packed()),
        scripts=scripts(),
        viewer_style=style(),
    )


def stage_scene(found: Sequence[Stage]) -> scene.Scene:
    """All stages; the layers of a stage bear its letter."""
    everything = [corners(layer).reshape(-1, 3) for stage in found for layer in stage.layers]
    centre = middle(np.concatenate(everything))
    return scene.Scene([layer for stage in found for layer in _layers(stage, centre)])


def _layers(stage: Stage, centre: Floats) -> Iterator[scene.Layer]:
    parts = [(layer, colour) for layer in stage.layers for colour in _by_colour(layer)]
    for k, (layer, (colour, rows)) in enumerate(parts):
        about: dict[str, Any] = {
            "id": f"{stage.letter}{k}",
            "name": f"{stage.letter} {stage.title}",
            "colour": colour,
        }
        points = on_screen(corners(layer)[rows].reshape(-1, 3), centre)
        match layer:
            case Faces():
                yield _faces(layer, points, about)
            case Lines():
                pairs = np.arange(len(points)).reshape(-1, 2)
                yield scene.Lines(points=points, pairs=pairs, **about)
            case Dots():
                yield scene.Dots(points=points, size=2.0 * layer.radius, **about)


def _by_colour(layer: Layer) -> list[tuple[str, Indices]]:
    """Colours and the rows of *layer* that have them; faces have one each, and stay together."""
    if len(layer.colours) == 0:
        return []
    if isinstance(layer, Faces):
        return [(hexadecimal(layer.colours.mean(axis=0)), np.arange(len(layer.colours)))]
    steps = np.round(layer.colours * _SHADES) / _SHADES
    kinds, which = np.unique(steps, axis=0, return_inverse=True)
    which = which.ravel()
    means = [layer.colours[which == k].mean(axis=0) for k in range(len(kinds))]
    return [(hexadecimal(mean), np.flatnonzero(which == k)) for k, mean in enumerate(means)]


def _faces(layer: Faces, points: Any, about: Mapping[str, Any]) -> scene.Faces:
    """Polygons as fans of triangles, each polygon with its colour."""
    count, sides = layer.corners.shape[:2]
    unique, number_of = np.unique(points, axis=0, return_inverse=True)
    polygons = number_of.reshape(count, sides)
    fans = np.stack([polygons[:, [0, k, k + 1]] for k in range(1, sides - 1)], axis=1)
    return scene.Faces(
        points=unique,
        triangles=fans.reshape(-1, 3),
        sizes=[sides - 2] * count,
        colours=layer.colours,
        **about,
    )
