"""Node axes without torsion for planar panels at any node angle: a parallel mesh.

Give every node an offset d so that the offset mesh has every edge parallel to its own:
(d_j - d_i) x e = 0. Then both end offsets and the edge lie in one plane, and a support plate along
them is flat, whatever the angle. A simply connected mesh of planar panels has many such meshes
(Pottmann et al. 2007, Liu et al. 2006); taken is the one whose offsets are nearest to the node axes
in the sense of least squares. At a node angle of 90 degrees that is the offset at a constant
distance, to the order of the panels' size; at another angle no parallel mesh is an offset, and the
axes lean: ``tilt`` is the price of flat plates.

The least squares with their linear conditions are solved by an augmented Lagrangian, so that
conditions that follow from each other (every loop of edges gives some) do no harm; one
factorisation serves all rounds.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from gridshell.arrays import Floats, Vectors, frozen, unit
from gridshell.errors import MeshError
from gridshell.mesh import PanelMesh, position

_PENALTY = 1e8
_ROUNDS = 8
_GONE = 1e-3


@dataclass(frozen=True, eq=False)
class TorsionFreeAxes:
    """Axes along which all support plates are flat.

    Parameters
    ----------
    axes : (n, 3) unit.
    tilt : (n,) angle to the axes they stand in for, radians.
    distance : (n,) length of each offset where theirs is 1: how far from constant the distance of
        the parallel mesh is.
    residual : largest part of an offset difference across its edge, where offsets are 1; nought
        but for rounding where panels are flat.
    """

    axes: Vectors
    tilt: Floats
    distance: Floats
    residual: float


def torsion_free_axes(mesh: PanelMesh) -> TorsionFreeAxes:
    """The torsion-free axes nearest to those of *mesh*.

    Raises
    ------
    MeshError
        Where the nearest parallel mesh leaves a node without an axis, as panels that are not flat
        or that close around a hole can.
    """
    from scipy.sparse import csr_matrix, identity
    from scipy.sparse.linalg import splu

    i, j = mesh.edges.T
    first, second = _across(mesh.vertices[j] - mesh.vertices[i])
    count, size = len(i), mesh.vertices.size
    ends = np.hstack([3 * i[:, None] + np.arange(3), 3 * j[:, None] + np.arange(3)])
    values = np.vstack([np.hstack([-first, first]), np.hstack([-second, second])])
    rows = np.repeat(np.arange(2 * count), 6)
    shape = (2 * count, size)
    across = csr_matrix((values.ravel(), (rows, np.tile(ends, (2, 1)).ravel())), shape=shape)
    system = (identity(size) + _PENALTY * (across.T @ across)).tocsc()
    factor = splu(
        system,
        permc_spec="MMD_AT_PLUS_A",
        diag_pivot_thresh=0.0,
        options={"SymmetricMode": True},
    )
    force = np.zeros(2 * count)
    found = rest = np.zeros(0)
    for _ in range(_ROUNDS):
        found = factor.solve(mesh.axes.ravel() - across.T @ force)
        rest = across @ found
        force += _PENALTY * rest
    offsets = found.reshape(-1, 3)
    distance = np.linalg.norm(offsets, axis=1)
    lost = int(np.argmin(distance))
    if not distance[lost] > _GONE:
        raise MeshError(
            "No torsion-free axes come near those of the net",
            where=f"node {lost} {position(mesh.vertices[lost])}",
            limit="flat panels over a surface without closed rings",
            advice="a node angle of 90 degrees, which needs no other axes",
        )
    axes = unit(offsets)
    aside = np.linalg.norm(np.cross(axes, mesh.axes), axis=1)
    tilt = np.arctan2(aside, np.einsum("nc,nc->n", axes, mesh.axes))
    return TorsionFreeAxes(frozen(axes), frozen(tilt), frozen(distance), float(np.abs(rest).max()))


def _across(run: Floats) -> tuple[Vectors, Vectors]:
    """Two unit directions across each edge (m, 3) and each other."""
    helper = np.eye(3)[np.argmin(np.abs(run), axis=1)]
    first = unit(np.cross(run, helper))
    return first, unit(np.cross(run, first))
