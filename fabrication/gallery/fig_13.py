"""Fig. 13: the angle as a design parameter, around a central singularity."""

from __future__ import annotations

from math import radians

import numpy as np

import fabrication as fab
import gridshell as gs
from fabrication.export.raster import Scene
from fabrication.gallery.figure import Condition, Figure, average, equal, largest
from fabrication.gallery.scenery import lamella_faces, pattern
from gridshell.painter import seen_from

_ROOMS = {"a, b": (60.0, 90.0), "c, d": (90.0, 60.0)}
"""Degrees at the singularity and at the boundary."""


def figure() -> Figure:
    """Form-finding without a reference: six sectors, an angle that grows or falls outwards."""
    patch = gs.SingularPatch(valence=6, cells=11, reach=0.65, cut=1)
    start = gs.control_patch(gs.Enneper(8000.0), patch)
    reach = float(np.linalg.norm(start.vertices, axis=1).max())
    view = seen_from(0.35, -1.0, 1.3)
    scenes: list[Scene] = []
    remarks: list[str] = []
    steps = 0
    conditions = [equal("|V|", len(start.vertices), 787), equal("|F|", len(start.quads), 720)]
    for letters, (inner, outer) in _ROOMS.items():
        field = gs.RadialAngle((0.0, 0.0, 0.0), (0.0, reach), (radians(inner), radians(outer)))
        recipe = gs.a_net(angle=field, conditions=(gs.NearRhombi(),))
        result = gs.optimize(start, recipe, anchor=gs.Free())
        steps = max(steps, len(result.steps))
        where = f"{letters}: {inner:.0f} to {outer:.0f} degrees"
        conditions += [
            Condition(f"{where}: star planarity", largest(result.quality.star_planarity), 1e-6),
            Condition(
                f"{where}: off the field, degrees", largest(result.quality.angle_error_deg), 0.01
            ),
            Condition(f"{where}: collapsed quads", result.quality.collapsed, 0),
        ]
        remarks.append(_verdict(start, field, where, result.control))
        net = gs.diagonal_meshes(result.control)[0]
        built = fab.structure(net, fab.Profile(150.0, 5.0, fab.STAINLESS))
        scenes += [
            Scene(f"{inner:.0f} to {outer:.0f} degrees, pattern", pattern(result.control), view),
            Scene("gridshell", lamella_faces(built), view),
        ]
    return Figure(
        name="13",
        title="The angle as a design parameter",
        paper={"|V|": 787, "|F|": 720, "steps": 10},
        ours={"|V|": len(start.vertices), "|F|": len(start.quads), "steps": steps},
        conditions=tuple(conditions),
        scenes=tuple(scenes),
        remarks=tuple(remarks),
        columns=2,
    )


def _verdict(
    start: gs.ControlMesh, field: gs.RadialAngle, where: str, found: gs.ControlMesh
) -> str:
    """What became of the rhombi: planar stars at given angles leave no room for exact ones."""
    near = gs.net_quality(found, rhombus=True).rhombus_error
    free = gs.optimize(start, gs.a_net(angle=field), anchor=gs.Free()).control
    without = gs.net_quality(free, rhombus=True).rhombus_error
    return (
        f"{where}: exact rhombi are not attainable beside planar stars and this field of angles; "
        f"diagonals differ by {average(near):.1%} on average, {largest(near):.1%} at most "
        f"({average(without):.1%} and {largest(without):.1%} where they are not asked for)."
    )
