"""The bodies of a planar net: panels, plates and connectors; equal ones share one shape."""

from __future__ import annotations

from fabrication.grouping import equal_groups
from fabrication.panel_structure import (
    COLOURS,
    SAME,
    PanelStructure,
    sections_alike,
)
from fabrication.shapes import Bodies, Prisms, joined, prisms


def structure_bodies(built: PanelStructure) -> Bodies:
    """Panels, plates and connectors of *built*; equal ones within ``SAME`` share their shape."""
    return joined(_panels(built), _plates(built), _connectors(built))


def _panels(built: PanelStructure) -> Prisms:
    outlines = [p.outline for p in built.panels]
    return prisms(
        "panels",
        COLOURS["panels"],
        [p.mark for p in built.panels],
        outlines,
        [p.frame for p in built.panels],
        equal_groups(outlines, SAME, prefix="G"),
        (0.0, built.system.panels.thickness),
        built.system.panels.material,
    )


def _plates(built: PanelStructure) -> Prisms:
    half = 0.0 if built.system.plates is None else built.system.plates.thickness / 2.0
    outlines = [p.outline for p in built.plates]
    return prisms(
        "plates",
        COLOURS["plates"],
        [p.mark for p in built.plates],
        outlines,
        [p.frame for p in built.plates],
        equal_groups(outlines, SAME, prefix="H", mirror=True),
        (-half, half),
        None if built.system.plates is None else built.system.plates.material,
    )


def _connectors(built: PanelStructure) -> Prisms:
    pieces = built.pieces
    return prisms(
        "connectors",
        COLOURS["connectors"],
        [piece.mark for piece in pieces],
        [piece.connector.section() for piece in pieces],
        [piece.frame for piece in pieces],
        sections_alike(pieces, SAME),
        (0.0, pieces[0].height if pieces else 0.0),
        built.system.connector_material,
    )
