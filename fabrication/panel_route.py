"""Panels, support plates and connectors on a planar net, and the files they are made from."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import asdict, dataclass
from functools import cached_property
from math import degrees
from pathlib import Path

import gridshell as gs
from fabrication.angle_settings import angle_of
from fabrication.beam_layout import Beam, BeamSection, beams
from fabrication.bodies import structure_bodies
from fabrication.errors import KernelError
from fabrication.export.cut_sets import CutSet, cut_set
from fabrication.export.interchange.model import bodies_model
from fabrication.export.quality_series import Series
from fabrication.exporting import write_exports
from fabrication.finding import Finding
from fabrication.grouping import group_names
from fabrication.kernel_job import BodiesWork, Kernel, KernelResult
from fabrication.nesting import NestedSheet, nest
from fabrication.panel_sections import PanelsSection
from fabrication.panel_settings import panel_system
from fabrication.panel_structure import (
    PanelStructure,
    panelled,
)
from fabrication.placing import keyed
from fabrication.routes import (
    CLOSURE_LIMIT,
    VOLUME_LIMIT,
    Clock,
    Report,
    Written,
    errors_at,
    loop_findings,
)
from fabrication.sections import Project
from fabrication.settings import sheet_of
from fabrication.shapes import Bodies
from fabrication.sheet_parts import SheetPiece, panel_piece, plate_piece, star_piece
from fabrication.support import SupportPlate

_SKINS = {"D1": gs.Skin.D1, "D2": gs.Skin.D2, "P": gs.Skin.PATTERN}


@dataclass(frozen=True, eq=False)
class PanelRoute:
    """The route of a project with ``[panels]``."""

    project: Project
    panels: PanelsSection

    @property
    def planarity(self) -> gs.Planarity:
        """The white quads of the checkerboard pattern: faces of D1 and of D2."""
        return gs.Planarity.WHITE_FACES

    @property
    def files(self) -> tuple[str, ...]:
        """One sheet of panels at least."""
        plates = () if self.project.supports is None else ("sheets/plates-01.dxf",)
        return ("sheets/panels-01.dxf", *plates)

    def recipe(self, folder: Path) -> gs.NetRecipe:
        """A net of planar quads; a rim that is free lies flat for the plates there, too."""
        net = self.project.net
        free = net.anchor == "free" and self.project.supports is not None
        with keyed("net.angle"):
            angle = angle_of(net.angle, folder)
        return gs.pq_net(
            angle=angle,
            rhombus=net.rhombus,
            square=net.square,
            conditions=(gs.FlatRim(),) if free else (),
            steps=net.steps,
            tolerance=net.tolerance,
        )

    def build(self, control: gs.ControlMesh, clock: Clock) -> PanelNetSystem:
        """Panels on one of the three skins."""
        project = self.project
        with clock.stage("structure"):
            mesh, lean = skin_and_lean(project, control)
            built = panelled(mesh, panel_system(project, self.panels))
            findings = built.findings()
            along = _beams(project, mesh)
        with clock.stage("parts"):
            stock = sheet_of(project.panel_sheet or project.sheet)
            panels = nest([panel_piece(p) for p in built.panels], stock)
            plates = nest([plate_piece(p) for p in built.plates], sheet_of(project.sheet))
            stars = nest(_stars(built), sheet_of(project.sheet))
            bodies = structure_bodies(built)
        return PanelNetSystem(project, built, lean, panels, plates, stars, bodies, findings, along)


@dataclass(frozen=True, eq=False)
class PanelNetSystem:
    """Panels, plates and connectors, the sheets the flat ones lie on, and their solids.

    Parameters
    ----------
    lean : largest angle between torsion-free axes and the normals they stand in for, radians;
        None where the axes are the normals.
    """

    project: Project
    built: PanelStructure
    lean: float | None
    panel_sheets: tuple[NestedSheet, ...]
    plate_sheets: tuple[NestedSheet, ...]
    star_sheets: tuple[NestedSheet, ...]
    bodies: Bodies
    findings: Sequence[Finding]
    beams: tuple[Beam, ...]

    def write(self, draft: Path, cad: Kernel, clock: Clock) -> Written:
        """Sheets, cut list and STEP, read back and laid over the net of ``net.json``."""
        from fabrication.export.beam_schedule import write_beam_schedule
        from fabrication.export.dxf import read_dxf
        from fabrication.export.panel_schedule import write_panel_schedule
        from fabrication.panel_loop import panel_closure

        cad.order(BodiesWork(self.bodies, self.project.name), draft / "structure.step")
        with clock.stage("sheets"):
            files = self._write_sheets(draft / "sheets")
            write_panel_schedule(
                draft / "parts.csv",
                self.built,
                self.panel_sheets,
                self.plate_sheets,
                self.star_sheets,
            )
            if self.beams:
                write_beam_schedule(draft / "beams.csv", self.beams)
            drawn = [part for path in files for part in read_dxf(path)]
            write_exports(
                draft,
                self.project.export,
                self.project.name,
                lambda: bodies_model(self.project.name, self.bodies),
                self._cut_sets,
            )
        with clock.stage("solids"):
            solid = self._solids(cad)
        with clock.stage("closure"):
            control = gs.read_net(draft / "net.json")
            mesh, _ = skin_and_lean(self.project, control)
            closed = asdict(panel_closure(mesh, self.built.system, drawn, solid.parts))
            supports = self._supports()
        return Written(
            sections={
                "structure": self._figures(),
                "closure": closed,
                **({} if supports is None else {"supports": supports}),
            },
            findings=loop_findings(
                (
                    (
                        *("closure", closed["worst"], closed["max_mm"], CLOSURE_LIMIT),
                        *("mm", "from the design"),
                    ),
                    (
                        *("volume", "all", closed["volume_ppm"], VOLUME_LIMIT),
                        *("ppm", "between sheet and solid"),
                    ),
                )
            ),
            kernel_seconds=solid.seconds,
        )

    def write_page(
        self, path: Path, report: Report, pictures: Sequence[Report], series: Sequence[Series]
    ) -> None:
        """The report on panels."""
        from fabrication.export.panel_report import write_panel_report

        write_panel_report(
            path,
            name=self.project.name,
            report=report,
            built=self.built,
            panel_sheets=self.panel_sheets,
            plate_sheets=self.plate_sheets,
            star_sheets=self.star_sheets,
            pictures=pictures,
            series=series,
        )

    def write_paper(self, path: Path, report: Report, series: Sequence[Series]) -> None:
        """The same to print."""
        from fabrication.export.papers.panel_paper import write_panel_paper

        write_panel_paper(
            path,
            name=self.project.name,
            report=report,
            series=series,
            built=self.built,
            panel_sheets=self.panel_sheets,
            plate_sheets=self.plate_sheets,
            star_sheets=self.star_sheets,
        )

    def _solids(self, cad: Kernel) -> KernelResult:
        try:
            return cad.result()
        except KernelError as error:
            told = errors_at(error.where or "", self.findings)
            advice = f"to mend what the checks found there: {told}" if told else error.advice
            raise KernelError(
                error.what, where=error.where, value=error.value, limit=error.limit, advice=advice
            ) from None

    def _cut_sets(self) -> list[CutSet]:
        """Flat panels, plates and stars by material, for machines."""
        system = self.built.system
        found = [cut_set("panels", system.panels.material, self.panel_sheets)]
        if system.plates is not None:
            found.append(cut_set("plates", system.plates.material, self.plate_sheets))
        if system.connector_material is not None:
            found.append(cut_set("stars", system.connector_material, self.star_sheets))
        return found

    def _write_sheets(self, folder: Path) -> list[Path]:
        from fabrication.export.dxf import write_dxf

        system, name = self.built.system, self.project.name
        panels = group_names([p.mark for p in self.built.panels], self.built.panel_groups)
        files = write_dxf(
            self.panel_sheets,
            folder,
            name=name,
            material=system.panels.material.name,
            prefix="panels",
            alike=panels,
        )
        if system.plates is not None:
            plates = group_names([p.mark for p in self.built.plates], self.built.plate_groups)
            files += write_dxf(
                self.plate_sheets,
                folder,
                name=name,
                material=system.plates.material.name,
                prefix="plates",
                alike=plates,
            )
        if system.connector_material is not None and self.star_sheets:
            stars = group_names([p.mark for p in self.built.pieces], self.built.connector_groups)
            files += write_dxf(
                self.star_sheets,
                folder,
                name=name,
                material=system.connector_material.name,
                prefix="stars",
                alike=stars,
            )
        return files

    def _figures(self) -> Report:
        built = self.built
        mass = sum(p.mass for p in built.panels) + sum(p.mass for p in built.plates)
        mass += sum(built.piece_mass(piece) for piece in built.pieces)
        return {
            "panels": len(built.panels),
            "plates": len(built.plates),
            "connectors": len(built.connectors),
            "beams": len(self.beams),
            "nodes": len(built.mesh.vertices),
            "panel_groups": len(built.panel_groups),
            "plate_groups": len(built.plate_groups),
            "connector_groups": len(built.connector_groups),
            "distinct_solids": len(self.bodies.shapes),
            "panel_area_m2": round(sum(p.area for p in built.panels) / 1e6, 4),
            "panel_planarity_mm": {"max": max(p.planarity for p in built.panels)},
            "corner_angle_deg": {
                "min": degrees(min(float(p.corner_angles.min()) for p in built.panels)),
                "max": degrees(max(float(p.corner_angles.max()) for p in built.panels)),
            },
            "mass_kg": float(f"{mass:.6g}"),
            "sheets": len(self.panel_sheets) + len(self.plate_sheets) + len(self.star_sheets),
            "panel_sheets": len(self.panel_sheets),
            "plate_sheets": len(self.plate_sheets),
            **({} if built.system.star is None else {"star_plates": len(built.pieces)}),
        }

    def _supports(self) -> Report | None:
        plates, classical = self.built.plates, self.built.classical_plates
        if not plates:
            return None
        return {
            "out_of_plane_mm": {"max": max(p.out_of_plane for p in plates)},
            "out_of_plane_mm_per_m": {"max": max(_per_metre(p) for p in plates)},
            "twist_deg": {"max": max(degrees(abs(p.twist)) for p in plates)},
            "classical_out_of_plane_mm": {"max": max(p.out_of_plane for p in classical)},
            "classical_twist_deg": {"max": max(degrees(abs(p.twist)) for p in classical)},
            **({} if self.lean is None else {"lean_deg": {"max": degrees(self.lean)}}),
            "flat": sum(p.flat for p in plates),
            "plates": len(plates),
            "height_mm": self._height,
        }

    @cached_property
    def _height(self) -> float:
        section = self.built.system.plates
        return 0.0 if section is None else section.height


def skin_and_lean(project: Project, control: gs.ControlMesh) -> tuple[gs.PanelMesh, float | None]:
    """The skin with the node axes that the project asks for, and how far these lean, radians.

    Raises
    ------
    MeshError
        Where there are no torsion-free axes near the normals, as around a closed ring.
    """
    mesh = gs.skin(control, _SKINS[project.net.skin])
    if project.supports is None or project.supports.axes == "normals":
        return mesh, None
    found = gs.torsion_free_axes(mesh)
    return mesh.with_axes(found.axes), float(found.tilt.max())


def _beams(project: Project, mesh: gs.PanelMesh) -> tuple[Beam, ...]:
    section = project.beams
    if section is None:
        return ()
    return beams(mesh, BeamSection(section.width, section.height, section.setback))


def _stars(built: PanelStructure) -> list[SheetPiece]:
    """The star plates; cylinders are not cut from sheets."""
    return [] if built.system.star is None else [star_piece(piece) for piece in built.pieces]


def _per_metre(plate: SupportPlate) -> float:
    return plate.out_of_plane / plate.length * 1000.0
