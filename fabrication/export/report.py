"""The report: one HTML page that opens from disk and asks no network for anything.

The page is a picture of what is in ``report.json``, ``parts.csv`` and the structure: the shell to
turn and to hover over, the key figures with their definitions, the findings, the cut list and a
drawing of the longest strip. Words and definitions live in ``report.html``; geometry and the
writing of numbers live here. plotly.js is inlined, and the page's own policy forbids all requests.

Strips are drawn as their middle surfaces: the flat outline, cut into columns, each column laid in
place by the strip's own map. Slots are the only notches, so a column has one lower and one upper
bound.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np
import plotly.graph_objects as go
from jinja2 import ChainableUndefined, Environment, FileSystemLoader
from markupsafe import Markup
from plotly.offline import get_plotlyjs

from fabrication.cut import Edge, outline
from fabrication.errors import OutputError
from fabrication.finding import Severity
from fabrication.lamella import Lamella
from fabrication.parts import FlatPart
from fabrication.structures import Structure
from gridshell.arrays import Floats, Indices, Points

FAMILY_COLOURS = {1: (0.80, 0.52, 0.25), 2: (0.36, 0.47, 0.58)}
"""sRGB colours of families 1 and 2."""

_SAMPLES_PER_BAY = 6
_M = 1e-3
"""mm to m."""

_INK, _QUIET = "#1c232d", "#5a6472"
_FONT = "system-ui, -apple-system, 'Segoe UI', Roboto, 'Helvetica Neue', Arial, sans-serif"
_LIGHT = {"ambient": 0.8, "diffuse": 0.35, "specular": 0.05, "roughness": 0.8, "fresnel": 0.05}
_FIELD_OF_VIEW, _ASPECT = np.pi / 4.0, 1.5
"""plotly's own, and the frame's width over its height."""

_STRIP_LENGTH, _STRIP_HEIGHT = 1040.0, 62.0
_THINNEST_SLOT, _PITCH = 3.0, 13.0
"""Of the drawing, px: the strip, its narrowest slot, and the room a station's figure needs."""


def write_report(
    path: Path | str,
    *,
    name: str,
    report: Mapping[str, Any],
    structure: Structure,
    parts: Sequence[FlatPart],
) -> None:
    """Write the page.

    Parameters
    ----------
    path : the HTML file; its folder exists.
    name : the project's name, as the title.
    report : what ``report.json`` holds; a figure that is missing or None is shown as not measured.
    structure, parts : one part per lamella, in the structure's order.

    Raises
    ------
    OutputError
        When the file cannot be written.
    """
    page = (
        _environment()
        .get_template("report.html")
        .render(
            name=name,
            report=report,
            verdict=_verdict(report.get("findings")),
            findings=_by_severity(report.get("findings") or ()),
            structure=structure,
            parts=parts,
            families=[sum(lamella.family == f for lamella in structure.lamellas) for f in (1, 2)],
            size=np.ptp([node.position for node in structure.nodes], axis=0) * _M,
            colours={family: _css(colour) for family, colour in FAMILY_COLOURS.items()},
            drawing=_drawing(max(parts, key=lambda part: part.length)),
            figure=_for_script(_figure(structure, parts).to_json()),
            plotly=Markup(get_plotlyjs()),
        )
    )
    try:
        Path(path).write_text(page, encoding="utf-8")
    except OSError as error:
        raise OutputError(
            "The report cannot be written", where=str(path), value=error.strerror or ""
        ) from None


def _environment() -> Environment:
    environment = Environment(
        loader=FileSystemLoader(Path(__file__).parent),
        autoescape=True,
        undefined=ChainableUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
    )
    environment.filters.update(figure=_number, fixed=_fixed)
    return environment


# ---- words and numbers ----------------------------------------------------------------------


@dataclass(frozen=True)
class _Verdict:
    """The line under the title; *level* is good, warning, error or unknown."""

    level: str
    text: str


def _verdict(findings: Sequence[Mapping[str, Any]] | None) -> _Verdict:
    """Good, or how many findings of which severity."""
    if findings is None:
        return _Verdict("unknown", "Not checked")
    if not findings:
        return _Verdict("good", "Good: no findings")
    grades = [str(finding.get("severity")) for finding in findings]
    counts = [(grade.value, grades.count(grade.value)) for grade in _GRAVEST_FIRST]
    told = ", ".join(_plural(count, grade) for grade, count in counts if count)
    worst = next((grade for grade, count in counts if count), "unknown")
    level = "good" if worst == Severity.INFO.value else worst
    total = _plural(len(findings), "finding")
    return _Verdict(level, ("Good, with " if level == "good" else "") + f"{total}: {told}")


