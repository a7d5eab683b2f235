"""What meshes show of themselves in a notebook; see ``picture``."""

from __future__ import annotations

from collections.abc import Sequence
from math import ceil, sqrt

import numpy as np

from gridshell.arrays import Floats, Indices
from gridshell.mesh.control_mesh import ControlMesh
from gridshell.mesh.crossings import crossing_angles
from gridshell.mesh.diagonals import DiagonalMesh, diagonal_meshes
from gridshell.mesh.panel_mesh import PanelMesh
from gridshell.mesh.polylines import edge_strands, polylines
from gridshell.mesh.quad_mesh import QuadMesh
from gridshell.painter import Layer, polygons
from gridshell.picture import (
    FAMILY_COLOURS,
    INK,
    MOST_LINES,
    card,
    family_lines,
    limits,
    pale,
    size,
    sketch,
    straight,
)

_MOST_FACES = 2_500
"""Nets with more are drawn by some of their lines alone."""

Shown = tuple[list[Layer], tuple[str, ...]]
"""Layers of a picture, and what to say beside it."""


def quad_mesh_html(mesh: QuadMesh) -> str:
    """Its quads and edges, and its size."""
    layers, notes = _drawn_edges(mesh)
    figures = [*_counts(mesh), ("Mean edge", f"{mesh.mean_edge:.1f} mm"), _singular(mesh)]
    picture = sketch(layers, label="A quad mesh")
    return card("Quad mesh", figures, picture=picture, notes=notes)


def control_mesh_html(control: ControlMesh) -> str:
    """Its quads with the edges of D1 by family; its own edges where families are not known."""
    layers, notes = control_layers(control)
    picture = sketch(layers, label="A control mesh with the edges of D1")
    return card("Control mesh", control_figures(control), picture=picture, notes=notes)


def diagonal_mesh_html(net: DiagonalMesh) -> str:
    """Its faces and its edges by family."""
    layers, notes = _drawn_net(net, polygons(net.vertices, net.faces))
    counts = [int(np.count_nonzero(net.family == family)) for family in FAMILY_COLOURS]
    figures = [
        ("Vertices", f"{len(net.vertices)}"),
        ("Faces", f"{len(net.faces)}"),
        ("Edges of family 1, 2", " + ".join(map(str, counts))),
        ("Mean edge", f"{net.mean_edge:.1f} mm" if len(net.edges) else ""),
        ("Spans", size(net.vertices)),
        ("Node angle", limits(np.degrees(_star_angles(net)), "degrees")),
    ]
    picture = sketch(layers, label="A net of two families")
    return card("Diagonal mesh", figures, picture=picture, notes=notes)


def panel_mesh_html(mesh: PanelMesh) -> str:
    """Its panels and the edges between them."""
    layers: list[Layer] = [
        pale(polygons(mesh.vertices, mesh.faces[:_MOST_FACES])),
        straight(mesh.vertices, mesh.edges[:MOST_LINES], width=0.8),
    ]
    many = len(mesh.faces) > _MOST_FACES or len(mesh.edges) > MOST_LINES
    figures = [
        ("Nodes", f"{len(mesh.vertices)}"),
        ("Panels", f"{len(mesh.faces)}"),
        ("Spans", size(mesh.vertices)),
        ("Edges", limits(mesh.edge_lengths, "mm", 1)),
    ]
    notes = (f"The first {_MOST_FACES} panels are drawn.",) if many else ()
    picture = sketch(layers, label="A skin of panels")
    return card("Panel mesh", figures, picture=picture, notes=notes)


def control_layers(control: ControlMesh) -> Shown:
    """The quads of a control mesh and the edges of D1 on them."""
    if (control.colour < 0).all():
        return _drawn_edges(control.mesh)
    net = diagonal_meshes(control)[0]
    return _drawn_net(net, control.vertices[control.quads])


def control_figures(control: ControlMesh) -> list[tuple[str, str]]:
    """Size of a control mesh, and the angles between the diagonals of its quads."""
    known = bool((control.colour >= 0).any())
    angles = np.degrees(crossing_angles(control.vertices, control.quads))
    return [
        *_counts(control.mesh),
        ("Mean edge", f"{control.mesh.mean_edge:.1f} mm"),
        _singular(control.mesh),
        ("Node angle", limits(angles, "degrees") if known else ""),
    ]


def _counts(mesh: QuadMesh) -> list[tuple[str, str]]:
    used = mesh.valence > 0
    return [
        ("Vertices", f"{int(np.count_nonzero(used))}"),
        ("Faces", f"{len(mesh.quads)}"),
        ("Spans", size(mesh.vertices[used])),
    ]


def _singular(mesh: QuadMesh) -> tuple[str, str]:
    inner = ~mesh.on_boundary & (mesh.valence > 0) & (mesh.valence != 4)
    return ("Singular vertices", f"{int(np.count_nonzero(inner))}")


def _star_angles(net: DiagonalMesh) -> Floats:
    """(m,) from family 1 to family 2 at every closed star of four, radians."""
    centre = np.flatnonzero(net.stars.closed & (net.stars.count == 4))
    ring = net.stars.spokes[centre, :4]
    second = net.family[net.spoke_edges[centre, 0]] == 2
    turned = np.where(second[:, None], np.roll(ring, -1, axis=1), ring)
    return crossing_angles(net.vertices, turned)


# ---- pictures ------------------------------------------------------------------------------------


def _drawn_net(net: DiagonalMesh, faces: Floats) -> Shown:
    """The edges of a net by family on *faces* (m, k, 3), or some lines of a large one."""
    if len(net.edges) <= min(MOST_LINES, _MOST_FACES):
        return [pale(faces), *family_lines(net.vertices, net.edges, net.family)], ()
    found = polylines(net)
    layers: list[Layer] = []
    step = _step(len(net.edges))
    for family, colour in FAMILY_COLOURS.items():
        own = [
            np.r_[line.vertices, line.vertices[:1]] if line.closed else line.vertices
            for line in found
            if line.family == family
        ]
        layers.append(straight(net.vertices, _some(own, step), colour))
    return layers, (_told(step, len(faces)),)


def _drawn_edges(mesh: QuadMesh) -> Shown:
    """The edges of *mesh* on its quads, or some lines of a large one."""
    if len(mesh.quads) <= _MOST_FACES:
        edges = straight(mesh.vertices, mesh.edges, width=0.8)
        return [pale(mesh.vertices[mesh.quads]), edges], ()
    step = _step(len(mesh.edges))
    some = straight(mesh.vertices, _some(edge_strands(mesh), step), INK, 0.8)
    return [some], (_told(step, len(mesh.quads)),)


def _step(edges: int) -> int:
    """Of how many lines, and of how many points on them, one is drawn."""
    return max(1, ceil(sqrt(edges / MOST_LINES)))


def _told(step: int, faces: int) -> str:
    if step == 1:
        return f"A large net of {faces} quads: its lines without faces."
    return f"A large net of {faces} quads: one line of {step} is drawn, straight over {step} edges."


def _some(lines: Sequence[Indices], step: int) -> Indices:
    """(m, 2) ends of straight lines along every *step*-th of *lines*, over so many edges each."""
    chosen = [line[np.unique(np.r_[0 : len(line) : step, len(line) - 1])] for line in lines[::step]]
    ends = [np.stack([line[:-1], line[1:]], axis=1) for line in chosen]
    return np.concatenate([np.empty((0, 2), dtype=np.int64), *ends])
