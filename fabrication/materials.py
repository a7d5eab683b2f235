"""Materials of strips and panels, and where the numbers of the known ones come from.

Strengths are short-term ones and carry no safety factor. Wood and fibre plastics that stay bent
for years creep and break at less: give a material of one's own with the share that is allowed.
Values of wood and plastics differ by maker and lay-up; the maker's declaration goes before these.
Stresses and moduli in N/mm2, densities in kg/m3.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from fabrication.sizes import require_positive

_ISOTROPIC = 2.6
"""Young's over shear modulus of a metal: 2 (1 + 0.3)."""

_STEEL_MODULUS, _STEEL = 170_000.0, (7500.0, 8200.0)
"""N/mm2 and kg/m3: all structural and stainless steels, no cast iron, brass, titanium."""
_TIMBER, _TIMBER_DENSITY = (2_000.0, 30_000.0), 1100.0
"""N/mm2 and kg/m3: from fibre board to the hardest woods, no fibre plastics."""


@dataclass(frozen=True)
class Material:
    """An elastic material, as a strip cut along its stronger direction sees it.

    Parameters
    ----------
    name : as it appears in lists.
    modulus : Young's modulus along the strip, N/mm2.
    strength : the stress along the strip it may see while it is bent into place, N/mm2.
    density : kg/m3.
    shear_modulus : within the sheet, which resists twist, N/mm2; that of an isotropic metal,
        modulus / 2.6, unless said otherwise.
    shear_strength : within the sheet, N/mm2; von Mises' strength / sqrt(3) unless said otherwise.

    Raises
    ------
    SettingError
        For a number that is not positive.
    """

    name: str
    modulus: float
    strength: float
    density: float
    shear_modulus: float | None = None
    shear_strength: float | None = None

    def __post_init__(self) -> None:
        for key in ("modulus", "strength", "density", "shear_modulus", "shear_strength"):
            value = getattr(self, key)
            if value is not None:
                require_positive(key, value)

    @property
    def rigidity(self) -> float:
        """Shear modulus that counts, N/mm2."""
        return self.modulus / _ISOTROPIC if self.shear_modulus is None else self.shear_modulus

    @property
    def shear_limit(self) -> float:
        """Shear strength that counts, N/mm2."""
        if self.shear_strength is None:
            return self.strength / float(np.sqrt(3.0))
        return self.shear_strength

    @property
    def is_steel(self) -> bool:
        """Whether it is steel, told by its numbers: own materials have names of any kind."""
        return self.modulus >= _STEEL_MODULUS and min(_STEEL) <= self.density <= max(_STEEL)

    @property
    def is_timber(self) -> bool:
        """Whether it is wood or a board of it, told by its numbers."""
        return min(_TIMBER) <= self.modulus <= max(_TIMBER) and self.density <= _TIMBER_DENSITY


S235 = Material("S235", modulus=210_000.0, strength=235.0, density=7850.0)
"""Structural steel: yield strength 235 N/mm2 up to 16 mm (EN 10025-2, Table 7); modulus, and shear
modulus of rounded 81000 N/mm2, as in EN 1993-1-1, 3.2.6."""

S355 = Material("S355", modulus=210_000.0, strength=355.0, density=7850.0)
"""Structural steel: yield strength 355 N/mm2 up to 16 mm (EN 10025-2, Table 7), else as S235."""

STAINLESS = Material("stainless", modulus=200_000.0, strength=220.0, density=7900.0)
"""Austenitic stainless sheet. The 0.2 % proof strength of 1.4301 is 210 N/mm2 hot rolled and 230
cold rolled (EN 10088-2); 220 is between them. Modulus 200000 N/mm2 (EN 1993-1-4)."""

BIRCH_PLY = Material(
    "birch-ply",
    modulus=10_000.0,
    strength=40.0,
    density=680.0,
    shear_modulus=620.0,
    shear_strength=9.0,
)
"""Birch plywood along the face grain. Makers' handbooks give 5 % bending strengths of 66 to 40
N/mm2 and moduli of 16500 to 10000 N/mm2 from 4 to 21 mm: here the lower ends. Modulus over
strength, which decides how tightly a strip bends, is 250 all along. Panel shear: modulus 620 N/mm2,
strength 9.5 N/mm2, rounded down. Class by EN 636, tests by EN 310 and EN 789."""

POPLAR_PLY = Material(
    "poplar-ply",
    modulus=6_000.0,
    strength=25.0,
    density=450.0,
    shear_modulus=400.0,
    shear_strength=5.0,
)
"""Poplar plywood along the face grain. Makers declare moduli of 6500 to 9000 N/mm2 (EN 310), the
lighter and cheaper boards less, mean bending strengths of 35 to 45 N/mm2, and 450 to 550 kg/m3.
Rounded down to a cautious 5 % strength; the shear values are estimated from birch by density."""

GRP = Material(
    "GRP",
    modulus=23_000.0,
    strength=240.0,
    density=1800.0,
    shear_modulus=3_000.0,
    shear_strength=25.0,
)
"""Pultruded glass-fibre plastic, grade E23 of EN 13706-3: modulus 23000 N/mm2, longitudinal tensile
and bending strength 240, interlaminar shear strength 25, all minima. Shear modulus 3000 N/mm2 as
makers of such profiles give it, not from the standard; density rounded (1600 to 2100)."""

GLASS = Material("glass", modulus=70_000.0, strength=45.0, density=2500.0, shear_modulus=29_200.0)
"""Float glass, EN 572-1: characteristic bending strength 45 N/mm2, before any safety factor;
Poisson's ratio 0.2, so that the shear modulus is 29167 N/mm2, rounded."""

MATERIALS = {
    material.name: material
    for material in (S235, S355, STAINLESS, BIRCH_PLY, POPLAR_PLY, GRP, GLASS)
}
