"""Checks of a structure against its material and its own cuts. Loads and buckling are not checked.

Limits (t thickness, h width, E modulus, f strength, G = E / 2.6):

* bending about the weak axis: radius >= E t / (2 f)
* twist (St Venant): rate <= f / (sqrt(3) G t)
* stretch by twist: a strip of one piece shortens until its mean stretch is nought, which leaves its
  edges with E rate^2 h^2 / 12 <= f and half of that, compressed, in its middle
* bending about the strong axis: stress E kappa_n h / 2 <= f; zero on an exact asymptotic net
* slots: material of at least one thickness between two slots and beside the cut ends,
  and behind each slot
* strips that pass through each other away from their slots: see ``collisions``
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from itertools import pairwise

import numpy as np

from fabrication.collisions import collisions
from fabrication.finding import Finding, Severity
from fabrication.lamella import Lamella
from fabrication.parts import FlatPart
from fabrication.stock import Profile
from fabrication.structures import Structure

_SAMPLES_PER_BAY = 8
_SHEAR_RATIO = 2.6


def check(structure: Structure, parts: Sequence[FlatPart]) -> tuple[Finding, ...]:
    """All findings about lamellas and flat parts, in the structure's order, then about pairs."""
    found: list[Finding] = []
    for lamella, part in zip(structure.lamellas, parts, strict=True):
        found += _bending(lamella, structure.profile)
        found += _slots(part)
        if lamella.closed:
            found.append(_seam(lamella))
    return (*found, *collisions(structure, parts))


def _bending(lamella: Lamella, profile: Profile) -> Iterator[Finding]:
    material = profile.material
    s = np.linspace(0.0, lamella.stations[-1], _SAMPLES_PER_BAY * len(lamella.nodes) + 1)
    weak, strong = (float(np.abs(k).max()) for k in lamella.bending(s))
    radius = np.inf if weak == 0.0 else 1.0 / weak
    smallest = material.modulus * profile.thickness / (2.0 * material.strength)
    if radius < smallest:
        thickest = profile.thickness * radius / smallest
        yield Finding(
            "bend-radius",
            Severity.ERROR,
            lamella.mark,
            radius,
            smallest,
            "mm",
            f"{lamella.mark} bends to a radius of {radius:.0f} mm; {material.name} of "
            f"{profile.thickness:g} mm needs {smallest:.0f} mm. At most {thickest:.2f} mm thick.",
        )
    rate = float(np.abs(lamella.twist(s)).max())
    shear = material.modulus / _SHEAR_RATIO
    fastest = material.strength / (np.sqrt(3.0) * shear * profile.thickness)
    if rate > fastest:
        yield Finding(
            "twist",
            Severity.ERROR,
            lamella.mark,
            rate,
            fastest,
            "rad/mm",
            f"{lamella.mark} twists by {np.degrees(rate) * 1000:.0f} degrees per metre; "
            f"{material.name} of {profile.thickness:g} mm bears "
            f"{np.degrees(fastest) * 1000:.0f}. Use a thinner strip.",
        )
    yield from _stretch(lamella.mark, rate, profile)
    stress = material.modulus * strong * profile.width / 2.0
    if stress > material.strength / 2.0:
        yield Finding(
            "edgewise-bend",
            Severity.ERROR if stress > material.strength else Severity.WARNING,
            lamella.mark,
            stress,
            material.strength,
            "N/mm2",
            f"{lamella.mark} must bend about its strong axis: {stress:.0f} N/mm2, "
            f"{material.strength:g} allowed. Its curve is not asymptotic there. Use more lamellas, "
            "where the net is coarse (half the bay, a quarter of the stress), or a narrower strip.",
        )


def _stretch(mark: str, rate: float, profile: Profile) -> Iterator[Finding]:
    """The edges of a twisted strip are longer than its middle."""
    material, width = profile.material, profile.width
    stress = material.modulus * rate**2 * width**2 / 12.0
    if stress > material.strength:
        widest = width * np.sqrt(material.strength / stress)
        yield Finding(
            "twist-stretch",
            Severity.ERROR,
            mark,
            stress,
            material.strength,
            "N/mm2",
            f"The twist of {mark} stretches its edges: {stress:.0f} N/mm2, {material.strength:g} "
            f"allowed. Use a strip of at most {np.floor(widest * 10.0) / 10.0:g} mm in width, or a "
            "flatter surface, which twists less.",
        )


def _slots(part: FlatPart) -> Iterator[Finding]:
    for a, b in pairwise(part.slots):
        web = (b.x - b.width / 2.0) - (a.x + a.width / 2.0)
        if web < part.thickness:
            yield Finding(
                "slot-spacing",
                Severity.ERROR,
                f"{part.mark} {a.node}-{b.node}",
                web,
                part.thickness,
                "mm",
                f"Only {web:.2f} mm are left between the slots for {a.partner} and {b.partner} in "
                f"{part.mark}. Use fewer lamellas or a thinner strip.",
            )
    for slot in sorted(part.slots, key=lambda s: -s.depth)[:1]:
        web = part.width - slot.depth
        if web < part.thickness:
            yield Finding(
                "slot-depth",
                Severity.ERROR,
                f"{part.mark} {slot.node}",
                web,
                part.thickness,
                "mm",
                f"The slots of {part.mark} leave {web:.2f} mm of its width, for {slot.partner} as "
                "elsewhere. Use a smaller depth clearance or a wider strip.",
            )
    for slot in dict.fromkeys(part.slots[:1] + part.slots[-1:]):
        web = min(slot.x, part.length - slot.x) - slot.width / 2.0
        if web < part.thickness:
            yield Finding(
                "slot-at-end",
                Severity.ERROR,
                f"{part.mark} {slot.node}",
                web,
                part.thickness,
                "mm",
                f"The slot for {slot.partner} leaves {web:.2f} mm at the end of {part.mark}. "
                "Use a longer overhang.",
            )


def _seam(lamella: Lamella) -> Finding:
    return Finding(
        "seam",
        Severity.INFO,
        lamella.mark,
        lamella.axis.length,
        lamella.length,
        "mm",
        f"{lamella.mark} is closed: its ends meet half-way between its last and its first node "
        "and need a splice there.",
    )
