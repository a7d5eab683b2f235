"""The sections of a project file as types, each with its limits.

Lengths are mm and angles degrees here and nowhere below.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated, Any, Literal

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
"""Nodes of the largest net that is tried, and quads of the largest mesh."""

USUAL_QUADS = 500
"""Of a mesh laid over a surface."""

Number = Annotated[float, Field(strict=True, allow_inf_nan=False)]
Positive = Annotated[Number, Field(gt=0.0, le=1e9)]
Size = Annotated[Number, Field(ge=1e-3, le=1e7)]
"""From a micrometre to ten kilometres, in mm."""
Distance = Annotated[Number, Field(ge=0.0, le=1e7)]
Parameter = Annotated[Number, Field(ge=-1e3, le=1e3)]
Whole = Annotated[int, Field(strict=True)]
Count = Annotated[Whole, Field(ge=2, le=MOST_NODES)]
Range = tuple[Parameter, Parameter]
UnitName = Literal["mm", "cm", "m", "inch", "foot"]


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


class FileSurface(Section):
    """A surface from a file: triangles, B-rep faces, or boundary curves of a minimal surface."""

    kind: Literal["imported"] = "imported"
    file: str
    unit: Annotated[UnitName | None, Field(description="the one a STEP or IGES file states")] = None


SurfaceSection = Annotated[
    EnneperSurface
    | CatenoidSurface
    | HelicoidSurface
    | HyparSurface
    | HyperboloidSurface
    | ScherkSurface
    | TorusSurface
    | SphereSurface
    | FileSurface,
    Field(discriminator="kind"),
]
AnalyticSection = (
    EnneperSurface
    | CatenoidSurface
    | HelicoidSurface
    | HyparSurface
    | HyperboloidSurface
    | ScherkSurface
    | TorusSurface
    | SphereSurface
)


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
    unit: UnitName
    lamellas_along: Literal["edges", "diagonals"]


class GuideSection(Section):
    """Lines of a file that the lines of one family shall follow."""

    file: str
    family: Annotated[Whole, Field(ge=1, le=2)] = 1


class RemeshSection(Section):
    """The quad mesh that is laid over a surface from a file; its edges become the lamellas."""

    directions: Literal["asymptotic", "principal", "conjugate"]
    angle: Annotated[
        Annotated[Number, Field(gt=0.0, lt=180.0)] | None,
        Field(description="of conjugate directions only"),
    ] = None
    hand: Annotated[
        Literal["left", "right"] | None, Field(description="of conjugate directions only")
    ] = None
    infeasible: Annotated[
        Literal["widen", "clamp", "refuse"] | None,
        Field(description="of conjugate directions only"),
    ] = None
    quads: Annotated[
        Annotated[Whole, Field(ge=1, le=MOST_NODES)] | None,
        Field(description=f"{USUAL_QUADS}, unless edge says otherwise"),
    ] = None
    edge: Annotated[Size | None, Field(description="as long as the number of quads makes it")] = (
        None
    )
    extent: Literal["inside", "cover", "trimmed"] = "inside"
    guides: list[GuideSection] = Field(default_factory=list)


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

    surface: AnalyticSection
    patch: PatchSection


@dataclass(frozen=True)
class RemeshSource:
    """A surface from a file and the quad mesh that is laid over it."""

    surface: FileSurface
    remesh: RemeshSection


class Project(Section):
    """A whole project."""

    name: Annotated[str, Field(min_length=1, max_length=80)]
    surface: SurfaceSection | None = None
    patch: PatchSection | None = None
    remesh: RemeshSection | None = None
    mesh: MeshSection | None = None
    net: NetSection
    profile: ProfileSection
    joint: SlotSection
    sheet: SheetSection

    @property
    def source(self) -> MeshSection | SurfaceSource | RemeshSource:
        """Where the net comes from; the validator below makes sure there is exactly one place."""
        surface, patch, remesh, mesh = self.surface, self.patch, self.remesh, self.mesh
        if mesh is not None:
            if (surface, patch, remesh) == (None, None, None):
                return mesh
        elif isinstance(surface, FileSurface):
            if patch is not None:
                raise ValueError("a [surface] from a file goes with [remesh], not with [patch]")
            if remesh is None:
                raise ValueError(
                    "a [surface] from a file needs [remesh]; a quad mesh is named by [mesh]"
                )
            return RemeshSource(surface, remesh)
        elif remesh is not None:
            raise ValueError("[remesh] needs a [surface] with a file")
        elif surface is not None and patch is not None:
            return SurfaceSource(surface, patch)
        raise ValueError("give either [surface] with [patch] or [remesh], or [mesh]")

    @field_validator("surface", mode="before")
    @classmethod
    def _from_file(cls, value: Any) -> Any:
        """A surface that names a file needs no kind."""
        if isinstance(value, dict) and "file" in value and "kind" not in value:
            return {"kind": "imported", **value}
        return value

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
