"""Fig. 5: the indicatrix at a point, and conjugate directions as conjugate diameters."""

from __future__ import annotations

from math import atan, degrees, radians, sqrt

import numpy as np

import gridshell as gs
from fabrication.export.raster import Scene
from fabrication.gallery.figure import Condition, Figure
from fabrication.gallery.scenery import BLUE, FROM_ABOVE, GREY, INK, RED, dots, edges
from gridshell.arrays import Floats
from gridshell.field import conjugate_field
from gridshell.mesh import grid_quads
from gridshell.painter import Layer, Lines, painted
from gridshell.surface import CurvedMesh, TriangleMesh

CASES = {"K < 0": (-0.5, 1.0), "K = 0": (0.0, 1.0), "K > 0": (0.5, 1.0)}
ANGLE = radians(75.0)


def figure() -> Figure:
    """Three paraboloids; directions from the field, judged by eqs. 1 to 3 and by true sections."""
    scenes, conditions = [], []
    for name, kappa in CASES.items():
        first, second = _directions(kappa)
        scenes.append(Scene(name, _layers(kappa, first, second), FROM_ABOVE))
        away = abs(kappa[0] * first[0] * second[0] + kappa[1] * first[1] * second[1])
        between = np.arccos(np.clip(first @ second, -1.0, 1.0))
        conditions += [
            Condition(f"eq. 2 at {name}", float(away), 1e-9),
            Condition(f"angle at {name}, degrees", abs(degrees(between - ANGLE)), 1e-6),
            Condition(f"section against indicatrix at {name}", _section_error(kappa), 1e-3),
        ]
    low, high = CASES["K > 0"]
    least = 2.0 * atan(sqrt(low / high))
    conditions.append(
        Condition("smallest angle at K > 0, degrees off 2 gamma", _refusal_error(least), 0.01)
    )
    return Figure(
        name="5",
        title="Dupin's indicatrix and conjugate directions",
        paper={"smallest angle at K > 0": "2 gamma, tan gamma = sqrt(k1 / k2)"},
        ours={"angle, degrees": degrees(ANGLE), "2 gamma here, degrees": round(degrees(least), 3)},
        conditions=tuple(conditions),
        scenes=tuple(scenes),
    )


def _curved(kappa: tuple[float, float]) -> CurvedMesh:
    """A patch of the tangent plane that knows the surface's shape operator: the point itself."""
    x, y = np.meshgrid([-1.0, 0.0, 1.0], [-1.0, 0.0, 1.0], indexing="ij")
    points = np.stack([x, y, np.zeros_like(x)], axis=-1).reshape(-1, 3)
    q = grid_quads(2, 2)
    mesh = TriangleMesh(points, np.concatenate([q[:, [0, 1, 2]], q[:, [0, 2, 3]]]))
    shapes = np.tile(np.diag([*kappa, 0.0]), (9, 1, 1))
    return CurvedMesh.of_vertices(mesh, np.tile([0.0, 0.0, 1.0], (9, 1)), shapes)


def _directions(kappa: tuple[float, float], angle: float = ANGLE) -> tuple[Floats, Floats]:
    field = conjugate_field(_curved(kappa), angle, where_infeasible=gs.Infeasible.REFUSE)
    return field.first_directions[0, :2], field.second_directions[0, :2]


def _refusal_error(least: float) -> float:
    """How far the smallest angle the field accepts is from the formula's, degrees."""
    low, high = 0.0, radians(89.0)
    while high - low > 1e-7:
        middle = (low + high) / 2.0
        try:
            _directions(CASES["K > 0"], middle)
            high = middle
        except gs.AngleInfeasibleError:
            low = middle
    return abs(degrees(high - least))


def _indicatrix(kappa: tuple[float, float], turn: Floats) -> Floats:
    """(k, 2) r (cos, sin) with r = 1 / sqrt(|normal curvature|) by Euler's formula (eq. 1)."""
    curvature = kappa[0] * np.cos(turn) ** 2 + kappa[1] * np.sin(turn) ** 2
    r = 1.0 / np.sqrt(np.maximum(np.abs(curvature), 1e-12))
    return np.stack([r * np.cos(turn), r * np.sin(turn)], axis=1)


def _section_error(kappa: tuple[float, float]) -> float:
    """Indicatrix against the surface z = (1 - cos) / k type, cut close to its tangent plane.

    The surface is the sum of two circles' arcs, whose second order is the paraboloid's. Along every
    direction the distance to the cut at height h, over sqrt(2 h), tends to the indicatrix.
    """
    h, worst = 1e-5, 0.0

    def height(p: Floats) -> float:
        arcs = [
            (1.0 - np.sqrt(1.0 - (k * c) ** 2)) / k if k else 0.0
            for k, c in zip(kappa, p, strict=True)
        ]
        return float(sum(arcs))

    for turn in np.linspace(0.05, 2.0 * np.pi, 24):
        wanted = _indicatrix(kappa, np.array([turn]))[0]
        r = float(np.hypot(*wanted))
        if r > 10.0:
            continue
        way = wanted / r
        low, high = 0.0, 4.0 * r * sqrt(2.0 * h)
        for _ in range(60):
            middle = (low + high) / 2.0
            low, high = (middle, high) if abs(height(middle * way)) < h else (low, middle)
        worst = max(worst, abs(low / sqrt(2.0 * h) / r - 1.0))
    return worst


def _layers(kappa: tuple[float, float], first: Floats, second: Floats) -> tuple[Layer, ...]:
    turn = np.linspace(0.0, 2.0 * np.pi, 721)
    curve = np.column_stack([_indicatrix(kappa, turn), np.zeros(len(turn))])
    near = np.hypot(*curve[:, :2].T) < 3.0
    pairs = np.stack([np.arange(720), np.arange(1, 721)], axis=1)
    pairs = pairs[near[pairs].all(axis=1)]
    layers: list[Layer] = [edges(curve, pairs, INK, 1.6)]
    for way, colour in ((first, RED), (second, BLUE)):
        r = min(
            float(np.hypot(*_indicatrix(kappa, np.array([np.arctan2(way[1], way[0])]))[0])), 2.5
        )
        ends = np.array([[*(-r * way), 0.0], [*(r * way), 0.0]])
        layers.append(Lines(ends[None], painted(colour, 1), 2.0))
    axes = np.array([[-3.0, 0, 0], [3.0, 0, 0], [0, -2.2, 0], [0, 2.2, 0]])
    layers.append(edges(axes, np.array([[0, 1], [2, 3]]), GREY, 0.5))
    return (*layers, dots(np.zeros((1, 3)), INK, 3.0))
