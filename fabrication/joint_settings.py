"""What ``[joint]`` stands for."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import fabrication.stock as stock
from fabrication.joint_sections import DoubleSlotSection, JointSection, SlotSection
from fabrication.joints import DoubleSlotJoint, Joint, SlotJoint, StarWasher
from fabrication.section_types import MaterialSection
from fabrication.settings import material_of


def joint_of(section: JointSection, profile: stock.Profile) -> Joint:
    """The joint of ``[joint]`` between strips of *profile*.

    Raises
    ------
    SettingError
        When its sizes do not go together.
    """
    return _MAKERS[section.kind](section, profile)


def _slot(section: SlotSection, _: stock.Profile) -> Joint:
    return SlotJoint(section.clearance, section.depth_clearance, section.weld)


def _double_slot(section: DoubleSlotSection, profile: stock.Profile) -> Joint:
    washer = section.washer
    star = StarWasher(
        washer.thickness, washer.arm, washer.beyond, _own_or(washer.material, profile)
    )
    return DoubleSlotJoint(
        section.spacing, section.bolt, star, section.clearance, section.depth_clearance
    )


def _own_or(chosen: str | MaterialSection | None, profile: stock.Profile) -> stock.Material:
    """The *chosen* material, or that of the strips."""
    return profile.material if chosen is None else material_of(chosen)


_MAKERS: dict[str, Callable[[Any, stock.Profile], Joint]] = {
    "slot": _slot,
    "double-slot": _double_slot,
}
