"""Joints: one file each, one line in the registry."""

from fabrication.joints.joint import Joint
from fabrication.joints.slot import SlotJoint, slot_width

JOINTS: dict[str, type[Joint]] = {
    "slot": SlotJoint,
}

__all__ = ["JOINTS", "Joint", "SlotJoint", "slot_width"]
