"""The shell in 3D, to turn and to hover over: a plotly figure of the built strips.

Strips are drawn as their middle surfaces: the flat outline is cut into columns, and each column
laid into place by the strip's own map. Slots are the only notches, so a column has one lower and
one upper bound.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
import plotly.graph_objects as go

from fabrication.colours import FAMILY_COLOURS, css
from fabrication.cut import Edge
from fabrication.export.words import fixed, plural
from fabrication.lamella import Lamella
from fabrication.parts import FlatPart
from fabrication.structures import Structure
from gridshell.arrays import Floats, Indices, Points

_SAMPLES_PER_BAY = 6
_INK, _QUIET = "#1c232d", "#5a6472"
LIGHT = {"ambient": 0.8, "diffuse": 0.35, "specular": 0.05, "roughness": 0.8, "fresnel": 0.05}
_VIEW, _FIELD, _ASPECT = (0.62, -0.64, 0.46), np.pi / 4.0, 1.5
"""Towards the camera; plotly's own vertical field of view; the frame's width over its height."""

_TOP = np.array([0.0, 0.0, 1.0])


@dataclass(frozen=True, eq=False)
class _StripMesh:
    """The middle surface of one built strip.

    Parameters
    ----------
    points : (n, 3) mm.
    triangles : (m, 3) point numbers.
    loop : (k,) point numbers around the outline, the first again at the end.
    hover : what the strip says of itself.
    """

    points: Points
    triangles: Indices
    loop: Indices
    hover: str


def _strip_mesh(lamella: Lamella, part: FlatPart) -> _StripMesh:
    """Columns between all outline corners and a few samples per bay, laid into place at once."""
    x, lower, upper = _columns(part)
    corner_x = np.stack([x[:-1], x[1:], x[1:], x[:-1]], axis=1)
    corner_y = np.stack([lower, lower, upper, upper], axis=1)
    corners = np.stack([corner_x.ravel(), corner_y.ravel()], axis=1)
    flat, number = np.unique(corners, axis=0, return_inverse=True)
    height = flat[:, 1] - part.width / 2.0
    quads = number.reshape(-1, 4)
    loop = np.r_[quads[:, :2].ravel(), quads[::-1, 2:].ravel(), quads[0, 0]]
    return _StripMesh(
        points=lamella.place(flat[:, 0] + lamella.start, np.zeros(len(flat)), height),
        triangles=np.concatenate([quads[:, [0, 1, 2]], quads[:, [0, 2, 3]]]),
        loop=loop[np.r_[True, np.diff(loop) != 0]],
        hover=f"<b>{lamella.mark}</b>, family {'AB'[lamella.family - 1]}<br>"
        f"length {fixed(part.length, 1)} mm<br>{plural(len(part.slots), 'slot')}",
    )


def _columns(part: FlatPart) -> tuple[Floats, Floats, Floats]:
    """(c + 1,) ends of the columns along the strip, (c,) lower and (c,) upper bounds, mm."""
    bays = np.unique(np.clip(np.r_[0.0, part.development.node_x, part.length], 0.0, part.length))
    steps = np.arange(_SAMPLES_PER_BAY * (len(bays) - 1) + 1) / _SAMPLES_PER_BAY
    samples = np.interp(steps, np.arange(len(bays)), bays)
    x = np.unique(np.clip(np.r_[part.outline[:, 0], samples], 0.0, part.length))
    x = x[np.r_[True, np.diff(x) > 1e-6]]
    middle = (x[:-1] + x[1:]) / 2.0
    notch = []
    for edge in (Edge.LOWER, Edge.UPPER):
        slots = [(slot.x, slot.width, slot.depth) for slot in part.slots if slot.edge is edge]
        centre, width, depth = np.array(slots).reshape(-1, 3).T
        inside = np.abs(middle[:, None] - centre) < width / 2.0
        notch.append(np.where(inside, depth, 0.0).max(axis=1, initial=0.0))
    return x, notch[0], np.maximum(notch[0], part.width - notch[1])


def shell_figure(structure: Structure, parts: Sequence[FlatPart]) -> Any:
    """The shell as few traces: per family a mesh and its outlines; marks, nodes and axes."""
    positions = np.array([node.position for node in structure.nodes])
    centre = (positions.min(axis=0) + positions.max(axis=0)) / 2.0
    traces = []
    for family in FAMILY_COLOURS:
        meshes = [
            _strip_mesh(lamella, part)
            for lamella, part in zip(structure.lamellas, parts, strict=True)
            if lamella.family == family
        ]
        traces += _family(family, meshes, centre) if meshes else []
    traces.append(_marks(structure, centre))
    points = np.concatenate([np.stack([t.x, t.y, t.z], axis=1) for t in traces]).astype(np.float64)
    points = points[np.isfinite(points[:, 0])]
    traces += [_nodes(structure, centre), axes_figure(points)]
    return go.Figure(traces, {"template": "none", "scene": {"camera": camera(points)}})


def _family(family: int, meshes: Sequence[_StripMesh], centre: Floats) -> list[Any]:
    """All strips of a family as one mesh and one line.

    What a strip says is kept once, with its number of points; the page says it at every point.
    """
    points = on_screen(np.concatenate([mesh.points for mesh in meshes]), centre)
    first = np.cumsum([0] + [len(mesh.points) for mesh in meshes[:-1]])
    triangles = np.concatenate([m.triangles + at for m, at in zip(meshes, first, strict=True)])
    gap = np.full((1, 3), np.nan, dtype=np.float32)
    loops = [points[m.loop + at] for m, at in zip(meshes, first, strict=True)]
    name, group = f"Family {'AB'[family - 1]}", f"family{family}"
    faces = go.Mesh3d(
        **xyz(points),
        **dict(zip("ijk", triangles.T.astype(np.min_scalar_type(len(points))), strict=True)),
        name=name,
        legendgroup=group,
        showlegend=True,
        color=css(FAMILY_COLOURS[family]),
        lighting=LIGHT,
        hoverinfo="text",
        meta={"texts": [m.hover for m in meshes], "counts": [len(m.points) for m in meshes]},
    )
    edges = go.Scatter3d(
        **xyz(np.concatenate([block for loop in loops for block in (loop, gap)])),
        mode="lines",
        name=f"{name}, edges",
        legendgroup=group,
        showlegend=False,
        line={"color": css(FAMILY_COLOURS[family], 0.7), "width": 1.0},
        hoverinfo="skip",
    )
    return [faces, edges]


def _marks(structure: Structure, centre: Floats) -> Any:
    """The mark of every lamella, a little beyond its first end."""
    beyond, nought = 0.4 * structure.profile.width, np.zeros(1)
    lamellas = structure.lamellas
    places = [
        lamella.place(lamella.start - np.array([beyond]), nought, nought) for lamella in lamellas
    ]
    return go.Scatter3d(
        **xyz(on_screen(np.concatenate(places), centre)),
        mode="text",
        name="Marks",
        text=[lamella.mark for lamella in lamellas],
        textposition=[f"middle {('left', 'right')[lamella.family - 1]}" for lamella in lamellas],
        textfont={
            "size": 11,
            "color": [css(FAMILY_COLOURS[lamella.family], 0.6) for lamella in lamellas],
        },
        hoverinfo="skip",
    )


def _nodes(structure: Structure, centre: Floats) -> Any:
    """A point per node, with its angle and its lamellas to hover over."""
    texts = []
    for node in structure.nodes:
        marks = " × ".join(structure.lamellas[c.lamella].mark for c in node.crossings)
        angle = "" if node.angle is None else f"{np.degrees(node.angle):.2f}°<br>"
        texts.append(f"<b>{node.name}</b><br>{angle}{marks}")
    return go.Scatter3d(
        **xyz(on_screen(np.array([node.position for node in structure.nodes]), centre)),
        mode="markers",
        name="Nodes",
        text=texts,
        marker={"size": 1.8, "color": _INK},
        hoverinfo="text",
    )


def axes_figure(points: Points) -> Any:
    """The directions x, y and z in a lower corner around *points*, a round length long."""
    length = 10.0 ** np.floor(np.log10(np.ptp(points, axis=0).max() / 4.0))
    right, rear, _ = points.max(axis=0) - length
    corner = np.array([right, rear, points[:, 2].min()])
    return go.Scatter3d(
        **xyz(corner + length * np.eye(4, 3, k=-1)[[1, 0, 2, 0, 3]]),
        mode="lines+text",
        name=f"Axes, {length:g} m long",
        text=["x", "", "y", "", "z"],
        textfont={"size": 12, "color": _QUIET},
        line={"color": _QUIET, "width": 3},
        hoverinfo="skip",
    )


def on_screen(points: Points, centre: Floats) -> Any:
    """*points* (n, 3) mm as metres from *centre*: single precision, rounded to 0.1 mm."""
    return np.round((points - centre) / 1e3, 4).astype(np.float32)


def xyz(points: Any) -> dict[str, Any]:
    """*points* (n, 3), or one (3,), as plotly's x, y and z."""
    return dict(zip("xyz", points.T, strict=True))


def camera(
    points: Points, eye: tuple[float, float, float] = _VIEW, top: Floats = _TOP
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
    return {"eye": xyz(frame @ place), "center": xyz(frame[:, :2] @ centre)}
