"""Fig. 6: from a triangle mesh to planar quads at a constant angle, stage by stage."""

from __future__ import annotations

from math import radians

import gridshell as gs
from fabrication.export.raster import Scene
from fabrication.export.stages import stages, view_of
from fabrication.gallery.figure import Condition, Figure, average, largest
from fabrication.gallery.scenery import pattern
from fabrication.gallery.starts import shell, triangles

_ROOMS = {"e": (60.0, 360), "f": (75.0, 378)}
_TRUE_TO = 0.01
"""Distance from the surface on average, over its size."""


def figure() -> Figure:
    """Directions at 60 and 75 degrees, quads along them, the exact nets near the surface."""
    size = 4000.0
    surface = triangles(shell, size, 60)
    scenes: list[Scene] = []
    conditions: list[Condition] = []
    ours: dict[str, float | int | str] = {}
    for letter, (degrees, faces) in _ROOMS.items():
        made = gs.quadrangulate(surface, gs.Conjugate(radians(degrees)), quads=2 * faces)
        start = made.control()
        recipe = gs.pq_net(angle=radians(degrees))
        result = gs.optimize(start, recipe, anchor=gs.Free(), reference=made.reference)
        away = result.quality.surface_distance_mm
        before = gs.net_quality(start, planarity=gs.Planarity.WHITE_FACES).face_planarity
        ours |= {
            f"|V| ({letter})": len(start.vertices),
            f"|F| ({letter})": len(start.quads),
            f"steps ({letter})": len(result.steps),
            f"planarity before ({letter})": largest(before),
            f"from the surface ({letter}), mm": average(away),
        }
        conditions += [
            Condition(f"{letter}: other faces than quads in M", made.report.non_quads, 0),
            Condition(f"{letter}: planarity", largest(result.quality.face_planarity), 1e-6),
            Condition(f"{letter}: angle, degrees", largest(result.quality.angle_error_deg), 0.01),
            Condition(f"{letter}: distance over size", average(away) / (2.0 * size), _TRUE_TO),
        ]
        view = view_of(made)
        if letter == "e":
            shown = {s.letter: s for s in stages(made, result.control)}
            scenes += [Scene(f"{s} {shown[s].title}", shown[s].layers, view, 0.5) for s in "abcd"]
        scenes.append(Scene(f"{letter} {degrees:.0f} degrees", pattern(result.control), view))
    return Figure(
        name="6",
        title="Remeshing a surface by planar quads of constant angle",
        paper={"|V| (e)": 409, "|F| (e)": 360, "|V| (f)": 427, "|F| (f)": 378, "steps": 10},
        ours=ours,
        conditions=tuple(conditions),
        scenes=tuple(scenes),
    )
