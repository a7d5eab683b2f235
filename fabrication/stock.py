"""What a strip is cut from: material, profile, sheet. Lengths mm, stresses N/mm2, density kg/m3."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from gridshell import SettingError


def require_positive(key: str, value: float) -> None:
    """Raise SettingError unless *value* is a positive, finite number."""
    if not (np.isfinite(value) and value > 0.0):
        raise SettingError(
            "A size must be positive",
            where=key,
            value=f"{value:g}",
            limit="> 0",
            advice="check the sign and the unit",
        )


def require_distance(key: str, value: float) -> None:
    """Raise SettingError unless *value* is nought or more, and finite."""
    if not (np.isfinite(value) and value >= 0.0):
        raise SettingError(
            "A distance cannot be negative",
            where=key,
            value=f"{value:g} mm",
            limit=">= 0",
            advice="check the sign",
        )


@dataclass(frozen=True)
class Material:
    """An elastic material.

    Parameters
    ----------
    name : as it appears in lists.
    modulus : Young's modulus, N/mm2.
    strength : the stress a strip may see while it is bent into place, N/mm2.
    density : kg/m3.

    Raises
    ------
    SettingError
        For a number that is not positive.
    """

    name: str
    modulus: float
    strength: float
    density: float

    def __post_init__(self) -> None:
        for key in ("modulus", "strength", "density"):
            require_positive(key, getattr(self, key))


S235 = Material("S235", modulus=210_000.0, strength=235.0, density=7850.0)
"""Structural steel, EN 10025-2: yield strength 235 N/mm2 up to 16 mm."""

STAINLESS = Material("stainless", modulus=200_000.0, strength=220.0, density=7900.0)
"""Austenitic stainless steel sheet, 0.2 % proof strength 220 N/mm2 (EN 10088-2, 1.4301)."""

BIRCH_PLY = Material("birch-ply", modulus=10_000.0, strength=40.0, density=680.0)
"""Birch plywood along the grain, rounded down from manufacturers' bending values."""

GLASS = Material("glass", modulus=70_000.0, strength=45.0, density=2500.0)
"""Float glass, EN 572-1: characteristic bending strength 45 N/mm2, before any safety factor."""

MATERIALS = {material.name: material for material in (S235, STAINLESS, BIRCH_PLY, GLASS)}


@dataclass(frozen=True)
class Profile:
    """The section of a lamella: a strip standing on the surface.

    Parameters
    ----------
    width : along the surface normal, mm.
    thickness : across the strip, mm.
    material : what it is made of.

    Raises
    ------
    SettingError
        For a size that is not positive, or a strip thicker than a third of its width.
    """

    width: float
    thickness: float
    material: Material

    def __post_init__(self) -> None:
        require_positive("width", self.width)
        require_positive("thickness", self.thickness)
        if self.thickness > self.width / 3.0:
            raise SettingError(
                "A lamella must be a strip: much wider than thick",
                where="thickness",
                value=f"{self.thickness:g} mm",
                limit=f"at most a third of the width, {self.width / 3.0:g} mm",
                advice="a thinner strip, or a wider one",
            )


def require_web(profile: Profile, depth_clearance: float) -> None:
    """Refuse slots, half the strip's width and *depth_clearance* mm deep, that cut it through.

    Raises
    ------
    SettingError
        When nothing of the strip is left behind them.
    """
    if not depth_clearance < profile.width / 2.0:
        raise SettingError(
            "The slots cut the strips through",
            where="depth_clearance",
            value=f"{depth_clearance:g} mm",
            limit=f"below half the strip's width, {profile.width / 2.0:g} mm",
            advice="0.5 mm",
        )


@dataclass(frozen=True)
class Sheet:
    """Raw material as it lies on the machine.

    Parameters
    ----------
    length, width : mm.
    margin : kept free along every edge, mm.
    gap : between neighbouring parts, mm.

    Raises
    ------
    SettingError
        For a size that is not positive or a margin that leaves nothing.
    """

    length: float
    width: float
    margin: float = 10.0
    gap: float = 10.0

    def __post_init__(self) -> None:
        for key in ("length", "width"):
            require_positive(key, getattr(self, key))
        for key in ("margin", "gap"):
            require_distance(key, getattr(self, key))
        if 2.0 * self.margin >= min(self.length, self.width):
            raise SettingError(
                "The margins leave nothing of the sheet",
                where="margin",
                value=f"{self.margin:g} mm",
                limit=f"below {min(self.length, self.width) / 2.0:g} mm",
            )
