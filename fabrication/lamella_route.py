"""Lamellas on an asymptotic net: strips and joints, stock, checks; from the net to a system."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from math import radians
from pathlib import Path

import numpy as np

import gridshell as gs
from fabrication.angle_settings import angle_of, conditions_of
from fabrication.assembling import Assembly, assembly_order
from fabrication.checks import check
from fabrication.coupon import Coupon, coupon
from fabrication.facade_route import STEP_FILE, FacadeSystem, facade_system
from fabrication.finding import Finding
from fabrication.flat_checks import Ground
from fabrication.flat_state import FlatState, lay_flat
from fabrication.joint_sections import JointSection, SlottedJoint
from fabrication.joint_settings import joint_of
from fabrication.jointed import Jointed
from fabrication.joints import HingedJoint
from fabrication.lamella_design import Plans
from fabrication.lamella_sections import FlatSection
from fabrication.lamella_stock import (
    BarStock,
    SheetSet,
    bar_stock,
    copies_of,
    other_sheets,
    strip_sheets,
)
from fabrication.lamella_system import LamellaSystem
from fabrication.motion import motion
from fabrication.motion_checks import motion_findings
from fabrication.moving import Moving
from fabrication.parts import FlatPart, parts_of
from fabrication.placing import keyed
from fabrication.routes import Clock
from fabrication.sections import ProfileSection, Project
from fabrication.segment_checks import require_apart
from fabrication.segmented import Segmented
from fabrication.segments import Segments
from fabrication.settings import profile_of, sheet_of
from fabrication.shop import Process
from fabrication.shop_checks import shop_findings
from fabrication.shop_settings import process_of
from fabrication.stock import Profile
from fabrication.strength import bay_stress
from fabrication.structures import Structure, structure

_SHARPEST = 10.0
"""Node angle down to which a net moves where its joints say nothing, degrees."""


@dataclass(frozen=True, eq=False)
class LamellaRoute:
    """The route of a project with ``[profile]`` and ``[joint]``."""

    project: Project
    profile: ProfileSection
    joint: JointSection

    @property
    def planarity(self) -> gs.Planarity:
        """Vertex stars of D1 and D2; of D1 alone where the net moves and D2 only fills it."""
        if self.project.umbrella is not None:
            return gs.Planarity.FIRST_DIAGONAL_STARS
        return gs.Planarity.DIAGONAL_STARS

    @property
    def files(self) -> tuple[str, ...]:
        """One sheet or bar at least, and the facade's where there is one."""
        facade = () if self.project.facade is None else (STEP_FILE, "sheets/panels-01.dxf")
        strips = "sheet" if self.project.bars is None else "bar"
        return (f"sheets/{strips}-01.dxf", "bays.csv", "bill.csv", "drawings.pdf", *facade)

    def recipe(self, folder: Path) -> gs.NetRecipe:
        """An A-net."""
        net = self.project.net
        with keyed("net.angle"):
            angle = angle_of(net.angle, folder)
        return gs.a_net(
            angle=angle,
            planarity=self.planarity,
            conditions=conditions_of(net),
            steps=net.steps,
            tolerance=net.tolerance,
        )

    def build(self, control: gs.ControlMesh, clock: Clock) -> LamellaSystem:
        """Lamellas along one of the two diagonal meshes."""
        profile = profile_of(self.profile)
        with clock.stage("structure"):
            skin = self.skin(control)
            whole = self._jointed(skin, profile)
            plans = Plans(*self._assembly(whole))
        with clock.stage("stock"):
            bars = self._bars(whole)
            jointed = whole if bars is None else bars.applied(whole)
        with clock.stage("parts"):
            with keyed("shop"):
                process = process_of(self.project.shop, profile)
            segmented = self._segmented(jointed)
            if segmented is not None:
                jointed = replace(jointed, bill=segmented.bill(jointed.bill))
            parts = parts_of(jointed, process.relief, copies=copies_of(self.project))
            strips = strip_sheets(parts, self.project, profile, bars)
            others = tuple(other_sheets(jointed, self.project, bars, self._coupons(jointed)))
            facade = self._facade(skin, jointed.design)
        moving = self._moving(control, jointed.design, clock)
        with clock.stage("checks"):
            stress = bay_stress(jointed.strips, parts)
            findings = (
                *jointed.findings,
                *plans.findings,
                *check(jointed.strips, parts, stress),
                *self._shop_findings(process, parts, others),
                *self._motion_findings(moving, profile),
                *(() if segmented is None else segmented.findings),
            )
        return LamellaSystem(
            project=self.project,
            rebuilt=lambda net: self._rebuilt(net, profile, bars),
            jointed=jointed,
            parts=parts,
            stress=stress,
            bars=bars,
            sheets=(strips, *others),
            facade=facade,
            plans=plans,
            moving=moving,
            segmented=segmented,
            process=process,
            findings=findings,
        )

    def skin(self, control: gs.ControlMesh) -> gs.DiagonalMesh:
        """The diagonal mesh along whose edges lamellas run."""
        return gs.diagonal_meshes(control)[0 if self.project.net.skin == "D1" else 1]

    def _rebuilt(
        self, control: gs.ControlMesh, profile: Profile, bars: BarStock | None
    ) -> tuple[gs.DiagonalMesh, Jointed]:
        """The net and the strips with their fixtures anew, on a mesh that was read back."""
        skin = self.skin(control)
        whole = self._jointed(skin, profile)
        return skin, whole if bars is None else bars.applied(whole)

    def _jointed(self, skin: gs.DiagonalMesh, profile: Profile) -> Jointed:
        design = structure(skin, profile, overhang=self.profile.overhang)
        with keyed("joint"):
            return joint_of(self.joint, profile).build(design)

    def _segmented(self, jointed: Jointed) -> Segmented | None:
        """Equal segments, where the project asks for them and they have room."""
        section = self.project.segments
        if section is None:
            return None
        segments = Segments(section.count, section.centre, section.seam)
        return Segmented(segments, require_apart(segments, jointed.strips), section.hang)

    def _moving(self, control: gs.ControlMesh, design: Structure, clock: Clock) -> Moving | None:
        """The motion of the net, where the project asks for it."""
        section = self.project.motion
        if section is None:
            return None
        with clock.stage("motion"), keyed("motion"):
            position = gs.umbrella_of(control)
            joint = joint_of(self.joint, design.profile)
            smallest = radians(section.smallest or _SHARPEST)
            if section.smallest is None and isinstance(joint, HingedJoint):
                smallest = joint.folded(design)
            found = motion(
                position,
                design.profile,
                cable=None if section.cable is None else gs.Cable(*section.cable),
                count=section.positions,
                limits=(smallest, radians(section.largest)),
                announce=lambda number: clock.shared(number / section.positions),
            )
        return Moving(found, position.opening)

    def _motion_findings(self, moving: Moving | None, profile: Profile) -> list[Finding]:
        if moving is None:
            return []
        return motion_findings(moving.motion, moving.opening, profile.material.name)

    def _bars(self, whole: Jointed) -> BarStock | None:
        if self.project.bars is None:
            return None
        with keyed("bars"):
            return bar_stock(whole, self.project.bars, copies_of(self.project))

    def _assembly(self, whole: Jointed) -> tuple[Assembly, FlatState | None]:
        """The order of assembly, and the flat state where the project asks for it."""
        flat = self.project.flat
        if flat is None:
            return assembly_order(whole), None
        with keyed("flat"):
            return assembly_order(whole), _laid_flat(whole, flat)

    def _coupons(self, jointed: Jointed) -> tuple[Coupon, ...]:
        """Two coupons to try the fit of slots with, where the project asks for them."""
        papers, joint = self.project.papers, self.joint
        if papers is None or not papers.coupon or not isinstance(joint, SlottedJoint):
            return ()
        angles = [node.angle for node in jointed.strips.nodes if node.angle is not None]
        return tuple(
            coupon(
                jointed.strips.profile,
                angle=float(np.median(angles)),
                clearance=joint.clearance,
                depth_clearance=joint.depth_clearance,
                mark=mark,
            )
            for mark in ("FIT-1", "FIT-2")
        )

    def _shop_findings(
        self, process: Process, parts: Sequence[FlatPart], others: Sequence[SheetSet]
    ) -> tuple[Finding, ...]:
        """What the shop of the project cannot cut; of equal connectors one is tried."""
        if self.project.shop is None:
            return ()
        more = {
            (part.labels[0].text if part.labels else part.mark): part
            for own in others
            for sheet in own.sheets
            for part in (placement.part for placement in sheet.placements)
        }
        return shop_findings([*parts, *more.values()], process)

    def _facade(self, net: gs.DiagonalMesh, built: Structure) -> FacadeSystem | None:
        project = self.project
        if project.facade is None:
            return None
        sheet = sheet_of(project.panel_sheet or project.sheet)
        return facade_system(project.facade, net, built, sheet)


def _laid_flat(whole: Jointed, section: FlatSection) -> FlatState:
    sized = section.length is not None and section.width is not None
    return lay_flat(
        whole,
        lamellas=section.lamellas,
        opening=None if section.opening is None else radians(section.opening),
        ground=Ground(section.length or 0.0, section.width or 0.0) if sized else None,
    )
