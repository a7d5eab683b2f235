"""Fig. 3: a principal mesh, its node axes and its torsion-free support structure."""

from __future__ import annotations

from math import radians

import numpy as np

import fabrication as fab
import gridshell as gs
from fabrication.export.raster import Scene
from fabrication.gallery.figure import Condition, Figure, average, largest
from fabrication.gallery.scenery import BLUE, RED, edges
from fabrication.gallery.starts import dome, triangles
from gridshell.painter import Faces, painted, polygons, seen_from


def figure() -> Figure:
    """Remesh a dome along its principal directions, make it exact, stand plates on it."""
    made = gs.quadrangulate(triangles(dome, 4000.0, 60), gs.Principal(), quads=420)
    recipe = gs.pq_net(angle=radians(90.0), conditions=(gs.FlatRim(),))
    result = gs.optimize(made.control(), recipe, anchor=gs.Free(), reference=made.reference)
    skin = gs.skin(result.control, gs.Skin.D1)
    other = gs.skin(result.control, gs.Skin.D2)
    plates = fab.supports(skin, fab.PlateSection(-250.0, 0.0, 8.0, fab.S235))
    twist = max(plate.out_of_plane for plate in plates)
    view = seen_from(0.5, -1.0, 0.75)
    corners = np.array([plate.corners for plate in plates])
    axes = np.stack([skin.vertices, skin.vertices - 250.0 * skin.axes], axis=1)
    faces = polygons(skin.vertices, skin.faces)
    lines = edges(axes.reshape(-1, 3), np.arange(2 * len(axes)).reshape(-1, 2), width=0.9)
    return Figure(
        name="3",
        title="Principal mesh, node axes, torsion-free supports",
        paper={},
        ours={
            "|V|": len(result.control.vertices),
            "|F|": len(result.control.quads),
            "plates": len(plates),
            "from the surface, mm": average(result.quality.surface_distance_mm),
        },
        conditions=(
            Condition("faces planar, over diagonal", largest(result.quality.face_planarity), 1e-8),
            Condition("angle, degrees", largest(result.quality.angle_error_deg), 1e-5),
            Condition("plates out of plane, mm", twist, 1e-3),
            Condition("axis off the normal of the other mesh", _lean(result.control), 1e-8),
        ),
        scenes=(
            Scene(
                "D1 (red), D2 (blue), node axes",
                (
                    Faces(faces, painted((0.96, 0.96, 0.94), len(faces))),
                    edges(skin.vertices, skin.edges, RED, 1.4),
                    edges(other.vertices, other.edges, BLUE, 0.8),
                    lines,
                ),
                view,
            ),
            Scene("Torsion-free supports", (Faces(corners, painted(RED, len(corners))),), view),
        ),
        columns=2,
    )


def _lean(control: gs.ControlMesh) -> float:
    """Largest sine between a node's axis and the diagonals of the face of D2 around it."""
    axes, partial = gs.node_axes(control)
    stars = gs.edge_stars(control.mesh)
    inner = np.flatnonzero(~partial & stars.closed & (stars.count == 4))
    ring = control.vertices[stars.spokes[inner, :4]]
    across = [ring[:, 2] - ring[:, 0], ring[:, 3] - ring[:, 1]]
    leans = [
        np.abs(np.einsum("nc,nc->n", a, axes[inner])) / np.linalg.norm(a, axis=1) for a in across
    ]
    return float(np.max(leans))
