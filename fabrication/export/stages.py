"""The way from a surface to a net in pictures, after Fig. 6 of the paper.

a the surface and the sign of its curvature, b the pair of directions, c the quad mesh M with its
vertices in two colours, d the control mesh C, e how well M follows the directions, f the optimised
net as a checkerboard. Each is a handful of layers, drawn once as an SVG and once in 3D.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

import gridshell as gs
from fabrication.colours import FAMILY_COLOURS
from fabrication.words import plural
from gridshell.arrays import Floats, Indices
from gridshell.painter import (
    Dots,
    Faces,
    Layer,
    Lines,
    View,
    bounds,
    hexadecimal,
    painted,
    polygons,
    svg,
)
from gridshell.surface import TriangleMesh

_TRIANGLES = 3_000
"""Of a surface in a picture, about."""

_SEGMENTS = 700
"""Places where the pair of directions is drawn, about."""

_MOST_FACES = 5_000
"""Quads above which a mesh is drawn by its edges alone, over the surface."""

HOTTEST = 5.0
"""Degrees off the directions that are drawn in the last colour of the heat map."""

_PALE, _GREY, _INK = (0.95, 0.95, 0.93), (0.60, 0.62, 0.65), (0.11, 0.14, 0.18)
_FAINT = (0.78, 0.80, 0.83)
_SADDLE, _DOME = (0.35, 0.55, 0.78), (0.90, 0.60, 0.30)
_RED, _BLUE = (0.80, 0.16, 0.14), (0.13, 0.34, 0.74)
_VIOLET, _BLACK = (0.72, 0.58, 0.85), (0.25, 0.29, 0.34)
_HEAT = np.array([(0.12, 0.30, 0.55), (0.25, 0.62, 0.55), (0.95, 0.80, 0.30), (0.80, 0.12, 0.10)])


@dataclass(frozen=True, eq=False)
class Stage:
    """One picture.

    Parameters
    ----------
    letter, title : as in Fig. 6.
    caption : one sentence with the figures.
    layers : what is drawn.
    legend : colour (sRGB) and meaning.
    """

    letter: str
    title: str
    caption: str
    layers: tuple[Layer, ...]
    legend: tuple[tuple[str, str], ...]

    @property
    def file_name(self) -> str:
        """As ``a-surface.svg``."""
        return f"{self.letter}-{self.title.lower().replace(' ', '-')}.svg"


@dataclass(frozen=True, eq=False)
class _Skin:
    """The surface, with few triangles, each knowing the fine one it stands for."""

    corners: Floats
    source: Indices


def stages(made: gs.Quadrangulation, net: gs.ControlMesh | None = None) -> tuple[Stage, ...]:
    """The pictures a to e, and f where there is an optimised *net*; d only where M holds a C."""
    skin = _skin(made.curved.mesh)
    found = [_surface(made, skin), _directions(made, skin), _quads(made, skin)]
    if made.report.control_quads:
        found.append(_control(made, skin))
    found.append(_alignment(made, skin))
    if net is not None:
        found.append(_net(net))
    return tuple(found)


def view_of(made: gs.Quadrangulation) -> View:
    """One view for all pictures."""
    mesh = made.curved.mesh
    return View.onto(mesh.areas @ mesh.face_normals / mesh.areas.sum())


def pictures(
    made: gs.Quadrangulation, net: gs.ControlMesh | None = None
) -> tuple[dict[str, Any], ...]:
    """The stages as a page wants them: letter, title, caption, legend, svg, file."""
    return drawn(stages(made, net), view_of(made))


def drawn(found: Sequence[Stage], view: View) -> tuple[dict[str, Any], ...]:
    """The same for given stages; all pictures have one frame."""
    frame = bounds([layer for stage in found for layer in stage.layers], view)
    return tuple(
        {
            "letter": stage.letter,
            "title": stage.title,
            "caption": stage.caption,
            "legend": stage.legend,
            "svg": svg(stage.layers, view, frame, label=f"{stage.letter}: {stage.title}"),
            "file": stage.file_name,
        }
        for stage in found
    )


# ---- the stages --------------------------------------------------------------------------------


def _surface(made: gs.Quadrangulation, skin: _Skin) -> Stage:
    a, b, c = made.curved.face_shapes.T
    curvature = a * c - b * b
    areas = made.curved.mesh.areas
    saddle = float(areas[curvature < 0.0].sum() / areas.sum())
    strong = np.percentile(np.abs(curvature), 90) + 1e-300
    share = np.sqrt(np.minimum(np.abs(curvature) / strong, 1.0))[:, None]
    target = np.where(curvature[:, None] < 0.0, _SADDLE, _DOME)
    colours = (1.0 - share) * _PALE + share * target
    return Stage(
        "a",
        "Surface",
        f"{saddle:.0%} of the area is saddle-shaped, {1.0 - saddle:.0%} is not; "
        f"{len(areas)} triangles.",
        (Faces(skin.corners, colours[skin.source]),),
        ((_css(_SADDLE), "K < 0"), (_css(_PALE), "flat"), (_css(_DOME), "K > 0")),
    )


def _directions(made: gs.Quadrangulation, skin: _Skin) -> Stage:
    mesh, field = made.field.mesh, made.field
    step = float(np.sqrt(mesh.areas.sum() / _SEGMENTS))
    some = _apart(mesh.centroids, step)
    centres = mesh.centroids[some]
    layers: list[Layer] = [_pale(skin)]
    for family, along in ((1, field.first_directions), (2, field.second_directions)):
        reach = 0.42 * step * along[some]
        ends = np.stack([centres - reach, centres + reach], axis=1)
        layers.append(Lines(ends, painted(FAMILY_COLOURS[family], len(some)), 1.6))
    low, middle, high = made.report.angle_deg
    return Stage(
        "b",
        "Directions",
        f"The angle between the pair is {low:.1f}° to {high:.1f}°, {middle:.1f}° in the middle.",
        tuple(layers),
        ((_css(FAMILY_COLOURS[1]), "family 1"), (_css(FAMILY_COLOURS[2]), "family 2")),
    )


def _quads(made: gs.Quadrangulation, skin: _Skin) -> Stage:
    mesh = made.mesh
    layers: list[Layer] = [_filled(mesh, skin), _edges(mesh, _GREY, 0.9)]
    legend: tuple[tuple[str, str], ...] = ()
    if not made.report.colour_conflicts and len(mesh.quads) <= _MOST_FACES:
        colour = gs.two_colouring(mesh)
        for number, paint in ((0, _RED), (1, _BLUE)):
            places = mesh.vertices[colour == number]
            layers.append(Dots(places, painted(paint, len(places)), 2.3))
        legend = ((_css(_RED), "red vertices"), (_css(_BLUE), "blue vertices"))
    return Stage(
        "c",
        "Quad mesh M",
        f"{len(mesh.quads)} quads over {made.report.coverage:.1%} of the surface.",
        tuple(layers),
        legend,
    )


def _control(made: gs.Quadrangulation, skin: _Skin) -> Stage:
    control = made.control().mesh
    fine = len(made.mesh.quads) > _MOST_FACES
    layers: list[Layer] = [_filled(control, skin), _edges(control, width=0.5 if fine else 1.3)]
    if not fine:
        layers.insert(1, _edges(made.mesh, _FAINT, 0.7))
    return Stage(
        "d",
        "Control mesh C",
        f"{len(control.quads)} quads; the edges of M are its diagonals.",
        tuple(layers),
        ((_css(_INK), "edges of C"), *(() if fine else ((_css(_FAINT), "edges of M"),))),
    )


def _alignment(made: gs.Quadrangulation, skin: _Skin) -> Stage:
    report, mesh = made.report, made.mesh
    missing = made.field.infeasible[skin.source][:, None]
    layers: list[Layer] = [Faces(skin.corners, np.where(missing, _VIOLET, _PALE))]
    ends = mesh.vertices[mesh.edges]
    colours = heat(_edge_errors(made, ends.mean(axis=1)))
    layers.append(Lines(ends, colours, 2.0))
    spikes = np.array([spike.position for spike in report.singularities]).reshape(-1, 3)
    layers.append(Dots(spikes, painted(_INK, len(spikes)), 5.0))
    stray = report.alignment_deg
    infeasible = f"; {report.infeasible_area:.1%} of the area has no such pair"
    return Stage(
        "e",
        "Alignment",
        f"Edges are off the directions by {stray.mean:.2f}° on average, {stray.p95:.2f}° for 95 of "
        f"100, {stray.max:.1f}° at most; {plural(len(spikes), 'singular point')}"
        f"{infeasible if report.infeasible_area else ''}.",
        tuple(layers),
        (
            *_heat_legend(),
            (_css(_GREY), "beyond the rim"),
            *(((_css(_INK), "singular point"),) if len(spikes) else ()),
            *(((_css(_VIOLET), "no such pair"),) if report.infeasible_area else ()),
        ),
    )


def _net(net: gs.ControlMesh) -> Stage:
    pattern = gs.checkerboard(net)
    black = pattern.vertices[pattern.black]
    white = polygons(pattern.vertices, pattern.white)
    return Stage(
        "f",
        "Optimised net",
        f"{len(black)} black parallelograms, {len(white)} white faces.",
        (
            Faces(white, painted((1.0, 1.0, 1.0), len(white))),
            Faces(black, painted(_BLACK, len(black))),
            _edges(net.mesh, (0.55, 0.57, 0.60), 0.5),
        ),
        ((_css(_BLACK), "one in each quad of C"), (_css((1.0, 1.0, 1.0)), "halves of D1 and D2")),
    )


# ---- parts of pictures -------------------------------------------------------------------------


def heat(degrees: Floats) -> Floats:
    """(m, 3) colours of alignment errors (m,); grey where there is none to tell (NaN)."""
    known = np.isfinite(degrees)
    share = np.clip(np.where(known, degrees, 0.0) / HOTTEST, 0.0, 1.0) * (len(_HEAT) - 1)
    at = np.minimum(share.astype(np.int64), len(_HEAT) - 2)
    mixed = _HEAT[at] + (share - at)[:, None] * (_HEAT[at + 1] - _HEAT[at])
    return np.where(known[:, None], mixed, _GREY)


def _apart(points: Floats, step: float) -> Indices:
    """Some of *points* (n, 3), in order, no two closer than *step*, mm, none further from one."""
    from scipy.spatial import cKDTree

    tree, free = cKDTree(points), np.ones(len(points), dtype=bool)
    chosen = []
    for i in range(len(points)):
        if free[i]:
            chosen.append(i)
            free[tree.query_ball_point(points[i], step)] = False
    return np.array(chosen, dtype=np.int64)


def _heat_legend() -> list[tuple[str, str]]:
    degrees = [f"{d:.2g}°" for d in np.linspace(0.0, HOTTEST, len(_HEAT))]
    degrees[-1] += " and more"
    return [(_css(colour), text) for colour, text in zip(_HEAT, degrees, strict=True)]


def _edge_errors(made: gs.Quadrangulation, middles: Floats) -> Floats:
    """Degrees (m,) at the middles (m, 3) of M's edges; NaN for edges beyond the surface."""
    from scipy.spatial import cKDTree

    if len(made.edge_points) == 0:
        return np.full(len(middles), np.nan)
    away, near = cKDTree(made.edge_points).query(middles)
    errors = np.degrees(made.edge_errors[near])
    return np.where(away < 0.25 * made.mesh.mean_edge, errors, np.nan)


