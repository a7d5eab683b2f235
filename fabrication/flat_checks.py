"""What keeps a segment from lying flat.

Limits, for strips of thickness t, slots of width w and an acute angle a of the node on the ground:

* a partner fills t / sin a + t / tan a = t / tan(a / 2) of a slot, so a slot lets angles down to
  2 atan(t / w) pass
* a bay between two slots can be longer or shorter than in the design by half of what is left free
  in both, on the ground, or in the design where the angle on the ground does not pass; less than
  0.05 mm counts as kept
* bending about the weak axis: radius >= E t / (2 f)
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from fabrication.cut import Cuts
from fabrication.finding import Finding, Severity
from fabrication.flat_grid import FlatGrid
from fabrication.flat_strips import FlatStrip
from fabrication.stock import Profile, require_positive
from gridshell.arrays import Floats

SLIP = 0.05
"""Distances of slots are kept when they miss by no more, mm: less than any machine cuts."""

_LOOSE = 0.3
"""The clearance of a common slot, mm: no more play is taken for granted."""


@dataclass(frozen=True)
class Ground:
    """The floor, or the bed of a lorry, that a flat segment must fit, mm.

    Raises
    ------
    SettingError
        For a size that is not positive.
    """

    length: float
    width: float

    def __post_init__(self) -> None:
        for key in ("length", "width"):
            require_positive(f"ground.{key}", getattr(self, key))


def slot_widths(grid: FlatGrid, cuts: Mapping[str, Cuts]) -> Floats:
    """(c, 2) widths of the slots of both strips at regular nodes, NaN where there is none, mm."""
    width = {(mark, s.node): s.width for mark, own in cuts.items() for s in own.slots}
    return np.array(
        [
            [
                width.get((grid.lamellas[i].mark, grid.nodes[v].name), np.nan)
                for i in (first, second)
            ]
            for v, (first, second) in zip(grid.crossed.tolist(), grid.pair.tolist(), strict=True)
        ]
    ).reshape(-1, 2)


def filled(angles: Floats, thickness: float) -> Floats:
    """What a partner fills of a slot at node *angles*, mm; infinite where the net is folded."""
    acute = np.minimum(angles, np.pi - angles)
    half = np.tan(np.maximum(acute, 0.0) / 2.0)
    return np.asarray(np.where(half > 0.0, thickness / np.maximum(half, 1e-12), np.inf))


def play(grid: FlatGrid, widths: Floats, angles: Floats, thickness: float) -> Floats:
    """(m,) how much the slots at both ends of each bay can give, mm; infinite without a slot."""
    room = np.full((len(grid.lamellas), len(grid.nodes)), np.inf)
    here, designed = (widths - filled(a, thickness)[:, None] for a in (angles, grid.design))
    left = np.where(here > 0.0, here, np.maximum(designed, 0.0)) / 2.0
    for side in (0, 1):
        slotted = np.isfinite(widths[:, side])
        room[grid.pair[slotted, side], grid.crossed[slotted]] = left[slotted, side]
    return np.asarray(room[grid.strip[:, None], grid.edges].sum(axis=1))


def usual_slip(grid: FlatGrid, widths: Floats, angles: Floats, thickness: float) -> Floats:
    """(m,) what a bay may slip at node *angles*: its play, up to that of common slots, mm."""
    return np.clip(play(grid, widths, angles, thickness), SLIP, _LOOSE)


def flat_findings(
    grid: FlatGrid,
    strips: Sequence[FlatStrip],
    *,
    slips: Floats,
    free: Floats,
    angles: Floats,
    widths: Floats,
    profile: Profile,
    size: tuple[float, float],
    ground: Ground | None,
) -> tuple[Finding, ...]:
    """All of them, each kind once where it is worst or once per strip.

    Parameters
    ----------
    slips, free : (m,) how much longer each bay is as it lies, and its slots' play, mm.
    angles : (c,) node angles on the ground, radians.
    widths : (c, 2) slot widths, mm.
    """
    return (
        *_slips(grid, slips, free),
        *_bends(strips, profile),
        *_folds(grid, angles),
        *_angles(grid, angles, widths, profile.thickness),
        *_singular(grid),
        *_ground(size, ground),
    )


def _slips(grid: FlatGrid, slips: Floats, free: Floats) -> Iterator[Finding]:
    over = np.abs(slips) - np.maximum(free, SLIP)
    for i in np.unique(grid.strip[over > 0.0]).tolist():
        own = np.flatnonzero(grid.strip == i)
        e = own[np.argmax(over[own])]
        a, b = (grid.nodes[v].name for v in grid.edges[e].tolist())
        mark, slip = grid.lamellas[i].mark, abs(float(slips[e]))
        yield Finding(
            "flat-slip",
            Severity.WARNING,
            f"{mark} {a}-{b}",
            slip,
            float(free[e]),
            "mm",
            f"On the ground the slots of {mark} at {a} and {b} would have to come {slip:.2f} mm "
            f"{'apart' if slips[e] > 0.0 else 'together'}; they have {free[e]:.2f} mm of play. "
            f"Use {slip - free[e]:.2f} mm more clearance, or a smaller segment.",
        )


def _bends(strips: Sequence[FlatStrip], profile: Profile) -> Iterator[Finding]:
    material, thickness = profile.material, profile.thickness
    limit = material.modulus * thickness / (2.0 * material.strength)
    for strip in strips:
        if strip.radius < limit:
            yield Finding(
                "flat-bend",
                Severity.WARNING,
                strip.mark,
                strip.radius,
                limit,
                "mm",
                f"On the ground {strip.mark} bends to a radius of {strip.radius:.0f} mm; "
                f"{material.name} of {thickness:g} mm needs {limit:.0f} mm. At most "
                f"{thickness * strip.radius / limit:.2f} mm thick, or a smaller segment.",
            )


def _folds(grid: FlatGrid, angles: Floats) -> Iterator[Finding]:
    folded = np.flatnonzero(angles <= 0.0)
    if len(folded):
        worst = int(folded[np.argmin(angles[folded])])
        name, angle = grid.nodes[grid.crossed[worst]].name, float(np.degrees(angles[worst]))
        yield Finding(
            "flat-fold",
            Severity.WARNING,
            name,
            angle,
            0.0,
            "degrees",
            f"The flat segment folds over itself at {name}{_more(len(folded))}. "
            "Open it to a larger mean angle, or choose a smaller segment.",
        )


def _angles(grid: FlatGrid, angles: Floats, widths: Floats, thickness: float) -> Iterator[Finding]:
    need = filled(angles, thickness)
    short = need - np.nanmin(np.where(np.isnan(widths), np.inf, widths), axis=1, initial=np.inf)
    tight = np.flatnonzero((short > SLIP) & (angles > 0.0) & np.isfinite(need))
    if not len(tight):
        return
    worst = int(tight[np.argmax(short[tight])])
    name, angle = grid.nodes[grid.crossed[worst]].name, float(angles[worst])
    acute = float(np.degrees(min(angle, np.pi - angle)))
    narrow = float(np.nanmin(widths[worst]))
    limit = float(np.degrees(2.0 * np.arctan2(thickness, narrow)))
    yield Finding(
        "flat-angle",
        Severity.WARNING,
        name,
        acute,
        limit,
        "degrees",
        f"On the ground the strips cross at {acute:.1f} degrees at {name}; its slot of "
        f"{narrow:.2f} mm lets {limit:.1f} pass. The slots of {name}{_more(len(tight))} are too "
        f"tight: use {np.ceil(float(short[worst]) * 100.0) / 100.0:.2f} mm more clearance, loose "
        "slots, or a smaller segment.",
    )


def _more(count: int) -> str:
    """How many besides the one that is named."""
    return "" if count < 2 else f" and {count - 1} more {'node' if count == 2 else 'nodes'}"


def _singular(grid: FlatGrid) -> Iterator[Finding]:
    for node in grid.nodes:
        if len(node.crossings) > 2:
            yield Finding(
                "flat-singular",
                Severity.INFO,
                node.name,
                float(len(node.crossings)),
                2.0,
                "lamellas",
                f"{len(node.crossings)} lamellas end at {node.name}: nothing is slotted there, and "
                "on the ground their ends only lie together. Connect them once the segment stands.",
            )


def _ground(size: tuple[float, float], ground: Ground | None) -> Iterator[Finding]:
    if ground is None:
        return
    sides = sorted((ground.length, ground.width), reverse=True)
    for found, limit, name in zip(size, sides, ("length", "width"), strict=True):
        if found > limit:
            yield Finding(
                "flat-size",
                Severity.WARNING,
                "segment",
                found,
                limit,
                "mm",
                f"Flat, the segment has a {name} of {found / 1e3:.2f} m; there are "
                f"{limit / 1e3:.2f} m. Choose a smaller segment, or close it to a smaller angle.",
            )
