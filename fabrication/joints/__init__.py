"""Joints: one file each, one line in the registry."""

from fabrication.joints.cleats import Cleat
from fabrication.joints.double_slot import DoubleSlotJoint, StarWasher
from fabrication.joints.half_lap import slot_width
from fabrication.joints.hinged import HingedJoint
from fabrication.joints.joint import Joint
from fabrication.joints.reciprocal import ReciprocalJoint
from fabrication.joints.scissor import AnglePlay, ScissorJoint, angle_play
from fabrication.joints.slot import SlotJoint
from fabrication.joints.stud import StudJoint
from fabrication.joints.stud_shapes import Stud

JOINTS: dict[str, type[Joint]] = {
    "slot": SlotJoint,
    "scissor": ScissorJoint,
    "reciprocal": ReciprocalJoint,
    "two-level": StudJoint,
    "double-slot": DoubleSlotJoint,
    "hinged": HingedJoint,
}

__all__ = [
    "JOINTS",
    "AnglePlay",
    "Cleat",
    "DoubleSlotJoint",
    "HingedJoint",
    "Joint",
    "ReciprocalJoint",
    "ScissorJoint",
    "SlotJoint",
    "StarWasher",
    "Stud",
    "StudJoint",
    "angle_play",
    "slot_width",
]
