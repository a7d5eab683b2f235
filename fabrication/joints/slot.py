"""The slot joint (Fig. 15a): both lamellas are slotted to half their width and pushed together.

Slots vary with the node angle and set it when the strips go together; they are welded then. The
cuts themselves are those of every slotted joint, see ``half_lap``.
"""

from __future__ import annotations

from dataclasses import dataclass

from fabrication.jointed import BillLine, Jointed
from fabrication.joints.half_lap import HalfLap, half_lap, slot_findings
from fabrication.joints.joint import Joint
from fabrication.stock import require_distance
from fabrication.structures import Structure


@dataclass(frozen=True)
class SlotJoint(Joint):
    """Half-lap slots.

    Parameters
    ----------
    clearance : added to the width so that the strips go together, mm (0.1 to 0.3 for steel).
    depth_clearance : added to the half depth, so that the floors never touch first, mm.
    weld : length of the seam in each of the four corners of a node, mm; 0 where nothing is welded.

    Raises
    ------
    SettingError
        For a negative clearance or seam.
    """

    clearance: float = 0.3
    depth_clearance: float = 0.5
    weld: float = 0.0

    def __post_init__(self) -> None:
        for key in ("clearance", "depth_clearance", "weld"):
            require_distance(key, getattr(self, key))

    def build(self, design: Structure) -> Jointed:
        """One slot per node a lamella shares with one of the other family.

        Raises
        ------
        SettingError
            When the slots would cut the strips through.
        """
        cuts, fixtures = half_lap(design, HalfLap(self.clearance, self.depth_clearance))
        return Jointed(
            design=design,
            strips=design,
            carriers=tuple(range(len(design.lamellas))),
            cuts=cuts,
            fixtures=fixtures,
            bill=self._bill(design),
            findings=slot_findings(design),
        )

    def _bill(self, design: Structure) -> tuple[BillLine, ...]:
        seams = 4 * sum(node.regular for node in design.nodes)
        if self.weld == 0.0 or seams == 0:
            return ()
        size = f"{self.weld:g} mm"
        return (BillLine("weld", size, seams * self.weld, "mm", note="four corners of every node"),)
