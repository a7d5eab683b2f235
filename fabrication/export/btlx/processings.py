"""What is done to a strip, as BTLx processings.

Element names, their order and their ranges are those of the published schema BTLx 2.0.0 of
design2machine. A strip's length is the part's Length, its thickness the Width, its width the
Height. Reference side 1 is its lower edge and 3 its upper one, both as wide as the strip is thick;
side 4 is the face that is engraved, with x along the strip and y from its lower edge up, as in the
DXF sheets. A dimension is in mm, an angle in degrees.
"""

from __future__ import annotations

from collections.abc import Iterator
from itertools import pairwise
from xml.etree.ElementTree import Element, SubElement

import numpy as np

from fabrication.cut import Edge, Floor, Hole, Slot
from fabrication.parts import FlatPart, Label

FACE = 4
"""Reference side that is engraved and drilled."""
_EDGES = {Edge.LOWER: 1, Edge.UPPER: 3}


def processings(part: FlatPart) -> Iterator[Element]:
    """Both ends, slots, holes and texts of *part*, in this order, numbered from 1."""
    made = [
        _end(part, "start"),
        _end(part, "end"),
        *(_slot(slot, part) for slot in part.slots),
        *(_drilling(hole, part) for hole in part.holes),
        *(_text(label) for label in part.labels),
    ]
    for number, element in enumerate(made, start=1):
        element.set("ProcessID", f"{number}")
        yield element


def number(value: float) -> str:
    """A dimension or an angle: four digits behind the point, and no negative nought."""
    return f"{round(value, 4) + 0.0:.4f}"


def _processing(name: str, side: int, **attributes: str) -> Element:
    """An element with the attributes that every processing has."""
    given = {"Name": name, "Process": "yes", "Priority": "0", "ReferencePlaneID": f"{side}"}
    return Element(name, {**given, **attributes})


def _with(element: Element, **values: str | float) -> Element:
    """Children in the order they are given; numbers as text."""
    for key, value in values.items():
        SubElement(element, key).text = value if isinstance(value, str) else number(value)
    return element


def _end(part: FlatPart, which: str) -> Element:
    """The cut of an end: square, or inclined through the thickness where the joint bevels it."""
    bevel = part.bevels[0 if which == "start" else 1]
    # the far face (-b) is side 4; the near one is *bevel* longer
    shorter = max(0.0, bevel)
    x = shorter if which == "start" else part.length - shorter
    inclination = float(np.degrees(np.arctan2(part.thickness, -bevel)))
    return _with(
        _processing("JackRafterCut", FACE),
        Orientation=which,
        StartX=x,
        StartY=0.0,
        StartDepth=0.0,
        Angle=90.0,
        Inclination=inclination,
    )


def _slot(slot: Slot, part: FlatPart) -> Element:
    """A lap from an edge through the thickness; one with a rounded floor as a contour."""
    return _lap(slot, part) if slot.floor is Floor.SQUARE else _contour(slot, part)


def _lap(slot: Slot, part: FlatPart) -> Element:
    lap = _with(
        _processing("Lap", _EDGES[slot.edge], Comment=f"{slot.node}, {slot.partner}"),
        Orientation="start",
        StartX=slot.x - slot.width / 2.0,
        StartY=0.0,
        Angle=90.0,
        Inclination=90.0,
        Slope=0.0,
        Length=slot.width,
        Width=part.thickness,
        Depth=slot.depth,
        LeadAngleParallel="yes",
        LeadAngle=90.0,
        LeadInclinationParallel="yes",
        LeadInclination=90.0,
    )
    limits = {"Start": "yes", "End": "yes", "Front": "no", "Back": "no", "Top": "no"}
    faces = {f"FaceLimited{name}": value for name, value in {**limits, "Bottom": "yes"}.items()}
    SubElement(lap, "MachiningLimits", faces)
    return lap


def _contour(slot: Slot, part: FlatPart) -> Element:
    """From one mouth of the slot around its floor to the other, the tool inside the slot."""
    upper = slot.edge is Edge.UPPER
    rows = [(slot.x + dx, part.width - dy if upper else dy, b) for dx, dy, b in slot.notch()]
    free = _processing(
        "FreeContour",
        FACE,
        Comment=f"{slot.node}, {slot.partner}",
        CounterSink="no",
        ToolPosition="left" if upper else "right",
    )
    depth = {"DepthBounded": "no", "Depth": number(part.thickness), "Inclination": number(0.0)}
    contour = SubElement(free, "Contour", depth)
    _point(contour, "StartPoint", rows[0][0], rows[0][1])
    for (x0, y0, bulge), (x1, y1, _) in pairwise(rows):
        step = SubElement(contour, "Arc" if bulge else "Line")
        _point(step, "EndPoint", x1, y1)
        if bulge:
            # mirrored to the upper edge, an arc turns the other way
            turned = -bulge if upper else bulge
            x, y = (x0 + x1) / 2.0, (y0 + y1) / 2.0
            _point(step, "PointOnArc", x + turned * (y1 - y0) / 2.0, y - turned * (x1 - x0) / 2.0)
    return free


def _drilling(hole: Hole, part: FlatPart) -> Element:
    return _with(
        _processing("Drilling", FACE, Comment=f"{hole.node}, {hole.purpose}"),
        StartX=hole.x,
        StartY=hole.y,
        Angle=0.0,
        Inclination=90.0,
        DepthLimited="no",
        Depth=part.thickness,
        Diameter=hole.diameter,
    )


def _text(label: Label) -> Element:
    return _with(
        _processing("Text", FACE),
        StartX=label.x,
        StartY=label.y,
        Angle=float(np.degrees(label.angle)),
        AlignmentVertical="center",
        AlignmentHorizontal="center",
        AlignmentMultiline="center",
        StackedMarking="no",
        TextHeightAuto="no",
        TextHeight=label.height,
        Text=label.text,
    )


def _point(parent: Element, name: str, x: float, y: float) -> None:
    SubElement(parent, name, {"X": number(x), "Y": number(y), "Z": number(0.0)})
