"""What the sections of a planar project stand for: panels, plates and connectors."""

from __future__ import annotations

from pathlib import Path

from fabrication.connector import ConnectorSpec
from fabrication.connector_pieces import StarSpec
from fabrication.errors import ProjectError
from fabrication.panel import PanelSpec
from fabrication.panel_sections import FacadeSection, PanelsSection, SlottedSection, StarSection
from fabrication.panel_structure import PanelSystem
from fabrication.placing import placed
from fabrication.sections import Project
from fabrication.settings import material_of
from fabrication.support import PlateSection


def panel_spec(section: PanelsSection | FacadeSection) -> PanelSpec:
    """The panels of ``[panels]`` or ``[facade]``."""
    return PanelSpec(
        gap=section.gap,
        thickness=section.thickness,
        material=material_of(section.material),
        clearance=section.clearance,
    )


def plate_section(project: Project) -> PlateSection | None:
    """The plates of ``[supports]``; they end at the floors of the connectors' slots."""
    section, connector = project.supports, connector_spec(project)
    if section is None:
        return None
    reach = section.thickness if connector is None else connector.floor + connector.clearance
    return PlateSection(
        below=section.below,
        above=section.above,
        thickness=section.thickness,
        material=material_of(section.material),
        setback=reach if section.setback is None else section.setback,
    )


def connector_spec(project: Project) -> ConnectorSpec | None:
    """The cylinders of ``[connector]``, as high as the plates unless it says otherwise."""
    section, plates = project.connector, project.supports
    if section is None or plates is None:
        return None
    return ConnectorSpec(
        radius=section.radius,
        height=plates.above - plates.below if section.height is None else section.height,
        plate_thickness=plates.thickness,
        clearance=section.clearance,
        depth=section.radius / 2.0 if section.depth is None else section.depth,
        web=section.web,
    )


def star_spec(section: SlottedSection | None) -> StarSpec | None:
    """The star plates of ``[connector]``, where it asks for them."""
    return StarSpec(section.thickness, section.layers) if isinstance(section, StarSection) else None


def panel_system(project: Project, section: PanelsSection) -> PanelSystem:
    """Everything that is made on the net."""
    connector = project.connector
    return PanelSystem(
        panels=panel_spec(section),
        plates=plate_section(project),
        connectors=connector_spec(project),
        connector_material=None if connector is None else material_of(connector.material),
        star=star_spec(connector),
        tolerance=section.tolerance,
        turn_over=section.turn_over,
    )


def require_panels(project: Project, path: Path) -> None:
    """Refuse what can be told to fail before a net is made.

    Raises
    ------
    ProjectError
        Naming the file *path* and the key.
    """
    net = project.net
    if net.square and net.angle not in (None, 90.0):
        raise ProjectError(
            "Squares have right angles",
            where=f"{path}, net.angle",
            value=f"{net.angle} with net.square = true",
            limit="90 degrees",
            advice="net.rhombus = true in place of net.square, or no net.angle",
        )
    for name, section in (("panels", project.panels), ("facade", project.facade)):
        if section is not None:
            with placed(path, name):
                panel_spec(section)
    if project.supports is not None:
        if not project.supports.below < project.supports.above:
            raise ProjectError(
                "A plate needs a height",
                where=f"{path}, supports.below",
                value=f"{project.supports.below:g} mm",
                limit=f"below supports.above, {project.supports.above:g} mm",
                advice="below = -200, above = 0",
            )
        with placed(path, "connector"):
            connector_spec(project)
        with placed(path, "supports"):
            plate_section(project)
