"""The sections of a project on how strips are cut from bars, spliced, and drawn: mm."""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import Field

from fabrication.section_types import Distance, Section, SheetMetal, Size, Whole


class SpliceSection(Section):
    """Plates that join the pieces of a strip longer than a bar."""

    length: Size
    width: Annotated[Size | None, Field(description="three quarters of the strip's")] = None
    thickness: Annotated[Size | None, Field(description="that of the strips")] = None
    bolts: Annotated[Whole, Field(ge=1, le=20)] = 2
    bolt: Size = 8.0
    sides: Annotated[Whole, Field(ge=1, le=2)] = 2
    gap: Distance = 1.0
    material: Annotated[SheetMetal | None, Field(description="that of the strips")] = None


class BarsSection(Section):
    """Bars as wide and thick as the strips, which are cut from them instead of from sheets."""

    length: Size
    kerf: Distance = 3.0
    trim: Annotated[Distance, Field(description="cut off at either end of a bar")] = 10.0
    prefer: Literal["few-splices", "balanced", "few-bars"] = "balanced"
    splice: Annotated[
        SpliceSection | None, Field(description="no strip may be longer than a bar")
    ] = None


class PapersSection(Section):
    """Drawings and papers for the shop."""

    drawings: bool = True
    paper: Literal["A4", "A3", "A2", "A1"] = "A3"
    labels: bool = False
    templates: Annotated[
        Literal["A4", "A3"] | None, Field(description="no templates to print at full size")
    ] = None
    coupon: bool = False
    revision: str = ""
