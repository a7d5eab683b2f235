"""The project file: typed, validated, every error names its key.

Lengths are mm and angles degrees here and nowhere below. A project says *where* the net comes
from (``[surface]`` with ``[patch]``, or ``[mesh]``), *what* it must be (``[net]``) and *how* it is
built (``[profile]``, ``[joint]``, ``[sheet]``).
"""

from __future__ import annotations

import difflib
import tomllib
from dataclasses import dataclass
from pathlib import Path
from typing import Annotated, Literal, get_args

from pydantic import (
    BaseModel,
    ConfigDict,
    Discriminator,
    Field,
    Tag,
    ValidationError,
    model_validator,
)

from fabrication.errors import ProjectError

Number = Annotated[float, Field(strict=True, allow_inf_nan=False)]
Positive = Annotated[Number, Field(gt=0.0)]
Distance = Annotated[Number, Field(ge=0.0)]
Whole = Annotated[int, Field(strict=True)]
Range = tuple[Number, Number]


class _Section(BaseModel):
    model_config = ConfigDict(extra="forbid", frozen=True, strict=False)


class EnneperSurface(_Section):
    """Enneper's surface; *scale* mm per unit of its formula."""

    kind: Literal["enneper"]
    scale: Positive


class CatenoidSurface(_Section):
    """Catenoid with a waist of *radius* mm."""

    kind: Literal["catenoid"]
    radius: Positive


class HelicoidSurface(_Section):
    """Helicoid rising by *pitch* mm per turn."""

    kind: Literal["helicoid"]
    pitch: Positive


class HyparSurface(_Section):
    """Hyperbolic paraboloid z = x y / scale."""

    kind: Literal["hypar"]
    scale: Positive


class HyperboloidSurface(_Section):
    """Hyperboloid of one sheet: waist *radius*, z = *height* times tan v."""

    kind: Literal["hyperboloid"]
    radius: Positive
    height: Positive


class ScherkSurface(_Section):
    """Scherk's surface; *scale* mm per unit of its formula."""

    kind: Literal["scherk"]
    scale: Positive


class TorusSurface(_Section):
    """Torus; only its inner half carries asymptotic nets."""

    kind: Literal["torus"]
    major: Positive
    minor: Positive


class SphereSurface(_Section):
    """Sphere: positively curved, no asymptotic net."""

    kind: Literal["sphere"]
    radius: Positive


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


class AsymptoticPatchSection(_Section):
    """Lamellas along the asymptotic parameters p and q, from edge to edge of the patch."""

    layout: Literal["asymptotic"]
    p: Range
    q: Range
    lamellas: tuple[Whole, Whole]


class BisectingPatchSection(_Section):
    """Control quads along u = (p + q) / 2 and v = (p - q) / 2; lamellas cross them diagonally.

    Without u the patch closes into a ring.
    """

    layout: Literal["bisecting"]
    v: Range
    cells: Whole
    u: Range | None = None


PatchSection = Annotated[
    AsymptoticPatchSection | BisectingPatchSection, Field(discriminator="layout")
]


class MeshSection(_Section):
    """A quad mesh from a file: its edges or its diagonals become the lamellas."""

    file: str
    unit: Literal["mm", "cm", "m", "inch", "foot"]
    lamellas_along: Literal["edges", "diagonals"]


class NetSection(_Section):
    """What the net must be and what holds its shape meanwhile."""

    kind: Literal["asymptotic"] = "asymptotic"
    angle: Annotated[Number, Field(gt=0.0, lt=180.0)] | None = None
    anchor: Literal["free", "boundary-pinned", "boundary-glide"]
    keep_to_surface: bool = True
    skin: Literal["D1", "D2"] = "D1"
    steps: Annotated[Whole, Field(ge=1)] = 30
    tolerance: Positive = 1e-9


class MaterialSection(_Section):
    """A material of one's own: N/mm2 and kg/m3."""

    name: str
    modulus: Positive
    strength: Positive
    density: Positive


class ProfileSection(_Section):
    """The strip: width along the surface normal, thickness across, mm."""

    width: Positive
    thickness: Positive
    material: Annotated[
        Annotated[Literal["S235", "stainless", "birch-ply"], Tag("known material")]
        | Annotated[MaterialSection, Tag("own material")],
        Discriminator(lambda value: f"{'own' if isinstance(value, dict) else 'known'} material"),
    ]
    overhang: Positive | None = None


class SlotSection(_Section):
    """The slot joint (Fig. 15a): clearances in mm."""

    kind: Literal["slot"]
    clearance: Distance = 0.3
    depth_clearance: Distance = 0.5


