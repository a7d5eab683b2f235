"""The shell in 3D, to turn and to hover over: a plotly figure of the built strips.

Strips are drawn as their middle surfaces: the flat outline is cut into columns, and each column
laid into place by the strip's own map. A column has one lower and one upper bound: slots are drawn
as rectangles, as deep as their rounded floors are on average, holes are left out, and a bevelled
end is half-way between its two faces.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
import plotly.graph_objects as go

from fabrication.colours import FAMILY_COLOURS, css
from fabrication.export.view_meshes import columns
from fabrication.export.words import fixed, plural
from fabrication.jointed import Jointed
from fabrication.lamella import Lamella
from fabrication.outlines import Frame
from fabrication.parts import FlatPart
from fabrication.strength import BayStress
from fabrication.structures import Structure
from gridshell.arrays import Floats, Indices, Points

_SAMPLES_PER_BAY = range(2, 7)
_COLUMNS = 10_000
"""Samples per bay: fewest to most, and about how many columns all strips may have between slots."""

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
    bays : (m,) number of the bay each triangle lies in, or nearest to.
    hover : what the strip says of itself.
    """

    points: Points
    triangles: Indices
    loop: Indices
    bays: Indices
    hover: str


def _strip_mesh(lamella: Lamella, part: FlatPart, stress: BayStress, index: int) -> _StripMesh:
    """Columns between all slot walls and a few samples per bay, laid into place at once."""
    per_bay = int(np.clip(_COLUMNS // len(stress), _SAMPLES_PER_BAY[0], _SAMPLES_PER_BAY[-1]))
    x, lower, upper = columns(part, per_bay)
    corner_x = np.stack([x[:-1], x[1:], x[1:], x[:-1]], axis=1)
    corner_y = np.stack([lower, lower, upper, upper], axis=1)
    corners = np.stack([corner_x.ravel(), corner_y.ravel()], axis=1)
    flat, number = np.unique(corners, axis=0, return_inverse=True)
    height = flat[:, 1] - part.width / 2.0
    quads = number.reshape(-1, 4)
    loop = np.r_[quads[:, :2].ravel(), quads[::-1, 2:].ravel(), quads[0, 0]]
    bays = stress.of_strip(index)
    middle = lamella.start + (x[:-1] + x[1:]) / 2.0
    column_bay = bays[np.searchsorted(stress.end[bays][:-1], middle)]
    return _StripMesh(
        points=lamella.place(flat[:, 0] + lamella.start, np.zeros(len(flat)), height),
        triangles=np.stack([quads[:, [0, 1, 2]], quads[:, [0, 2, 3]]], axis=1).reshape(-1, 3),
        loop=loop[np.r_[True, np.diff(loop) != 0]],
        bays=np.repeat(column_bay, 2),
        hover=_hover(lamella, part, stress, bays),
    )


def _hover(lamella: Lamella, part: FlatPart, stress: BayStress, bays: Indices) -> str:
    worst = int(bays[np.argmax(stress.utilisation[bays])])
    cuts = [plural(len(part.slots), "slot")]
    if part.holes or part.drills:
        cuts.append(plural(len(part.holes) + len(part.drills), "hole"))
    return (
        f"<b>{lamella.mark}</b>, family {'AB'[lamella.family - 1]}<br>"
        f"length {fixed(part.length, 1)} mm<br>{', '.join(cuts)}<br>"
        f"{fixed(100.0 * stress.utilisation[worst], 0)} % used at {stress.bays[worst]}"
    )


def shell_figure(
    jointed: Jointed,
    parts: Sequence[FlatPart],
    stress: BayStress,
    copies: Sequence[Frame] = (),
) -> Any:
    """The shell as few traces: per family a mesh and its outlines; marks, nodes and axes.

    Strips are those that are built, marks and nodes those of the design.

    Parameters
    ----------
    parts : one per strip.
    stress : of all bays of the strips; a mesh's *meta* says which triangles lie in which bay.
    copies : where else the shell stands; the axes of its strips are drawn there.
    """
    design, strips = jointed.design, jointed.strips
    positions = np.array([node.position for node in design.nodes])
    centre = (positions.min(axis=0) + positions.max(axis=0)) / 2.0
    traces = []
    for family in FAMILY_COLOURS:
        meshes = [
            _strip_mesh(lamella, part, stress, index)
            for index, (lamella, part) in enumerate(zip(strips.lamellas, parts, strict=True))
            if lamella.family == family
        ]
        traces += _family(family, meshes, centre) if meshes else []
    traces.append(_marks(design, centre))
    if copies:
        traces.append(_copies(strips, copies, centre))
    placed = [np.stack([t.x, t.y, t.z], axis=1) for t in traces if t.x is not None]
    points = np.concatenate(placed).astype(np.float64)
    points = points[np.isfinite(points).all(axis=1)]
    traces += [_nodes(design, centre), axes_figure(points)]
    return go.Figure(traces, {"template": "none", "scene": {"camera": camera(points)}})


def _family(family: int, meshes: Sequence[_StripMesh], centre: Floats) -> list[Any]:
    """All strips of a family as one mesh and one line.

    What a strip says is kept once, with its number of points; the page says it at every point.
    Edges are numbers of the mesh's points, a strip's last one followed by that of a gap; the page
    looks them up.
    """
    points = on_screen(np.concatenate([mesh.points for mesh in meshes]), centre)
    first = np.cumsum([0] + [len(mesh.points) for mesh in meshes[:-1]])
    triangles = np.concatenate([m.triangles + at for m, at in zip(meshes, first, strict=True)])
    gap = len(points)
    loops = np.concatenate([np.r_[m.loop + at, gap] for m, at in zip(meshes, first, strict=True)])
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
        meta={
            "texts": [m.hover for m in meshes],
            "counts": [len(m.points) for m in meshes],
            **_runs(np.concatenate([m.bays for m in meshes])),
        },
    )
    edges = go.Scatter3d(
        mode="lines",
        name=f"{name}, edges",
        legendgroup=group,
        showlegend=False,
        line={"color": css(FAMILY_COLOURS[family], 0.7), "width": 1.0},
        hoverinfo="skip",
        meta={"edges_of": name, "loops": loops.astype(np.min_scalar_type(gap))},
    )
    return [faces, edges]


def _runs(bays: Indices) -> dict[str, list[int]]:
    """Bays of triangles (m,) as runs of equal ones: which, and how many triangles long."""
    starts = np.flatnonzero(np.r_[True, np.diff(bays) != 0])
    lengths = np.diff(np.r_[starts, len(bays)])
    return {"bays": bays[starts].tolist(), "triangles": lengths.tolist()}


def _copies(strips: Structure, copies: Sequence[Frame], centre: Floats) -> Any:
    """The axes of all strips in the other segments, as one line with gaps."""
    gap = np.full((1, 3), np.nan)
    lines = []
    for strip in strips.lamellas:
        s = np.linspace(strip.start, strip.end, 2 * len(strip.stations) + 1)
        points = strip.place(s, np.zeros_like(s), np.zeros_like(s))
        for frame in copies:
            lines += [frame.place(points), gap]
    return go.Scatter3d(
        **xyz(on_screen(np.concatenate(lines), centre)),
        mode="lines",
        name="Other segments",
        line={"color": _QUIET, "width": 1.5},
        hoverinfo="skip",
    )


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
