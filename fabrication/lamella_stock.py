"""What strips, washers and splice plates are cut from: bars or sheets, and how they lie there."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace

import numpy as np

from fabrication.bars import Bar, CutBar
from fabrication.cutting_stock import cut_bars
from fabrication.finding import Finding
from fabrication.joint_settings import own_or_strips
from fabrication.jointed import Jointed
from fabrication.lamella_sections import BarsSection, SpliceSection
from fabrication.nesting import NestedSheet, Placement, SheetPart, nest, sheet_bound
from fabrication.parts import FlatPart
from fabrication.routes import Report
from fabrication.sections import Project
from fabrication.settings import sheet_of
from fabrication.shapes import Prisms
from fabrication.sheet_parts import shape_piece
from fabrication.splice_plan import SplicePlan, Splices, preferred, tradeoff
from fabrication.splice_plate import Sides, SplicePlate
from fabrication.splice_search import Run
from fabrication.splices import runs_of, splice_plates, spliced
from fabrication.stock import Material, Profile, Sheet

_WISHES = {
    "few-splices": Splices.FEW,
    "balanced": Splices.BALANCED,
    "few-bars": Splices.FEW_BARS,
}


BAR, COUPON = "bar", "coupon"
"""Prefixes of the files of bars and coupons."""


@dataclass(frozen=True, eq=False)
class SheetSet:
    """Sheets or bars of one material and thickness.

    Parameters
    ----------
    prefix : of the files' names: "sheet", "bar", "star-washers", ...
    bound : no nesting needs fewer sheets; of bars, no cutting plan for the same pieces.
    """

    prefix: str
    material: Material
    sheets: tuple[NestedSheet, ...]
    bound: int

    @property
    def of_bars(self) -> bool:
        """Whether these are bars, as wide as what is cut from them."""
        return self.prefix == BAR

    @property
    def kind(self) -> str:
        """What the parts are."""
        return "strips" if self.prefix in (BAR, "sheet") else self.prefix

    def figures(self) -> Report:
        """For the report."""
        used = [sheet.used for sheet in self.sheets]
        return {
            "sheets": len(self.sheets),
            "bound": self.bound,
            "used": round(sum(used) / len(used), 4) if used else 0.0,
        }


@dataclass(frozen=True, eq=False)
class BarStock:
    """Strips cut from bars.

    Parameters
    ----------
    plan : splices and bars that were chosen.
    front : the plans it was chosen from.
    plate : of the splices; None where no strip is spliced.
    """

    plan: SplicePlan
    front: tuple[SplicePlan, ...]
    plate: SplicePlate | None

    @property
    def findings(self) -> Sequence[Finding]:
        """Splices that are not staggered."""
        return self.plan.findings

    def applied(self, jointed: Jointed) -> Jointed:
        """*jointed* with its strips cut into the plan's pieces."""
        if self.plate is None or not self.plan.splices:
            return jointed
        return spliced(jointed, self.plan, self.plate)


def bar_stock(jointed: Jointed, section: BarsSection, copies: int = 1) -> BarStock:
    """Choose splices and bars for the strips of *jointed*.

    Parameters
    ----------
    copies : how often all strips are built; splices are chosen for one, bars for all.

    Raises
    ------
    StockError
        Naming a strip, or the length between two places to splice, that fits no bar.
    SettingError
        For sizes of bars or plates that cannot be.
    """
    bar = Bar(section.length, section.kerf, section.trim)
    if section.splice is None:
        plate = None
        runs = tuple(Run(s.mark, s.length, (), ()) for s in jointed.strips.lamellas)
        front = tradeoff(runs, bar)
    else:
        plate = splice_plate(section.splice, jointed.strips.profile)
        runs = runs_of(jointed, plate, clear=section.splice.clear)
        front = tradeoff(runs, bar, gap=section.splice.gap, shortest=section.shortest)
    if copies > 1:
        front = tuple(_repeated(plan, copies) for plan in front)
    return BarStock(preferred(front, _WISHES[section.prefer]), front, plate)


def _repeated(plan: SplicePlan, copies: int) -> SplicePlan:
    """The same splices in every copy, and the bars that all pieces are cut from."""
    pieces = [piece for cut in plan.bars.cut for piece in cut.pieces] * copies
    bars = cut_bars(pieces, plan.bars.bar)
    whole = sum(piece.length for piece in pieces)
    return replace(
        plan, copies=copies, bars=bars, floor=int(np.ceil(whole / plan.bars.bar.room - 1e-9))
    )


def splice_plate(section: SpliceSection, profile: Profile) -> SplicePlate:
    """The plate of ``[bars.splice]``."""
    return SplicePlate(
        length=section.length,
        width=0.75 * profile.width if section.width is None else section.width,
        thickness=profile.thickness if section.thickness is None else section.thickness,
        material=own_or_strips(section.material, profile),
        bolt=section.bolt,
        bolts=section.bolts,
        sides=Sides(section.sides),
    )


def copies_of(project: Project) -> int:
    """How often everything is built."""
    return 1 if project.segments is None else project.segments.count


def strip_sheets(
    parts: Sequence[FlatPart], project: Project, profile: Profile, bars: BarStock | None
) -> SheetSet:
    """The strips of all copies on their sheets, or on the bars of the plan."""
    material = profile.material
    if bars is None:
        sheet, every = sheet_of(project.sheet), [*parts] * copies_of(project)
        return SheetSet("sheet", material, nest(every, sheet), sheet_bound(every, sheet))
    named = {part.mark: part for part in parts}
    cut = tuple(_as_sheet(bar, named, profile) for bar in bars.plan.bars.cut)
    return SheetSet(BAR, material, cut, bars.plan.bars.bound)


def _as_sheet(cut: CutBar, parts: dict[str, FlatPart], profile: Profile) -> NestedSheet:
    raw = Sheet(cut.bar.length, profile.width, margin=0.0, gap=cut.bar.kerf)
    placed = zip(cut.pieces, cut.positions, strict=True)
    return NestedSheet(
        cut.number, raw, tuple(Placement(parts[piece.mark], x, 0.0) for piece, x in placed)
    )


def other_sheets(
    jointed: Jointed, project: Project, bars: BarStock | None, coupons: Sequence[SheetPart] = ()
) -> Iterator[SheetSet]:
    """Connectors that are cut from sheet, splice plates and coupons, each on sheets of its own."""
    sheet, copies = sheet_of(project.panel_sheet or project.sheet), copies_of(project)
    for kind in jointed.connectors:
        if kind.from_sheet and kind.bodies and kind.material is not None:
            yield _nested(kind.name.replace(" ", "-"), kind.material, _pieces(kind) * copies, sheet)
    if bars is not None and bars.plate is not None and bars.plan.splices:
        plates = [*splice_plates(bars.plan, bars.plate)] * copies
        yield _nested("splices", bars.plate.material, plates, sheet)
    if coupons:
        material = jointed.strips.profile.material
        yield _nested(COUPON, material, coupons, sheet_of(project.sheet))


def _pieces(kind: Prisms) -> list[SheetPart]:
    return [shape_piece(body.mark, kind.shapes[body.shape]) for body in kind.bodies]


def _nested(prefix: str, material: Material, parts: Sequence[SheetPart], sheet: Sheet) -> SheetSet:
    return SheetSet(prefix, material, nest(parts, sheet), sheet_bound(parts, sheet))
