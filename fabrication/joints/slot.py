"""The slot joint (Fig. 15a): both lamellas are slotted to half their width and pushed together.

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

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from fabrication.cut import Edge, Slot
from fabrication.finding import Finding, Severity
from fabrication.joints.joint import Joint
from fabrication.node import Node
from fabrication.stock import require_web
from fabrication.structures import Structure
from gridshell import SettingError
from gridshell.arrays import Floats

_HEIGHTS = 17
_SHARPEST = np.radians(15.0)


@dataclass(frozen=True)
class SlotJoint(Joint):
    """Half-lap slots.

    Parameters
    ----------
    clearance : added to the width so that the strips go together, mm (0.1 to 0.3 for steel).
    depth_clearance : added to the half depth, so that the floors never touch first, mm.

    Raises
    ------
    SettingError
        For a negative clearance.
    """

    clearance: float = 0.3
    depth_clearance: float = 0.5

    def __post_init__(self) -> None:
        for key in ("clearance", "depth_clearance"):
            value = getattr(self, key)
            if not (np.isfinite(value) and value >= 0.0):
                raise SettingError(
                    "A clearance cannot be negative",
                    where=key,
                    value=f"{value:g} mm",
                    limit=">= 0",
                    advice="0.1 to 0.3 mm for steel, 0 for pressed plywood",
                )

    def cuts(self, structure: Structure) -> Mapping[str, tuple[Slot, ...]]:
        """One slot per node a lamella shares with one of the other family.

        Raises
        ------
        SettingError
            When the slots would cut the strips through.
        """
        require_web(structure.profile, self.depth_clearance)
        slots: dict[str, list[Slot]] = {lamella.mark: [] for lamella in structure.lamellas}
        regular = [node for node in structure.nodes if node.regular]
        widths = self._widths(structure, regular)
        for node, drawn in zip(regular, widths.tolist(), strict=True):
            for own, partner, width in zip(
                node.crossings, node.crossings[::-1], drawn, strict=True
            ):
                lamella = structure.lamellas[own.lamella]
                slots[lamella.mark].append(
                    Slot(
                        x=own.station - lamella.start,
                        width=width,
                        depth=structure.profile.width / 2.0 + self.depth_clearance,
                        edge=Edge.UPPER if lamella.family == 1 else Edge.LOWER,
                        node=node.name,
                        partner=structure.lamellas[partner.lamella].mark,
                    )
                )
        return {mark: tuple(sorted(cuts, key=lambda s: s.x)) for mark, cuts in slots.items()}

    def findings(self, structure: Structure) -> tuple[Finding, ...]:
        """Nodes without a joint, and angles too sharp to slot."""
        found = []
        for node in structure.nodes:
            if len(node.crossings) > 2:
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

    def _widths(self, structure: Structure, nodes: Sequence[Node]) -> Floats:
        """(n, 2) drawn widths of the slots in family 1 and in family 2, mm."""
        tangents, twists = _at_nodes(structure, nodes)
        axes = np.array([node.axis for node in nodes]).reshape(-1, 3)
        across = np.einsum("nc,nc->n", np.cross(tangents[:, 0], tangents[:, 1]), axes)
        angle = np.arctan2(across, np.einsum("nc,nc->n", tangents[:, 0], tangents[:, 1]))
        shared = np.linspace(-self.depth_clearance, structure.profile.width / 2.0, _HEIGHTS)
        thickness = structure.profile.thickness
        filled = [
            slot_width(
                angle=sign * angle[:, None],
                own_twist=twists[:, own, None],
                partner_twist=twists[:, 1 - own, None],
                own_thickness=thickness,
                partner_thickness=thickness,
                heights=sign * shared,
            ).max(axis=1)
            for own, sign in ((0, 1.0), (1, -1.0))
        ]
        return np.stack(filled, axis=1) + self.clearance


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


def _at_nodes(structure: Structure, nodes: Sequence[Node]) -> tuple[Floats, Floats]:
    """(n, 2, 3) tangents and (n, 2) rates of twist of both families at regular *nodes*."""
    tangents, twists = np.zeros((len(nodes), 2, 3)), np.zeros((len(nodes), 2))
    rows: dict[int, list[tuple[int, float]]] = {}
    for row, node in enumerate(nodes):
        for crossing in node.crossings:
            rows.setdefault(crossing.lamella, []).append((row, crossing.station))
    for number, entries in rows.items():
        lamella = structure.lamellas[number]
        here = np.array([row for row, _ in entries])
        stations = np.array([station for _, station in entries])
        tangents[here, lamella.family - 1] = lamella.axis.tangents(stations)
        twists[here, lamella.family - 1] = lamella.twist(stations)
    return tangents, twists
