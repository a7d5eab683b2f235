"""Panels: every face of a skin as a flat outline, set back for its joints, with its place in space.

The outline is what is cut; the *face* is the polygon of the net it fills. Both are in the panel's
own frame, so putting flat points back onto the net is one call. Along every side stands the mark
of the neighbour.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from fabrication.finding import Finding, Severity
from fabrication.grouping import Group, equal_groups
from fabrication.outlines import Frame, best_frame, corner_angles, inset, polygon_area
from fabrication.stock import Material, require_positive
from gridshell import PanelMesh, SettingError
from gridshell.arrays import Floats, Points, frozen

FLATNESS = 5e-5
"""A panel counts as flat up to this distance from its plane over its longest diagonal."""

_MM3_KG_PER_M3 = 1e-9


@dataclass(frozen=True)
class PanelSpec:
    """How panels are made.

    Parameters
    ----------
    gap : between the edges of neighbouring panels, mm; either is set back by half of it.
    thickness : mm.
    material : what they are made of.
    clearance : every edge is set back by so much more, mm.

    Raises
    ------
    SettingError
        For a thickness that is not positive, or a negative distance.
    """

    gap: float
    thickness: float
    material: Material
    clearance: float = 0.0

    def __post_init__(self) -> None:
        require_positive("thickness", self.thickness)
        for key in ("gap", "clearance"):
            value = getattr(self, key)
            if not (np.isfinite(value) and value >= 0.0):
                raise SettingError("A distance cannot be negative", where=key, value=f"{value} mm")

    @property
    def setback(self) -> float:
        """From the net's edge to the panel's, mm."""
        return self.gap / 2.0 + self.clearance


@dataclass(frozen=True, eq=False)
class Panel:
    """One flat panel.

    Parameters
    ----------
    mark : "P1", "P2", ...: the number of the face plus one.
    index : of the face.
    outline : (k, 2) what is cut, counter-clockwise seen from the surface's positive side, mm.
    face : (k, 2) the face of the net it fills, corner by corner, mm.
    frame : where (0, 0) and the axes lie in space; the mean of the corners, x along side 0.
    nodes : (k,) the net's vertices at the corners.
    neighbours : (k,) mark of the panel across each side, None at the rim; side c runs from corner
        c to the next.
    edges : (k,) the net's edge under each side.
    corner_angles : (k,) radians, of the outline and the face alike.
    planarity : largest distance of the net's corners from the panel's plane, mm.
    thickness : mm.
    mass : kg.
    black : a black parallelogram of the checkerboard pattern.
    """

    mark: str
    index: int
    outline: Floats
    face: Floats
    frame: Frame
    nodes: tuple[int, ...]
    neighbours: tuple[str | None, ...]
    edges: tuple[int, ...]
    corner_angles: Floats
    planarity: float
    thickness: float
    mass: float
    black: bool

    @property
    def area(self) -> float:
        """After cutting, mm2."""
        return polygon_area(self.outline)

    def in_space(self) -> Points:
        """(k, 3) the outline on the net, mm."""
        return self.frame.place(self.outline)


def panels(mesh: PanelMesh, spec: PanelSpec) -> tuple[Panel, ...]:
    """One panel per face, in the order of the faces.

    Raises
    ------
    SettingError
        Naming the first panel of which the gap and the clearance leave nothing sound.
    """
    return tuple(_panel(mesh, spec, face) for face in range(len(mesh.faces)))


def panel_groups(
    made: Sequence[Panel], tolerance: float, *, mirror: bool = False
) -> tuple[Group, ...]:
    """Panels that are equal within *tolerance* mm at every corner: "G1", "G2", ...

    Parameters
    ----------
    mirror : whether a panel may be turned over; not for coated or printed sheets.
    """
    return equal_groups([p.outline for p in made], tolerance, prefix="G", mirror=mirror)


def panel_findings(made: Sequence[Panel]) -> tuple[Finding, ...]:
    """``panel-planarity``, an error, for every panel whose corners do not lie in a plane."""
    found = []
    for panel in made:
        apart = panel.face[:, None] - panel.face[None]
        limit = FLATNESS * float(np.linalg.norm(apart, axis=2).max())
        if panel.planarity > limit:
            found.append(
                Finding(
                    "panel-planarity",
                    Severity.ERROR,
                    panel.mark,
                    panel.planarity,
                    limit,
                    "mm",
                    f"The corners of {panel.mark} lie {panel.planarity:.3g} mm off any plane, and "
                    "a flat panel does not fit. Optimise the net for planar quads, or triangulate.",
                )
            )
    return tuple(found)


def panel_mark(face: int) -> str:
    """The mark of a face's panel."""
    return f"P{face + 1}"


def _panel(mesh: PanelMesh, spec: PanelSpec, index: int) -> Panel:
    corners = mesh.corner_points(index)
    count = len(corners)
    frame = best_frame(corners)
    face = frame.flat(corners)
    outline = inset(face, spec.setback)
    if outline is None:
        raise SettingError(
            "A panel has nothing sound left inside its joints",
            where=f"panel {panel_mark(index)}, sides of {_sides(face)} mm",
            value=f"{spec.setback:g} mm set back along every side",
            limit="sides that stay on their places and do not cross",
            advice="a smaller gap, a smaller edge clearance, or larger and less pointed panels",
        )
    edges = mesh.face_edges[index, :count]
    across = mesh.edge_faces[edges].sum(axis=1) - index
    area = polygon_area(outline)
    return Panel(
        mark=panel_mark(index),
        index=index,
        outline=frozen(outline),
        face=frozen(face),
        frame=frame,
        nodes=tuple(mesh.faces[index, :count].tolist()),
        neighbours=tuple(None if f < 0 else panel_mark(f) for f in across.tolist()),
        edges=tuple(edges.tolist()),
        corner_angles=frozen(corner_angles(face)),
        planarity=float(np.abs(frame.distance(corners)).max()),
        thickness=spec.thickness,
        mass=area * spec.thickness * spec.material.density * _MM3_KG_PER_M3,
        black=bool(mesh.black[index]),
    )


def _sides(face: Floats) -> str:
    length = np.linalg.norm(np.roll(face, -1, axis=0) - face, axis=1)
    return ", ".join(f"{side:.1f}" for side in length)
