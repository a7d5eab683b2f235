"""Whole scenes: everything of a shell of lamellas, or of one of panels, and its flat patterns."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

import gridshell as gs
from fabrication.export.flat_drawing import piece_svg, shape_svg
from fabrication.export.scene.bodies import connector_layers, pattern_key
from fabrication.export.scene.layers import Layer, Scene
from fabrication.export.scene.motion import motion_layers
from fabrication.export.scene.net import net_layers
from fabrication.export.scene.packing import on_screen
from fabrication.export.scene.panels import panel_layers, plate_colouring, support_layers
from fabrication.export.scene.strips import axis_layers, strip_layers
from fabrication.export.stress_view import stress_colourings
from fabrication.jointed import Jointed
from fabrication.motion import Motion
from fabrication.outlines import Frame
from fabrication.panel_structure import PanelStructure
from fabrication.parts import FlatPart
from fabrication.sheet_parts import panel_piece, plate_piece, star_piece
from fabrication.strength import BayStress
from fabrication.strip_picture import strip_svg
from gridshell.arrays import Floats, Points


def lamella_scene(
    jointed: Jointed,
    parts: Sequence[FlatPart],
    stress: BayStress,
    *,
    facade: PanelStructure | None = None,
    copies: Sequence[Frame] = (),
    net: gs.ControlMesh | None = None,
    moving: tuple[Motion, float] | None = None,
    centre: Floats | None = None,
) -> Scene:
    """Strips, nodes, connectors, and the panels above them, hidden until they are asked for.

    Parameters
    ----------
    net : the control mesh; its layers are left out without.
    moving : how the net opens, and how far it is opened as built.
    centre : (3,) mm, the origin of the scene; the middle of the nodes without.
    """
    nodes = np.array([node.position for node in jointed.design.nodes])
    centre = middle(nodes) if centre is None else centre
    layers: list[Layer] = strip_layers(jointed, parts, stress, centre, copies)
    layers += connector_layers(jointed.connectors, centre)
    if facade is not None:
        layers += panel_layers(facade, centre, visible=False)
    if net is not None:
        layers += net_layers(net, centre)
    if moving is not None:
        layers += motion_layers(moving[0], centre, moving[1])
    return Scene([*layers, *axis_layers(on_screen(nodes, centre))], stress_colourings(stress))


def middle(points: Points) -> Floats:
    """(3,) of the box around *points* (n, 3)."""
    return np.asarray((points.min(axis=0) + points.max(axis=0)) / 2.0)


def flat_patterns(jointed: Jointed, parts: Sequence[FlatPart]) -> dict[str, str]:
    """The drawings of all flat strips by their marks, and of all shapes of connectors: SVG."""
    families = [lamella.family for lamella in jointed.strips.lamellas]
    strips = {
        part.mark: strip_svg(part, family) for part, family in zip(parts, families, strict=True)
    }
    shapes = {
        pattern_key(prisms, number): shape_svg(shape)
        for prisms in jointed.connectors
        for number, shape in enumerate(prisms.shapes)
    }
    return {**strips, **shapes}


def panel_patterns(built: PanelStructure) -> dict[str, str]:
    """The drawings of all panels, plates and star plates by their marks: SVG."""
    pieces = [panel_piece(panel) for panel in built.panels]
    pieces += [plate_piece(plate) for plate in built.plates]
    pieces += [star_piece(piece) for piece in built.pieces]
    return {piece.mark: piece_svg(piece) for piece in pieces}


def panel_scene(
    built: PanelStructure, *, net: gs.ControlMesh | None = None, centre: Floats | None = None
) -> Scene:
    """Panels, plates, connectors and marks.

    Parameters
    ----------
    net : the control mesh; its layers are left out without.
    centre : (3,) mm, the origin of the scene; the middle of the vertices without.
    """
    vertices = built.mesh.vertices
    centre = middle(vertices) if centre is None else centre
    layers = [*panel_layers(built, centre), *support_layers(built, centre)]
    layers += [] if net is None else net_layers(net, centre)
    return Scene([*layers, *axis_layers(on_screen(vertices, centre))], plate_colouring(built))
