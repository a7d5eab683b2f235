"""Fig. 16: the urban roof: constant 60 degrees, straight pieces, triangles of glass."""

from __future__ import annotations

from math import radians

import numpy as np

import fabrication as fab
import gridshell as gs
from fabrication.export.raster import Scene
from fabrication.gallery.figure import Condition, Figure, largest
from fabrication.gallery.scenery import GLASS, GREY, edges, lamella_faces
from gridshell.painter import Faces, painted, polygons, seen_from


def figure() -> Figure:
    """Pieces between strips that run through, two flat triangles in every bay."""
    patch = gs.AsymptoticPatch(p=(-0.8, 0.8), q=(-0.8, 0.8), lamellas=(12, 12))
    start = gs.control_patch(gs.Enneper(9000.0), patch)
    net = gs.optimize(start, gs.a_net(angle=radians(60.0)), anchor=gs.Free())
    skin = gs.diagonal_meshes(net.control)[0]
    design = fab.structure(skin, fab.Profile(200.0, 10.0, fab.S355))
    jointed = fab.ReciprocalJoint(gap=2.0).build(design)
    parts = fab.parts_of(jointed)
    fitted = fab.fit(jointed.strips, parts, jointed.connectors)
    glazing = fab.PanelSpec(gap=20.0, thickness=12.0, material=fab.GLASS)
    axes = np.array([node.axis for node in design.nodes])
    roof = fab.triangulated_facade(skin, glazing, axes=axes)
    glass = roof.mesh
    faces = polygons(glass.vertices, glass.faces)
    angles = np.degrees([node.angle for node in design.nodes if node.angle is not None])
    view = seen_from(0.6, -0.8, 1.7)
    return Figure(
        name="16",
        title="Urban metro station at 60 degrees",
        paper={"angle, degrees": 60},
        ours={
            "strips and pieces": len(parts),
            "panes of glass": len(faces),
            "between strips at nodes, degrees": f"{angles.min():.2f} to {angles.max():.2f}",
        },
        conditions=(
            Condition("star planarity", largest(net.quality.star_planarity), 1e-6),
            Condition("angle, degrees", largest(net.quality.angle_error_deg), 0.01),
            Condition("other panes than triangles", int(np.count_nonzero(glass.corners != 3)), 0),
            Condition("clash, mm3", fitted.max_mm3, 1e-3),
        ),
        scenes=(
            Scene("Pieces between strips", lamella_faces(jointed.strips), view),
            Scene(
                "Triangulated glass",
                (
                    *lamella_faces(design),
                    Faces(faces, painted(GLASS, len(faces))),
                    edges(glass.vertices, glass.edges, GREY, 0.7),
                ),
                view,
            ),
        ),
        columns=2,
    )
