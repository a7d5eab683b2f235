"""Everything that is built on a planar net: panels, support plates, connectors; which are equal.

Panels lie with their lower side on the net. Plates stand between the node axes, half of their
thickness on either side of their plane, and reach to the slots' floors of the connectors, which
are centred half-way up the plates.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from fabrication.connector import Connector, ConnectorSpec, connector_findings, connectors
from fabrication.connector_pieces import ConnectorPiece, StarSpec, connector_pieces
from fabrication.finding import Finding
from fabrication.grouping import Group, equal_groups
from fabrication.panel import Panel, PanelSpec, panel_groups, panels
from fabrication.stock import Material
from fabrication.support import (
    PlateSection,
    SupportPlate,
    plate_groups,
    support_findings,
    supports,
)
from gridshell import PanelMesh, averaged_normals
from gridshell.painter import Faces, padded, painted
from gridshell.picture import card, limits, size, sketch

SAME = 1e-3
"""Parts whose corners agree this well are one shape in the STEP file, mm."""

_MOST_SHOWN = 1_500
"""Panels, and plates, in a picture for notebooks."""

COLOURS = {
    "panels": (0.62, 0.78, 0.88),
    "plates": (0.36, 0.47, 0.58),
    "connectors": (0.80, 0.52, 0.25),
    "profiles": (0.55, 0.55, 0.52),
}
"""By kind, sRGB."""


@dataclass(frozen=True)
class PanelSystem:
    """How everything on a planar net is made.

    Parameters
    ----------
    panels : how panels are made.
    plates : how support plates are made; None for a net without.
    connectors : how connectors are made; None for a net without.
    connector_material : what those are made of.
    star : star plates they consist of; None for cylinders.
    tolerance : parts whose corners agree this well are one group for the shop, mm.
    turn_over : whether a panel may be turned over to fit a group.
    """

    panels: PanelSpec
    plates: PlateSection | None = None
    connectors: ConnectorSpec | None = None
    connector_material: Material | None = None
    star: StarSpec | None = None
    tolerance: float = 0.5
    turn_over: bool = False


@dataclass(frozen=True, eq=False)
class PanelStructure:
    """What is built.

    Parameters
    ----------
    mesh : the skin it is built on.
    panels, plates, connectors : by face, edge and node of *mesh*.
    """

    mesh: PanelMesh
    system: PanelSystem
    panels: tuple[Panel, ...]
    plates: tuple[SupportPlate, ...]
    connectors: tuple[Connector, ...]

    @cached_property
    def panel_groups(self) -> tuple[Group, ...]:
        """Panels that are equal for the shop."""
        return panel_groups(self.panels, self.system.tolerance, mirror=self.system.turn_over)

    @cached_property
    def plate_groups(self) -> tuple[Group, ...]:
        """Plates that are equal for the shop; a plate may be turned over."""
        return plate_groups(self.plates, self.system.tolerance)

    @cached_property
    def pieces(self) -> tuple[ConnectorPiece, ...]:
        """The cylinders or star plates."""
        return connector_pieces(self.connectors, connector_middle(self.system), self.system.star)

    @cached_property
    def connector_groups(self) -> tuple[Group, ...]:
        """Pieces of connectors that are equal for the shop."""
        return sections_alike(self.pieces, self.system.tolerance)

    def piece_mass(self, piece: ConnectorPiece) -> float:
        """Mass of a cylinder or star plate, kg."""
        material = self.system.connector_material
        density = 0.0 if material is None else material.density
        return piece.area * piece.height * density * 1e-9

    @cached_property
    def classical_plates(self) -> tuple[SupportPlate, ...]:
        """The plates as they would be along averaged normals: what the node axes are for."""
        section = self.system.plates
        if section is None:
            return ()
        return supports(self.mesh.with_axes(averaged_normals(self.mesh)), section)

    def findings(self) -> list[Finding]:
        """Twisted plates and crowded connectors."""
        section = self.system.plates
        twisted = () if section is None else support_findings(self.plates, section)
        return [*twisted, *connector_findings(self.connectors)]

    def _repr_html_(self) -> str:
        """For notebooks: the panels, and plates below where they are to be seen."""
        layers, notes = _shown(self)
        picture = sketch(layers, label="Panels on a planar net")
        return card("Panel structure", _figures(self), picture=picture, notes=notes)


def panelled(mesh: PanelMesh, system: PanelSystem) -> PanelStructure:
    """Build *system* on *mesh*.

    Raises
    ------
    SettingError
        Naming the first panel, plate or connector of which nothing sound is left.
    """
    return PanelStructure(
        mesh=mesh,
        system=system,
        panels=panels(mesh, system.panels),
        plates=() if system.plates is None else supports(mesh, system.plates),
        connectors=() if system.connectors is None else connectors(mesh, system.connectors),
    )


def sections_alike(pieces: Sequence[ConnectorPiece], tolerance: float) -> tuple[Group, ...]:
    """Pieces whose sections agree within *tolerance* mm: "C1", "C2", ..."""
    sections = [piece.connector.section()[:, :2] for piece in pieces]
    return equal_groups(sections, tolerance, prefix="C")


def connector_middle(system: PanelSystem) -> float:
    """Place of the connectors' middle along the axes, mm from the net."""
    plates = system.plates
    return 0.0 if plates is None else (plates.below + plates.above) / 2.0


# ---- for notebooks -------------------------------------------------------------------------------


def _figures(built: PanelStructure) -> list[tuple[str, str]]:
    spec, pieces = built.system.panels, built.pieces
    masses = (
        *(panel.mass for panel in built.panels),
        *(plate.mass for plate in built.plates),
        *(built.piece_mass(piece) for piece in pieces),
    )
    corners = np.concatenate([np.zeros(0), *(panel.corner_angles for panel in built.panels)])
    return [
        ("Panels", f"{len(built.panels)} of {spec.thickness:g} mm, {spec.material.name}"),
        ("Support plates", f"{len(built.plates)}" if built.plates else ""),
        ("Connectors", f"{len(built.connectors)}" if built.connectors else ""),
        ("Spans", size(built.mesh.vertices)),
        ("Area of panels", f"{sum(panel.area for panel in built.panels) / 1e6:.2f} m2"),
        ("Corners", limits(np.degrees(corners), "degrees", 1)),
        ("Mass", f"{sum(masses):.1f} kg"),
    ]


def _shown(built: PanelStructure) -> tuple[tuple[Faces, ...], tuple[str, ...]]:
    """Panels and plates as polygons in their colours."""
    layers = tuple(
        Faces(found, painted(COLOURS[kind], len(found)))
        for kind, found in (
            ("plates", padded([plate.in_space() for plate in built.plates[:_MOST_SHOWN]])),
            ("panels", padded([panel.in_space() for panel in built.panels[:_MOST_SHOWN]])),
        )
    )
    many = max(len(built.panels), len(built.plates)) > _MOST_SHOWN
    return layers, (f"The first {_MOST_SHOWN} panels and plates are drawn.",) if many else ()
