"""The key figures of a report, in the order and by the names of the report's page."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Any

from fabrication.export.papers.drawn import Figure
from fabrication.words import finite, fixed, number, plural

Found = Mapping[str, Any]


def net_figures(net: Found) -> Iterator[Figure]:
    """What the net is judged by; what was not asked for is left out."""
    errors = (
        ("Node angle error, largest", "angle_error_deg", "°"),
        ("Star planarity, largest", "star_planarity", ""),
        ("Face planarity, largest", "face_planarity", ""),
        ("Sphericity, largest", "sphericity", ""),
        ("Rhombus error, largest", "rhombus_error", ""),
        ("Distance from the surface, largest", "surface_distance_mm", "mm"),
    )
    yield _between("Node angle", net.get("node_angle_deg"), "°")
    for label, key, unit in errors:
        if net.get(key):
            mean = f"mean {number(_at(net, key, 'mean'))}{unit if unit == '°' else ' ' + unit}"
            yield Figure(label, number(_at(net, key, "max")), unit, mean.rstrip())
    yield _between("Edge ratio", net.get("edge_ratio"), "", "of the mean edge")
    ratio = net.get("curvature_ratio")
    yield Figure("Curvature ratio", number(ratio), "", "median, the smaller over the larger")


def strip_figures(built: Found, longest: str, raw: str) -> Iterator[Figure]:
    """What is built of strips; *raw* is what they are cut from."""
    yield Figure("Lamellas", number(built.get("lamellas")), "", _counted(built, "strips", "strip"))
    yield Figure("Joints", number(built.get("joints")), "", _counted(built, "nodes", "node"))
    if built.get("joint_angle_deg"):
        yield _between("Angle at the joints", built["joint_angle_deg"], "°")
    yield Figure("Total length", fixed(built.get("total_length_m"), 1), "m", longest)
    sheets = _counted(built, "sheets", raw)
    yield Figure("Mass", number(built.get("mass_kg")), "kg", sheets)
    strain = _times(100.0, built.get("max_edge_strain"))
    yield Figure("Edge strain, largest", number(strain, 3), "%", "by twist")
    edgewise = number(built.get("max_edgewise_mm"))
    yield Figure("Edgewise, largest", edgewise, "mm", "of an axis from a straight line")


def stress_figures(stress: Found) -> Iterator[Figure]:
    """What bending and twisting costs the material; a bound that does not exist is a word."""
    used, radius = stress.get("utilisation", {}), _at(stress, "radius_mm", "min")
    yield Figure(
        "Utilisation, largest", fixed(_times(100.0, used.get("max")), 0), "%", used.get("where", "")
    )
    worst = number(_at(stress, "von_mises_n_mm2", "max"), 3)
    yield Figure("Von Mises stress, largest", worst, "N/mm²")
    thickest = _at(stress, "thickest_mm", "min")
    if "thickest_mm" in stress and not thickest:
        yield Figure("Largest thickness", "any" if thickest is None else "none")
    else:
        yield Figure("Largest thickness", fixed(thickest, 2), "mm", "that still passes")
    if "radius_mm" in stress and radius is None:
        yield Figure("Bending radius, smallest", "straight")
    else:
        yield Figure(
            "Bending radius, smallest", fixed(_times(1e-3, radius), 2), "m", "about the weak axis"
        )
    yield Figure("Twist, largest", fixed(_at(stress, "twist_deg_per_m", "max"), 1), "°/m")


def file_figures(report: Found) -> Iterator[Figure]:
    """How well the files close onto the design."""
    closed = report.get("closure") or {}
    yield Figure("Closure", number(closed.get("max_mm")), "mm", closed.get("worst", ""))
    yield Figure("Volume difference, largest", number(closed.get("volume_ppm"), 3), "ppm")
    if "fit" in report:
        clash = number(_at(report["fit"], "clash_mm3", "max"))
        yield Figure("Clash, largest", clash, "mm³", _counted(report["fit"], "nodes", "node"))


def facade_figures(glass: Found) -> Iterator[Figure]:
    """What lies on the strips."""
    groups = _counted(glass, "panel_groups", "group")
    yield Figure("Triangular panels", number(glass.get("panels")), "", groups)
    metres = f"{number(glass.get('profile_length_m'))} m"
    yield Figure("Secondary profiles", number(glass.get("profiles")), "", metres)
    yield Figure("Closure of the panels", number(_at(glass, "closure_mm", "max")), "mm")


def remesh_figures(laid: Found) -> Iterator[Figure]:
    """How the mesh was laid over the surface."""
    control = f"{number(laid.get('control_quads'))} of the control mesh"
    yield Figure("Quads of M", number(laid.get("quads")), "", control)
    yield Figure("Singular points", number(len(laid.get("singularities") or ())))
    worst = f"largest {number(_at(laid, 'alignment_deg', 'max'), 3)}°"
    yield Figure("Alignment, mean", number(_at(laid, "alignment_deg", "mean"), 3), "°", worst)
    yield Figure("Covered", fixed(_times(100.0, laid.get("coverage")), 1), "%")


def panel_figures(built: Found) -> Iterator[Figure]:
    """What is built of panels."""
    groups = _counted(built, "panel_groups", "group")
    yield Figure("Panels", number(built.get("panels")), "", groups)
    area = number(built.get("panel_area_m2"))
    yield Figure("Area of panels", area, "m²", _counted(built, "panel_sheets", "sheet"))
    yield Figure("Panel planarity, largest", number(_at(built, "panel_planarity_mm", "max")), "mm")
    yield _between("Corner angles", built.get("corner_angle_deg"), "°", decimals=1)
    for key, word in (("plate", "Support plates"), ("connector", "Connectors")):
        if built.get(f"{key}s"):
            alike = _counted(built, f"{key}_groups", "group")
            yield Figure(word, number(built[f"{key}s"]), "", alike)
    yield Figure("Mass", number(built.get("mass_kg")), "kg", _counted(built, "sheets", "sheet"))


def support_figures(held: Found) -> Iterator[Figure]:
    """How flat support plates are, and would be along averaged normals."""
    flat = f"{held.get('flat')} of {held.get('plates')} plates flat"
    yield Figure("Out of plane, largest", number(_at(held, "out_of_plane_mm", "max")), "mm", flat)
    yield Figure("Twist, largest", number(_at(held, "twist_deg", "max")), "°")
    classical = number(_at(held, "classical_out_of_plane_mm", "max"))
    yield Figure("With averaged normals", classical, "mm", "out of plane")
    if held.get("lean_deg"):
        yield Figure("Lean of the axes, largest", number(_at(held, "lean_deg", "max"), 3), "°")


def _at(found: Found, key: str, kind: str) -> Any:
    """``found[key][kind]``, None where there is none."""
    return (found.get(key) or {}).get(kind)


def _times(factor: float, value: Any) -> float | None:
    return factor * float(value) if finite(value) else None


def _between(
    label: str, ends: Found | None, unit: str, detail: str = "", decimals: int = 2
) -> Figure:
    low, high = (fixed((ends or {}).get(kind), decimals) for kind in ("min", "max"))
    return Figure(label, low if low == high else f"{low} to {high}", unit, detail)


def _counted(found: Found, key: str, word: str) -> str:
    count = found.get(key)
    return plural(count, word) if isinstance(count, int) else ""
