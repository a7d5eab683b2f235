"""Panel families: how few moulds make all curved panels of a skin (the paper's Weingarten remark).

Up to second order a panel of radius r is a patch of the quadric z = (k1 x^2 + k2 y^2) / 2 in its
principal frame. Laid onto a mould with curvatures m1, m2 in its own frame it departs by at most
max(abs(k1 - m1), abs(k2 - m2)) r^2 / 2, reached on a principal line at the rim. So a panel is a
square about (k1, k2), and one mould serves all panels whose squares it lies in. On a surface with a
relation between its curvatures the squares are strung along a curve, not spread over an area, and
where the tolerance is what a single panel's own curvature varies by, N panels need about sqrt(N).
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from gridshell.arrays import Floats, Indices, Points, frozen
from gridshell.curvature import principal_curvatures
from gridshell.errors import SettingError
from gridshell.mesh import ControlMesh, PanelMesh
from gridshell.surface import Surface


@dataclass(frozen=True, eq=False)
class PanelFamilies:
    """Moulds, and the mould of every panel.

    Parameters
    ----------
    moulds : (m, 2) curvatures, k1 <= k2, 1/mm, in the order of the first.
    mould_of : (n,) the mould each panel is made on.
    deviation : (n,) largest distance of the panel from its mould, mm.
    """

    moulds: Floats
    mould_of: Indices
    deviation: Floats

    @property
    def panels_per_mould(self) -> float:
        """On average."""
        return len(self.mould_of) / len(self.moulds)


def cluster_panels(curvatures: Floats, radius: Floats | float, tolerance: float) -> PanelFamilies:
    """Cluster curved panels into moulds.

    Parameters
    ----------
    curvatures : (n, 2) principal curvatures of each panel, in either order, 1/mm.
    radius : (n,) or one for all: from the middle of a panel to its furthest corner, mm.
    tolerance : largest distance of any panel from its mould, mm.

    Raises
    ------
    SettingError
        For no panels, values that are not finite, or sizes that are not positive.
    """
    kappa = np.sort(np.asarray(curvatures, dtype=np.float64), axis=1)
    reach = np.broadcast_to(np.asarray(radius, dtype=np.float64), (len(kappa),))
    _check(kappa, reach, tolerance)
    slack = (2.0 * tolerance / reach**2)[:, None]
    low, high = kappa - slack, kappa + slack
    mould_of = np.full(len(kappa), -1, dtype=np.int64)
    moulds: list[Floats] = []
    order = np.argsort(high[:, 0], kind="stable")
    while len(order):
        # all squares left end at or beyond this line; those that begin before it are cut by it
        first = order[0]
        cut = order[low[order, 0] <= high[first, 0]]
        own = cut[_stabbed(low[cut, 1], high[cut, 1], low[first, 1], high[first, 1])]
        moulds.append((low[own].max(axis=0) + high[own].min(axis=0)) / 2.0)
        mould_of[own] = len(moulds) - 1
        order = order[mould_of[order] < 0]
    centre = np.array(moulds)
    apart = np.abs(kappa - centre[mould_of]).max(axis=1)
    return PanelFamilies(frozen(centre), frozen(mould_of, np.int64), frozen(apart * reach**2 / 2.0))


def panel_curvatures(mesh: PanelMesh, surface: Surface) -> tuple[Floats, Floats]:
    """Curvatures and sizes of panels that are bent to a surface.

    Returns
    -------
    curvatures : (f, 2) principal curvatures of *surface* at the middle of each panel, 1/mm.
    radius : (f,) from the mean of a panel's corners to the furthest, mm.
    """
    middle, radius = _places(mesh)
    return np.asarray(surface.closest(middle).curvature), radius


def panel_curvatures_from_mesh(mesh: PanelMesh, control: ControlMesh) -> tuple[Floats, Floats]:
    """The same, estimated from the control mesh of a skin alone.

    A panel takes the curvature of the nearest vertex at which two rings of neighbours tell it,
    that of its middle for D1 and D2 away from the rim.

    Raises
    ------
    SettingError
        For a mesh too small to tell curvature anywhere.
    """
    from scipy.spatial import cKDTree

    vertices, kappa = principal_curvatures(control.mesh)
    if len(vertices) == 0:
        raise SettingError(
            "The mesh is too small to tell its curvature",
            value=f"{len(control.quads)} quads",
            advice="a finer mesh",
        )
    middle, radius = _places(mesh)
    _, nearest = cKDTree(control.vertices[vertices]).query(middle)
    return kappa[nearest], radius


def own_variation(mesh: PanelMesh, curvatures: Floats, radius: Floats) -> float:
    """By how much half of all panels depart from their own quadric at least, mm.

    That is half the step in curvature from a panel to its neighbours. A tolerance below it asks
    moulds to be truer than the panels are quadrics.

    Returns
    -------
    The median over the edges between panels; 0 where there is none.
    """
    pairs = mesh.edge_faces[(mesh.edge_faces >= 0).all(axis=1)]
    if len(pairs) == 0:
        return 0.0
    kappa = np.sort(curvatures, axis=1)
    step = np.abs(kappa[pairs[:, 0]] - kappa[pairs[:, 1]]).max(axis=1)
    return float(np.median(step / 2.0 * (radius[pairs] ** 2).mean(axis=1) / 2.0))


def _places(mesh: PanelMesh) -> tuple[Points, Floats]:
    inside = (mesh.faces >= 0)[..., None]
    corners = mesh.vertices[mesh.faces]
    middle = np.where(inside, corners, 0.0).sum(axis=1) / mesh.corners[:, None]
    away = np.where(inside, corners - middle[:, None], 0.0)
    return middle, np.asarray(np.linalg.norm(away, axis=2).max(axis=1))


def _stabbed(low: Floats, high: Floats, start: float, end: float) -> Indices:
    """Intervals [low, high] that contain the number in [start, end] that most of them contain."""
    candidates = np.concatenate([[start], low[(low > start) & (low <= end)]])
    candidates = np.unique(candidates)
    begun = np.searchsorted(np.sort(low), candidates, side="right")
    ended = np.searchsorted(np.sort(high), candidates, side="left")
    best = candidates[np.argmax(begun - ended)]
    return np.flatnonzero((low <= best) & (high >= best))


def _check(kappa: Floats, reach: Floats, tolerance: float) -> None:
    if kappa.ndim != 2 or kappa.shape[1] != 2 or len(kappa) == 0:
        raise SettingError("Panels need two curvatures each", value=str(kappa.shape))
    if not np.isfinite(kappa).all():
        raise SettingError("A curvature is not a number", where="curvatures")
    for key, values in (("radius", reach), ("tolerance", np.array([tolerance]))):
        if not (np.isfinite(values).all() and (values > 0.0).all()):
            raise SettingError(
                "A size must be positive", where=key, value=f"{values.min():g}", limit="> 0"
            )
