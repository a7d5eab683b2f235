"""What a joint makes of a design: strips, their cuts, what connects them, and where it all lies.

Everything downstream reads this: flat parts, solids, fit, closure, lists and drawings. A joint is
one file in ``joints/`` that fills it in.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from enum import Enum

from fabrication.cut import Cuts
from fabrication.finding import Finding
from fabrication.shapes import Prisms
from fabrication.structures import Structure
from gridshell.arrays import Floats


class Feature(Enum):
    """What of a flat strip can be found again in the files."""

    SLOT = "slot"
    HOLE = "hole"
    DRILL = "drill"
    START = "start"
    END = "end"


@dataclass(frozen=True, eq=False)
class Fixture:
    """A place on a flat strip, and where it must come to lie in space.

    Positions are known from the net and the joint alone, not from the strip's own map: closing
    the loop compares the two.

    Parameters
    ----------
    mark : of the strip.
    node : name of the node, for messages.
    feature : what is there on the flat strip.
    x, y : of its middle in strip coordinates, mm. Of a slot or an end half-way up the strip.
    position : (3,) where that lies in space, mm.
    axis : (3,) unit direction of the strip's width there, along which both edges are compared,
        too; None where only the position counts.
    """

    mark: str
    node: str
    feature: Feature
    x: float
    y: float
    position: Floats
    axis: Floats | None = None


@dataclass(frozen=True)
class BillLine:
    """One line of the bill of material that is no strip.

    Parameters
    ----------
    item : "bolt", "star washer", "weld", ...
    size : "M8 x 130", "100 x 100 x 4 mm", ...
    quantity : pieces, or millimetres where *unit* says so.
    unit : "pcs" or "mm".
    material : empty for bought parts.
    mass : of one piece, kg; None where it is not known.
    note : where they go, what to watch.
    """

    item: str
    size: str
    quantity: float
    unit: str = "pcs"
    material: str = ""
    mass: float | None = None
    note: str = ""


@dataclass(frozen=True, eq=False)
class Jointed:
    """A design with its joints.

    Parameters
    ----------
    design : one lamella per axis.
    strips : what is built along the axes, as lamellas; its nodes are where two strips cross. The
        design itself where every axis carries one whole strip.
    carriers : index of the design's lamella for each strip.
    cuts : of every strip by its mark.
    fixtures : places that the files are compared at.
    connectors : solids that are no strips, each kind with one shape for equal ones.
    bill : what is bought or made besides the strips, and welds.
    findings : what a person should know about these joints.
    """

    design: Structure
    strips: Structure
    carriers: tuple[int, ...]
    cuts: Mapping[str, Cuts]
    fixtures: tuple[Fixture, ...]
    connectors: tuple[Prisms, ...] = ()
    bill: tuple[BillLine, ...] = ()
    findings: Sequence[Finding] = field(default=())