_GRAVEST_FIRST = (Severity.ERROR, Severity.WARNING, Severity.INFO)


def _plural(count: int, word: str) -> str:
    return f"{count} {word}" if count == 1 or word == "info" else f"{count} {word}s"


def _by_severity(findings: Sequence[Mapping[str, Any]]) -> list[Mapping[str, Any]]:
    order = {grade.value: i for i, grade in enumerate(_GRAVEST_FIRST)}
    return sorted(findings, key=lambda finding: order.get(str(finding.get("severity")), 0))


def _number(value: Any, digits: int = 4) -> str:
    """*value* with so many significant digits; a power of ten where it is very small or large."""
    if not isinstance(value, (int, float, np.number)) or not np.isfinite(value):
        return "–"
    size = abs(float(value))
    if size == 0.0 or (isinstance(value, (int, np.integer)) and size < 1e12):
        return f"{int(value):,}".replace(",", "\u202f")
    if not 1e-3 <= size < 1e7:
        mantissa, exponent = f"{value:.2e}".split("e")
        power = str(int(exponent)).translate(str.maketrans("-0123456789", "⁻⁰¹²³⁴⁵⁶⁷⁸⁹"))
        return f"{mantissa.replace('-', '−')} × 10{power}"
    return _fixed(value, max(0, digits - 1 - int(np.floor(np.log10(size)))))


def _fixed(value: Any, decimals: int) -> str:
    """*value* with so many decimals, thousands apart."""
    if not isinstance(value, (int, float, np.number)) or not np.isfinite(value):
        return "–"
    return f"{value:,.{decimals}f}".replace(",", "\u202f").replace("-", "−")


def _css(colour: tuple[float, float, float], shade: float = 1.0) -> str:
    """An sRGB colour in 0 to 1, darker by *shade*, as CSS."""
    return "rgb({}, {}, {})".format(*(round(255 * shade * c) for c in colour))


def _for_script(json: str) -> Markup:
    """JSON that no text inside can end the script with."""
    return Markup(json.replace("<", "\\u003c"))


# ---- the shell ------------------------------------------------------------------------------


@dataclass(frozen=True, eq=False)
class _StripMesh:
    """The middle surface of one built strip.

    Parameters
    ----------
    points : (n, 3) mm.
    triangles : (m, 3) point numbers.
    loop : (k,) point numbers around the outline, first repeated at the end.
    """

    points: Points
    triangles: Indices
    loop: Indices


def _strip_mesh(lamella: Lamella, part: FlatPart) -> _StripMesh:
    """Columns between all outline corners and a few samples per bay, laid in place at once."""
    x, lower, upper = _columns(part)
    corner_x = np.stack([x[:-1], x[1:], x[1:], x[:-1]], axis=1)
    corner_y = np.stack([lower, lower, upper, upper], axis=1)
    corners = np.stack([corner_x.ravel(), corner_y.ravel()], axis=1)
    flat, number = np.unique(corners, axis=0, return_inverse=True)
    quads = number.reshape(-1, 4)
    height = flat[:, 1] - part.width / 2.0
    loop = np.r_[quads[:, :2].ravel(), quads[::-1, 2:].ravel(), quads[0, 0]]
    return _StripMesh(
        points=lamella.place(flat[:, 0] + lamella.start, np.zeros(len(flat)), height),
        triangles=np.concatenate([quads[:, [0, 1, 2]], quads[:, [0, 2, 3]]]),
        loop=loop[np.r_[True, np.diff(loop) != 0]],
    )


def _columns(part: FlatPart) -> tuple[Floats, Floats, Floats]:
    """(c + 1,) ends of the columns along the strip, (c,) lower and (c,) upper bound of each, mm."""
    bays = np.unique(np.clip(np.r_[0.0, part.development.node_x, part.length], 0.0, part.length))
    steps = np.arange(_SAMPLES_PER_BAY * (len(bays) - 1) + 1) / _SAMPLES_PER_BAY
    samples = np.interp(steps, np.arange(len(bays)), bays)
    x = np.unique(np.clip(np.r_[part.outline[:, 0], samples], 0.0, part.length))
    x = x[np.r_[True, np.diff(x) > 1e-6]]
    middle = (x[:-1] + x[1:]) / 2.0
    lower, upper = np.zeros(len(middle)), np.full(len(middle), part.width)
    for edge, bound in ((Edge.LOWER, lower), (Edge.UPPER, upper)):
        slots = [slot for slot in part.slots if slot.edge is edge]
        centre, width, depth = np.array([(s.x, s.width, s.depth) for s in slots]).reshape(-1, 3).T
        inside = np.abs(middle[:, None] - centre) < width / 2.0
        deepest = np.where(inside, depth, 0.0).max(axis=1, initial=0.0)
        bound += deepest if edge is Edge.LOWER else -deepest
    return x, lower, np.maximum(lower, upper)


