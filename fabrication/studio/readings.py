"""The figures beside the view: those of ``report.json``, in the words of the report."""

from __future__ import annotations

from dataclasses import dataclass

from fabrication.lamella_system import LamellaSystem
from fabrication.panel_route import PanelNetSystem
from fabrication.studio.design import Built, NetDesign
from fabrication.words import fixed, number, plural
from gridshell import Spread


@dataclass(frozen=True)
class Reading:
    """One figure: a key that tests and styles go by, its name, and its value in words."""

    key: str
    label: str
    value: str


def net_readings(net: NetDesign) -> list[Reading]:
    """Of the net."""
    quality = net.quality
    low, high = quality.node_angle_deg
    found = [Reading("node_angle_deg", "Node angle", f"{fixed(low, 2)} to {fixed(high, 2)}°")]
    found += _largest("angle_error_deg", "Angle error, largest", quality.angle_error_deg, "°")
    found += _largest("star_planarity", "Star planarity, largest", quality.star_planarity, "")
    found += _largest("face_planarity", "Face planarity, largest", quality.face_planarity, "")
    found += _largest(
        "surface_distance_mm", "Distance to surface, largest", quality.surface_distance_mm, " mm"
    )
    shortest, longest = (number(ratio, 3) for ratio in quality.edge_ratio)
    control = net.result.control
    return [
        *found,
        Reading("edge_ratio", "Edge ratio", f"{shortest} to {longest}"),
        Reading("faces", "Control quads", number(len(control.quads))),
        Reading("steps", "Steps", f"{len(net.residuals)} in {fixed(net.seconds, 2)} s"),
    ]


def _largest(key: str, label: str, spread: Spread | None, unit: str) -> list[Reading]:
    return [] if spread is None else [Reading(key, label, f"{number(spread.max)}{unit}")]


def built_readings(built: Built) -> list[Reading]:
    """Of what is built."""
    system = built.system
    if isinstance(system, LamellaSystem):
        design, parts = system.jointed.design, system.parts
        density = design.profile.material.density
        length = sum(part.quantity * part.length for part in parts) / 1e3
        mass = sum(part.quantity * part.volume for part in parts) * density * 1e-9
        used = 100.0 * float(system.stress.utilisation.max(initial=0.0))
        return [
            Reading("lamellas", "Lamellas", number(len(design.lamellas))),
            Reading("nodes", "Nodes", number(len(design.nodes))),
            Reading("total_length_m", "Total length", f"{fixed(length, 1)} m"),
            Reading("mass_kg", "Mass", f"{number(mass)} kg"),
            Reading("utilisation", "Strength used, largest", f"{fixed(used, 0)} %"),
        ]
    if isinstance(system, PanelNetSystem):
        panels = system.built.panels
        area = sum(panel.area for panel in panels) / 1e6
        groups = plural(len(system.built.panel_groups), "group")
        return [
            Reading("panels", "Panels", f"{len(panels)} in {groups}"),
            Reading("plates", "Support plates", number(len(system.built.plates))),
            Reading("panel_area_m2", "Area of panels", f"{fixed(area, 2)} m²"),
        ]
    raise AssertionError("there are two kinds of systems")
