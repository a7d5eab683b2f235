"""Panels, plates and connectors in 3D, to turn and to hover over: a plotly figure."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
import plotly.graph_objects as go
from plotly.colors import sample_colorscale

from fabrication.colours import css
from fabrication.export.shell import LIGHT, axes_figure, camera, on_screen, xyz
from fabrication.export.words import fixed, number
from fabrication.grouping import Group
from fabrication.panel_structure import COLOURS, PanelStructure, connector_span
from gridshell.arrays import Floats, Points

_ALONE = (0.74, 0.80, 0.84)
"""Of panels with no equal, sRGB."""

_SIDES = 12
"""Of the prisms that stand for cylinders."""


def group_colours(groups: Sequence[Group]) -> Floats:
    """(g, 3) a colour for each group, sRGB; panels without an equal are pale."""
    several = [n for n, group in enumerate(groups) if len(group.members) > 1]
    colours = np.tile(np.array(_ALONE), (len(groups), 1))
    for place, n in enumerate(several):
        hue = 0.55 + 0.618034 * place
        colours[n] = _hue(hue % 1.0)
    return colours


def panel_figure(built: PanelStructure) -> Any:
    """The panels by group, the plates by how far they are out of plane, the connectors."""
    vertices = built.mesh.vertices
    centre = (vertices.min(axis=0) + vertices.max(axis=0)) / 2.0
    traces = [*_panels(built, centre)]
    if built.plates:
        traces.append(_plates(built, centre))
    if built.connectors:
        traces.append(_connectors(built, centre))
    points = on_screen(vertices, centre).astype(np.float64)
    traces += [_marks(built, centre), axes_figure(points)]
    return go.Figure(traces, {"template": "none", "scene": {"camera": camera(points)}})


def _panels(built: PanelStructure, centre: Floats) -> list[Any]:
    colours, texts, polygons, shades = group_colours(built.panel_groups), [], [], []
    group_of = {m.index: n for n, g in enumerate(built.panel_groups) for m in g.members}
    lift = built.system.panels.thickness
    for panel in built.panels:
        group = built.panel_groups[group_of[panel.index]]
        polygons.append(panel.in_space() + lift * panel.frame.normal)
        shades.append(css(tuple(colours[group_of[panel.index]].tolist())))
        angles = " / ".join(fixed(a, 1) for a in np.degrees(panel.corner_angles).tolist())
        texts.append(
            f"<b>{panel.mark}</b>, group {group.name} of {len(group.members)}<br>"
            f"{number(panel.mass)} kg<br>corners {angles}°"
        )
    mesh = _fans(polygons, texts, centre, name="Panels", colours=shades)
    mesh.update(legendgroup="panels")
    return [mesh, _rims(polygons, centre)]


def _plates(built: PanelStructure, centre: Floats) -> Any:
    off = np.array([plate.out_of_plane for plate in built.plates])
    top = max(float(off.max()), 1e-9)
    flat = all(plate.flat for plate in built.plates)
    scale = sample_colorscale("YlOrRd", (off / top).tolist())
    colours = [css(COLOURS["plates"])] * len(off) if flat else scale
    texts = [
        f"<b>{plate.mark}</b><br>length {fixed(plate.length, 1)} mm<br>"
        f"out of plane {number(plate.out_of_plane)} mm<br>"
        f"twist {number(float(np.degrees(abs(plate.twist))))}°"
        for plate in built.plates
    ]
    name = "Plates, flat" if flat else f"Plates, up to {number(top, 3)} mm out of plane (red)"
    polygons = [plate.in_space() for plate in built.plates]
    return _fans(polygons, texts, centre, name=name, colours=colours)


def _connectors(built: PanelStructure, centre: Floats) -> Any:
    low, high = connector_span(built.system)
    turn = 2.0 * np.pi * np.arange(_SIDES) / _SIDES
    polygons, texts = [], []
    for connector in built.connectors:
        ring = connector.spec.radius * np.stack([np.cos(turn), np.sin(turn)], axis=1)
        base, up = connector.frame.place(ring), connector.frame.normal
        around = np.roll(np.arange(_SIDES), -1)
        sides = np.stack([base + low * up, base + high * up], axis=1)
        polygons += [np.concatenate([sides[k], sides[around[k]][::-1]]) for k in range(_SIDES)]
        polygons.append(base + high * up)
        between = " / ".join(fixed(a, 1) for a in np.degrees(connector.between).tolist())
        texts += [f"<b>{connector.mark}</b><br>slots {between}° apart"] * (_SIDES + 1)
    return _fans(polygons, texts, centre, name="Connectors", colours=[css(COLOURS["connectors"])])


def _fans(
    polygons: Sequence[Points],
    texts: Sequence[str],
    centre: Floats,
    *,
    name: str,
    colours: Sequence[str],
) -> Any:
    """Convex polygons as one mesh; one colour for each, or one for all."""
    counts = [len(polygon) for polygon in polygons]
    first = np.cumsum([0, *counts[:-1]])
    spans = zip(first.tolist(), counts, strict=True)
    triangles = np.array([(at, at + k, at + k + 1) for at, n in spans for k in range(1, n - 1)])
    points = on_screen(np.concatenate(polygons), centre)
    per_face = len(colours) == len(polygons)
    shade = (
        {"facecolor": np.repeat(np.array(colours), np.array(counts) - 2).tolist()}
        if per_face
        else {"color": colours[0]}
    )
    return go.Mesh3d(
        **xyz(points),
        **dict(zip("ijk", triangles.T.astype(np.min_scalar_type(len(points))), strict=True)),
        **shade,
        name=name,
        showlegend=True,
        flatshading=True,
        lighting=LIGHT,
        hoverinfo="text",
        meta={"texts": list(texts), "counts": counts},
    )


def _rims(polygons: Sequence[Points], centre: Floats) -> Any:
    gap = np.full((1, 3), np.nan)
    loops = [block for p in polygons for block in (p, p[:1], gap)]
    return go.Scatter3d(
        **xyz(on_screen(np.concatenate(loops), centre)),
        mode="lines",
        name="Panels, edges",
        legendgroup="panels",
        showlegend=False,
        line={"color": "#5a6472", "width": 1.0},
        hoverinfo="skip",
    )


def _marks(built: PanelStructure, centre: Floats) -> Any:
    places = np.array([p.in_space().mean(axis=0) for p in built.panels])
    lift = np.array([p.frame.normal for p in built.panels])
    raised = places + 0.05 * built.mesh.edge_lengths.mean() * lift
    return go.Scatter3d(
        **xyz(on_screen(raised, centre)),
        mode="text",
        name="Marks",
        text=[panel.mark for panel in built.panels],
        textfont={"size": 10, "color": "#1c232d"},
        visible=True if len(built.panels) <= 150 else "legendonly",
        hoverinfo="skip",
    )


def _hue(hue: float) -> Floats:
    """A light colour of a hue in [0, 1), sRGB."""
    import colorsys

    return np.array(colorsys.hls_to_rgb(hue, 0.68, 0.5))
