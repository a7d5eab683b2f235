"""The fit-test coupon: slots of graded clearance, to learn which one the real sheet wants.

Sheets are rarely as thick as they are sold and a beam has a width, so the shop cuts two coupons,
turns one upside down, puts slot into slot at the node angle, and draws the clearance that fits.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from math import isfinite, pi, sin, tan

import numpy as np

from fabrication.cut import SQUARE, Edge, Relief, Slot, area, outline
from fabrication.parts import LETTER, Label
from fabrication.stock import Profile
from gridshell import SettingError
from gridshell.arrays import Floats

GRADES = (-0.2, -0.1, 0.0, 0.1, 0.2, 0.3, 0.4)
"""Added to the drawn clearance from slot to slot, mm."""


@dataclass(frozen=True, eq=False)
class Coupon:
    """A sheet part with one slot per clearance; cut it twice.

    Parameters
    ----------
    mark : engraved.
    outline : (k, 2) or (k, 3), see ``FlatPart``, mm.
    slots : in order along the coupon, all open to the upper edge.
    clearances : of each slot, mm.
    labels : the mark, and under each slot its clearance.
    length, width, thickness : mm.
    """

    mark: str
    outline: Floats
    slots: tuple[Slot, ...]
    clearances: tuple[float, ...]
    labels: tuple[Label, ...]
    length: float
    width: float
    thickness: float

    @property
    def circles(self) -> Floats:
        """(0, 3): no holes."""
        return np.empty((0, 3))

    @property
    def area(self) -> float:
        """Net area, mm2."""
        return area(self.outline)


def coupon(
    profile: Profile,
    *,
    angle: float = pi / 2.0,
    clearance: float = 0.3,
    depth_clearance: float = 0.5,
    grades: Sequence[float] = GRADES,
    relief: Relief = SQUARE,
    mark: str = "FIT",
) -> Coupon:
    """Slots t / sin(angle) + t / |tan(angle)| + clearance + grade wide, for each of *grades*.

    Parameters
    ----------
    angle : typical node angle, in (0, pi), radians. The coupon is flat: without twist.
    clearance, depth_clearance : of the joint as drawn, mm.
    grades : ascending, mm.
    relief : of the floors.

    Raises
    ------
    SettingError
        For an angle outside (0, pi), no grades, grades that do not ascend, or a slot without width.
    """
    if not 0.0 < angle < pi:
        raise SettingError(
            "A coupon needs the angle at which its strips cross",
            where="coupon.angle",
            value=f"{np.degrees(angle):g} degrees",
            limit="> 0, < 180",
            advice="the typical node angle",
        )
    steps = np.asarray(grades, dtype=float)
    bare = profile.thickness * (1.0 / sin(angle) + abs(1.0 / tan(angle)))
    widths = bare + clearance + steps
    good = steps.size and np.isfinite(widths).all() and (np.diff(steps) > 0.0).all()
    if not (good and widths[0] > 0.0 and isfinite(depth_clearance)):
        raise SettingError(
            "The grades of a coupon ascend, and every slot has a width",
            where="coupon.grades",
            value=", ".join(f"{g:g}" for g in steps.ravel()),
            limit=f"> {-(bare + clearance):.2f} mm",
            advice="grades from -0.2 to 0.4 in steps of 0.1",
        )
    return _cut(profile, widths, clearance + steps, depth_clearance, relief, mark)


def _cut(
    profile: Profile, widths: Floats, clearances: Floats, beyond: float, relief: Relief, mark: str
) -> Coupon:
    """Slots far enough apart for their labels and for a web three times the thickness."""
    height = max(min(profile.width / 8.0, 10.0), 2.0)
    told = [f"{c:+.2f}" for c in clearances.tolist()]
    text = LETTER * height * max(map(len, told))
    pitch = max(1.3 * text, float(widths[-1]) + max(3.0 * profile.thickness, 10.0))
    start = 1.3 * LETTER * height * len(mark) + pitch / 2.0
    depth = profile.width / 2.0 + beyond
    slots = tuple(
        Slot(start + k * pitch, w, depth, Edge.UPPER, c, mark, relief)
        for k, (w, c) in enumerate(zip(widths.tolist(), told, strict=True))
    )
    length = start + (len(slots) - 0.5) * pitch
    behind = 0.2 * profile.width
    labels = (
        Label(mark, (start - pitch / 2.0) / 2.0, behind, height),
        *(Label(c, s.x, behind, height) for c, s in zip(told, slots, strict=True)),
    )
    return Coupon(
        mark=mark,
        outline=outline(length, profile.width, slots),
        slots=slots,
        clearances=tuple(clearances.tolist()),
        labels=labels,
        length=length,
        width=profile.width,
        thickness=profile.thickness,
    )
