"""What a moving net does on its way: angles, cables, curvature and stress of the strips.

The strips are straight at rest, so all of their curvature and twist is elastic. The strain energy U
of all strips against the length L of the cables gives what the cables must pull: by virtual work
the sum of their tensions is -dU / dL (self weight, wind and friction are not in it).

Lengths mm, angles radians, forces N, stresses N/mm2.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from math import pi

import numpy as np

import gridshell as gs
from fabrication.lamella import Lamella
from fabrication.stiffness import stiffness, strip_stress
from fabrication.stock import Profile
from fabrication.structures import structure
from gridshell.arrays import Floats, Points

_SAMPLES_PER_BAY = 8


@dataclass(frozen=True, eq=False)
class MotionStep:
    """One position.

    Parameters
    ----------
    opening : 0 closed, 1 opened, as far as the net itself goes.
    cable : length of each cable, mm.
    lean : angle of the cables from the vertical, radians.
    force : sum of the cables' tensions that holds the position against the strips, N; negative
        where the strips would open it by themselves.
    height, top_radius : of the highest and the last ring, mm.
    angles : smallest and largest node angle, radians.
    radius : smallest bending radius about the weak axis, mm.
    twist : largest rate of twist, rad/mm.
    utilisation : of the material's strength, at the worst place.
    strips : (k, m, 2, 3) lower and upper edges of all strips at m places, mm; family 1 first.
    """

    opening: float
    cable: float
    lean: float
    force: float
    height: float
    top_radius: float
    angles: tuple[float, float]
    radius: float
    twist: float
    utilisation: float
    strips: Points


@dataclass(frozen=True, eq=False)
class Motion:
    """The whole way.

    Parameters
    ----------
    umbrella : the lengths that are kept.
    cable : what drives it.
    steps : from closed to opened.
    locks : smallest and largest opening at which the node angles are within their limits.
    limits : smallest and largest node angle that the joints let be, radians.
    dead_point : opening at which the cables are longest; None where that is the closed end.
    kept : largest relative change of an edge's length over the motion.
    planar : largest distance of a star's neighbours from its plane, over its mean edge.
    first : strips of family 1.
    """

    umbrella: gs.Umbrella
    cable: gs.Cable
    steps: tuple[MotionStep, ...]
    locks: tuple[float, float]
    limits: tuple[float, float]
    dead_point: float | None
    kept: float
    planar: float
    first: int


def motion(
    position: gs.Position,
    profile: Profile,
    *,
    cable: gs.Cable | None = None,
    count: int = 60,
    limits: tuple[float, float] = (pi / 18.0, pi * 17.0 / 18.0),
    announce: Callable[[int], None] = lambda number: None,
) -> Motion:
    """Move an umbrella from one lock to the other.

    Parameters
    ----------
    position : any position of it.
    profile : of its strips.
    cable : from the base ring to the highest one above it unless said otherwise.
    count : positions.
    limits : node angles that the joints let be, radians.
    announce : called with the number of every position.

    Raises
    ------
    SettingError
        For a cable that the umbrella cannot have, or limits that no position keeps.
    """
    umbrella = position.umbrella
    last = len(umbrella.bays)
    driven = gs.Cable(0, last - last % 2) if cable is None else cable
    low, high = _range(umbrella, limits)
    positions = [umbrella.position(o) for o in np.linspace(low, high, count).tolist()]
    lengths = np.array([driven.length(p) for p in positions])
    states = []
    for number, here in enumerate(positions):
        announce(number)
        states.append(_state(here, profile))
    energy = np.array([state.energy for state in states])
    force = -np.gradient(energy, lengths) if count > 1 else np.zeros(count)
    steps = tuple(
        _step(here, driven, state, float(f))
        for here, state, f in zip(positions, states, force, strict=True)
    )
    kept, planar = _exactness(positions)
    return Motion(
        umbrella=umbrella,
        cable=driven,
        steps=steps,
        locks=(low, high),
        limits=limits,
        dead_point=umbrella.dead_point(driven),
        kept=kept,
        planar=planar,
        first=states[0].first,
    )


# ---- parts -------------------------------------------------------------------------------------


@dataclass(frozen=True, eq=False)
class _State:
    """The strips in one position."""

    energy: float
    radius: float
    twist: float
    utilisation: float
    strips: Points
    first: int


def _state(position: gs.Position, profile: Profile) -> _State:
    built = structure(gs.diagonal_meshes(position.control())[0], profile)
    weak_, strong_, twist_, edges = [], [], [], []
    energy, bending = 0.0, stiffness(profile)
    for strip in built.lamellas:
        s = _places(strip)
        weak, strong = strip.bending(s)
        twist = strip.twist(s)
        density = bending.weak * weak**2 + bending.strong * strong**2 + bending.torsion * twist**2
        energy += float(np.trapezoid(density, s)) / 2.0
        weak_.append(weak)
        strong_.append(strong)
        twist_.append(twist)
        edges.append(_edges(strip, s, profile.width))
    rates = [np.abs(np.concatenate(rows)) for rows in (weak_, strong_, twist_)]
    used = strip_stress(rates[0], rates[1], rates[2], profile)["utilisation"]
    return _State(
        energy=energy,
        radius=1.0 / max(float(rates[0].max()), 1e-12),
        twist=float(rates[2].max()),
        utilisation=float(used.max()),
        strips=np.stack(edges),
        first=sum(strip.family == 1 for strip in built.lamellas),
    )


def _places(strip: Lamella) -> Floats:
    """Stations between the first and the last node: overhangs are free to lie as they like."""
    count = _SAMPLES_PER_BAY * (len(strip.stations) - 1) + 1
    return np.interp(
        np.linspace(0.0, 1.0, count), np.linspace(0.0, 1.0, len(strip.stations)), strip.stations
    )


def _edges(strip: Lamella, s: Floats, width: float) -> Points:
    """(m, 2, 3) lower and upper edge."""
    frames = strip.frames(s)
    half = width / 2.0 * frames.n
    return np.stack([frames.points - half, frames.points + half], axis=1)


def _step(position: gs.Position, cable: gs.Cable, state: _State, force: float) -> MotionStep:
    r, z = position.radii, position.heights
    away, up = r[cable.high] - r[cable.low], z[cable.high] - z[cable.low]
    angles = position.node_angles
    return MotionStep(
        opening=position.opening,
        cable=cable.length(position),
        lean=float(np.arctan2(away, up)),
        force=force,
        height=position.height,
        top_radius=float(r[-1]),
        angles=(float(angles.min()), float(angles.max())),
        radius=state.radius,
        twist=state.twist,
        utilisation=state.utilisation,
        strips=state.strips,
    )


def _range(umbrella: gs.Umbrella, limits: tuple[float, float]) -> tuple[float, float]:
    """Openings between which all node angles are within *limits*."""
    tried = np.linspace(0.0, 1.0, 2001)
    closed, opened = umbrella.locks
    r, _ = umbrella.rings(closed.first + tried * (opened.first - closed.first))
    angles = umbrella.node_angles(r)
    good = (angles.min(axis=1) >= limits[0]) & (angles.max(axis=1) <= limits[1])
    if np.count_nonzero(good) < 2:
        short = np.maximum(limits[0] - angles.min(axis=1), angles.max(axis=1) - limits[1])
        nearest = angles[int(np.argmin(short))]
        low, high = float(np.degrees(nearest.min())), float(np.degrees(nearest.max()))
        raise gs.SettingError(
            "No position keeps all node angles between the limits of the joints",
            where="smallest, largest",
            value="{:.4g} and {:.4g} degrees".format(*np.degrees(limits)),
            limit=f"the position that comes nearest has {low:.4g} to {high:.4g} degrees",
            advice=f"smallest = {0.95 * low:.3g}, largest = {min(1.05 * high, 175.0):.3g}",
        )
    where = np.flatnonzero(good)
    return float(tried[where[0]]), float(tried[where[-1]])


def _exactness(positions: Sequence[gs.Position]) -> tuple[float, float]:
    """Largest change of an edge and largest star planarity, measured on the nets themselves."""
    kept = planar = 0.0
    rest: Floats | None = None
    for position in positions:
        control = position.control()
        net = gs.diagonal_meshes(control)[0]
        a, b = net.vertices[net.edges.T]
        lengths = np.linalg.norm(a - b, axis=1)
        rest = lengths if rest is None else rest
        kept = max(kept, float(np.abs(lengths / rest - 1.0).max()))
        quality = gs.net_quality(control, planarity=gs.Planarity.FIRST_DIAGONAL_STARS)
        planar = max(planar, quality.star_planarity.max if quality.star_planarity else 0.0)
    return kept, planar
