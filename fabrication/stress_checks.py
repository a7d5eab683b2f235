"""Findings of what bending and twisting into place does to the material, and their summary.

Limits (t thickness, h width, E and G moduli, f strength, fv shear strength, f / sqrt(3) of metals):

* bending about the weak axis: radius >= E t / (2 f)
* twist (St Venant): rate <= fv / (G t)
* stretch by twist: a strip of one piece shortens until its mean stretch is nought, which leaves its
  edges with E rate^2 h^2 / 12 <= f and half of that, compressed, in its middle
* bending about the strong axis: stress E kappa_n h / 2 <= f; zero on an exact asymptotic net
* all of it at once: see ``strength``

One finding per strip and code; the message names the bay where it is worst.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import numpy as np

from fabrication.finding import Finding, Severity
from fabrication.stock import Profile
from fabrication.strength import NOT_CHECKED, BayStress, twist_lever
from fabrication.structures import Structure
from gridshell.arrays import Indices


def stress_findings(structure: Structure, stress: BayStress) -> list[list[Finding]]:
    """The findings of each strip of *structure*."""
    profile = structure.profile
    return [
        list(_of_strip(lamella.mark, stress, stress.of_strip(index), profile))
        for index, lamella in enumerate(structure.lamellas)
    ]


def stress_section(stress: BayStress) -> dict[str, Any]:
    """What ``report.json`` says of the material; None where a figure has no end.

    Returns
    -------
    ``utilisation`` {max, where}, ``von_mises_n_mm2`` {max}, ``radius_mm`` {min},
    ``twist_deg_per_m`` {max}, ``edge_strain`` {max}, ``thickest_mm`` {min} and ``not_checked``.
    """
    if len(stress) == 0:
        return {"not_checked": list(NOT_CHECKED)}
    worst = int(np.argmax(stress.utilisation))
    return {
        "utilisation": {
            "max": float(stress.utilisation[worst]),
            "where": stress.where(worst),
        },
        "von_mises_n_mm2": {"max": float(stress.von_mises_edge.max())},
        "radius_mm": {"min": _bounded(stress.radius.min())},
        "twist_deg_per_m": {"max": float(np.degrees(stress.twist.max()) * 1e3)},
        "edge_strain": {"max": float(stress.edge_strain.max())},
        "thickest_mm": {"min": _bounded(stress.thickest.min())},
        "not_checked": list(NOT_CHECKED),
    }


def _bounded(value: Any) -> float | None:
    return float(value) if np.isfinite(value) else None


def _of_strip(mark: str, stress: BayStress, bays: Indices, profile: Profile) -> Iterator[Finding]:
    if len(bays) == 0:
        return
    yield from _bend_radius(mark, stress, bays, profile)
    yield from _twist(mark, stress, bays, profile)
    yield from _stretch(mark, stress, bays, profile)
    yield from _edgewise(mark, stress, bays, profile)
    yield from _together(mark, stress, bays, profile)


def _bend_radius(
    mark: str, stress: BayStress, bays: Indices, profile: Profile
) -> Iterator[Finding]:
    bay = int(bays[np.argmin(stress.radius[bays])])
    material, radius = profile.material, float(stress.radius[bay])
    smallest = material.modulus * profile.thickness / (2.0 * material.strength)
    if radius < smallest:
        yield Finding(
            "bend-radius",
            Severity.ERROR,
            mark,
            radius,
            smallest,
            "mm",
            f"{stress.where(bay)} bends to a radius of {radius:.0f} mm; {material.name} of "
            f"{profile.thickness:g} mm needs {smallest:.0f} mm. "
            f"At most {_down(profile.thickness * radius / smallest)} mm thick.",
        )


def _twist(mark: str, stress: BayStress, bays: Indices, profile: Profile) -> Iterator[Finding]:
    bay = int(bays[np.argmax(stress.twist[bays])])
    material, rate = profile.material, float(stress.twist[bay])
    fastest = material.shear_limit / (material.rigidity * twist_lever(profile))
    if rate > fastest:
        yield Finding(
            "twist",
            Severity.ERROR,
            mark,
            rate,
            fastest,
            "rad/mm",
            f"{stress.where(bay)} twists by {np.degrees(rate) * 1000:.0f} degrees per metre; "
            f"{material.name} of {profile.thickness:g} mm bears "
            f"{np.degrees(fastest) * 1000:.0f}. "
            f"At most {_down(profile.thickness * fastest / rate)} mm thick.",
        )


def _stretch(mark: str, stress: BayStress, bays: Indices, profile: Profile) -> Iterator[Finding]:
    """The edges of a twisted strip are longer than its middle."""
    bay = int(bays[np.argmax(stress.helix_edge[bays])])
    value, strength = float(stress.helix_edge[bay]), profile.material.strength
    if value > strength:
        widest = profile.width * np.sqrt(strength / value)
        yield Finding(
            "twist-stretch",
            Severity.ERROR,
            mark,
            value,
            strength,
            "N/mm2",
            f"The twist of {stress.where(bay)} stretches its edges: {value:.0f} N/mm2, "
            f"{strength:g} allowed. Use a strip of at most {np.floor(widest * 10.0) / 10.0:g} mm "
            "in width, or a flatter surface, which twists less.",
        )


def _edgewise(mark: str, stress: BayStress, bays: Indices, profile: Profile) -> Iterator[Finding]:
    bay = int(bays[np.argmax(stress.edgewise[bays])])
    value, strength = float(stress.edgewise[bay]), profile.material.strength
    if value > strength / 2.0:
        yield Finding(
            "edgewise-bend",
            Severity.ERROR if value > strength else Severity.WARNING,
            mark,
            value,
            strength,
            "N/mm2",
            f"{stress.where(bay)} must bend about its strong axis: {value:.0f} N/mm2, "
            f"{strength:g} allowed. Its curve is not asymptotic there. Use more lamellas, "
            "where the net is coarse (half the bay, a quarter of the stress), or a narrower strip.",
        )


def _together(mark: str, stress: BayStress, bays: Indices, profile: Profile) -> Iterator[Finding]:
    bay = int(bays[np.argmax(stress.utilisation[bays])])
    used, strength = float(stress.utilisation[bay]), profile.material.strength
    if used > 1.0:
        yield Finding(
            "stress",
            Severity.ERROR,
            mark,
            used * strength,
            strength,
            "N/mm2",
            f"{stress.where(bay)} sees {used * strength:.0f} N/mm2 in all, {strength:g} allowed: "
            f"bending {stress.bending[bay]:.0f}, shear by twist {stress.shear[bay]:.0f}, stretch "
            f"by twist {stress.helix_edge[bay]:.0f}, strong-axis bending "
            f"{stress.edgewise[bay]:.0f}. {_cure(stress, bays)}",
        )


def _cure(stress: BayStress, bays: Indices) -> str:
    """The nearest thickness or width that all *bays* bear."""
    thickest, widest = float(stress.thickest[bays].min()), float(stress.widest[bays].min())
    cures = []
    if thickest >= 0.01:
        cures.append(f"{_down(thickest)} mm thick")
    if widest >= 0.1:
        cures.append(f"{np.floor(widest * 10.0) / 10.0:g} mm wide")
    if cures:
        return f"At most {' or '.join(cures)}."
    return "No thickness and no width would do: use a flatter surface or more lamellas."


def _down(thickness: float) -> str:
    """*thickness* rounded down to a hundredth of a millimetre."""
    return f"{np.floor(thickness * 100.0) / 100.0:.2f}"
