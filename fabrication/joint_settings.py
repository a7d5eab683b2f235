"""What ``[joint]`` stands for."""

from __future__ import annotations

from collections.abc import Callable
from math import radians
from typing import Any

import fabrication.stock as stock
from fabrication.joint_sections import (
    BlocksSection,
    CleatSection,
    DoubleSlotSection,
    HingedSection,
    JointSection,
    ReciprocalSection,
    ScissorSection,
    SlotSection,
    StudJointSection,
)
from fabrication.joints import (
    Cleat,
    DoubleSlotJoint,
    HingedJoint,
    Joint,
    ReciprocalJoint,
    ScissorJoint,
    SlotJoint,
    StarWasher,
    Stud,
    StudJoint,
)
from fabrication.section_types import MaterialSection
from fabrication.settings import material_of
from fabrication.shear_blocks import ShearBlock


def joint_of(section: JointSection, profile: stock.Profile) -> Joint:
    """The joint of ``[joint]`` between strips of *profile*.

    Raises
    ------
    SettingError
        When its sizes do not go together.
    """
    return _MAKERS[section.kind](section, profile)


def own_or_strips(chosen: str | MaterialSection | None, profile: stock.Profile) -> stock.Material:
    """The *chosen* material, or that of the strips."""
    return profile.material if chosen is None else material_of(chosen)


def _slot(section: SlotSection, _: stock.Profile) -> Joint:
    return SlotJoint(section.clearance, section.depth_clearance, section.weld)


def _scissor(section: ScissorSection, _: stock.Profile) -> Joint:
    return ScissorJoint(
        opens_from=radians(section.opens_from),
        clearance=section.clearance,
        depth_clearance=section.depth_clearance,
        control=radians(section.control),
    )


def _double_slot(section: DoubleSlotSection, profile: stock.Profile) -> Joint:
    washer = section.washer
    material = own_or_strips(washer.material, profile)
    star = StarWasher(washer.thickness, washer.arm, washer.beyond, material)
    return DoubleSlotJoint(
        section.spacing, section.bolt, star, section.clearance, section.depth_clearance
    )


def _hinged(section: HingedSection, _: stock.Profile) -> Joint:
    return HingedJoint(section.pin, section.gap, section.play)


def _reciprocal(section: ReciprocalSection, profile: stock.Profile) -> Joint:
    return ReciprocalJoint(
        gap=section.gap,
        through=1 if section.through == "A" else 2,
        pinwheel=section.pinwheel,
        square_ends=section.square_ends,
        weld=section.weld,
        cleat=None if section.cleat is None else _cleat(section.cleat, profile),
        shortest=section.shortest,
        sharpest=radians(section.sharpest),
    )


def _cleat(section: CleatSection, profile: stock.Profile) -> Cleat:
    material = own_or_strips(section.material, profile)
    return Cleat(section.leg, section.thickness, section.height, material, section.play)


def _stud(section: StudJointSection, profile: stock.Profile) -> Joint:
    stud = section.stud
    return StudJoint(
        spacing=section.spacing,
        stud=Stud(
            own_or_strips(stud.material, profile),
            size=stud.size,
            length=stud.length,
            wall=stud.wall,
            fit=stud.fit,
            step=stud.step,
        ),
        level=section.level,
        bolt=section.bolt,
        blocks=None if section.blocks is None else _blocks(section.blocks, profile),
    )


def _blocks(section: BlocksSection, profile: stock.Profile) -> ShearBlock:
    return ShearBlock(
        per_bay=section.per_bay,
        length=section.length,
        material=own_or_strips(section.material, profile),
        height=section.height,
        bolt=section.bolt,
        play=section.play,
        step=section.step,
    )


_MAKERS: dict[str, Callable[[Any, stock.Profile], Joint]] = {
    "slot": _slot,
    "scissor": _scissor,
    "reciprocal": _reciprocal,
    "two-level": _stud,
    "double-slot": _double_slot,
    "hinged": _hinged,
}
