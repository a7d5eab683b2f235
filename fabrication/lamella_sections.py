"""The sections of a project on bars that strips are cut from, on a flat segment, and on papers."""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import Field

from fabrication.joint_sections import OwnOrStrips
from fabrication.section_types import Distance, Number, Place, Section, Size, Whole


class SpliceSection(Section):
    """Plates that join the pieces of a strip longer than a bar, mm."""

    length: Size
    width: Annotated[Size | None, Field(description="three quarters of the strip's")] = None
    thickness: Annotated[Size | None, Field(description="that of the strips")] = None
    bolt: Size = 6.0
    bolts: Annotated[Whole, Field(ge=1, le=20)] = 2
    sides: Annotated[Whole, Field(ge=1, le=2)] = 2
    gap: Distance = 1.0
    clear: Distance = 5.0
    material: OwnOrStrips = None


class BarsSection(Section):
    """Bars as wide and thick as the strips, which are cut from them instead of from sheets, mm."""

    length: Size
    kerf: Distance = 3.0
    trim: Distance = 10.0
    prefer: Literal["few-splices", "balanced", "few-bars"] = "balanced"
    shortest: Distance = 500.0
    splice: Annotated[
        SpliceSection | None, Field(description="no strip may be longer than a bar")
    ] = None


class SegmentsSection(Section):
    """Copies of the net around a vertical axis; everything else describes one of them. mm."""

    count: Annotated[Whole, Field(ge=2, le=1000)]
    centre: tuple[Place, Place] = (0.0, 0.0)
    seam: Distance = 0.0
    hang: bool = True


class FlatSection(Section):
    """The flat scissor state: degrees, and mm of the ground or the lorry it must fit."""

    opening: Annotated[
        Annotated[Number, Field(gt=0.0, lt=180.0)] | None,
        Field(description="the angles of the net"),
    ] = None
    lamellas: Annotated[tuple[str, ...] | None, Field(description="all")] = None
    length: Annotated[Size | None, Field(description="any")] = None
    width: Annotated[Size | None, Field(description="any")] = None


class PapersSection(Section):
    """Drawings and papers for the shop."""

    drawings: bool = True
    paper: Literal["A4", "A3", "A2", "A1"] = "A3"
    revision: str = ""
    labels: bool = False
    templates: Annotated[Literal["A4", "A3"] | None, Field(description="none at full size")] = None
    coupon: bool = False
