"""Where a net comes from, as sections of a project file: surfaces, patches, meshes, remeshing."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated, Literal

from pydantic import Field

from fabrication.section_types import (
    MOST_NODES,
    Count,
    Number,
    Range,
    Section,
    Size,
    UnitName,
    Whole,
)

USUAL_QUADS = 500
"""Of a mesh laid over a surface."""


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


class ConjugatePatchSection(Section):
    """Panels along the conjugate parameters u and v, as many as said each way, for planar nets.

    Without u the patch closes into a ring.
    """

    layout: Literal["conjugate"]
    v: Range
    panels: tuple[Count, Count]
    u: Annotated[Range | None, Field(description="all around")] = None


class SingularPatchSection(Section):
    """Sectors of control quads around a central singularity, on Enneper's surfaces (Fig. 13)."""

    layout: Literal["singular"]
    valence: Whole
    cells: Count
    reach: Number
    cut: Annotated[Whole, Field(ge=0)] = 0


PatchSection = Annotated[
    AsymptoticPatchSection | BisectingPatchSection | ConjugatePatchSection | SingularPatchSection,
    Field(discriminator="layout"),
]


class MeshSection(Section):
    """A quad mesh from a file: its edges or its diagonals become the net."""

    file: str
    unit: Annotated[UnitName | None, Field(description="the one a .3dm file states")] = None
    lamellas_along: Annotated[
        Literal["edges", "diagonals"] | None, Field(description="of asymptotic nets only")
    ] = None
    panels_along: Annotated[
        Literal["edges", "diagonals"] | None, Field(description="of planar nets only")
    ] = None

    @property
    def along(self) -> Literal["edges", "diagonals"] | None:
        """Whichever of the two is given."""
        return self.lamellas_along or self.panels_along


class GuideSection(Section):
    """Lines of a file that the lines of one family shall follow."""

    file: str
    family: Annotated[Whole, Field(ge=1, le=2)] = 1


class RemeshSection(Section):
    """The quad mesh that is laid over a surface from a file; its edges become the net."""

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
