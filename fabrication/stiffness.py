"""How stiff a strip's section is, and what given rates of bending and twist cost it.

A solid strip of width h and thickness t: h t^3 / 12 about its weak axis, t h^3 / 12 about its
strong one, h t^3 / 3 in torsion. Of a tube the cavity is taken off, and in torsion it is a closed
ring (Bredt): 4 Am^2 w / pm, with the area Am and the length pm of the middle line of its wall w.
"""

from __future__ import annotations

from dataclasses import dataclass

from fabrication.stock import Profile, wall_of
from fabrication.strength import section_stress
from gridshell.arrays import Floats


@dataclass(frozen=True)
class Stiffness:
    """Of a section, N mm2.

    Parameters
    ----------
    weak, strong : bending stiffness E I about either axis.
    torsion : G J.
    """

    weak: float
    strong: float
    torsion: float


def stiffness(profile: Profile) -> Stiffness:
    """E I and G J of a profile."""
    h, t, material = profile.width, profile.thickness, profile.material
    wall = wall_of(profile)
    if wall:
        high, deep = h - 2.0 * wall, t - 2.0 * wall
        ring = 4.0 * ((h - wall) * (t - wall)) ** 2 * wall / (2.0 * (h + t - 2.0 * wall))
        return Stiffness(
            weak=material.modulus * (h * t**3 - high * deep**3) / 12.0,
            strong=material.modulus * (t * h**3 - deep * high**3) / 12.0,
            torsion=material.rigidity * ring,
        )
    return Stiffness(
        weak=material.modulus * h * t**3 / 12.0,
        strong=material.modulus * t * h**3 / 12.0,
        torsion=material.rigidity * h * t**3 / 3.0,
    )


def strip_stress(
    weak: Floats, strong: Floats, twist: Floats, profile: Profile
) -> dict[str, Floats]:
    """Figures of :class:`fabrication.strength.BayStress` at places with given rates, 1/mm."""
    return section_stress(
        weak,
        strong,
        twist,
        width=profile.width,
        thickness=profile.thickness,
        material=profile.material,
        wall=wall_of(profile),
    )
