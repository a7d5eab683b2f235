"""The triangulated facade on lamellas (Fig. 16): glass above the strips, profiles along diagonals.

The net's nodes are lifted along their axes to where the glass lies; three lifted nodes are always
in one plane, so every bay carries two flat panels. They are cut, listed and built as panels of
planar nets are, in files of their own: ``sheets/panels-*.dxf`` and ``facade.step``.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, replace
from math import degrees
from pathlib import Path

import numpy as np

from fabrication.bodies import structure_bodies
from fabrication.export.dxf import DxfPart, read_dxf, write_dxf
from fabrication.export.panel_schedule import schedule_rows
from fabrication.export.schedule import Line
from fabrication.export.step_prism_reader import StepPrism
from fabrication.facade import DiagonalRule, Facade, triangulated_facade
from fabrication.finding import Finding
from fabrication.grouping import group_names
from fabrication.nesting import NestedSheet, nest
from fabrication.panel import panel_mark
from fabrication.panel_loop import PanelClosure, panel_closure
from fabrication.panel_sections import FacadeSection
from fabrication.panel_settings import panel_spec
from fabrication.panel_structure import PanelStructure, PanelSystem
from fabrication.routes import CLOSURE_LIMIT, VOLUME_LIMIT, Report, loop_findings
from fabrication.shapes import Bodies
from fabrication.sheet_parts import panel_piece
from fabrication.stock import Sheet
from fabrication.structures import Structure
from gridshell import DiagonalMesh

STEP_FILE = "facade.step"


@dataclass(frozen=True, eq=False)
class FacadeSystem:
    """The facade, its panels as a structure of their own, the sheets they lie on, and solids.

    Parameters
    ----------
    height : of the panels' lower side above the nodes, along the axes, mm.
    """

    section: FacadeSection
    height: float
    facade: Facade
    built: PanelStructure
    sheets: tuple[NestedSheet, ...]
    bodies: Bodies

    def write_sheets(self, folder: Path, *, name: str) -> list[DxfPart]:
        """Write the sheets of panels and read them back."""
        marks = [panel.mark for panel in self.built.panels]
        files = write_dxf(
            self.sheets,
            folder,
            name=name,
            material=self.built.system.panels.material.name,
            prefix="panels",
            alike=group_names(marks, self.built.panel_groups),
        )
        return [part for path in files for part in read_dxf(path)]

    def lines(self) -> list[Line]:
        """Panels, and profiles with the two panels they lie between, for the cut list."""
        panels = [
            Line(
                mark=row.mark,
                length=row.length,
                width=row.width,
                thickness=row.thickness,
                material=row.material,
                mass=row.mass,
                sheet=row.sheet,
            )
            for row in schedule_rows(self.built, self.sheets, ())
        ]
        beside = np.sort(self.facade.mesh.edge_faces[self.facade.secondary], axis=1).tolist()
        profiles = [
            Line(mark=f"T{number} ({panel_mark(left)}/{panel_mark(right)})", length=length)
            for number, (length, (left, right)) in enumerate(
                zip(self.facade.lengths.tolist(), beside, strict=True), start=1
            )
        ]
        return [*panels, *profiles]

    def closure(
        self,
        net: DiagonalMesh,
        built: Structure,
        drawn: Iterable[DxfPart],
        solids: Iterable[StepPrism],
    ) -> PanelClosure:
        """Lay what was read from the files over *net*, which was read from ``net.json``."""
        found = _triangles(net, built, self.section, self.height)
        return panel_closure(found.mesh, self.built.system, drawn, solids)

    def figures(self, closed: PanelClosure) -> Report:
        """The section ``facade`` of the report."""
        panels, facade = self.built.panels, self.facade
        return {
            "panels": len(panels),
            "panel_groups": len(self.built.panel_groups),
            "panel_area_m2": round(sum(p.area for p in panels) / 1e6, 4),
            "mass_kg": float(f"{sum(p.mass for p in panels):.6g}"),
            "height_mm": self.height,
            "profiles": len(facade.lengths),
            "profile_length_m": round(float(facade.lengths.sum()) / 1e3, 3),
            "fold_deg": {"max": degrees(float(facade.folds.max(initial=0.0)))},
            "sheets": len(self.sheets),
            "closure_mm": {"max": closed.max_mm},
            "volume_ppm": closed.volume_ppm,
        }


def facade_findings(closed: PanelClosure) -> list[Finding]:
    """Errors where the panels do not close back onto the net."""
    worst, limit = closed.worst, CLOSURE_LIMIT
    return loop_findings(
        (
            ("facade-closure", worst, closed.max_mm, limit, "mm", "from the design"),
            (
                *("facade-volume", "all", closed.volume_ppm, VOLUME_LIMIT),
                *("ppm", "between sheet and solid"),
            ),
        )
    )


def facade_system(
    section: FacadeSection, net: DiagonalMesh, built: Structure, sheet: Sheet
) -> FacadeSystem:
    """The facade on *net*; half a strip's width above it, unless *section* says otherwise.

    Raises
    ------
    SettingError
        Naming the first triangle of which the gap leaves nothing.
    StockError
        For a triangle that *sheet* does not hold.
    """
    height = built.profile.width / 2.0 if section.above is None else section.above
    facade = _triangles(net, built, section, height)
    system = PanelSystem(panels=panel_spec(section))
    panelled = PanelStructure(facade.mesh, system, facade.panels, (), ())
    return FacadeSystem(
        section=section,
        height=height,
        facade=facade,
        built=panelled,
        sheets=nest([panel_piece(p) for p in facade.panels], sheet),
        bodies=structure_bodies(panelled),
    )


def _triangles(
    net: DiagonalMesh, built: Structure, section: FacadeSection, height: float
) -> Facade:
    axes = np.array([node.axis for node in built.nodes])
    lifted = replace(net, vertices=net.vertices + height * axes)
    rule = DiagonalRule(section.rule)
    return triangulated_facade(lifted, panel_spec(section), axes=axes, rule=rule)
