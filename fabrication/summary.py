"""What the command line says of a run: a few lines from its report."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from fabrication.words import number, plural

Report = dict[str, Any]


def summary_lines(report: Report) -> list[str]:
    """What was built and how well, by the kind of net."""
    lines: Callable[[Report], list[str]] = _planar if "panels" in report["structure"] else _strips
    return [*lines(report), *_moulds(report.get("moulds"))]


def _moulds(found: Report | None) -> list[str]:
    if found is None:
        return []
    return [
        f"bent to the surface, {plural(found['panels'], 'panel')} would need "
        f"{plural(found['moulds'], 'mould')} within {number(found['tolerance_mm'], 2)} mm"
    ]


def _strips(report: Report) -> list[str]:
    built, closed, angle = report["structure"], report["closure"], report["net"]["node_angle_deg"]
    clash = report["fit"]["clash_mm3"]["max"]
    strips = (
        "" if built["strips"] == built["lamellas"] else f" in {plural(built['strips'], 'strip')}"
    )
    count = built.get("segments", 1)
    segments = "" if count == 1 else f"{plural(count, 'equal segment')}, each of "
    raw = "bar" if "bars" in report["stock"] else "sheet"
    lines = [
        f"{segments}{plural(built['lamellas'], 'lamella')}{strips}, "
        f"{plural(built['joints'], 'joint')}{', ' if count == 1 else '; all of them '}"
        f"{length(built['total_length_m'])}, {mass(built['mass_kg'])} on "
        f"{plural(built['sheets'], raw)}; "
        f"node angles {angle['min']:.2f} to {angle['max']:.2f} degrees{_at_joints(built)}",
        *_stock(report["stock"]),
        f"bent in, the material bears {100.0 * report['stress']['utilisation']['max']:.0f} % of "
        f"its strength at most, at {report['stress']['utilisation']['where']}",
        f"files close onto the design within {closed['max_mm']:.3f} mm, volumes within "
        f"{closed['volume_ppm']:.1f} ppm; largest clash {clash:.1g} mm3",
    ]
    glass = report.get("facade")
    if glass is not None:
        lines.append(
            f"facade of {plural(glass['panels'], 'triangular panel')} in "
            f"{plural(glass['panel_groups'], 'group')}, "
            f"{plural(glass['profiles'], 'secondary profile')}, {length(glass['profile_length_m'])}"
        )
    return lines


def _at_joints(built: Report) -> str:
    """The angles of strips at their nodes, which differ from those of the net's quads."""
    found = built.get("joint_angle_deg")
    return f", {found['min']:.2f} to {found['max']:.2f} at the joints" if found else ""


def _stock(stock: Report) -> list[str]:
    """Bars, whether fewer could do, and the splices they cost."""
    return [stock["bars"]["text"]] if "bars" in stock else []


def _planar(report: Report) -> list[str]:
    built, closed, angle = report["structure"], report["closure"], report["net"]["node_angle_deg"]
    parts = [f"{plural(built['panels'], 'panel')} in {plural(built['panel_groups'], 'group')}"]
    if built["plates"]:
        parts.append(plural(built["plates"], "support plate"))
    if built["connectors"]:
        parts.append(plural(built["connectors"], "connector"))
    if built.get("beams"):
        parts.append(plural(built["beams"], "beam"))
    lines = [
        f"{', '.join(parts)}, {mass(built['mass_kg'])} on {plural(built['sheets'], 'sheet')}; "
        f"node angles {angle['min']:.2f} to {angle['max']:.2f} degrees",
    ]
    held = report.get("supports")
    if held is not None:
        lines.append(
            f"plates within {number(held['out_of_plane_mm']['max'], 2)} mm of their planes "
            f"({number(held['classical_out_of_plane_mm']['max'], 2)} mm with averaged normals), "
            f"twisted by {number(held['twist_deg']['max'], 2)} degrees at most"
        )
    lines.append(
        f"files close onto the design within {closed['max_mm']:.3f} mm, volumes within "
        f"{closed['volume_ppm']:.1f} ppm"
    )
    return lines


def length(metres: float) -> str:
    """Metres, or millimetres where it is less than one."""
    return f"{metres:.1f} m" if metres >= 1.0 else f"{metres * 1e3:.0f} mm"


def mass(kilograms: float) -> str:
    """Kilograms, or grams where it is less than one."""
    return f"{kilograms:.1f} kg" if kilograms >= 1.0 else f"{kilograms * 1e3:.3g} g"


_LISTED = 6
"""Defaults that are named; the rest is counted."""


def defaults_line(defaults: Report) -> str:
    """What was decided because the project does not say, those that matter to a shop first.

    What was left out by default (False, 0) is not named.
    """
    decided = [key for key, value in defaults.items() if value]
    ordered = sorted(decided, key=_rank)
    named = [f"{key} = {_short(defaults[key])}" for key in ordered[:_LISTED]]
    more = len(ordered) - len(named)
    rest = f" and {more} more, see report.json" if more else ""
    return f"by default: {', '.join(named)}{rest}"


def _rank(key: str) -> tuple[int, str]:
    order = ("joint", "bars", "profile", "panels", "supports", "sheet", "shop", "net")
    section = key.split(".")[0]
    return (order.index(section) if section in order else len(order)), key


def _short(value: object) -> str:
    return f"{value:g}" if isinstance(value, float) else str(value)
