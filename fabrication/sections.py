"""The sections of a project file as types, each with its limits.

Lengths are mm and angles degrees here and nowhere below.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import Annotated, Any, Literal

from pydantic import Field, ValidationError, field_validator, model_validator
from pydantic_core import InitErrorDetails, PydanticCustomError

from fabrication.angle_sections import AngleChoice, MirrorSection, NodeAngle, Point
from fabrication.export_sections import ExportSection
from fabrication.joint_sections import JointSection
from fabrication.lamella_sections import (
    BarsSection,
    FlatSection,
    PapersSection,
    SegmentsSection,
)
from fabrication.motion_sections import MotionSection, UmbrellaSection
from fabrication.panel_sections import (
    BeamsSection,
    ConnectorSection,
    FacadeSection,
    MouldsSection,
    PanelsSection,
    SupportsSection,
)
from fabrication.section_types import (
    Distance,
    Positive,
    Section,
    SheetMetal,
    Size,
    Whole,
)
from fabrication.shop_sections import ShopSection
from fabrication.source_sections import (
    FileSurface,
    MeshSection,
    PatchSection,
    RemeshSection,
    RemeshSource,
    SurfaceSection,
    SurfaceSource,
)

WeightNumber = Annotated[float, Field(ge=1e-6, le=1e4)]
"""Of a guiding term, at unit mean edge."""


class NetSection(Section):
    """What the net must be and what holds its shape meanwhile."""

    kind: Literal["asymptotic", "planar"] = "asymptotic"
    angle: Annotated[
        AngleChoice | None, Field(description="the angles of the net it begins with")
    ] = None
    angle_between: Annotated[
        tuple[NodeAngle, NodeAngle] | None, Field(description="any, of asymptotic nets only")
    ] = None
    near_rhombi: bool = False
    mirror: Annotated[
        MirrorSection | None, Field(description="no symmetry, of asymptotic nets only")
    ] = None
    rhombus: bool = False
    square: bool = False
    anchor: Literal["free", "boundary-pinned", "boundary-glide", "supports"]
    supports: Annotated[
        tuple[Point, ...] | None, Field(description="with anchor = 'supports' only")
    ] = None
    keep_to_surface: bool = True
    skin: Literal["D1", "D2", "P"] = "D1"
    fairness: Annotated[WeightNumber | None, Field(description="0.01, less from step to step")] = (
        None
    )
    proximity: Annotated[WeightNumber | None, Field(description="0.1, less from step to step")] = (
        None
    )
    steps: Annotated[Whole, Field(ge=1, le=10_000)] = 30
    tolerance: Positive = 1e-9


class ProfileSection(Section):
    """The strip: width along the surface normal, thickness across, mm."""

    width: Size
    thickness: Size
    wall: Annotated[Size | None, Field(description="a solid strip")] = None
    material: SheetMetal
    overhang: Annotated[Size | None, Field(description="half the width")] = None


class SheetSection(Section):
    """Raw sheets, mm."""

    length: Size
    width: Size
    margin: Distance = 10.0
    gap: Distance = 10.0


class Project(Section):
    """A whole project."""

    name: Annotated[str, Field(min_length=1, max_length=80)]
    surface: SurfaceSection | None = None
    patch: PatchSection | None = None
    remesh: RemeshSection | None = None
    mesh: MeshSection | None = None
    umbrella: UmbrellaSection | None = None
    net: NetSection
    profile: ProfileSection | None = None
    joint: JointSection | None = None
    bars: BarsSection | None = None
    shop: ShopSection | None = None
    flat: FlatSection | None = None
    papers: PapersSection | None = None
    motion: MotionSection | None = None
    segments: SegmentsSection | None = None
    export: ExportSection | None = None
    facade: FacadeSection | None = None
    panels: PanelsSection | None = None
    supports: SupportsSection | None = None
    connector: ConnectorSection | None = None
    beams: BeamsSection | None = None
    moulds: MouldsSection | None = None
    sheet: SheetSection
    panel_sheet: SheetSection | None = None

    @property
    def source(self) -> MeshSection | SurfaceSource | RemeshSource | UmbrellaSection:
        """Where the net comes from; the validator below makes sure there is exactly one place."""
        surface, patch, remesh, mesh = self.surface, self.patch, self.remesh, self.mesh
        if self.umbrella is not None:
            if (surface, patch, remesh, mesh) == (None, None, None, None):
                return self.umbrella
        elif mesh is not None:
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
        raise ValueError("give either [surface] with [patch] or [remesh], or [mesh], or [umbrella]")

    @field_validator("surface", mode="before")
    @classmethod
    def _from_file(cls, value: Any) -> Any:
        """A surface that names a file needs no kind."""
        if isinstance(value, dict) and "file" in value and "kind" not in value:
            return {"kind": "imported", **value}
        return value

    @field_validator("connector", mode="before")
    @classmethod
    def _cylinder(cls, value: Any) -> Any:
        """A connector that names no kind is a cylinder."""
        if isinstance(value, dict) and "kind" not in value:
            return {"kind": "cylinder", **value}
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

    @model_validator(mode="after")
    def _one_kind(self) -> Project:
        mistakes = [*_foreign(self), *_missing(self)]
        if mistakes:
            raise ValidationError.from_exception_data("Project", mistakes)
        return self


_SECTIONS = {
    "asymptotic": (
        *("umbrella", "profile", "joint", "facade", "bars", "shop", "flat", "papers", "motion"),
        "segments",
    ),
    "planar": ("panels", "supports", "connector", "beams"),
}
_NEEDED = {"asymptotic": ("profile", "joint"), "planar": ("panels",)}
_ALONG = {"asymptotic": "lamellas_along", "planar": "panels_along"}


def _foreign(project: Project) -> Iterator[InitErrorDetails]:
    """Settings that the project's kind of net does not have."""
    kind = project.net.kind
    other = "planar" if kind == "asymptotic" else "asymptotic"
    for name in _SECTIONS[other]:
        if getattr(project, name) is not None:
            yield _mistake((name,), f"net.kind = '{kind}'", f"net.kind = '{other}' only")
    hinged = project.joint is not None and project.joint.kind == "hinged"
    if project.profile is not None and project.profile.wall is not None and not hinged:
        named = "no joint" if project.joint is None else f"joint.kind = '{project.joint.kind}'"
        yield _mistake(("profile", "wall"), named, "joint.kind = 'hinged' only")
    if project.panel_sheet is not None and project.panels is None and project.facade is None:
        yield _mistake(("panel_sheet",), "no panels", "projects with [panels] or [facade]")
    if project.connector is not None and project.supports is None:
        yield _mistake(("connector",), "no [supports]", "projects with [supports]")
    if project.mesh is not None and getattr(project.mesh, _ALONG[other]) is not None:
        yield _mistake(("mesh", _ALONG[other]), f"net.kind = '{kind}'", f"mesh.{_ALONG[kind]}")
    held = project.net.anchor == "supports"
    if project.net.supports is not None and not held:
        yield _mistake(("net", "supports"), f"anchor = '{project.net.anchor}'", "anchor 'supports'")
    if kind == "planar":
        for name in ("angle_between", "near_rhombi", "mirror"):
            if getattr(project.net, name):
                yield _mistake(("net", name), "net.kind = 'planar'", "net.kind = 'asymptotic' only")
        return
    for name in ("rhombus", "square"):
        if getattr(project.net, name):
            yield _mistake(("net", name), "net.kind = 'asymptotic'", "net.kind = 'planar' only")
    if project.net.skin == "P":
        yield _mistake(("net", "skin"), "'P' with net.kind = 'asymptotic'", "D1, D2")


def _missing(project: Project) -> Iterator[InitErrorDetails]:
    kind = project.net.kind
    for name in _NEEDED[kind]:
        if getattr(project, name) is None:
            yield InitErrorDetails(type="missing", loc=(name,), input=None)
    hinged = project.joint is not None and project.joint.kind == "hinged"
    if hinged and project.profile is not None and project.profile.wall is None:
        yield InitErrorDetails(type="missing", loc=("profile", "wall"), input=None)
    if project.net.anchor == "supports" and project.net.supports is None:
        yield InitErrorDetails(type="missing", loc=("net", "supports"), input=None)
    if project.mesh is not None and project.mesh.along is None:
        yield InitErrorDetails(type="missing", loc=("mesh", _ALONG[kind]), input=None)


def _mistake(location: tuple[str, ...], value: str, limit: str) -> InitErrorDetails:
    kind = PydanticCustomError("foreign", "{value}, not {limit}", {"value": value, "limit": limit})
    return InitErrorDetails(type=kind, loc=location, input=None)
