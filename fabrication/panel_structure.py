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

SAME = 1e-3
"""Parts whose corners agree this well are one shape in the STEP file, mm."""


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
    tolerance : parts whose corners agree this well are one group for the shop, mm.
    turn_over : whether a panel may be turned over to fit a group.
    """

    panels: PanelSpec
    plates: PlateSection | None = None
    connectors: ConnectorSpec | None = None
    connector_material: Material | None = None
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
    def connector_groups(self) -> tuple[Group, ...]:
        """Connectors that are equal for the shop."""
        return sections_alike(self.connectors, self.system.tolerance)

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


def panel_structure(mesh: PanelMesh, system: PanelSystem) -> PanelStructure:
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


def sections_alike(made: Sequence[Connector], tolerance: float) -> tuple[Group, ...]:
    """Connectors whose sections agree within *tolerance* mm: "C1", "C2", ..."""
    return equal_groups([c.section()[:, :2] for c in made], tolerance, prefix="C")


def connector_span(system: PanelSystem) -> tuple[float, float]:
    """Lower and upper end of the connectors along the axes, mm from the net."""
    if system.plates is None or system.connectors is None:
        return 0.0, 0.0
    middle = (system.plates.below + system.plates.above) / 2.0
    return middle - system.connectors.height / 2.0, middle + system.connectors.height / 2.0


def connector_mass(connector: Connector, material: Material) -> float:
    """Mass of a connector, kg."""
    return section_area(connector) * connector.spec.height * material.density * 1e-9


def section_area(connector: Connector) -> float:
    """Area across the axis, mm2: the polygon of the corners and the segments under its arcs."""
    x, y, bulge = connector.section().T
    ahead_x, ahead_y = np.roll(x, -1), np.roll(y, -1)
    polygon = float((x * ahead_y - y * ahead_x).sum()) / 2.0
    sweep = 4.0 * np.arctan(bulge)
    return polygon + float((connector.spec.radius**2 / 2.0 * (sweep - np.sin(sweep))).sum())