def _figure(structure: Structure, parts: Sequence[FlatPart]) -> Any:
    """The shell as few traces: per family a mesh and its outlines; marks, nodes and axes."""
    positions = np.array([node.position for node in structure.nodes])
    centre = (positions.min(axis=0) + positions.max(axis=0)) / 2.0
    traces = []
    for family in FAMILY_COLOURS:
        members = [
            (_strip_mesh(lamella, part), _hover(lamella, part))
            for lamella, part in zip(structure.lamellas, parts, strict=True)
            if lamella.family == family
        ]
        if members:
            traces += _family(family, members, centre)
    marks = _marks(structure, centre)
    seen = [np.stack([t.x, t.y, t.z], axis=1) for t in (*traces[::2], marks)]
    points = np.concatenate(seen).astype(np.float64)
    traces += [marks, _nodes(structure, centre), _axes(points)]
    return go.Figure(traces, _layout(points))


def _hover(lamella: Lamella, part: FlatPart) -> str:
    family = "AB"[lamella.family - 1]
    return (
        f"<b>{lamella.mark}</b>, family {family}<br>length {_fixed(part.length, 1)} mm"
        f"<br>{_plural(len(part.slots), 'slot')}"
    )


def _family(family: int, members: Sequence[tuple[_StripMesh, str]], centre: Floats) -> list[Any]:
    """All strips of a family as one mesh and one line.

    The hover text of each strip is kept once, with its number of points; the page repeats it.
    """
    meshes = [mesh for mesh, _ in members]
    points = _on_screen(np.concatenate([mesh.points for mesh in meshes]), centre)
    first = np.cumsum([0] + [len(mesh.points) for mesh in meshes[:-1]])
    triangles = np.concatenate([m.triangles + at for m, at in zip(meshes, first, strict=True)])
    gap = np.full((1, 3), np.nan, dtype=np.float32)
    loops = [points[m.loop + at] for m, at in zip(meshes, first, strict=True)]
    lines = np.concatenate([block for loop in loops for block in (loop, gap)])
    name, group = f"Family {'AB'[family - 1]}", f"family{family}"
    faces = go.Mesh3d(
        **_xyz(points),
        **dict(zip("ijk", triangles.T.astype(np.min_scalar_type(len(points))), strict=True)),
        name=name,
        legendgroup=group,
        showlegend=True,
        color=_css(FAMILY_COLOURS[family]),
        lighting=_LIGHT,
        hoverinfo="text",
        meta={"texts": [text for _, text in members], "counts": [len(m.points) for m in meshes]},
    )
    edges = go.Scatter3d(
        **_xyz(lines),
        mode="lines",
        name=f"{name}, edges",
        legendgroup=group,
        showlegend=False,
        line={"color": _css(FAMILY_COLOURS[family], 0.7), "width": 1.0},
        hoverinfo="skip",
    )
    return [faces, edges]


def _marks(structure: Structure, centre: Floats) -> Any:
    """The mark of every lamella, a little beyond its first end."""
    beyond, nought = structure.profile.width, np.zeros(1)
    places = [
        lamella.place(np.array([lamella.start - beyond]), nought, nought)[0]
        for lamella in structure.lamellas
    ]
    colours = [_css(FAMILY_COLOURS[lamella.family], 0.6) for lamella in structure.lamellas]
    return go.Scatter3d(
        **_xyz(_on_screen(np.array(places), centre)),
        mode="text",
        name="Marks",
        text=[lamella.mark for lamella in structure.lamellas],
        textfont={"size": 11, "color": colours},
        hoverinfo="skip",
    )


def _nodes(structure: Structure, centre: Floats) -> Any:
    """A point per node, with its angle and its lamellas to hover over."""
    texts = []
    for node in structure.nodes:
        marks = " × ".join(structure.lamellas[c.lamella].mark for c in node.crossings)
        angle = "" if node.angle is None else f"{np.degrees(node.angle):.2f}°<br>"
        texts.append(f"<b>{node.name}</b><br>{angle}{marks}")
    positions = np.array([node.position for node in structure.nodes])
    return go.Scatter3d(
        **_xyz(_on_screen(positions, centre)),
        mode="markers",
        name="Nodes",
        text=texts,
        marker={"size": 1.8, "color": _INK},
        hoverinfo="text",
    )


