"""Large nets by way of small ones: solve every second line, carry the change over, solve again.

A new form is found in steps that fairness limits to a few edges at a time, so a net of many edges
would need many. On every second line of every second line the same form is few edges away. The
change found there is spread over the finer net as fairly as its lines allow, and little is left to
do for the next solve.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np

from gridshell.anchors import Anchor
from gridshell.angles import Angle
from gridshell.arrays import Indices, Points
from gridshell.mesh import ControlMesh, QuadMesh, diagonal_stars, edge_stars, two_colouring
from gridshell.mesh.parity import alternating_labels
from gridshell.optimization import OptimizedNet, optimize
from gridshell.pose import pose
from gridshell.recipes import NetRecipe
from gridshell.solve import Step
from gridshell.spreading import spread
from gridshell.surface import Surface
from gridshell.terms import Planarity, target_angles

SMALLEST = 300
"""Quads below which a net is not made coarser."""

LevelProgress = Callable[[int, int, Step], None]
"""Called with the number of quads of the level, the step's number and the step."""


@dataclass(frozen=True, eq=False)
class Coarser:
    """Every second line of both families of edges.

    Parameters
    ----------
    control : the coarser net, its vertices at their places in the finer one.
    vertices : (n,) index of each of its vertices in the finer net.
    centres : (f,) index of the finer net's vertex inside each of its quads.
    """

    control: ControlMesh
    vertices: Indices
    centres: Indices


def coarser(control: ControlMesh) -> Coarser | None:
    """The net of every second line; None where lines cannot be left out evenly.

    That takes an even number of quads between the boundaries and between singular vertices.
    """
    mesh = control.mesh
    row, column = (_line_parity(mesh, family) for family in (0, 1))
    if row is None or column is None:
        return None
    regular = ~mesh.on_boundary & (mesh.valence == 4)
    spokes = diagonal_stars(mesh).spokes
    for parity in range(4):
        inside = (row == parity % 2) & (column == parity // 2) & (mesh.valence > 0)
        centres = np.flatnonzero(inside)
        if 4 * len(centres) != len(mesh.quads) or not regular[centres].all():
            continue
        ring, first = spokes[centres, :4], mesh.first_spoke[centres]
        ring = np.where((first % 2 == 1)[:, None], np.roll(ring, -1, axis=1), ring)
        used, compact = np.unique(ring, return_inverse=True)
        quads = QuadMesh(mesh.vertices[used], compact.reshape(ring.shape))
        return Coarser(ControlMesh(quads, two_colouring(quads)), used, centres)
    return None


def finer(control: ControlMesh) -> ControlMesh:
    """Every quad cut into four along both families; new vertices lie fairly between the old ones.

    The old vertices keep their numbers and places.
    """
    mesh = control.mesh
    n, e, f = len(mesh.vertices), len(mesh.edges), len(mesh.quads)
    ends = np.sort(np.stack([mesh.origin, mesh.target], axis=1), axis=1)
    keys = mesh.edges[:, 0] * n + mesh.edges[:, 1]
    middle = (n + np.searchsorted(keys, ends[:, 0] * n + ends[:, 1])).reshape(-1, 4)
    centre = np.broadcast_to((n + e + np.arange(f))[:, None], (f, 4))
    parts = np.stack([mesh.quads, middle, centre, np.roll(middle, 1, axis=1)], axis=-1)
    # corner k of part k is the old corner: turned back, corner 0 stays in its family
    parts = np.stack([np.roll(parts[:, k], k, axis=-1) for k in range(4)], axis=1)
    a, b = mesh.vertices[mesh.edges.T]
    start = np.concatenate([mesh.vertices, (a + b) / 2.0, mesh.vertices[mesh.quads].mean(axis=1)])
    quads = QuadMesh(start, parts.reshape(-1, 4))
    fine = ControlMesh(quads, two_colouring(quads))
    return fine.moved(spread(fine, start, np.arange(n)))


def optimize_coarse_to_fine(
    control: ControlMesh,
    recipe: NetRecipe,
    *,
    anchor: Anchor,
    reference: Surface | None = None,
    progress: LevelProgress | None = None,
) -> OptimizedNet:
    """As :func:`gridshell.optimize`, for a new form on a large net.

    Parameters
    ----------
    control, recipe, anchor, reference : as there.
    progress : called after every step with the quads of the level, the step's number and the step.

    Returns
    -------
    The result on *control* itself; its steps are those of the finest level.

    Raises
    ------
    As :func:`gridshell.optimize`.
    """
    targets = recipe.angle
    if targets is not None and not callable(targets):
        targets = target_angles(control, recipe.planarity, targets)
    return _solve_level(control, recipe, targets, anchor, reference, progress)


def _solve_level(
    control: ControlMesh,
    recipe: NetRecipe,
    targets: Angle | None,
    anchor: Anchor,
    reference: Surface | None,
    progress: LevelProgress | None,
) -> OptimizedNet:
    size = len(control.quads)
    fixed_angle = replace(recipe, angle=targets)
    start = None
    level = coarser(control) if size >= 4 * SMALLEST else None
    if level is not None and not recipe.conditions:
        coarse = _solve_level(
            level.control,
            recipe,
            _coarse_targets(control, level, recipe.planarity, targets),
            anchor.restricted(level.vertices),
            reference,
            progress,
        )
        if coarse.verdict is None:
            change = coarse.control.vertices - level.control.vertices
            start = control.vertices + _carried(control, level, change, anchor)
    return optimize(
        control,
        fixed_angle,
        anchor=anchor,
        reference=reference,
        start=start,
        progress=None if progress is None else lambda k, step: progress(size, k, step),
    )


def _carried(control: ControlMesh, level: Coarser, change: Points, anchor: Anchor) -> Points:
    """The change of the coarse vertices spread over all; what the anchor holds stays."""
    held = pose(control, anchor).hold.vertices
    known = np.zeros_like(control.vertices)
    known[level.vertices] = change
    known[held] = 0.0
    return spread(control, known, np.union1d(level.vertices, held))


def _coarse_targets(
    control: ControlMesh, level: Coarser, planarity: Planarity, targets: Angle | None
) -> Angle | None:
    """A field as it is; else the mean over each coarse quad, or the value at each crossing."""
    if targets is None or callable(targets):
        return targets
    targets = np.asarray(targets)
    if planarity is not Planarity.EDGE_STARS:
        return np.asarray(targets[control.mesh.fans[level.centres, :4] // 4].mean(axis=1))
    at = np.full(len(control.vertices), np.nan)
    at[_edge_crossing_centres(control)] = targets
    return np.asarray(at[level.vertices[_edge_crossing_centres(level.control)]])


def _edge_crossing_centres(control: ControlMesh) -> Indices:
    stars = edge_stars(control.mesh)
    return np.flatnonzero(stars.closed & (stars.count == 4))


def _line_parity(mesh: QuadMesh, family: int) -> Indices | None:
    """(n,) labels that change across edges of *family* and stay along the others."""
    slot = np.arange(len(mesh.origin)) % 4
    differ = slot % 2 == family
    label = alternating_labels(len(mesh.vertices), mesh.origin, mesh.target, differ)
    broken = (label[mesh.origin] != label[mesh.target]) != differ
    return None if broken.any() else label
