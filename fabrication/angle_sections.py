"""The angle of ``[net]``: one for all, a formula, or a field over the surface. Degrees and mm."""

from __future__ import annotations

from typing import Annotated, Any, Literal

from pydantic import Discriminator, Field, Tag

from fabrication.section_types import Number, Place, Section, UnitName

NodeAngle = Annotated[Number, Field(gt=0.0, lt=180.0)]
Point = tuple[Place, Place, Place]


class MirrorSection(Section):
    """A plane that the net is symmetric about: a point of it, mm, and its normal."""

    point: Point = (0.0, 0.0, 0.0)
    normal: Point


class RadialAngleSection(Section):
    """An angle that changes with the distance from a centre, mm."""

    kind: Literal["radial"]
    centre: Point = (0.0, 0.0, 0.0)
    radii: tuple[Place, Place]
    angles: tuple[NodeAngle, NodeAngle]


class AngleAlongSection(Section):
    """An angle that changes along a direction, between stations in mm."""

    kind: Literal["along"]
    direction: Point
    stations: tuple[Place, ...]
    angles: tuple[NodeAngle, ...]


class SampledAngleSection(Section):
    """An angle through samples: a text file with x, y, z and degrees in every line."""

    kind: Literal["samples"]
    file: str
    unit: UnitName


class FormulaAngleSection(Section):
    """An angle by a formula in x, y, z and r, the distance from a centre; mm to degrees."""

    kind: Literal["formula"]
    formula: str
    centre: Point = (0.0, 0.0, 0.0)


FieldSection = RadialAngleSection | AngleAlongSection | SampledAngleSection | FormulaAngleSection


def _tag(value: Any) -> str | None:
    """The tag of an angle: a number, a formula in quotes, or a table by its kind."""
    if isinstance(value, dict | Section):
        kind = value.get("kind") if isinstance(value, dict) else getattr(value, "kind", None)
        return f"{kind} angle" if kind in _KINDS else None
    return "quoted angle" if isinstance(value, str) else "constant angle"


_KINDS = ("radial", "along", "samples", "formula")
ANGLE_CHOICES = f"degrees, a formula in quotes, or a table whose kind is {', '.join(_KINDS)}"

AngleChoice = Annotated[
    Annotated[NodeAngle, Tag("constant angle")]
    | Annotated[str, Tag("quoted angle")]
    | Annotated[RadialAngleSection, Tag("radial angle")]
    | Annotated[AngleAlongSection, Tag("along angle")]
    | Annotated[SampledAngleSection, Tag("samples angle")]
    | Annotated[FormulaAngleSection, Tag("formula angle")],
    Discriminator(_tag, custom_error_type="angle_choice", custom_error_message=ANGLE_CHOICES),
]
