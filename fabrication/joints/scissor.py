"""The scissor joint: loose half-lap slots for a grid that is slotted flat and pulled up.

On the ground the strips are parallel within each family and the grid opens and closes like
scissors. The slots must let every angle pass from the sharpest one it is closed to up to the node's
own. A slot that is wide enough for a sharp angle does not hold a blunter one: how far a node can
still turn is :func:`angle_play`.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from math import degrees

import numpy as np

from fabrication.cut import Cuts
from fabrication.finding import Finding, Severity
from fabrication.jointed import Jointed
from fabrication.joints.half_lap import HalfLap, half_lap, slot_findings
from fabrication.joints.joint import Joint
from fabrication.stock import require_distance
from fabrication.structures import Structure
from gridshell import SettingError
from gridshell.arrays import Floats


@dataclass(frozen=True)
class ScissorJoint(Joint):
    """Half-lap slots that let the strips turn.

    Parameters
    ----------
    opens_from : smallest angle between two strips while the grid is opened or closed, radians.
    clearance : added to the width that the sharpest angle needs, mm.
    depth_clearance : added to the half depth, mm.
    control : how much further than built a node may turn before it is told, radians.

    Raises
    ------
    SettingError
        For a negative clearance, or an angle out of (0, 90] degrees.
    """

    opens_from: float = float(np.radians(45.0))
    clearance: float = 0.3
    depth_clearance: float = 0.5
    control: float = float(np.radians(10.0))

    def __post_init__(self) -> None:
        for key in ("clearance", "depth_clearance", "control"):
            require_distance(key, getattr(self, key))
        if not 0.0 < self.opens_from <= np.pi / 2.0:
            raise SettingError(
                "A grid opens from an angle between its strips",
                where="opens_from",
                value=f"{degrees(self.opens_from):g} degrees",
                limit="above 0, at most 90 degrees",
                advice="45 degrees",
            )

    def build(self, design: Structure) -> Jointed:
        """One loose slot per node a lamella shares with one of the other family.

        Raises
        ------
        SettingError
            When the slots would cut the strips through.
        """
        sweep = (self.opens_from, np.pi - self.opens_from)
        lap = HalfLap(self.clearance, self.depth_clearance, sweep)
        cuts, fixtures = half_lap(design, lap)
        return Jointed(
            design=design,
            strips=design,
            carriers=tuple(range(len(design.lamellas))),
            cuts=cuts,
            fixtures=fixtures,
            findings=(*slot_findings(design), *self._findings(design, cuts)),
        )

    def _findings(self, design: Structure, cuts: Mapping[str, Cuts]) -> Iterator[Finding]:
        plays = _plays(design, cuts)
        if plays:
            yield self._loose(plays)
        web = design.profile.width / 2.0 - self.depth_clearance
        widest = max(
            ((slot.width, mark, slot.node) for mark, own in cuts.items() for slot in own.slots),
            default=(0.0, "", ""),
        )
        if widest[0] > web:
            width, mark, node = widest
            yield Finding(
                "wide-slot",
                Severity.ERROR,
                f"{mark} at {node}",
                width,
                web,
                "mm",
                f"The slot of {mark} at {node} is {width:.1f} mm wide, the web behind it only "
                f"{web:g} mm high: the strip folds there. " + self._opening(design, web),
            )

    def _opening(self, design: Structure, web: float) -> str:
        """Advice: from which angle the slots are no wider than the web."""
        t = design.profile.thickness
        sharpest = np.degrees(_sharpest(np.array([web - self.clearance]), t)[0])
        if np.isnan(sharpest):
            return "Use a thinner strip."
        return f"Open the grid from {np.ceil(sharpest):g} degrees, or use a thinner strip."

    def _loose(self, plays: Mapping[str, AnglePlay]) -> Finding:
        name, worst = max(plays.items(), key=lambda item: item[1].sharper)
        play, limit = float(np.degrees(worst.sharper)), float(np.degrees(self.control))
        loose = sum(one.sharper > self.control for one in plays.values())
        held = f"The slots let {name} close by {play:.1f} degrees more than built"
        if not loose:
            return Finding(
                "angle-play", Severity.INFO, name, play, limit, "degrees", f"{held}, the most."
            )
        return Finding(
            "angle-play",
            Severity.WARNING,
            name,
            play,
            limit,
            "degrees",
            f"{held}; {loose} of {len(plays)} nodes by more than {limit:g}: the slots do not "
            "control the angle. Tie the diagonals of some fields, or open the grid from a blunter "
            "angle.",
        )


@dataclass(frozen=True)
class AnglePlay:
    """How far the two strips of a node can turn from the angle they are built at.

    Parameters
    ----------
    angle : between them as built, in (0, pi / 2], radians.
    sharper : how much sharper it can become until the walls touch, radians.
    blunter : how much further it can open, past 90 degrees to the same limit, radians.
    """

    angle: float
    sharper: float
    blunter: float


def angle_play(jointed: Jointed) -> dict[str, AnglePlay]:
    """How far the slots let each node turn, by its name.

    Strips are taken as straight around the node: twist takes a little of the play away. Both slots
    of a node hold it; the narrower one counts.
    """
    return _plays(jointed.strips, jointed.cuts)


def _plays(strips: Structure, cuts: Mapping[str, Cuts]) -> dict[str, AnglePlay]:
    widths: dict[str, float] = {}
    for own in cuts.values():
        for slot in own.slots:
            widths[slot.node] = min(slot.width, widths.get(slot.node, np.inf))
    nodes = [node for node in strips.nodes if node.regular and node.name in widths]
    limit = _sharpest(np.array([widths[n.name] for n in nodes]), strips.profile.thickness)
    plays = {}
    for node, sharpest in zip(nodes, limit.tolist(), strict=True):
        angle = float(node.angle or np.pi / 2.0)
        sharp = min(angle, np.pi - angle)
        plays[node.name] = AnglePlay(sharp, sharp - sharpest, np.pi - sharpest - sharp)
    return plays


def _sharpest(width: Floats, thickness: float) -> Floats:
    """(n,) smallest angle at which a strip passes slots of *width* in one as thick, radians.

    w = t (1 + cos a) / sin a = t / tan(a / 2); NaN where a slot is narrower than the strip.
    """
    ratio = np.where(width >= thickness, width / thickness, np.nan)
    return np.asarray(2.0 * np.arctan(1.0 / ratio))
