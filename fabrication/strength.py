"""What bending and twisting a flat strip into place costs its material, bay by bay.

A strip of width h and thickness t, modulus E and shear modulus G lies along its axis with the
curvatures kg (about its weak axis) and kn (about its strong one) and the rate of twist w. At z from
its middle, on its faces, its fibres carry

    E t kg / 2                     bending about the weak axis, either sign
    E kn z                         bending about the strong axis
    E w^2 / 2 (z^2 - h^2 / 12)     a twisted strip's edges are longer than its middle; it shortens
                                   until nothing pulls along it (Wagner's effect)
    G t w                          shear (St Venant)

The sum along the strip is largest at the edge that both kn and w stretch: with the last two read
at z = h / 2, c = E (|kn| h / 2 + w^2 h^2 / 12) bounds them over the whole width. Bending and shear
grow with t and c does not, so the largest thickness that passes solves a quadratic.

A rectangular tube with the wall w carries twist as a closed ring (Bredt): with the area Am and the
length pm of the wall's middle line the shear is G w' 2 Am / pm for a rate w'. A fibre at the
distance r from its axis carries E w'^2 / 2 (r^2 - ip^2), with ip the polar radius of gyration.

What is imposed is the shape, so a notch changes none of this but where stresses flow around it;
the net sections at the slots are for those who check loads. Lengths mm, stresses N/mm2.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from fabrication.lamella import Lamella
from fabrication.materials import Material
from fabrication.net_sections import net_sections
from fabrication.parts import FlatPart
from fabrication.stock import Profile, wall_of
from fabrication.structures import Structure
from gridshell.arrays import Floats, Indices

_SAMPLES_PER_BAY = 8
_TOUCHING = 1e-3
"""A slot this close to a bay's end counts in both bays, mm."""

_STRAIGHT = 1e-12
"""A curvature of rounding errors: a radius of a million kilometres, 1/mm."""

NOT_CHECKED = (
    "loads and deflections",
    "buckling",
    "supports",
    "the strength of connections",
    "stress around slots and holes",
    "creep of wood and plastics that stay bent",
)
"""What no finding speaks of."""


@dataclass(frozen=True, eq=False)
class BayStress:
    """Every bay of every strip, in the strips' order: n bays. Of a bay its worst place.

    Parameters
    ----------
    strip : (n,) index of the strip.
    marks : of the strip, n of them.
    bays : names of the bay's two ends, "N5-N6"; "end" where the strip ends on the way.
    start, end : (n,) stations of the bay on its strip, mm.
    radius : (n,) smallest radius about the weak axis, mm; inf where it is straight.
    twist : (n,) rate, rad/mm.
    edge_strain : (n,) stretch of the edges against the middle, w^2 h^2 / 8.
    bending, shear, edgewise : (n,) stresses of bending, of twist, and of strong-axis bending.
    helix_edge, helix_mid : (n,) tension of the edges and compression of the middle by twist.
    von_mises_mid, von_mises_edge : (n,) sqrt(sigma^2 + 3 tau^2) half-way up and at the worse edge,
        which no place between exceeds.
    utilisation : (n,) sqrt(sigma^2 + (f / fv)^2 tau^2) / f; von Mises over strength where the
        material has no shear strength of its own.
    thickest : (n,) largest thickness that passes, mm; 0 where none does, inf where any does.
    widest : (n,) largest width that passes at this thickness, mm; 0 and inf likewise.
    net_area, net_inertia, net_modulus : (n,) smallest share of the section that slots and holes
        leave: of its area, and of its strong-axis second moment and section modulus.
    """

    strip: Indices
    marks: tuple[str, ...]
    bays: tuple[str, ...]
    start: Floats
    end: Floats
    radius: Floats
    twist: Floats
    edge_strain: Floats
    bending: Floats
    shear: Floats
    edgewise: Floats
    helix_edge: Floats
    helix_mid: Floats
    von_mises_mid: Floats
    von_mises_edge: Floats
    utilisation: Floats
    thickest: Floats
    widest: Floats
    net_area: Floats
    net_inertia: Floats
    net_modulus: Floats

    def __len__(self) -> int:
        return len(self.strip)

    def where(self, bay: int) -> str:
        """Strip and bay: "A3 N5-N6"."""
        return f"{self.marks[bay]} {self.bays[bay]}"

    def of_strip(self, index: int) -> Indices:
        """Numbers of the bays of a strip."""
        return np.flatnonzero(self.strip == index)


