"""A triangulated facade on a net whose bays are not flat, as an A-net's (Fig. 16).

A secondary profile along one diagonal braces each bay and frames two flat triangles. Bays around a
singular vertex, with more than four corners, get a fan of profiles from their first corner.
"""

from __future__ import annotations

from dataclasses import dataclass
from enum import Enum

import numpy as np

from fabrication.panel import Panel, PanelSpec, panels
from gridshell import DiagonalMesh, PanelMesh, panel_mesh
from gridshell.arrays import Floats, Indices, Mask, Points, frozen


class DiagonalRule(Enum):
    """Which diagonal of a bay carries the secondary profile; at a tie that of the first corner.

    Attributes
    ----------
    SHORTER : the shorter one: less material, less bending.
    FLATTER : the one about which the two triangles fold less.
    """

    SHORTER = "shorter"
    FLATTER = "flatter"


@dataclass(frozen=True, eq=False)
class Facade:
    """Glass and secondary profiles on a net.

    Parameters
    ----------
    mesh : the triangles as panels; the node axes are those given, at the net's own vertices.
    panels : two per bay, in the order of the bays; their marks count on from bay to bay.
    bay : (f,) the net's face each triangle belongs to.
    secondary : (s,) edges of *mesh* that carry a secondary profile.
    lengths : (s,) of these profiles from node to node, mm.
    folds : (s,) angle between the two panels there, 0 where they are in one plane, radians.
    """

    mesh: PanelMesh
    panels: tuple[Panel, ...]
    bay: Indices
    secondary: Indices
    lengths: Floats
    folds: Floats


def triangulated_facade(
    net: DiagonalMesh,
    spec: PanelSpec,
    *,
    axes: Points,
    rule: DiagonalRule = DiagonalRule.SHORTER,
) -> Facade:
    """Two flat triangles per bay of *net*.

    Parameters
    ----------
    axes : (n, 3) node axes of the net, as those of a structure's nodes.

    Raises
    ------
    MeshError
        For a net without a single bay.
    SettingError
        Naming the first triangle of which the gap leaves nothing.
    """
    triangles, bay = _triangles(net, rule)
    mesh = panel_mesh(net.vertices, triangles, axes)
    within = _same_bay(mesh, bay)
    secondary = np.flatnonzero(within)
    normals = mesh.normals()[mesh.edge_faces[secondary]]
    apart = np.linalg.norm(np.cross(normals[:, 0], normals[:, 1]), axis=1)
    folds = np.arctan2(apart, np.einsum("sc,sc->s", normals[:, 0], normals[:, 1]))
    return Facade(
        mesh=mesh,
        panels=panels(mesh, spec),
        bay=frozen(bay, np.int64),
        secondary=frozen(secondary, np.int64),
        lengths=frozen(mesh.edge_lengths[secondary]),
        folds=frozen(folds),
    )


def _triangles(net: DiagonalMesh, rule: DiagonalRule) -> tuple[Indices, Indices]:
    rows: list[list[int]] = []
    bay: list[int] = []
    for face, padded in enumerate(net.faces):
        ring = padded[padded >= 0]
        if len(ring) == 4 and _second_is_better(net.vertices[ring], rule):
            ring = np.roll(ring, -1)
        for k in range(1, len(ring) - 1):
            rows.append([int(ring[0]), int(ring[k]), int(ring[k + 1])])
            bay.append(face)
    return np.array(rows, dtype=np.int64).reshape(-1, 3), np.array(bay, dtype=np.int64)


def _second_is_better(corners: Points, rule: DiagonalRule) -> bool:
    """Whether the diagonal between corners 1 and 3 is the one to take."""
    if rule is DiagonalRule.SHORTER:
        first, second = corners[2] - corners[0], corners[3] - corners[1]
        return bool(np.linalg.norm(second) < (1.0 - 1e-9) * np.linalg.norm(first))
    first_fold, second_fold = _fold(corners), _fold(np.roll(corners, -1, axis=0))
    return bool(second_fold < first_fold - 1e-9)


def _fold(corners: Points) -> float:
    a, b, c, d = corners
    first, second = np.cross(b - a, c - a), np.cross(c - a, d - a)
    return float(np.arctan2(np.linalg.norm(np.cross(first, second)), first @ second))


def _same_bay(mesh: PanelMesh, bay: Indices) -> Mask:
    left, right = mesh.edge_faces.T
    return np.asarray((left >= 0) & (right >= 0) & (bay[left] == bay[right]))
