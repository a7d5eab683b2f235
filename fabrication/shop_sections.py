"""The section of a project that says what a shop can cut and how it wants its files: mm."""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import Field

from fabrication.section_types import Distance, Section, Size


class LayersSection(Section):
    """The shop's names for the layers; holes lie with the cuts unless DRILL names their own."""

    CUT: str = "CUT"
    MARK: str = "MARK"
    TEXT: str = "TEXT"
    SHEET: str = "SHEET"
    DRILL: Annotated[str | None, Field(description="that of the cuts")] = None


class ShopSection(Section):
    """A process and what a shop asks for beyond it."""

    process: Literal["laser", "waterjet", "router", "saw"]
    tool: Annotated[Size | None, Field(description="diameter of cutter or jet: by process")] = None
    min_web: Annotated[Distance | None, Field(description="between cuts: the thickness")] = None
    min_hole: Annotated[Distance | None, Field(description="the thickness, the tool")] = None
    min_edge: Annotated[Distance | None, Field(description="beside holes: the thickness")] = None
    min_slot: Annotated[Distance | None, Field(description="by process and thickness")] = None
    kerf: Annotated[Distance | None, Field(description="by process")] = None
    compensate: Annotated[
        bool, Field(description="lines half a kerf outside, for shops that cut on the line")
    ] = False
    bed: Annotated[tuple[Size, Size] | None, Field(description="any size")] = None
    layers: LayersSection = LayersSection()
    files: Annotated[str, Field(description="keys: name, material, thickness, prefix, number")] = (
        "{prefix}-{number}"
    )
    version: Literal["R12", "R2000", "R2010", "R2013"] = "R2010"