_FIGURES = (
    *("radius", "twist", "edge_strain", "bending", "shear", "edgewise", "helix_edge"),
    *("helix_mid", "von_mises_mid", "von_mises_edge", "utilisation", "thickest", "widest"),
)
_SMALLEST = ("radius", "thickest", "widest")
_SHARES = ("net_area", "net_inertia", "net_modulus")


def bay_stress(structure: Structure, parts: Sequence[FlatPart]) -> BayStress:
    """Stress in all bays of the strips of *structure*; *parts* are theirs, in their order."""
    names: list[dict[int, str]] = [{} for _ in structure.lamellas]
    for node in structure.nodes:
        for crossing in node.crossings:
            lamella = structure.lamellas[crossing.lamella]
            k = int(np.argmin(np.abs(lamella.stations - crossing.station)))
            names[crossing.lamella].setdefault(k, node.name)
    columns: dict[str, list[Floats]] = {key: [] for key in (*_FIGURES, *_SHARES)}
    strip: list[int] = []
    marks: list[str] = []
    labels: list[str] = []
    stretches = []
    for index, (lamella, part) in enumerate(zip(structure.lamellas, parts, strict=True)):
        bays, ends = _bays(lamella, names[index])
        strip += [index] * len(bays)
        marks += [lamella.mark] * len(bays)
        labels += ends
        stretches.append(bays)
        found = _in_bays(lamella, bays, structure) | _net(part, bays - lamella.start)
        for key, values in found.items():
            columns[key].append(values)
    stations = np.concatenate([np.zeros((0, 2)), *stretches])
    return BayStress(
        strip=np.array(strip, dtype=np.int64),
        marks=tuple(marks),
        bays=tuple(labels),
        start=stations[:, 0],
        end=stations[:, 1],
        **{key: np.concatenate([np.zeros(0), *values]) for key, values in columns.items()},
    )


def _bays(lamella: Lamella, names: dict[int, str]) -> tuple[Floats, list[str]]:
    """(n, 2) stations where the bays of a strip begin and end, and their names.

    An overhang is free to lie as it likes and is no bay; where a closed strip's ends meet there is
    one on either side of the seam.
    """
    stations = lamella.stations
    inside = (stations > lamella.start) & (stations < lamella.end)
    stops = [(float(stations[k]), names.get(k, "end")) for k in np.flatnonzero(inside).tolist()]
    if lamella.closed or lamella.start > stations[0]:
        stops.insert(0, (lamella.start, "end"))
    if lamella.closed or lamella.end < stations[-1]:
        stops.append((lamella.end, "end"))
    if len(stops) < 2:
        stops = [(lamella.start, "end"), (lamella.end, "end")]
    values, words = [s for s, _ in stops], [word for _, word in stops]
    pairs = np.stack([values[:-1], values[1:]], axis=1)
    return pairs, [f"{a}-{b}" for a, b in pairwise(words)]


def _in_bays(lamella: Lamella, bays: Floats, structure: Structure) -> dict[str, Floats]:
    """The figures of one strip, each the worst of the samples of a bay."""
    share = np.linspace(0.0, 1.0, _SAMPLES_PER_BAY + 1)
    s = bays[:, :1] + (bays[:, 1:] - bays[:, :1]) * share
    weak, strong = lamella.bending(s.ravel())
    twist = lamella.twist(s.ravel())
    profile = structure.profile
    figures = section_stress(
        *(np.abs(rates).reshape(s.shape) for rates in (weak, strong, twist)),
        width=profile.width,
        thickness=profile.thickness,
        material=profile.material,
        wall=wall_of(profile),
    )
    return {
        key: values.min(axis=1) if key in _SMALLEST else values.max(axis=1)
        for key, values in figures.items()
    }