class SheetSection(_Section):
    """Raw sheets, mm."""

    length: Positive
    width: Positive
    margin: Distance = 10.0
    gap: Distance = 10.0


@dataclass(frozen=True)
class SurfaceSource:
    """A patch of an analytic surface."""

    surface: SurfaceSection
    patch: PatchSection


class Project(_Section):
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

    @model_validator(mode="after")
    def _one_source(self) -> Project:
        _ = self.source
        return self


def read_project(path: Path | str) -> Project:
    """Read and validate a project file.

    Raises
    ------
    ProjectError
        When the file is missing, is not TOML, or a key is wrong, missing or unknown.
    """
    path = Path(path)
    try:
        document = tomllib.loads(path.read_text(encoding="utf-8"))
    except OSError as error:
        raise ProjectError(
            "The project file cannot be read",
            where=str(path),
            value=error.strerror or type(error).__name__,
            advice="check the path",
        ) from None
    except (tomllib.TOMLDecodeError, UnicodeDecodeError) as error:
        raise ProjectError("The project file is not TOML", where=f"{path}: {error}") from None
    try:
        return Project.model_validate(document)
    except ValidationError as error:
        raise _explained(path, error) from None


def _explained(path: Path, error: ValidationError) -> ProjectError:
    """The first thing that is wrong, unknown keys before all others, as one sentence."""
    problems = error.errors(include_url=False)
    first = min(problems, key=lambda problem: problem["type"] != "extra_forbidden")
    key, location = _key(first["loc"]), first["loc"]
    others = len({_key(problem["loc"]) for problem in problems}) - 1
    more = f" ({others} more after this one)" if others else ""
    where = f"{path}, {key}" if key else str(path)
    message = first["msg"].removeprefix("Value error, ")
    if first["type"] == "extra_forbidden":
        return ProjectError(f"Unknown key{more}", where=where, advice=_nearest_key(location))
    if first["type"] == "missing" and isinstance(location[-1], int):
        limit = f"{location[-1] + 1} numbers"
        where, value = f"{path}, {_key(location[:-1])}", repr(first["input"])
        return ProjectError(f"A key has a wrong value{more}", where=where, value=value, limit=limit)
    if first["type"] == "missing":
        return ProjectError(f"A key is missing{more}", where=where, advice=f"add {key}")
    if first["type"] == "union_tag_invalid":
        return _unknown_choice(where, more, first["ctx"])
    if not key:
        return ProjectError(f"{message[0].upper()}{message[1:]}{more}", where=where)
    return ProjectError(
        f"A key has a wrong value{more}",
        where=where,
        value=repr(first["input"]),
        limit=message[0].lower() + message[1:],
    )


def _unknown_choice(where: str, more: str, context: dict[str, str]) -> ProjectError:
    choices = context["expected_tags"].replace("'", "")
    return ProjectError(
        f"A key has a wrong value{more}",
        where=f"{where}.{context['discriminator'].strip(chr(39))}",
        value=repr(context["tag"]),
        limit=choices,
        advice=_nearest(context["tag"], choices.split(", ")),
    )


def _sections() -> dict[str, type[_Section]]:
    """Every section by what stands for it in an error's place: its key, or its kind or layout."""
    named: dict[str, type[_Section]] = {
        "mesh": MeshSection,
        "net": NetSection,
        "profile": ProfileSection,
        "joint": SlotSection,
        "sheet": SheetSection,
        "own material": MaterialSection,
    }
    for union in (SurfaceSection, PatchSection):
        section: type[_Section]
        for section in get_args(get_args(union)[0]):
            tag = section.model_fields.get("kind") or section.model_fields["layout"]
            named[get_args(tag.annotation)[0]] = section
    return named


def _key(location: tuple[int | str, ...]) -> str:
    """The dotted key a person wrote; names of union branches are left out."""
    sections: list[type[_Section]] = [Project, *_sections().values()]
    fields = {name for section in sections for name in section.model_fields}
    *path, last = location or ("",)
    shown = [part for part in path if isinstance(part, int) or part in fields]
    branch = last not in fields and (last in _sections() or str(last).endswith(" material"))
    return ".".join(str(part) for part in (shown if branch else [*shown, last]))


def _nearest_key(location: tuple[int | str, ...]) -> str:
    """Advice: the key of the same section that looks most like the unknown one."""
    sections = _sections()
    inside = [sections[str(part)] for part in location[:-1] if str(part) in sections]
    return _nearest(str(location[-1]), list((inside[-1] if inside else Project).model_fields))


def _nearest(word: str, known: list[str]) -> str:
    match = difflib.get_close_matches(word, known, n=1, cutoff=0.5)
    return f"'{match[0]}'" if match else f"one of {', '.join(known)}"
