"""The sections of a project on nets that move: an umbrella and its motion. mm and degrees."""

from __future__ import annotations

from typing import Annotated

from pydantic import Field

from fabrication.angle_sections import NodeAngle
from fabrication.section_types import Number, Section, Size, Whole


class UmbrellaSection(Section):
    """A net of revolution by the lengths that its motion keeps (Fig. 18)."""

    ribs: Annotated[Whole, Field(ge=3, le=1000)]
    radius: Size
    bays: tuple[Size, ...]
    opening: Annotated[Number, Field(ge=0.0, le=1.0)] = 0.3


class MotionSection(Section):
    """The way from the closed to the opened position."""

    positions: Annotated[Whole, Field(ge=2, le=1000)] = 60
    cable: Annotated[
        tuple[Whole, Whole] | None, Field(description="from the base ring to the highest above it")
    ] = None
    smallest: Annotated[
        NodeAngle | None, Field(description="what hinges let be, 10 degrees without")
    ] = None
    largest: NodeAngle = 170.0