def _axes(points: Points) -> Any:
    """The directions x, y and z at the lowest corner of *points*, a round length long."""
    length = 10.0 ** np.floor(np.log10(np.ptp(points, axis=0).max() / 5.0))
    ends = points.min(axis=0) + length * np.eye(4, 3, k=-1)[[1, 0, 2, 0, 3]]
    return go.Scatter3d(
        **_xyz(ends),
        mode="lines+text",
        name=f"Axes, {length:g} m long",
        text=["x", "", "y", "", "z"],
        textfont={"size": 12, "color": _QUIET},
        line={"color": _QUIET, "width": 3},
        hoverinfo="skip",
    )


def _on_screen(points: Points, centre: Floats) -> Any:
    """*points* (n, 3) mm from *centre*, in m: single precision, rounded to 0.1 mm."""
    return np.round((points - centre) * _M, 4).astype(np.float32)


def _xyz(points: Any) -> dict[str, Any]:
    return dict(zip("xyz", points.T, strict=True))


def _layout(points: Points) -> dict[str, Any]:
    """No axes, and a camera that sees all *points* (n, 3) from above at a slant."""
    hidden = {"visible": False, "showspikes": False}
    return {
        "template": "none",
        "autosize": True,
        "margin": dict.fromkeys("ltrb", 0),
        "font": {"family": _FONT, "size": 13, "color": _INK},
        "hoverlabel": {"bgcolor": "#ffffff", "bordercolor": _QUIET, "font": {"color": _INK}},
        "legend": {"x": 0.01, "y": 0.99, "itemsizing": "constant"},
        "scene": {f"{c}axis": hidden for c in "xyz"}
        | {"aspectmode": "data", "camera": {"eye": _eye(points)}},
    }


def _eye(points: Points) -> dict[str, float]:
    """Where the camera stands, in plotly's unit: the cube root of the bounding box's volume."""
    low, high = points.min(axis=0), points.max(axis=0)
    seen = (points - (low + high) / 2.0) / np.cbrt(np.prod(np.maximum(high - low, 1e-3)))
    back = np.array([0.62, -0.64, 0.46])
    back /= np.linalg.norm(back)
    right = np.array([-back[1], back[0], 0.0]) / np.hypot(back[0], back[1])
    half = np.tan(_FIELD_OF_VIEW / 2.0)
    needed = np.maximum(np.abs(seen @ np.cross(back, right)), np.abs(seen @ right) / _ASPECT) / half
    return _xyz(1.04 * float((needed + seen @ back).max()) * back)


# ---- the longest strip ----------------------------------------------------------------------


@dataclass(frozen=True)
class _Station:
    """A dimension of the drawing: drawn at *x*, its figure at *at* (px); *text* in mm."""

    x: float
    at: float
    text: str
    partner: str
    partner_y: float


@dataclass(frozen=True, eq=False)
class _Drawing:
    """A flat strip to look at: lengths true, width and slots not.

    Parameters
    ----------
    part : which strip.
    corners : its outline as SVG points, from its upper left corner, px.
    length, height : of the strip, px.
    stations : both ends and every slot.
    """

    part: FlatPart
    corners: str
    length: float
    height: float
    stations: tuple[_Station, ...]


def _drawing(part: FlatPart) -> _Drawing:
    along, across = _STRIP_LENGTH / part.length, _STRIP_HEIGHT / part.width
    drawn = [
        replace(
            s, x=s.x * along, width=max(s.width * along, _THINNEST_SLOT), depth=s.depth * across
        )
        for s in part.slots
    ]
    corners = outline(_STRIP_LENGTH, _STRIP_HEIGHT, drawn) * [1.0, -1.0] + [0.0, _STRIP_HEIGHT]
    stations = np.array([0.0, *(slot.x for slot in part.slots), part.length])
    partners = ["", *(slot.partner for slot in part.slots), ""]
    behind = [0.8 if s.edge is Edge.UPPER else 0.2 for s in part.slots]
    return _Drawing(
        part,
        " ".join(f"{x:.1f},{y:.1f}" for x, y in corners),
        _STRIP_LENGTH,
        _STRIP_HEIGHT,
        tuple(
            _Station(x * along, at, _fixed(x, 1), partner, share * _STRIP_HEIGHT)
            for x, at, partner, share in zip(
                stations.tolist(),
                _apart(stations * along).tolist(),
                partners,
                [0.5, *behind, 0.5],
                strict=True,
            )
        ),
    )


def _apart(x: Floats) -> Floats:
    """*x* (n,) in order, moved so far that neighbours are a pitch apart within the strip's ends."""
    steps = min(_PITCH, _STRIP_LENGTH / max(len(x) - 1, 1)) * np.arange(len(x))
    moved = np.maximum.accumulate(x - steps) + steps
    return np.minimum(moved, _STRIP_LENGTH - steps[::-1])
