"""Fig. 8: planar white quads at three constant angles on one surface."""

from __future__ import annotations

from math import radians

import gridshell as gs
from fabrication.export.raster import Scene
from fabrication.gallery.figure import Condition, Figure, equal, largest
from fabrication.gallery.scenery import pattern
from fabrication.gallery.starts import dome, graph
from gridshell.painter import seen_from


def figure() -> Figure:
    """One dome as the start, three angles; the surface gives way."""
    start = gs.as_control_mesh(graph(17, 31, dome, 3000.0))
    scenes, steps = [], 0
    conditions = [equal("|F|", len(start.quads), 527)]
    for degrees in (90.0, 75.0, 60.0):
        result = gs.optimize(start, gs.pq_net(angle=radians(degrees)), anchor=gs.Free())
        steps = max(steps, len(result.steps))
        at = f"{degrees:.0f} degrees"
        conditions += [
            Condition(f"{at}: planarity", largest(result.quality.face_planarity), 1e-9),
            Condition(f"{at}: angle, degrees", largest(result.quality.angle_error_deg), 1e-6),
            Condition(f"{at}: collapsed quads", result.quality.collapsed, 0),
        ]
        scenes.append(Scene(at, pattern(result.control), seen_from(1.0, -0.6, 1.0)))
    return Figure(
        name="8",
        title="Planar quads at a constant angle",
        paper={"|V|": 614, "|F|": 527, "steps": 10},
        ours={"|V|": len(start.vertices), "|F|": len(start.quads), "steps": steps},
        conditions=tuple(conditions),
        scenes=tuple(scenes),
    )
