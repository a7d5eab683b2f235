"""The flat scissor state of a segment: how it lies slotted on the ground before it is pulled up.

The paper's steel gridshell was "first slotted together by hand into flat segments, creating a
scissor joint at each intersection that allowed to deform the whole segment into its design shape"
(section 4.1), and the canopy's segments were "first assembled flat and then pulled upside down"
(4.2). Strips stand on edge there: they bend easily in the plane of the ground and not at all out
of it, slots keep their distances along the strips, and node angles are free within what the slots
let pass. Among all states that keep the distances, and with a given mean angle, the one of least
bending is taken; see ``flat_solve``.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from math import degrees
from typing import Any

import numpy as np

from fabrication.finding import Finding, Severity
from fabrication.flat_checks import Ground, flat_findings, play, slot_widths, usual_slip
from fabrication.flat_grid import FlatGrid, first_guess, flat_grid
from fabrication.flat_solve import node_angles, settle
from fabrication.flat_strips import FlatStrip, arcs, set_down
from fabrication.jointed import Jointed
from fabrication.stock import require_distance
from gridshell import SettingError
from gridshell.arrays import Floats, Indices, frozen


@dataclass(frozen=True, eq=False)
class FlatState:
    """A segment on the ground.

    Parameters
    ----------
    names : of its nodes.
    positions : (n, 2) mm; x along the longer side of the smallest rectangle around the segment,
        from its lower left corner; seen from the side the node axes point to.
    strips : the strips as they lie.
    edges : (m, 2) nodes at either end of each bay.
    edge_strips : (m,) the strip of each bay, a number of *strips*.
    lengths : (m,) developed length of each bay, mm.
    slips : (m,) how much longer a bay is as it lies, mm: what its slots would have to slip.
    play : (m,) what they can slip, mm.
    angles : (n,) node angles as in the design, first strip to second, radians; NaN where only
        one strip passes or more than two end; negative where the net is folded over.
    design_angles : (n,) the same in the design.
    size : length and width of the rectangle around all strips, mm.
    smallest_radius : what the material allows, mm.
    findings : what a person should know.
    """

    names: tuple[str, ...]
    positions: Floats
    strips: tuple[FlatStrip, ...]
    edges: Indices
    edge_strips: Indices
    lengths: Floats
    slips: Floats
    play: Floats
    angles: Floats
    design_angles: Floats
    size: tuple[float, float]
    smallest_radius: float
    findings: tuple[Finding, ...]

    @property
    def possible(self) -> bool:
        """Whether the segment can be put together so: nothing found that is more than a note."""
        return all(finding.severity is Severity.INFO for finding in self.findings)

    @property
    def opening(self) -> float:
        """Mean node angle, radians."""
        return float(self._angles.mean()) if len(self._angles) else float("nan")

    @property
    def radius(self) -> float:
        """Smallest bending radius of all strips, mm; infinite where all are straight."""
        return min(strip.radius for strip in self.strips)

    @property
    def _angles(self) -> Floats:
        return np.asarray(self.angles[np.isfinite(self.angles)])

    def section(self) -> dict[str, Any]:
        """What the report says of it: numbers a JSON file can hold."""
        angles = np.degrees(self._angles)
        return {
            "strips": len(self.strips),
            "nodes": len(self.names),
            "length_m": self.size[0] / 1e3,
            "width_m": self.size[1] / 1e3,
            "slip_mm": float(np.abs(self.slips).max(initial=0.0)),
            "radius_mm": {"min": _finite(self.radius), "limit": self.smallest_radius},
            "angle_deg": {
                "min": _finite(angles.min(initial=np.inf)),
                "mean": _finite(float(np.degrees(self.opening))),
                "max": _finite(angles.max(initial=-np.inf)),
            },
            "possible": self.possible,
            "findings": [finding.code for finding in self.findings],
        }

    def lines(self) -> tuple[str, ...]:
        """What to write beside a drawing of it."""
        angles = np.degrees(self._angles)
        turned = (
            f"node angles {angles.min():.1f} to {angles.max():.1f} degrees, "
            f"mean {angles.mean():.1f}"
            if len(angles)
            else "no strips of two families cross"
        )
        bent = "straight" if np.isinf(self.radius) else f"bent to {self.radius / 1e3:.2f} m"
        return (
            f"{len(self.strips)} strips, {len(self.names)} nodes, "
            f"{self.size[0] / 1e3:.2f} x {self.size[1] / 1e3:.2f} m",
            turned,
            f"strips {bent} at most; the material allows {self.smallest_radius / 1e3:.2f} m",
            f"distances of slots kept within {np.abs(self.slips).max(initial=0.0):.2f} mm",
            *(finding.message for finding in self.findings),
        )


def lay_flat(
    jointed: Jointed,
    *,
    lamellas: Sequence[str] | None = None,
    opening: float | None = None,
    slip: float | None = None,
    ground: Ground | None = None,
) -> FlatState:
    """The flat state of the strips of *jointed*, or of a segment of them.

    Parameters
    ----------
    lamellas : marks of the strips of the segment; all unless said otherwise. A closed strip lies
        open at its seam.
    opening : mean node angle on the ground, radians; the design's unless said otherwise.
    slip : what the distances of slots may miss, mm; the strips bend less for it. The play of the
        slots unless said otherwise, at most 0.3 mm.
    ground : what it must fit.

    Raises
    ------
    SettingError
        For strips that are not slotted into each other, that do not hang together or close around
        a hole, a mark that no strip has, or an opening that is no angle between 0 and 180 degrees.
    """
    if not any(cuts.slots for cuts in jointed.cuts.values()):
        raise SettingError(
            "Strips that are not slotted into each other have no flat scissor state",
            where="joint",
            advice="a joint with slots; others are put together in their final shape",
        )
    if slip is not None:
        require_distance("slip", slip)
    profile = jointed.strips.profile
    grid = flat_grid(jointed.strips, lamellas)
    held = _opening(grid, opening)
    widths = slot_widths(grid, jointed.cuts)

    def kept(p: Floats, misses: Floats) -> bool:
        angles = node_angles(grid, p)
        usual = usual_slip(grid, widths, np.abs(angles), profile.thickness)
        return bool((np.abs(misses) <= (usual if slip is None else slip)).all())

    lying = settle(grid, first_guess(grid, held), held, lambda p: arcs(grid, p), kept)
    positions, strips, size = set_down(grid, _handed(grid, lying), profile.thickness)
    turned = node_angles(grid, positions)
    slips = arcs(grid, positions) - grid.lengths
    free = play(grid, widths, turned, profile.thickness)
    return FlatState(
        names=tuple(node.name for node in grid.nodes),
        positions=frozen(positions),
        strips=strips,
        edges=grid.edges,
        edge_strips=grid.strip,
        lengths=frozen(grid.lengths),
        slips=frozen(slips),
        play=frozen(free),
        angles=_at_nodes(grid, turned),
        design_angles=_at_nodes(grid, grid.design),
        size=size,
        smallest_radius=profile.material.modulus
        * profile.thickness
        / (2.0 * profile.material.strength),
        findings=flat_findings(
            grid,
            strips,
            slips=slips,
            free=free,
            angles=turned,
            widths=widths,
            profile=profile,
            size=size,
            ground=ground,
        ),
    )


def _opening(grid: FlatGrid, opening: float | None) -> float:
    if opening is None:
        return float(grid.design.mean()) if len(grid.design) else np.pi / 2.0
    if not 0.0 < opening < np.pi:
        raise SettingError(
            "The opening of a flat segment is the mean angle of its nodes",
            where="opening",
            value=f"{degrees(opening):g} degrees",
            limit="between 0 and 180 degrees",
            advice="the design's node angle",
        )
    return opening


def _handed(grid: FlatGrid, p: Floats) -> Floats:
    """The state seen from the side the node axes point to."""
    angles = node_angles(grid, p)
    return p * np.array([1.0, -1.0]) if len(angles) and np.median(angles) < 0.0 else p


def _at_nodes(grid: FlatGrid, values: Floats) -> Floats:
    """(n,) *values* of the regular nodes, NaN at all others."""
    every = np.full(len(grid.nodes), np.nan)
    every[grid.crossed] = values
    return frozen(every)


def _finite(value: float) -> float | None:
    return float(value) if np.isfinite(value) else None
