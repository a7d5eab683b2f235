"""The sections of a project that say how lamellas are joined: mm and degrees."""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import Field

from fabrication.section_types import Distance, Section, SheetMetal, Size


class SlottedJoint(Section):
    """What all slotted joints have."""

    clearance: Distance = 0.3
    depth_clearance: Distance = 0.5


class SlotSection(SlottedJoint):
    """The slot joint (Fig. 15a)."""

    kind: Literal["slot"]
    weld: Annotated[Distance, Field(description="seam in each corner of a node")] = 0.0


class WasherSection(Section):
    """Star washers above and below: crosses cut from sheet."""

    thickness: Size
    arm: Annotated[Size, Field(description="width of the arms")]
    beyond: Annotated[Size, Field(description="length beyond the crossings")] = 8.0
    material: Annotated[SheetMetal | None, Field(description="that of the strips")] = None


class DoubleSlotSection(SlottedJoint):
    """Double lamellas with double slots and one bolt (Fig. 15d)."""

    kind: Literal["double-slot"]
    spacing: Annotated[Size, Field(description="between the middles of the two strips")]
    bolt: Annotated[Size, Field(description="diameter")]
    washer: WasherSection


JointSection = Annotated[SlotSection | DoubleSlotSection, Field(discriminator="kind")]
