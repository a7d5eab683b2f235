"""Half-lap slots, as every slotted joint has them (Fig. 15 a and d).

Family A is slotted from above, family B from below. A slot's walls follow the rulings of its own
strip, so the width must hold the partner as it turns against those rulings with the height z over
the axis. With a the signed angle from the own tangent to the partner's, t1 and t2 own and partner
thickness, and d1 = atan(w1 z), d2 = atan(w2 z) the turn of each strip at height z (w1, w2 the
rates of twist), the partner fills

    w(z) = (t2 cos d1 cos d2 + t1 |cos(a + d2)| cos d1) / |sin(a - d1 + d2)|

along the own axis; for d1 = d2 = 0 this is t2 / sin a + t1 / |tan a|. The slot is drawn with the
largest w(z) over the height where the two strips share it, plus the clearance.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from fabrication.cut import Cuts, Edge, Slot
from fabrication.finding import Finding, Severity
from fabrication.jointed import Feature, Fixture
from fabrication.joints.node_frames import node_tangents, node_twists
from fabrication.node import Node, rows_by_lamella
from fabrication.stock import require_web
from fabrication.structures import Structure
from gridshell.arrays import Floats

_HEIGHTS = 17
_SHARPEST = np.radians(15.0)


@dataclass(frozen=True)
class HalfLap:
    """How half-lap slots are cut.

    Parameters
    ----------
    clearance, depth_clearance : see ``SlotJoint``, mm.
    sweep : smallest and largest angle between the two strips that the slots must let pass besides
        their own, while the grid is opened like scissors, flat on the ground, radians.
    """

    clearance: float = 0.3
    depth_clearance: float = 0.5
    sweep: tuple[float, float] | None = None


def half_lap(strips: Structure, lap: HalfLap) -> tuple[dict[str, Cuts], tuple[Fixture, ...]]:
    """A slot in both strips at every regular node of *strips*, and where it lies in space.

    Raises
    ------
    SettingError
        When the slots would cut the strips through.
    """
    profile = strips.profile
    require_web(profile, lap.depth_clearance)
    slots: dict[str, list[Slot]] = {lamella.mark: [] for lamella in strips.lamellas}
    fixtures = []
    regular = [node for node in strips.nodes if node.regular]
    widths = slot_widths(strips, regular, lap)
    for node, drawn in zip(regular, widths.tolist(), strict=True):
        for own, partner, width in zip(node.crossings, node.crossings[::-1], drawn, strict=True):
            lamella = strips.lamellas[own.lamella]
            x = own.station - lamella.start
            slots[lamella.mark].append(
                Slot(
                    x=x,
                    width=width,
                    depth=profile.width / 2.0 + lap.depth_clearance,
                    edge=Edge.UPPER if lamella.family == 1 else Edge.LOWER,
                    node=node.name,
                    partner=strips.lamellas[partner.lamella].mark,
                )
            )
            middle = profile.width / 2.0
            fixtures.append(
                Fixture(lamella.mark, node.name, Feature.SLOT, x, middle, node.position, node.axis)
            )
    cuts = {mark: Cuts(tuple(sorted(own, key=lambda s: s.x))) for mark, own in slots.items()}
    return cuts, tuple(fixtures)


def slot_findings(strips: Structure) -> tuple[Finding, ...]:
    """Nodes without a joint, and angles too sharp to slot."""
    found = []
    for node in strips.nodes:
        if node.singular:
            found.append(
                Finding(
                    code="singular-node",
                    severity=Severity.WARNING,
                    where=node.name,
                    value=float(len(node.crossings)),
                    limit=2.0,
                    unit="lamellas",
                    message=f"{len(node.crossings)} lamellas end at {node.name}; a slot joint "
                    "connects two. The strips stop short of each other: add a connector.",
                )
            )
        elif node.angle is not None and min(node.angle, np.pi - node.angle) < _SHARPEST:
            found.append(
                Finding(
                    code="sharp-angle",
                    severity=Severity.ERROR,
                    where=node.name,
                    value=float(np.degrees(node.angle)),
                    limit=float(np.degrees(_SHARPEST)),
                    unit="degrees",
                    message=f"The lamellas meet at {np.degrees(node.angle):.1f} degrees at "
                    f"{node.name}: the slot becomes too long. Open the node angle.",
                )
            )
    return tuple(found)


def slot_widths(strips: Structure, nodes: Sequence[Node], lap: HalfLap) -> Floats:
    """(n, 2) drawn widths of the slots in family 1 and in family 2 at regular *nodes*, mm."""
    tangents, twists = node_tangents(strips, nodes), node_twists(strips, nodes)
    axes = np.array([node.axis for node in nodes]).reshape(-1, 3)
    across = np.einsum("nc,nc->n", np.cross(tangents[:, 0], tangents[:, 1]), axes)
    angle = np.arctan2(across, np.einsum("nc,nc->n", tangents[:, 0], tangents[:, 1]))
    shared = np.linspace(-lap.depth_clearance, strips.profile.width / 2.0, _HEIGHTS)
    thickness = strips.profile.thickness
    states = [(angle, twists)]
    if lap.sweep is not None:
        flat = np.zeros_like(twists)
        states += [(np.copysign(np.full_like(angle, a), angle), flat) for a in lap.sweep]
    filled = [
        np.max(
            [
                slot_width(
                    angle=sign * at[:, None],
                    own_twist=turning[:, own, None],
                    partner_twist=turning[:, 1 - own, None],
                    own_thickness=thickness,
                    partner_thickness=thickness,
                    heights=sign * shared,
                ).max(axis=1)
                for at, turning in states
            ],
            axis=0,
        )
        for own, sign in ((0, 1.0), (1, -1.0))
    ]
    return np.stack(filled, axis=1) + _astray(strips, nodes, tangents) + lap.clearance


def _astray(strips: Structure, nodes: Sequence[Node], tangents: Floats) -> Floats:
    """(n, 2) what slots need because the two strips' own lines at a node are not quite one, mm.

    Strips beside their axes share the axis of a crossing to the second order only.
    """
    heights = strips.profile.width * np.array([-0.5, 0.0, 0.5])
    lines = np.zeros((len(nodes), 2, 3, 3))
    for number, (here, stations) in rows_by_lamella(nodes).items():
        lamella = strips.lamellas[number]
        s, z = np.repeat(stations, 3), np.tile(heights, len(here))
        lines[here, lamella.family - 1] = lamella.place(s, np.zeros_like(s), z).reshape(-1, 3, 3)
    apart = np.einsum("nzc,nfc->nfz", lines[:, 0] - lines[:, 1], tangents)
    return np.asarray(2.0 * np.abs(apart).max(axis=2, initial=0.0))


def slot_width(
    *,
    angle: Floats | float,
    own_twist: Floats | float,
    partner_twist: Floats | float,
    own_thickness: float,
    partner_thickness: float,
    heights: Floats,
) -> Floats:
    """Length along the own axis that the partner fills at each height, mm.

    All arguments broadcast against each other.

    Parameters
    ----------
    angle : signed, from the own tangent to the partner's about the node axis, radians.
    own_twist, partner_twist : rates of twist dn/ds . b, rad/mm.
    own_thickness, partner_thickness : mm.
    heights : over the axis along the node axis, mm.
    """
    d1, d2 = np.arctan(own_twist * heights), np.arctan(partner_twist * heights)
    partner_part = partner_thickness * np.cos(d1) * np.cos(d2)
    own_part = own_thickness * np.abs(np.cos(angle + d2)) * np.cos(d1)
    return np.asarray((partner_part + own_part) / np.abs(np.sin(angle - d1 + d2)))
