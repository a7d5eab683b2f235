"""The sections of a project that say how lamellas are joined: mm and degrees."""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import Field

from fabrication.section_types import Distance, Number, Section, SheetMetal, Size, Whole

Sharp = Annotated[Number, Field(gt=0.0, le=90.0)]
"""An angle between two strips, degrees."""

OwnOrStrips = Annotated[SheetMetal | None, Field(description="that of the strips")]


class SlottedJoint(Section):
    """What all slotted joints have."""

    clearance: Distance = 0.3
    depth_clearance: Distance = 0.5


class SlotSection(SlottedJoint):
    """The slot joint (Fig. 15a)."""

    kind: Literal["slot"]
    weld: Annotated[Distance, Field(description="seam in each corner of a node")] = 0.0


class ScissorSection(SlottedJoint):
    """Loose slots: the grid is slotted flat, opens like scissors and is pulled up."""

    kind: Literal["scissor"]
    opens_from: Sharp = 45.0
    control: Annotated[Sharp, Field(description="play of the angle that is told")] = 10.0


class WasherSection(Section):
    """Star washers above and below: crosses cut from sheet."""

    thickness: Size
    arm: Size
    beyond: Size = 8.0
    material: OwnOrStrips = None


class DoubleSlotSection(SlottedJoint):
    """Double lamellas with double slots and one bolt (Fig. 15d)."""

    kind: Literal["double-slot"]
    spacing: Size
    bolt: Size
    washer: WasherSection


class CleatSection(Section):
    """Angles in the corners between a piece and the strip that runs through."""

    leg: Size
    thickness: Size
    height: Size
    play: Distance = 0.5
    material: OwnOrStrips = None


class ReciprocalSection(Section):
    """Segmented, reciprocal lamellas (Fig. 15b): bay pieces between strips that run through."""

    kind: Literal["reciprocal"]
    gap: Distance = 0.5
    through: Literal["A", "B"] = "A"
    pinwheel: bool = False
    square_ends: bool = False
    weld: Annotated[Distance | None, Field(description="twice the width, per end")] = None
    cleat: Annotated[CleatSection | None, Field(description="welded only")] = None
    shortest: Annotated[Size | None, Field(description="twice the width")] = None
    sharpest: Sharp = 30.0


class StudSection(Section):
    """The stud of a node: solid, or a pipe with a wall."""

    material: OwnOrStrips = None
    size: Annotated[Size | None, Field(description="what the strips leave")] = None
    length: Annotated[Size | None, Field(description="over both levels")] = None
    wall: Distance = 0.0
    fit: Distance = 0.2
    step: Distance = 0.1


class BlocksSection(Section):
    """Shear blocks between the two profiles of an axis."""

    per_bay: Annotated[Whole, Field(ge=1, le=100)] = 1
    length: Size
    height: Annotated[Size | None, Field(description="the strips' width")] = None
    bolt: Distance = 0.0
    play: Distance = 0.1
    step: Size = 0.1
    material: OwnOrStrips = None


class StudJointSection(Section):
    """Double profiles on two levels, connected by studs (Fig. 15c, Fig. 14)."""

    kind: Literal["two-level"]
    spacing: Size
    level: Annotated[Size | None, Field(description="half the width and 1 mm")] = None
    bolt: Distance = 0.0
    stud: StudSection = StudSection()
    blocks: Annotated[BlocksSection | None, Field(description="no shear blocks")] = None


class HingedSection(Section):
    """Hollow sections on two levels, a pin in every node (Fig. 18)."""

    kind: Literal["hinged"]
    pin: Size
    gap: Size = 4.0
    play: Distance = 0.3


JointSection = Annotated[
    SlotSection
    | ScissorSection
    | ReciprocalSection
    | StudJointSection
    | DoubleSlotSection
    | HingedSection,
    Field(discriminator="kind"),
]