def section_stress(
    weak: Floats,
    strong: Floats,
    twist: Floats,
    *,
    width: float,
    thickness: float,
    material: Material,
    wall: float = 0.0,
) -> dict[str, Floats]:
    """Figures of :class:`BayStress` at places with given rates, all >= 0 and of one shape, 1/mm.

    Parameters
    ----------
    wall : of a hollow section, mm; 0 for a solid strip.
    """
    e, g, f = material.modulus, material.rigidity, material.strength
    bending = e * thickness * weak / 2.0
    edgewise = e * strong * width / 2.0
    if wall:
        lever, corner, face = _hollow(width, thickness, wall)
        shear = g * twist * lever
        helix, pressed = (e * twist**2 / 2.0 * share for share in (corner, face))
    else:
        shear = g * thickness * twist
        helix = e * (twist * width) ** 2 / 12.0
        pressed = helix / 2.0
    along = bending + edgewise + helix
    mid = bending + pressed
    ratio = f / material.shear_limit
    with np.errstate(divide="ignore"):
        radius = 1.0 / np.where(weak > _STRAIGHT, weak, 0.0)
    return {
        "radius": radius,
        "twist": twist,
        "edge_strain": (twist * width) ** 2 / 8.0,
        "bending": bending,
        "shear": shear,
        "edgewise": edgewise,
        "helix_edge": helix,
        "helix_mid": pressed,
        "von_mises_mid": np.sqrt(mid**2 + 3.0 * shear**2),
        "von_mises_edge": np.sqrt(along**2 + 3.0 * shear**2),
        "utilisation": np.hypot(along, ratio * shear) / f,
        "thickest": _thickest(bending / thickness, ratio * shear / thickness, edgewise + helix, f),
        "widest": _widest(
            e * strong / 2.0, helix / width**2, _left(f, ratio * shear, bending), width
        ),
    }


def twist_lever(profile: Profile) -> float:
    """Shear of a section over shear modulus and rate of twist: the thickness of a strip, mm."""
    wall = wall_of(profile)
    if not wall:
        return profile.thickness
    return _hollow(profile.width, profile.thickness, wall)[0]


def _hollow(width: float, thickness: float, wall: float) -> tuple[float, float, float]:
    """Of a tube: shear over G times twist, mm, and how much further from the axis, squared, a
    corner is than the radius of gyration, and how much nearer the middle of a wide wall, mm2.
    """
    high, deep = width - 2.0 * wall, thickness - 2.0 * wall
    section = width * thickness - high * deep
    moments = width * thickness * (width**2 + thickness**2) - high * deep * (high**2 + deep**2)
    gyration = moments / 12.0 / section
    lever = (width - wall) * (thickness - wall) / (width + thickness - 2.0 * wall)
    return lever, (width**2 + thickness**2) / 4.0 - gyration, gyration - thickness**2 / 4.0


def _thickest(bending: Floats, shear: Floats, fixed: Floats, strength: float) -> Floats:
    """Largest t with (bending t + fixed)^2 + (shear t)^2 = strength^2; 0 without, inf for any."""
    left = np.maximum(strength**2 - fixed**2, 0.0)
    both = bending**2 + shear**2
    root = np.sqrt((bending * fixed) ** 2 + both * left)
    with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
        return np.asarray(np.where(left > 0.0, left / (bending * fixed + root), 0.0))


def _left(strength: float, shear: Floats, bending: Floats) -> Floats:
    """What bending and shear leave for the edges; below 0 where they alone are too much."""
    return np.sqrt(np.maximum(strength**2 - shear**2, 0.0)) - bending


def _widest(linear: Floats, square: Floats, left: Floats, width: float) -> Floats:
    """Largest h with linear h + square h^2 = left; 0 without, inf for any."""
    root = np.sqrt(linear**2 + 4.0 * square * np.maximum(left, 0.0))
    with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
        return np.asarray(np.where(left > 0.0, 2.0 * left / (linear + root), 0.0))


def _net(part: FlatPart, bays: Floats) -> dict[str, Floats]:
    """Smallest shares of the section in each bay, given by x on the flat strip."""
    x, shares = net_sections(part)
    reach = np.clip(x, bays[0, 0], bays[-1, 1])
    here = (reach >= bays[:, :1] - _TOUCHING) & (reach <= bays[:, 1:] + _TOUCHING)
    return {
        key: np.where(here, row, 1.0).min(axis=1, initial=1.0)
        for key, row in zip(_SHARES, shares, strict=True)
    }
