"""Panels, plates and the connectors of a planar net as layers."""

from __future__ import annotations

import colorsys
from collections.abc import Sequence

import numpy as np

from fabrication.colours import css
from fabrication.export.scene.layers import About, Colouring, Faces, Labels, Layer
from fabrication.export.scene.packing import on_screen
from fabrication.grouping import Group
from fabrication.panel_structure import COLOURS, PanelStructure
from fabrication.words import fixed, number
from gridshell.arrays import Floats, Indices, Points

_ALONE = (0.74, 0.80, 0.84)
"""Of panels with no equal, sRGB."""

_SIDES = 12
"""Of the prisms that stand for cylinders."""

_MANY = 150
"""Panels above which marks are hidden until they are asked for."""


def group_colours(groups: Sequence[Group]) -> Floats:
    """(g, 3) a colour for each group, sRGB; panels without an equal are pale."""
    several = [n for n, group in enumerate(groups) if len(group.members) > 1]
    colours = np.tile(np.array(_ALONE), (len(groups), 1))
    for place, n in enumerate(several):
        hue = 0.55 + 0.618034 * place
        colours[n] = colorsys.hls_to_rgb(hue % 1.0, 0.68, 0.5)
    return colours


def panel_layers(built: PanelStructure, centre: Floats, *, visible: bool = True) -> list[Layer]:
    """The panels by group; *centre* (3,) is the origin of the scene, mm."""
    colours, parts, polygons, shades = group_colours(built.panel_groups), [], [], []
    group_of = {m.index: n for n, g in enumerate(built.panel_groups) for m in g.members}
    lift = built.system.panels.thickness
    for panel in built.panels:
        group = built.panel_groups[group_of[panel.index]]
        polygons.append(panel.in_space() + lift * panel.frame.normal)
        shades.append(colours[group_of[panel.index]])
        angles = " / ".join(fixed(a, 1) for a in np.degrees(panel.corner_angles).tolist())
        parts.append(
            About(
                panel.mark,
                (
                    f"group {group.name} of {len(group.members)}",
                    f"{number(panel.mass)} kg",
                    f"corners {angles}°",
                ),
            )
        )
    faces = fans(
        polygons, centre, id="panels", name="Panels", parts=parts, colours=shades, visible=visible
    )
    return [faces] if polygons else []


def support_layers(built: PanelStructure, centre: Floats) -> list[Layer]:
    """The plates, the connectors and the marks of the panels."""
    layers = [_plates(built, centre)] if built.plates else []
    layers += [_connectors(built, centre)] if built.connectors else []
    return [*layers, _marks(built, centre)]


def plate_colouring(built: PanelStructure) -> list[Colouring]:
    """How far the plates are out of plane, where any is."""
    if not built.plates or all(plate.flat for plate in built.plates):
        return []
    off = np.array([plate.out_of_plane for plate in built.plates])
    top = max(float(off.max()), 1e-9)
    return [Colouring("Plates out of plane", "plates", off / top, "0", f"{number(top, 3)} mm")]


def _plates(built: PanelStructure, centre: Floats) -> Faces:
    parts = [
        About(
            plate.mark,
            (
                f"length {fixed(plate.length, 1)} mm",
                f"out of plane {number(plate.out_of_plane)} mm",
                f"twist {number(float(np.degrees(abs(plate.twist))))}°",
            ),
        )
        for plate in built.plates
    ]
    polygons = [plate.in_space() for plate in built.plates]
    return fans(
        polygons,
        centre,
        id="plates",
        name="Plates",
        parts=parts,
        colour=css(COLOURS["plates"]),
        cells_of="plates",
    )


def _connectors(built: PanelStructure, centre: Floats) -> Faces:
    turn = 2.0 * np.pi * np.arange(_SIDES) / _SIDES
    polygons, parts = [], []
    around = np.roll(np.arange(_SIDES), -1)
    for piece in built.pieces:
        connector, high = piece.connector, piece.height
        ring = connector.spec.radius * np.stack([np.cos(turn), np.sin(turn)], axis=1)
        base, up = piece.frame.place(ring), piece.frame.normal
        sides = np.stack([base, base + high * up], axis=1)
        polygons += [np.concatenate([sides[k], sides[around[k]][::-1]]) for k in range(_SIDES)]
        polygons.append(base + high * up)
        between = " / ".join(fixed(a, 1) for a in np.degrees(connector.between).tolist())
        parts.append(About(piece.mark, (f"slots {between}° apart",)))
    return fans(
        polygons,
        centre,
        id="connectors",
        name="Connectors",
        parts=parts,
        colour=css(COLOURS["connectors"]),
        each=_SIDES + 1,
        outlined=False,
    )


def fans(
    polygons: Sequence[Points],
    centre: Floats,
    *,
    id: str,
    name: str,
    parts: Sequence[About],
    colours: Sequence[Floats] = (),
    colour: str = "#5a6472",
    visible: bool = True,
    each: int = 1,
    outlined: bool = True,
    cells_of: str = "",
    opacity: float = 1.0,
) -> Faces:
    """Convex polygons as one layer, *each* of them to a part; one colour for each, or one for all.

    Outlines are drawn around every polygon.
    """
    counts = np.array([len(polygon) for polygon in polygons])
    first = np.cumsum(np.r_[0, counts[:-1]])
    triangles = np.concatenate(
        [at + np.stack([0 * k, k, k + 1], axis=1) for at, k in _spans(first, counts)]
    )
    gap = int(counts.sum())
    loops = np.concatenate(
        [np.r_[at : at + n, at, gap] for at, n in zip(first.tolist(), counts.tolist(), strict=True)]
    )
    return Faces(
        id=id,
        name=name,
        colour=colour,
        visible=visible,
        points=on_screen(np.concatenate(polygons), centre),
        triangles=triangles,
        sizes=(counts - 2).reshape(-1, each).sum(axis=1).tolist(),
        parts=parts,
        colours=np.array(colours) if len(colours) else None,
        loops=loops if outlined else None,
        cells_of=cells_of,
        opacity=opacity,
    )


def _spans(first: Indices, counts: Indices) -> list[tuple[int, Indices]]:
    return [
        (int(at), np.arange(1, int(n) - 1)) for at, n in zip(first, counts, strict=True) if n > 2
    ]


def _marks(built: PanelStructure, centre: Floats) -> Labels:
    places = np.array([p.in_space().mean(axis=0) for p in built.panels])
    lift = np.array([p.frame.normal for p in built.panels])
    raised = places + 0.05 * built.mesh.edge_lengths.mean() * lift
    return Labels(
        id="marks",
        name="Marks",
        visible=len(built.panels) <= _MANY,
        points=on_screen(raised, centre),
        texts=[panel.mark for panel in built.panels],
    )
