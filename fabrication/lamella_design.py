"""All that is built of lamellas, before any file: strips, joints, flat parts, stock, plans."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from fabrication.assembling import Assembly
from fabrication.facade_route import FacadeSystem
from fabrication.finding import Finding
from fabrication.flat_state import FlatState
from fabrication.jointed import Jointed
from fabrication.lamella_stock import BarStock, SheetSet
from fabrication.moving import Moving
from fabrication.parts import FlatPart
from fabrication.routes import Report
from fabrication.sections import Project
from fabrication.segmented import Segmented
from fabrication.shop import Process
from fabrication.strength import BayStress


@dataclass(frozen=True, eq=False)
class Plans:
    """How the shell is put together.

    Parameters
    ----------
    assembly : the order of strips and connectors.
    flat : the flat scissor state; None where it was not asked for.
    """

    assembly: Assembly
    flat: FlatState | None

    @property
    def findings(self) -> tuple[Finding, ...]:
        """Strips that are locked out, distances that cannot be kept, ..."""
        flat = () if self.flat is None else self.flat.findings
        return (*self.assembly.findings, *flat)

    def sections(self) -> Report:
        """For the report."""
        flat = {} if self.flat is None else {"flat": self.flat.section()}
        return {"assembly": self.assembly.section(), **flat}


@dataclass(frozen=True, eq=False)
class LamellaDesign:
    """Strips, their joints, flat parts and stock.

    Parameters
    ----------
    stress : of every bay.
    bars : None where strips are cut from sheets.
    sheets : of the strips first, then of connectors, splice plates and coupons.
    moving : where the net moves.
    segmented : where there are equal segments.
    process : how the shop cuts, and wants its files.
    """

    project: Project
    jointed: Jointed
    parts: tuple[FlatPart, ...]
    stress: BayStress
    bars: BarStock | None
    sheets: tuple[SheetSet, ...]
    facade: FacadeSystem | None
    plans: Plans
    moving: Moving | None
    segmented: Segmented | None
    process: Process
    findings: Sequence[Finding]
