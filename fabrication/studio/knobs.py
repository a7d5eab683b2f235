"""What of a project can be turned while looking: angle, edge length, profile, weights, opening."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from math import log10

from fabrication.sections import Project
from fabrication.source_sections import (
    USUAL_QUADS,
    AsymptoticPatchSection,
    BisectingPatchSection,
    ConjugatePatchSection,
    SingularPatchSection,
)

_FAIRNESS, _PROXIMITY = 1e-2, 0.1
"""What recipes begin with where the project says nothing."""


@dataclass(frozen=True)
class Knob:
    """A slider.

    Parameters
    ----------
    key : of the project.
    group : what it is listed under.
    value, low, high, step : in the project's own unit; of a logarithmic one powers of ten.
    whole : whether values are whole numbers.
    powers : whether the value is ten to the slider's place.
    live : whether a change is fast enough to follow the pointer.
    """

    key: str
    label: str
    group: str
    unit: str
    value: float
    low: float
    high: float
    step: float
    whole: bool = False
    powers: bool = False
    live: bool = True

    def chosen(self, place: float) -> float | int:
        """The project's value at *place* of the slider."""
        if self.powers:
            return float(f"{10.0**place:.3g}")
        return round(place) if self.whole else float(round(place, 6))

    def place(self, value: float) -> float | None:
        """Where *value* is on the slider; None where it has no place there."""
        if self.powers and value <= 0.0:
            return None
        found = log10(value) if self.powers else value
        return found if self.low <= found <= self.high else None


def knobs(project: Project) -> list[Knob]:
    """The sliders of *project*, in the order they are listed."""
    return [*_net(project), *_density(project), *_built(project), *_weights(project)]


def _net(project: Project) -> Iterator[Knob]:
    angle = project.net.angle
    if isinstance(angle, float | int):
        low, high = min(20.0, float(angle)), max(160.0, float(angle))
        yield Knob("net.angle", "Node angle", "Net", "°", float(angle), low, high, 0.5)
    if project.umbrella is not None:
        opening = project.umbrella.opening
        yield Knob("umbrella.opening", "Opening", "Net", "", opening, 0.0, 1.0, 0.01)


def _density(project: Project) -> Iterator[Knob]:
    match project.patch:
        case AsymptoticPatchSection(lamellas=counts):
            for n, letter in enumerate("AB"):
                label = f"Lamellas, family {letter}"
                yield _count(f"patch.lamellas.{n}", label, counts[n])
        case ConjugatePatchSection(panels=counts):
            for n, letter in enumerate("uv"):
                yield _count(f"patch.panels.{n}", f"Panels along {letter}", counts[n])
        case BisectingPatchSection(cells=count, u=None):
            yield _count("patch.cells", "Control quads around", count, least=4, step=2)
        case BisectingPatchSection(cells=count) | SingularPatchSection(cells=count):
            yield _count("patch.cells", "Control quads each way", count)
    remesh = project.remesh
    if remesh is not None and remesh.edge is not None:
        low, high = remesh.edge / 3.0, remesh.edge * 3.0
        yield Knob(
            *("remesh.edge", "Edge length", "Net", " mm", remesh.edge, low, high, low / 20.0),
            live=False,
        )
    elif remesh is not None:
        quads = remesh.quads or USUAL_QUADS
        low, high = max(1.0, quads / 4.0), quads * 4.0
        yield Knob(
            *("remesh.quads", "Quads of M", "Net", "", quads, round(low), round(high), 1.0),
            whole=True,
            live=False,
        )


def _count(key: str, label: str, count: int, *, least: int = 3, step: int = 1) -> Knob:
    low, high = min(least, count), max(40, 2 * count)
    return Knob(key, label, "Net", "", count, low, high, float(step), whole=True)


def _built(project: Project) -> Iterator[Knob]:
    profile, panels, supports = project.profile, project.panels, project.supports
    if profile is not None:
        yield _size("profile.width", "Width", "Profile", profile.width, 1.0)
        yield _size("profile.thickness", "Thickness", "Profile", profile.thickness, 0.1)
    if panels is not None:
        yield _size("panels.thickness", "Thickness of panels", "Panels", panels.thickness, 0.5)
        yield _size("panels.gap", "Gap between panels", "Panels", panels.gap, 0.5)
    if supports is not None:
        yield _size("supports.thickness", "Thickness of plates", "Panels", supports.thickness, 0.5)


def _size(key: str, label: str, group: str, value: float, step: float) -> Knob:
    low, high = max(step, round(value / 4.0 / step) * step), max(step, 3.0 * value)
    return Knob(key, label, group, " mm", value, min(low, value), high, step)


def _weights(project: Project) -> Iterator[Knob]:
    net = project.net
    yield _weight("net.fairness", "Fairness", net.fairness or _FAIRNESS)
    if net.keep_to_surface and project.umbrella is None:
        yield _weight("net.proximity", "Closeness to the surface", net.proximity or _PROXIMITY)


def _weight(key: str, label: str, value: float) -> Knob:
    return Knob(key, label, "Weights", "", log10(value), -5.0, 3.0, 0.1, powers=True)
