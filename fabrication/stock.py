"""What a strip is cut from: profile and sheet, of a material. Lengths mm."""

from __future__ import annotations

from dataclasses import dataclass

from fabrication.materials import BIRCH_PLY as BIRCH_PLY
from fabrication.materials import GLASS as GLASS
from fabrication.materials import GRP as GRP
from fabrication.materials import MATERIALS as MATERIALS
from fabrication.materials import POPLAR_PLY as POPLAR_PLY
from fabrication.materials import S235 as S235
from fabrication.materials import S355 as S355
from fabrication.materials import STAINLESS as STAINLESS
from fabrication.materials import Material as Material
from fabrication.sizes import require_distance as require_distance
from fabrication.sizes import require_positive as require_positive
from gridshell import SettingError


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

    @property
    def size(self) -> str:
        """Width by thickness, mm: "100 x 2.5"."""
        return f"{self.width:g} x {self.thickness:g}"

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


@dataclass(frozen=True)
class HollowProfile(Profile):
    """A rectangular hollow section: a tube that bends and twists as a strip does.

    Parameters
    ----------
    width, thickness : its outer sizes, as of a strip: along the surface normal and across, mm.
    wall : of all four walls, mm.

    Raises
    ------
    SettingError
        For a size that is not positive, a tube thicker than wide, or walls that fill it.
    """

    wall: float

    @property
    def size(self) -> str:
        """Width by thickness by wall, mm: "40 x 14 x 2"."""
        return f"{super().size} x {self.wall:g}"

    def __post_init__(self) -> None:
        for key in ("width", "thickness", "wall"):
            require_positive(key, getattr(self, key))
        if self.thickness > self.width:
            raise SettingError(
                "A hollow section stands upright on the surface",
                where="thickness",
                value=f"{self.thickness:g} mm",
                limit=f"at most the width, {self.width:g} mm",
                advice="width and thickness the other way round",
            )
        if not 2.0 * self.wall < self.thickness:
            raise SettingError(
                "The walls leave no room inside",
                where="wall",
                value=f"{self.wall:g} mm",
                limit=f"below half the thickness, {self.thickness / 2.0:g} mm",
                advice=f"{self.thickness / 8.0:.2g} mm",
            )


def wall_of(profile: Profile) -> float:
    """Wall of a hollow section, mm; 0 for a solid strip."""
    return profile.wall if isinstance(profile, HollowProfile) else 0.0


def hollow_area(width: float, thickness: float, wall: float) -> float:
    """Section of a tube, mm2."""
    return width * thickness - (width - 2.0 * wall) * (thickness - 2.0 * wall)


def section_area(profile: Profile) -> float:
    """Of a strip or a tube before it is cut, mm2."""
    wall = wall_of(profile)
    if wall:
        return hollow_area(profile.width, profile.thickness, wall)
    return profile.width * profile.thickness


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
