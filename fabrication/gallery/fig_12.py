"""Fig. 12: planar white quads and similar black rhombi on free surfaces."""

from __future__ import annotations

from math import radians

import gridshell as gs
from fabrication.export.raster import Scene
from fabrication.gallery.figure import Condition, Figure, equal, largest
from fabrication.gallery.scenery import pattern
from fabrication.gallery.starts import dome, graph
from gridshell.painter import seen_from


def figure() -> Figure:
    """One dome as the start, three angles; discrete isothermic at 90 degrees."""
    start = gs.as_control_mesh(graph(30, 59, dome, 2500.0))
    scenes, steps = [], 0
    conditions = [equal("|V|", len(start.vertices), 1860), equal("|F|", len(start.quads), 1770)]
    for degrees in (120.0, 90.0, 60.0):
        recipe = gs.pq_net(angle=radians(degrees), rhombus=True)
        result = gs.optimize(start, recipe, anchor=gs.Free())
        steps = max(steps, len(result.steps))
        at, quality = f"{degrees:.0f} degrees", result.quality
        conditions += [
            Condition(f"{at}: planarity", largest(quality.face_planarity), 1e-9),
            Condition(f"{at}: angle, degrees", largest(quality.angle_error_deg), 1e-6),
            Condition(f"{at}: rhombi", largest(quality.rhombus_error), 1e-9),
            Condition(f"{at}: collapsed quads", quality.collapsed, 0),
        ]
        scenes.append(Scene(at, pattern(result.control), seen_from(1.0, -0.6, 1.0)))
    return Figure(
        name="12",
        title="Free patterns with similar rhombi",
        paper={"|V|": 1860, "|F|": 1770, "steps": 10},
        ours={"|V|": len(start.vertices), "|F|": len(start.quads), "steps": steps},
        conditions=tuple(conditions),
        scenes=tuple(scenes),
    )
