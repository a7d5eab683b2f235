"""A control mesh, its two diagonal meshes and the checkerboard between them as layers.

Figures of every control quad colour the control mesh: where the net is not yet as it shall be.
"""

from __future__ import annotations

import numpy as np

import gridshell as gs
from fabrication.colours import FAMILY_COLOURS, css
from fabrication.export.scene.layers import Colouring, Faces, Layer, Lines
from fabrication.export.scene.packing import on_screen
from fabrication.words import number
from gridshell.arrays import Floats, Indices, Points

_MESH, _SECOND, _BOARD = "#8a95a3", "#9c7bb0", "#c9d2dc"


def net_layers(control: gs.ControlMesh, centre: Floats, *, shown: bool = False) -> list[Layer]:
    """The control mesh, D1 by family, D2 and the checkerboard's parallelograms.

    Parameters
    ----------
    centre : (3,) mm, the origin of the scene.
    shown : whether D1 is visible at first; everything else is not.
    """
    mesh = control.mesh
    first, second = gs.diagonal_meshes(control)
    board = gs.checkerboard(control)
    quads = _quads("control-faces", "Control mesh", mesh.vertices, mesh.quads, centre, _MESH)
    layers: list[Layer] = [
        quads,
        Lines(
            id="control-edges",
            name="Control mesh",
            colour=_MESH,
            visible=False,
            of_net=True,
            points=quads.points,
            pairs=mesh.edges,
        ),
    ]
    vertices = on_screen(first.vertices, centre)
    layers += [
        Lines(
            id=f"D1-{family}",
            name="Net D1",
            colour=css(FAMILY_COLOURS[family]),
            visible=shown,
            of_net=True,
            points=vertices,
            pairs=first.edges[first.family == family],
        )
        for family in FAMILY_COLOURS
    ]
    layers.append(
        Lines(
            id="D2",
            name="Diagonal mesh D2",
            colour=_SECOND,
            visible=False,
            of_net=True,
            points=on_screen(second.vertices, centre),
            pairs=second.edges,
        )
    )
    layers.append(
        _quads("checkerboard", "Checkerboard", board.vertices, board.black, centre, _BOARD)
    )
    return layers


def _quads(
    id: str, name: str, vertices: Points, quads: Indices, centre: Floats, colour: str
) -> Faces:
    triangles = quads[:, [0, 1, 2, 0, 2, 3]].reshape(-1, 3)
    loops = np.column_stack([quads, quads[:, :1], np.full(len(quads), len(vertices))]).ravel()
    own = "quads" if id == "control-faces" else ""
    return Faces(
        id=id,
        name=name,
        colour=colour,
        visible=False,
        of_net=True,
        points=on_screen(vertices, centre),
        triangles=triangles,
        sizes=[2] * len(quads),
        loops=loops,
        cells_of=own,
    )


def net_colourings(found: gs.QuadFigures) -> list[Colouring]:
    """Angle error, planarity, distance from the surface, ratio of curvatures, quad by quad."""
    shown = [
        ("Planarity", found.planarity, ""),
        ("Distance to surface", found.surface_distance, " mm"),
        ("Curvature ratio", found.curvature_ratio, ""),
    ]
    if found.angle_error is not None:
        shown.insert(0, ("Angle error", np.degrees(found.angle_error), "°"))
    return [
        _colouring(name, values, unit, from_zero=name != "Curvature ratio")
        for name, values, unit in shown
        if values is not None and np.isfinite(values).any()
    ]


def _colouring(name: str, values: Floats, unit: str, *, from_zero: bool) -> Colouring:
    low = 0.0 if from_zero else float(np.nanmin(values))
    high = float(np.nanmax(values))
    shares = (values - low) / (high - low if high > low else 1.0)
    return Colouring(name, "quads", shares, f"{number(low, 3)}{unit}", f"{number(high, 3)}{unit}")
