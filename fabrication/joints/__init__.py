"""Joints: one file each, one line in the registry."""

from fabrication.joints.double_slot import DoubleSlotJoint, StarWasher
from fabrication.joints.half_lap import slot_width
from fabrication.joints.joint import Joint
from fabrication.joints.slot import SlotJoint

JOINTS: dict[str, type[Joint]] = {
    "slot": SlotJoint,
    "double-slot": DoubleSlotJoint,
}

__all__ = ["JOINTS", "DoubleSlotJoint", "Joint", "SlotJoint", "StarWasher", "slot_width"]
