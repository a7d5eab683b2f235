"""What the sections of a project file are made of: numbers with their limits, units, a table."""

from __future__ import annotations

from typing import Annotated, Any, Literal

from pydantic import BaseModel, ConfigDict, Discriminator, Field, Tag

MOST_NODES = 100_000
"""Nodes of the largest net that is tried, and quads of the largest mesh."""

Number = Annotated[float, Field(strict=True, allow_inf_nan=False)]
Positive = Annotated[Number, Field(gt=0.0, le=1e9)]
Size = Annotated[Number, Field(ge=1e-3, le=1e7)]
"""From a micrometre to ten kilometres, in mm."""
Distance = Annotated[Number, Field(ge=0.0, le=1e7)]
Place = Annotated[Number, Field(ge=-1e7, le=1e7)]
"""Along an axis, in mm."""
Parameter = Annotated[Number, Field(ge=-1e3, le=1e3)]
Whole = Annotated[int, Field(strict=True)]
Count = Annotated[Whole, Field(ge=2, le=MOST_NODES)]
Range = tuple[Parameter, Parameter]
UnitName = Literal["mm", "cm", "m", "inch", "foot"]


class Section(BaseModel):
    """A table of the file: only known keys, frozen."""

    model_config = ConfigDict(extra="forbid", frozen=True, strict=False)


class MaterialSection(Section):
    """A material of one's own: N/mm2 and kg/m3."""

    name: str
    modulus: Positive
    strength: Positive
    density: Positive


def known_or_own(value: Any) -> str:
    """The tag of a material: one by its name, or a table."""
    return f"{'own' if isinstance(value, dict | MaterialSection) else 'known'} material"


OwnMaterial = Annotated[MaterialSection, Tag("own material")]
SheetName = Literal["S235", "S355", "stainless", "birch-ply", "poplar-ply", "GRP"]
SheetMetal = Annotated[
    Annotated[SheetName, Tag("known material")] | OwnMaterial,
    Discriminator(known_or_own),
]
Sheeting = Annotated[
    Annotated[Literal["glass"] | SheetName, Tag("known material")] | OwnMaterial,
    Discriminator(known_or_own),
]
