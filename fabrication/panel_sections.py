"""The sections of a project that say how panels, support plates and connectors are made: mm."""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import Field

from fabrication.section_types import Distance, Place, Section, Sheeting, SheetMetal, Size, Whole


class PanelsSection(Section):
    """Flat panels: one per face of the net, its lower side on the net."""

    thickness: Size
    gap: Annotated[Distance, Field(description="between neighbours")] = 10.0
    clearance: Distance = 0.0
    material: Sheeting = "glass"
    tolerance: Size = 0.5
    turn_over: bool = False


class SupportsSection(Section):
    """Plates between neighbouring nodes; *below* and *above* are places along the node axes."""

    below: Place
    above: Place = 0.0
    thickness: Size
    material: SheetMetal = "S235"
    axes: Literal["normals", "torsion-free"] = "normals"
    setback: Annotated[
        Distance | None,
        Field(description="the slot's floor of the connector; without connectors the thickness"),
    ] = None


class SlottedSection(Section):
    """What all connectors have: slots for the plates in a round section."""

    radius: Size
    height: Annotated[Size | None, Field(description="that of the plates")] = None
    depth: Annotated[Size | None, Field(description="half the radius")] = None
    clearance: Distance = 0.3
    web: Annotated[Size | None, Field(description="the plates' thickness")] = None
    material: SheetMetal = "S235"


class CylinderSection(SlottedSection):
    """Cylinders with one slot per plate."""

    kind: Literal["cylinder"]


class StarSection(SlottedSection):
    """Star plates with one slot per plate, at even distances along the axis."""

    kind: Literal["star"]
    thickness: Size
    layers: Annotated[Whole, Field(ge=2, le=100)] = 2


ConnectorSection = Annotated[CylinderSection | StarSection, Field(discriminator="kind")]


class BeamsSection(Section):
    """Rectangular beams along the edges of a planar net, mitred or set back at the nodes."""

    width: Size
    height: Size
    setback: Annotated[
        Distance, Field(description="from the node, where connectors join the beams")
    ] = 0.0


class MouldsSection(Section):
    """Moulds for panels bent to the surface: how many, within *tolerance* mm."""

    tolerance: Size


class FacadeSection(Section):
    """Flat triangles, two per bay of an asymptotic net, and profiles along its diagonals."""

    thickness: Size
    gap: Distance = 10.0
    clearance: Distance = 0.0
    material: Sheeting = "glass"
    above: Annotated[
        Distance | None, Field(description="half the strip's width: on its upper edge")
    ] = None
    rule: Literal["shorter", "flatter"] = "shorter"
