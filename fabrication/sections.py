"""The sections of a project file as types, each with its limits.

Lengths are mm and angles degrees here and nowhere below.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated, Literal

from pydantic import (
    BaseModel,
    ConfigDict,
    Discriminator,
    Field,
    Tag,
    field_validator,
    model_validator,
)

MOST_NODES = 100_000
"""Nodes of the largest net that is tried."""

Number = Annotated[float, Field(strict=True, allow_inf_nan=False)]
Positive = Annotated[Number, Field(gt=0.0, le=1e9)]
Size = Annotated[Number, Field(ge=1e-3, le=1e7)]
"""From a micrometre to ten kilometres, in mm."""
Distance = Annotated[Number, Field(ge=0.0, le=1e7)]
Parameter = Annotated[Number, Field(ge=-1e3, le=1e3)]
Whole = Annotated[int, Field(strict=True)]
Count = Annotated[Whole, Field(ge=2, le=MOST_NODES)]
Range = tuple[Parameter, Parameter]


class Section(BaseModel):
    """A table of the file: only known keys, frozen."""

    model_config = ConfigDict(extra="forbid", frozen=True, strict=False)


class EnneperSurface(Section):
    """Enneper's surface; *scale* mm per unit of its formula."""

    kind: Literal["enneper"]
    scale: Size


class CatenoidSurface(Section):
    """Catenoid with a waist of *radius* mm."""

    kind: Literal["catenoid"]
    radius: Size


class HelicoidSurface(Section):
    """Helicoid rising by *pitch* mm per turn."""

    kind: Literal["helicoid"]
    pitch: Size


class HyparSurface(Section):
    """Hyperbolic paraboloid z = x y / scale."""

    kind: Literal["hypar"]
    scale: Size


class HyperboloidSurface(Section):
    """Hyperboloid of one sheet: waist *radius*, z = *height* times tan v."""

    kind: Literal["hyperboloid"]
    radius: Size
    height: Size


class ScherkSurface(Section):
    """Scherk's surface; *scale* mm per unit of its formula."""

    kind: Literal["scherk"]
    scale: Size


class TorusSurface(Section):
    """Torus; only its inner half carries asymptotic nets."""

    kind: Literal["torus"]
    major: Size
    minor: Size


class SphereSurface(Section):
    """Sphere: positively curved, no asymptotic net."""

    kind: Literal["sphere"]
    radius: Size


SurfaceSection = Annotated[
    EnneperSurface
    | CatenoidSurface
    | HelicoidSurface
    | HyparSurface
    | HyperboloidSurface
    | ScherkSurface
    | TorusSurface
    | SphereSurface,
    Field(discriminator="kind"),
]


class AsymptoticPatchSection(Section):
    """Lamellas along the asymptotic parameters p and q, from edge to edge of the patch."""

    layout: Literal["asymptotic"]
    p: Range
    q: Range
    lamellas: tuple[Count, Count]


class BisectingPatchSection(Section):
    """Control quads along u = (p + q) / 2 and v = (p - q) / 2; lamellas cross them diagonally.

    Without u the patch closes into a ring.
    """

    layout: Literal["bisecting"]
    v: Range
    cells: Count
    u: Annotated[Range | None, Field(description="all around")] = None


PatchSection = Annotated[
    AsymptoticPatchSection | BisectingPatchSection, Field(discriminator="layout")
]


class MeshSection(Section):
    """A quad mesh from a file: its edges or its diagonals become the lamellas."""

    file: str
    unit: Literal["mm", "cm", "m", "inch", "foot"]
    lamellas_along: Literal["edges", "diagonals"]


class NetSection(Section):
    """What the net must be and what holds its shape meanwhile."""

    kind: Literal["asymptotic"] = "asymptotic"
    angle: Annotated[
        Annotated[Number, Field(gt=0.0, lt=180.0)] | None,
        Field(description="the angles of the net it begins with"),
    ] = None
    anchor: Literal["free", "boundary-pinned", "boundary-glide"]
    keep_to_surface: bool = True
    skin: Literal["D1", "D2"] = "D1"
    steps: Annotated[Whole, Field(ge=1, le=10_000)] = 30
    tolerance: Positive = 1e-9


class MaterialSection(Section):
    """A material of one's own: N/mm2 and kg/m3."""

    name: str
    modulus: Positive
    strength: Positive
    density: Positive


class ProfileSection(Section):
    """The strip: width along the surface normal, thickness across, mm."""

    width: Size
    thickness: Size
    material: Annotated[
        Annotated[Literal["S235", "stainless", "birch-ply"], Tag("known material")]
        | Annotated[MaterialSection, Tag("own material")],
        Discriminator(lambda value: f"{'own' if isinstance(value, dict) else 'known'} material"),
    ]
    overhang: Annotated[Size | None, Field(description="half the width")] = None


class SlotSection(Section):
    """The slot joint (Fig. 15a): clearances in mm."""

    kind: Literal["slot"]
    clearance: Distance = 0.3
    depth_clearance: Distance = 0.5


class SheetSection(Section):
    """Raw sheets, mm."""

    length: Size
    width: Size
    margin: Distance = 10.0
    gap: Distance = 10.0


@dataclass(frozen=True)
class SurfaceSource:
    """A patch of an analytic surface."""

    surface: SurfaceSection
    patch: PatchSection


class Project(Section):
    """A whole project."""

    name: Annotated[str, Field(min_length=1, max_length=80)]
    surface: SurfaceSection | None = None
    patch: PatchSection | None = None
    mesh: MeshSection | None = None
    net: NetSection
    profile: ProfileSection
    joint: SlotSection
    sheet: SheetSection

    @property
    def source(self) -> MeshSection | SurfaceSource:
        """Where the net comes from; the validator below makes sure there is exactly one place."""
        if self.mesh is not None and self.surface is None and self.patch is None:
            return self.mesh
        if self.mesh is None and self.surface is not None and self.patch is not None:
            return SurfaceSource(self.surface, self.patch)
        raise ValueError("give either [surface] with [patch], or [mesh]")

    @field_validator("name")
    @classmethod
    def _printable(cls, name: str) -> str:
        if not name.strip() or not name.isprintable():
            raise ValueError("one line of text that is not blank")
        return name

    @model_validator(mode="after")
    def _one_source(self) -> Project:
        _ = self.source
        return self
