"""Fig. 14: an asymptotic net at right angles on a Schwarz D patch, and its timber prototype."""

from __future__ import annotations

from math import radians

import numpy as np

import fabrication as fab
import gridshell as gs
from fabrication.export.raster import Scene
from fabrication.gallery.figure import Condition, Figure, average, largest
from fabrication.gallery.scenery import connector_faces, lamella_faces, pattern
from gridshell.arrays import Points
from gridshell.painter import seen_from

SPAN = 4000.0
_INSIDE = 0.9
"""Share of the quads asked for that the ragged rim leaves."""


def frame() -> Points:
    """Four straight edges of a cube of which the minimal surface is a patch of Schwarz D."""
    corners = np.array([[0, 0, 0], [1, 0, 1], [1, 1, 0], [0, 1, 1]]) * [SPAN, SPAN, 0.7 * SPAN]
    share = np.linspace(0.0, 1.0, 24, endpoint=False)[:, None]
    ahead = np.roll(corners, -1, axis=0)
    return np.concatenate([a + share * (b - a) for a, b in zip(corners, ahead, strict=True)])


def net(quads: int) -> tuple[gs.ControlMesh, gs.OptimizedNet]:
    """About so many control quads between the edges, their diagonals at right angles."""
    surface = gs.TriangulatedSurface(*_triangles())
    made = gs.quadrangulate(surface, gs.Asymptotic(), quads=2 * quads, extent=gs.Extent.COVER)
    start = made.control()
    recipe = gs.a_net(angle=radians(90.0), conditions=(gs.NearRhombi(),))
    return start, gs.optimize(start, recipe, anchor=gs.Free(), reference=made.reference)


def _triangles() -> tuple[Points, np.ndarray]:
    found = gs.minimal_surface([frame()], edge=SPAN / 40.0)
    return found.vertices, found.triangles


def figure() -> Figure:
    """The net at the paper's size, the prototype coarser, with its studs."""
    start, result = net(round(606 / _INSIDE))
    quality = result.quality
    rhombi = gs.net_quality(result.control, rhombus=True).rhombus_error
    _, coarse = net(round(130 / _INSIDE))
    design = fab.structure(
        gs.diagonal_meshes(coarse.control)[0], fab.Profile(60.0, 4.0, fab.POPLAR_PLY)
    )
    jointed = fab.StudJoint(30.0, fab.Stud(fab.BIRCH_PLY), level=31.0).build(design)
    parts = fab.parts_of(jointed)
    fitted = fab.fit(jointed.strips, parts, jointed.connectors)
    view = seen_from(0.5, -1.0, 0.9)
    timber = (*lamella_faces(jointed.strips), *connector_faces(jointed.connectors))
    return Figure(
        name="14",
        title="Schwarz D at right angles, and the timber prototype",
        paper={"|V|": 679, "|F|": 606, "steps": 10, "span, m": 4, "profile, mm": "60 x 4"},
        ours={
            "|V|": len(start.vertices),
            "|F|": len(start.quads),
            "steps": len(result.steps),
            "span, m": SPAN / 1000.0,
            "profile, mm": design.profile.size,
            "profiles": len(parts),
            "studs": sum(len(kind.bodies) for kind in jointed.connectors),
        },
        conditions=(
            Condition("star planarity", largest(quality.star_planarity), 1e-6),
            Condition("angle, degrees", largest(quality.angle_error_deg), 0.01),
            Condition("diagonals unequal on average", average(rhombi), 0.02),
            Condition("prototype: angle, degrees", largest(coarse.quality.angle_error_deg), 0.01),
            Condition("prototype: clash, mm3", fitted.max_mm3, 1e-3),
        ),
        scenes=(
            Scene("Pattern", pattern(result.control), view),
            Scene("Timber prototype", timber, view),
        ),
        columns=2,
    )
