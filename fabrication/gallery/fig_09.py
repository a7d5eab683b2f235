"""Fig. 9: asymptotic nets of constant angle, and the gridshells on them."""

from __future__ import annotations

from math import radians

import fabrication as fab
import gridshell as gs
from fabrication.export.raster import Scene
from fabrication.gallery.figure import Condition, Figure, equal, largest
from fabrication.gallery.scenery import lamella_faces, pattern
from gridshell.painter import seen_from

PAPER = {60.0: -1.0 / 3.0, 75.0: -0.58879, 90.0: -1.0}
"""kappa1 / kappa2 as printed: -tan^2 of half the angle."""


def net(degrees: float, cells: int = 36) -> gs.OptimizedNet:
    """A patch of Enneper's surface, its control mesh along principal lines, at one angle."""
    half = 0.7 * round(cells * 40 / 36) / cells
    patch = gs.BisectingPatch(v=(-half, half), cells=cells, u=(-0.7, 0.7))
    start = gs.control_patch(gs.Enneper(8000.0), patch)
    return gs.optimize(start, gs.a_net(angle=radians(degrees)), anchor=gs.Free())


def figure() -> Figure:
    """Three angles from one start; left the pattern, right the lamellas on D1."""
    scenes: list[Scene] = []
    conditions: list[Condition] = []
    steps = vertices = faces = 0
    view = seen_from(0.7, -0.7, 1.8)
    for degrees, ratio in PAPER.items():
        result = net(degrees)
        quality, at = result.quality, f"{degrees:.0f} degrees"
        steps = max(steps, len(result.steps))
        vertices, faces = len(result.control.vertices), len(result.control.quads)
        conditions += [
            equal(f"{at}: |F|", faces, 1440),
            Condition(f"{at}: star planarity", largest(quality.star_planarity), 1e-6),
            Condition(f"{at}: angle, degrees", largest(quality.angle_error_deg), 0.01),
            Condition(
                f"{at}: k1 / k2 off the paper's number",
                abs((quality.curvature_ratio or 0.0) - ratio),
                0.01,
            ),
        ]
        built = fab.structure(
            gs.diagonal_meshes(result.control)[0], fab.Profile(120.0, 4.0, fab.STAINLESS)
        )
        scenes += [
            Scene(f"{at}, pattern", pattern(result.control), view),
            Scene(f"{at}, gridshell", lamella_faces(built), view),
        ]
    return Figure(
        name="9",
        title="Asymptotic nets of constant angle",
        paper={"|V|": 1499, "|F|": 1440, "steps": 10},
        ours={"|V|": vertices, "|F|": faces, "steps": steps},
        conditions=tuple(conditions),
        scenes=tuple(scenes),
        columns=2,
    )
