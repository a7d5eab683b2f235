"""Splice plates: two strips butt, and plates with bolts on one or both sides hold them together."""

from __future__ import annotations

from dataclasses import dataclass
from enum import Enum

import numpy as np

from fabrication.bolts import EDGE_DISTANCE, HOLE_PLAY, bolt_length
from fabrication.jointed import BillLine
from fabrication.parts import Label
from fabrication.sheet_parts import SheetPiece
from fabrication.stock import Material, require_positive
from gridshell import SettingError
from gridshell.arrays import Floats, frozen

_PITCH = 2.2
"""Between two holes, in diameters of the hole (EN 1993-1-8, Table 3.3)."""


class Sides(Enum):
    """Where the plates of a splice lie; the value is their number."""

    ONE = 1
    BOTH = 2


@dataclass(frozen=True)
class SplicePlate:
    """A plate over the joint of two pieces of a strip; it is bent on site with the strip.

    Parameters
    ----------
    length, width, thickness : mm.
    material : what it is cut from.
    bolt : diameter, mm.
    bolts : on either side of the joint, in a row along the strip at half its width.
    sides : one plate, or one on either face of the strip.

    Raises
    ------
    SettingError
        For a size that is not positive, or holes too near each other or an edge.
    """

    length: float
    width: float
    thickness: float
    material: Material
    bolt: float = 6.0
    bolts: int = 2
    sides: Sides = Sides.BOTH

    def __post_init__(self) -> None:
        for key in ("length", "width", "thickness", "bolt", "bolts"):
            require_positive(f"splice.{key}", getattr(self, key))
        pitch = self.length / (2.0 * self.bolts)
        needed = max(_PITCH, 2.0 * EDGE_DISTANCE) * self.hole
        if pitch < needed:
            raise SettingError(
                "The holes of the splice plate are too near to each other",
                where="splice.length",
                value=f"{self.length:g} mm",
                limit=f"at least {2.0 * self.bolts * needed:.0f} mm for {self.bolts} bolts of "
                f"{self.bolt:g} mm on either side",
                advice="a longer plate, or fewer or smaller bolts",
            )
        if self.width < 2.0 * EDGE_DISTANCE * self.hole:
            raise SettingError(
                "The splice plate is too narrow for its holes",
                where="splice.width",
                value=f"{self.width:g} mm",
                limit=f"at least {2.0 * EDGE_DISTANCE * self.hole:.1f} mm",
                advice="a wider plate, or smaller bolts",
            )

    @property
    def hole(self) -> float:
        """Diameter of the holes, mm."""
        return self.bolt + HOLE_PLAY

    @property
    def offsets(self) -> Floats:
        """(2 bolts,) places of the holes along the strip from the joint, mm."""
        pitch = self.length / (2.0 * self.bolts)
        return np.asarray((np.arange(2 * self.bolts) + 0.5) * pitch - self.length / 2.0)

    def piece(self, mark: str) -> SheetPiece:
        """The plate as it is cut from a sheet."""
        x, y = self.length, self.width
        corners = np.array([[0.0, 0.0], [x, 0.0], [x, y], [0.0, y]])
        holes = np.column_stack(
            [
                self.offsets + x / 2.0,
                np.full(2 * self.bolts, y / 2.0),
                np.full(2 * self.bolts, self.hole),
            ]
        )
        room = y / 2.0 - self.hole / 2.0
        label = Label(mark, x / 2.0, y * 0.82, min(10.0, 0.4 * room, x / (len(mark) + 2)))
        return SheetPiece(mark, frozen(corners), (label,), x, y, self.thickness, frozen(holes))

    def bill(self, splices: int, strip: float) -> tuple[BillLine, ...]:
        """Plates, bolts and nuts of so many splices of strips *strip* mm thick."""
        if not splices:
            return ()
        count = self.sides.value
        grip = strip + count * self.thickness
        bolts = 2 * self.bolts * splices
        return (
            BillLine(
                "splice plate",
                f"{self.length:g} x {self.width:g} x {self.thickness:g} mm",
                count * splices,
                material=self.material.name,
                mass=self._net * self.thickness * self.material.density * 1e-9,
                note=f"{2 * self.bolts} holes of {self.hole:g} mm; bent on site with the strip",
            ),
            BillLine(
                "bolt",
                f"M{self.bolt:g} x {bolt_length(grip, self.bolt):g}",
                bolts,
                note="of the splices",
            ),
            BillLine("nut", f"M{self.bolt:g}", bolts, note="of the splices"),
        )

    @property
    def _net(self) -> float:
        """Area without its holes, mm2."""
        return self.length * self.width - 2 * self.bolts * float(np.pi) * self.hole**2 / 4.0


def require_room(plate: SplicePlate, width: float) -> None:
    """Refuse a plate wider than a strip of *width* mm."""
    if plate.width > width:
        raise SettingError(
            "The splice plate is wider than the strip",
            where="splice.width",
            value=f"{plate.width:g} mm",
            limit=f"at most {width:g} mm",
            advice=f"{0.8 * width:g} mm",
        )
