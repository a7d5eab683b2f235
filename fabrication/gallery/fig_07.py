"""Fig. 7: rotational patterns with planar white quads and similar black rhombi."""

from __future__ import annotations

from math import radians, tan

import numpy as np

import gridshell as gs
from fabrication.export.raster import Scene
from fabrication.gallery.figure import Condition, Figure, equal, largest
from fabrication.gallery.scenery import pattern
from fabrication.gallery.starts import ring_on_sphere
from gridshell.painter import seen_from


def figure() -> Figure:
    """Conformal rings of a sphere, made exact at three angles."""
    scenes, conditions = [], []
    vertices = faces = steps = 0
    for degrees in (60.0, 90.0, 120.0):
        angle = radians(degrees)
        start = ring_on_sphere(50, 15, angle, 3000.0)
        result = gs.optimize(start, gs.pq_net(angle=angle, rhombus=True), anchor=gs.Free())
        quality = result.quality
        steps = max(steps, len(result.steps))
        vertices, faces = len(start.vertices), len(start.quads)
        at = f"{degrees:.0f} degrees"
        ratio = _positive(result.control)
        conditions += [
            equal(f"{at}: |V|", vertices, 800),
            equal(f"{at}: |F|", faces, 750),
            Condition(f"{at}: planarity", largest(quality.face_planarity), 1e-9),
            Condition(f"{at}: angle, degrees", largest(quality.angle_error_deg), 1e-6),
            Condition(f"{at}: rhombi", largest(quality.rhombus_error), 1e-9),
            Condition(f"{at}: k1 / k2 off tan^2(angle / 2)", abs(ratio - _theory(angle)), 0.05),
        ]
        scenes.append(Scene(at, pattern(result.control), seen_from(0.0, -1.0, 0.35)))
    return Figure(
        name="7",
        title="Rotational patterns with similar rhombi",
        paper={"|V|": 800, "|F|": 750, "steps": 10},
        ours={"|V|": vertices, "|F|": faces, "steps": steps},
        conditions=tuple(conditions),
        scenes=tuple(scenes),
    )


def _theory(angle: float) -> float:
    """The smaller curvature over the larger one."""
    ratio = tan(angle / 2.0) ** 2
    return min(ratio, 1.0 / ratio)


def _positive(control: gs.ControlMesh) -> float:
    """Median ratio of the principal curvatures, the smaller over the larger one."""
    _, kappa = gs.principal_curvatures(control.mesh)
    size = np.sort(np.abs(kappa), axis=1)
    return float(np.median(size[:, 0] / size[:, 1]))