def _skin(mesh: TriangleMesh) -> _Skin:
    """Few triangles that look like *mesh*, and the nearest of its triangles for each."""
    import fast_simplification
    from scipy.spatial import cKDTree

    points, faces = mesh.vertices, mesh.triangles
    if len(faces) > 1.2 * _TRIANGLES:
        share = 1.0 - _TRIANGLES / len(faces)
        points, faces = fast_simplification.simplify(
            np.array(points), np.array(faces, dtype=np.int32), share
        )
    corners = np.asarray(points, dtype=np.float64)[faces]
    return _Skin(corners, cKDTree(mesh.centroids).query(corners.mean(axis=1))[1])


def _pale(skin: _Skin) -> Faces:
    return Faces(skin.corners, painted(_PALE, len(skin.corners)))


def _filled(mesh: gs.QuadMesh, skin: _Skin) -> Faces:
    """The quads of *mesh*, or the surface where they are too many."""
    if len(mesh.quads) > _MOST_FACES:
        return _pale(skin)
    return Faces(mesh.vertices[mesh.quads], painted(_PALE, len(mesh.quads)))


def _edges(
    mesh: gs.QuadMesh, colour: tuple[float, float, float] = _INK, width: float = 1.3
) -> Lines:
    return Lines(mesh.vertices[mesh.edges], painted(colour, len(mesh.edges)), width)


def _css(colour: Any) -> str:
    return hexadecimal(np.asarray(colour, dtype=np.float64))
